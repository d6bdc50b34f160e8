// SPDX-License-Identifier: MIT
// Batches of samples, passes over a batch, and rounds of stages until no path is in flight.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>

#include "renderer/base/error.h"
#include "renderer/session/state.h"
#include "renderer/shared/tail.h"

namespace rtrays {

namespace {

/// Returns the number of paths of one batch. It is small enough to show progress and to react to an
/// interrupt within seconds. It is also many times the number of paths in flight, because the last
/// paths of a batch leave a device nearly idle. The work counter has 32 bits.
uint64_t batch_paths(const DeviceInfo &device) {
    return device.is_cpu ? 1u << 21 : 1u << 26;
}

/// Number of rounds that are enqueued between two reads of the counters.
constexpr int rounds_per_check = 8;

/// Number of counter reads between two collections of the profile, which keeps an event of every
/// launch until then.
constexpr int checks_per_profile = 64;

/// Number of rounds of a batch's tail after which a kernel that advances them by many
/// vertices per launch is worth its compilation.
constexpr int tail_rounds_before_compilation = 512;

/// Returns the number of rounds after which all stages of a pass are launched in every round or in
/// none. Only then may the tail replace the round.
int limited_rounds(const std::vector<RoundStage> &round) {
    uint32_t rounds = 0;
    for (const RoundStage &stage : round) {
        rounds = std::max(rounds, stage.rounds);
    }
    return static_cast<int>(rounds);
}

/// Binds the index of the light or vertex that a stage connects to, if it has changed.
void bind_index(CompiledPass &pass, const RoundStage &stage) {
    for (auto &[input, bound] : pass.indices) {
        if (stage.index != bound && stage_description(stage.stage).reads(input)) {
            pass.stages.bind({{input, {stage.index}}});
            bound = stage.index;
        }
    }
}

/// Reads of the stream counters. The host waits for the read before the last one, so that the
/// device stays busy.
class CounterReads {
  public:
    CounterReads(DeviceContext &device, const Buffer<StreamCounters> &counters)
        : device_(&device), counters_(&counters) {}
    ~CounterReads() {
        clFinish(device_->queue());  // after an error, a read may still be writing to `seen_`
    }
    CounterReads(const CounterReads &) = delete;
    CounterReads &operator=(const CounterReads &) = delete;

    /// Enqueues a read and returns the result of the one before, if there was one. Throws `Error`
    /// (run failed) if a stream has overflowed.
    std::optional<StreamCounters> next() {
        cl_event event = nullptr;
        check_cl(clEnqueueReadBuffer(device_->queue(), counters_->get(), CL_FALSE, 0,
                                     sizeof(StreamCounters), &seen_[now_], 0, nullptr, &event),
                 "reading the stream counters");
        read_[now_] = ClEvent(event);
        check_cl(clFlush(device_->queue()), "submitting work to the device");
        now_ = 1 - now_;
        const cl_event wanted = read_[now_].get();
        if (wanted == nullptr) {
            return std::nullopt;
        }
        check_cl(clWaitForEvents(1, &wanted), "waiting for the device");
        if (seen_[now_].overflow > 0) {
            throw run_error(fmt::format("a stream overflowed {} times", seen_[now_].overflow));
        }
        return seen_[now_];
    }

