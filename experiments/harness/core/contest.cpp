// SPDX-License-Identifier: MIT
#include "experiments/harness/core/contest.h"

#include <algorithm>
#include <stdexcept>

#include "experiments/harness/core/host.h"

namespace rtrays {

void Contest::add(const std::string &name, const std::function<Seconds()> &run) {
    contestants_.push_back({name, run});
}

Contest::ForeignLoad Contest::measured_foreign_load() {
    return [meter = CpuMeter()]() mutable {
        const CpuUse use = meter.use();
        meter.start();
        return use.foreign + use.steal;
    };
}

void Contest::turn() {
    foreign_since_();
    const size_t count = contestants_.size();
    for (size_t i = 0; i < count; ++i) {
        Contestant &contestant = contestants_[started_ % 2 == 0 ? i : count - 1 - i];
        contestant.times.push_back(contestant.run());
    }
    foreign_.push_back(foreign_since_());
    ++started_;
}

void Contest::discard_turn() {
    for (Contestant &contestant : contestants_) {
        contestant.times.pop_back();
    }
    foreign_.pop_back();
}

std::vector<std::string> Contest::names() const {
    std::vector<std::string> names;
    for (const Contestant &contestant : contestants_) {
        names.push_back(contestant.name);
    }
    return names;
}

const Contest::Contestant &Contest::find(const std::string &name) const {
    const auto found =
        std::find_if(contestants_.begin(), contestants_.end(),
                     [&](const Contestant &contestant) { return contestant.name == name; });
    if (found == contestants_.end()) {
        throw std::out_of_range("unknown contestant " + name);
    }
    return *found;
}

namespace {

template <typename Value>
Interval median_of(const std::vector<Seconds> &times, const Value &value) {
    std::vector<double> values;
    for (const Seconds &time : times) {
        values.push_back(value(time));
    }
    return median_interval(values);
}

}  // namespace

Interval Contest::wall_seconds(const std::string &name) const {
    return median_of(find(name).times, [](const Seconds &time) { return time.wall; });
}

Interval Contest::processor_seconds(const std::string &name) const {
    return median_of(find(name).times, [](const Seconds &time) { return time.processor; });
}

Interval Contest::speed_over(const std::string &name, const std::string &other) const {
    const std::vector<Seconds> &ours = find(name).times, &theirs = find(other).times;
    std::vector<double> ratios;
    for (size_t i = 0; i < ours.size(); ++i) {
        ratios.push_back(clock_ == Clock::wall ? theirs[i].wall / ours[i].wall
                                               : theirs[i].processor / ours[i].processor);
    }
    return median_interval(ratios);
}

double Contest::foreign_load() const {
    return median(foreign_);
}

}  // namespace rtrays