  private:
    DeviceContext *device_;
    const Buffer<StreamCounters> *counters_;
    std::array<StreamCounters, 2> seen_{};
    std::array<ClEvent, 2> read_;
    size_t now_ = 0;
};

}  // namespace

uint64_t RenderSession::State::batch_size(uint64_t begin, uint64_t end) const {
    const uint64_t batch =
        batch_paths(device.info()) / std::max<uint64_t>(1, live_paths_per_sample());
    uint64_t count = std::min(std::clamp<uint64_t>(batch, 1, FILM_ADDITIONS_AT_ONCE), end - begin);
    if (convergence != nullptr && convergence->live_count() > 0) {
        count = std::min(count, convergence->rule().next_check(begin) - begin);
    }
    return count;
}

void RenderSession::State::require_next(uint64_t begin, uint64_t end) const {
    const uint64_t done = ranges.samples();
    if (convergence != nullptr && begin < end && begin != done) {
        throw input_error(fmt::format(
            "convergence control needs all samples from 0 on in order; the film has {}: "
            "expected sample {}, got {}",
            done, done, begin));
    }
}

void RenderSession::State::enqueue(CompiledPass &pass, Stage stage, uint64_t paths) {
    switch (stage_description(stage).items) {
        case StageItems::entries:
            return pass.stages.enqueue(stage, (layout.capacity + layout.chunk - 1) / layout.chunk);
        case StageItems::paths:
            return pass.stages.enqueue(stage, (paths + layout.chunk - 1) / layout.chunk);
        case StageItems::slots:
            return pass.stages.enqueue(stage, layout.capacity);
        case StageItems::tail_paths:
            return pass.stages.enqueue(stage, TAIL_PATHS(layout.capacity));
        case StageItems::film_sums:
            return pass.stages.enqueue(stage, film_sums());
        case StageItems::one:
            return pass.stages.enqueue(stage, 1);
    }
}

void RenderSession::State::run_batch(uint64_t first, uint64_t count) {
    for (CompiledPass &pass : passes) {
        pass.is_carried = false;
        if (count == 0) {
            carry_film(pass);  // the first enqueue compiles the kernel
        }
    }
    if (features.has(Feature::vertex_connections)) {
        // Each pass traces one path per pixel, chunk by chunk, so that both passes use the same
        // light vertices.
        const auto work = static_cast<uint32_t>(count * pixels());
        for (uint32_t begin = 0; begin == 0 || begin < work; begin += layout.capacity) {
            for (CompiledPass &pass : passes) {
                run_pass(pass, first, begin, std::min(begin + layout.capacity, work));
            }
        }
    } else {
        for (CompiledPass &pass : passes) {
            const auto work = static_cast<uint32_t>(count * live_paths_per_sample(pass));
            if (work > 0 || count == 0) {
                run_pass(pass, first, 0, work);
            }
        }
    }
    for (CompiledPass &pass : passes) {
        if (pass.features.has(Feature::convergence) &&
            (count == 0 || convergence->rule().is_check(first + count))) {
            carry_film(pass);
            convergence->check(pass.film, first + count);
            pass.stages.bind(convergence->arguments());
        }
        collect_profile(pass);
    }
}

void RenderSession::State::carry_film(CompiledPass &pass) {
    if (!pass.is_carried && !settings.light_path_trials) {
        enqueue(pass, Stage::carry_film);
        collect_profile(pass);
        pass.is_carried = true;
    }
}

std::vector<int64_t> RenderSession::State::read_film(CompiledPass &pass) {
    carry_film(pass);
    return pass.film.read();
}

void RenderSession::State::collect_profile(CompiledPass &pass) {
    device.finish();
    for (const auto &[name, stage] : device.profiler().take()) {
        pass.profile[name].seconds += stage.seconds;
        pass.profile[name].launches += stage.launches;
    }
}

void RenderSession::State::add_tail_stages(CompiledPass &pass) {
    collect_profile(pass);
    const auto start = SteadyClock::now();
    for (const RoundStage &stage : pass.tail) {
        if (!pass.stages.has(stage.stage)) {
            pass.stages.add({stage.stage});
        }
        enqueue(pass, stage.stage);  // the first enqueue compiles
    }
    device.finish();
    compile_seconds += seconds_since(start);
}

void RenderSession::State::run_pass(CompiledPass &pass, uint64_t first, uint32_t begin,
                                    uint32_t end) {
    pass.stages.bind({{StageInput::first_sample, {first}},
                      {StageInput::first_work, {begin}},
                      {StageInput::work, {end}}});
    if (!pass.streams) {
        enqueue(pass, pass.round.front().stage,
                std::max<uint64_t>(end - begin, 1));  // 1: the first enqueue compiles
        return collect_profile(pass);
    }
    enqueue(pass, Stage::reset_streams);
    uint64_t in_flight = layout.capacity;
    const int first_tail_round = limited_rounds(pass.round);
    int tail_rounds = 0;
    CounterReads reads(device, counters);
    for (int check = 0;; ++check) {
        const bool few = in_flight <= TAIL_PATHS(layout.capacity);
        tail_rounds += few ? rounds_per_check : 0;
        if (tail_rounds > tail_rounds_before_compilation && !pass.tail.empty() &&
            !pass.has_tail_stages()) {
            add_tail_stages(pass);
        }
        const bool runs_tail =
            few && pass.has_tail_stages() && check * rounds_per_check >= first_tail_round;
        for (int i = 0; i < rounds_per_check; ++i) {
            for (const RoundStage &stage : runs_tail ? pass.tail : pass.round) {
                if (stage.rounds > 0 &&
                    static_cast<uint32_t>(check * rounds_per_check + i) >= stage.rounds) {
                    continue;
                }
                if (stage.shows_emitters && !emitters_in_view) {
                    continue;
                }
                bind_index(pass, stage);
                enqueue(pass, stage.stage);
            }
        }
        if (check % checks_per_profile == checks_per_profile - 1) {
            collect_profile(pass);
        }
        if (const std::optional<StreamCounters> seen = reads.next()) {
            in_flight = seen->next_work >= end ? seen->active[seen->parity] : in_flight;
            if (in_flight == 0) {
                break;
            }
        }
    }
    collect_profile(pass);
}

}  // namespace rtrays
