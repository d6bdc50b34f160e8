// SPDX-License-Identifier: MIT
#include "experiments/harness/kinds/curves_description.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>

#include "renderer/base/error.h"

namespace rtrays {

namespace {

/// Returns the sample counts up to `last`. Throws `Error` (bad input) if `last` is not among them
/// or if fewer than three remain.
std::vector<uint64_t> rungs_up_to(const std::vector<uint64_t> &spp, uint64_t last,
                                  const std::string &location) {
    const auto found = std::find(spp.begin(), spp.end(), last);
    if (found == spp.end() || found - spp.begin() < 2) {
        throw input_error(fmt::format("{}: expected the third or a later value of \"spp\", got {}",
                                      location, last));
    }
    return {spp.begin(), found + 1};
}

/// Reads the values that `key` of a profile sets for single curves, by id. Throws `Error` (bad
/// input) for an unknown id.
std::map<std::string, uint64_t> read_by_curve(const DescriptionFile &file,
                                              const std::string &pointer, const Json &profile,
                                              const std::string &key,
                                              const std::vector<CurveDescription> &curves) {
    auto counts = profile.value(key, std::map<std::string, uint64_t>());
    for (const auto &[id, count] : counts) {
        if (std::none_of(curves.begin(), curves.end(),
                         [&, &id = id](const auto &curve) { return curve.id() == id; })) {
            throw input_error(
                fmt::format("{}: unknown curve '{}'", file.location(pointer + "/" + key), id));
        }
    }
    return counts;
}

/// Fills in the sample counts and seeds of a profile.
void read_ladders(const DescriptionFile &file, const std::string &pointer, const Json &profile,
                  std::vector<CurveDescription> &curves) {
    const auto spp = profile.at("spp").get<std::vector<uint64_t>>();
    require_increasing(spp, file.location(pointer + "/spp"));
    const auto early = profile.value("early_images", std::vector<uint64_t>());
    for (const uint64_t wanted : early) {
        if (std::find(spp.begin(), spp.end(), wanted) == spp.end()) {
            throw input_error(fmt::format("{}: expected a value of \"spp\", got {}",
                                          file.location(pointer + "/early_images"), wanted));
        }
    }
    const auto seeds = profile.at("seeds").get<uint32_t>();
    const auto most = read_by_curve(file, pointer, profile, "most_spp", curves);
    const auto more = read_by_curve(file, pointer, profile, "more_seeds", curves);
    for (CurveDescription &curve : curves) {
        curve.seeds =
            more.count(curve.id()) > 0 ? static_cast<uint32_t>(more.at(curve.id())) : seeds;
        const auto limit = most.find(curve.id());
        curve.spp = limit == most.end()
                        ? spp
                        : rungs_up_to(spp, limit->second, file.location(pointer + "/most_spp"));
        if (curve.spp.back() % batches_per_seed != 0) {
            throw input_error(
                fmt::format("{}: expected a last value divisible into batches, got {}; make it a "
                            "multiple of {}",
                            file.location(pointer + "/spp"), curve.spp.back(), batches_per_seed));
        }
        std::copy_if(early.begin(), early.end(), std::back_inserter(curve.early_images),
                     [&](uint64_t wanted) { return wanted <= curve.spp.back(); });
    }
}

}  // namespace

CurvesDescription read_curves(const DescriptionFile &file, const std::string &profile) {
    const Json &json = file.json;
    const Json &chosen = file.profile(profile);
    CurvesDescription experiment;
    json.at("name").get_to(experiment.name);
    experiment.title = json.value("title", experiment.name);
    experiment.thesis = json.value("thesis", "none");
    experiment.claim = json.value("claim", "");
    if (json.contains("expected_slope")) {
        json.at("expected_slope").at("value").get_to(experiment.expected_slope);
        json.at("expected_slope").at("tolerance").get_to(experiment.slope_tolerance);
    }
    experiment.expected_gain = json.value("expected_gain", Json());
    read_measured_scene(file, chosen.at("size"), experiment);
    experiment.profile = profile;
    experiment.settings = chosen.value("settings", Json::object());
    read_ladders(file, "/profiles/" + profile, chosen, experiment.curves);
    if (chosen.contains("throughput")) {
        const Json &throughput = chosen.at("throughput");
        const auto &curves = experiment.curves;
        const auto last = std::find_if(curves.rbegin(), curves.rend(),
                                       [](const auto &curve) { return !curve.other; });
        if (last == curves.rend()) {
            throw input_error(fmt::format(
                "{}: the throughput is that of this renderer, which has no curve; remove it",
                file.location("/profiles/" + profile + "/throughput")));
        }
        experiment.throughput = {*last, throughput.at("repetitions"), throughput.at("spp")};
    }
    experiment.source = file.of_profile(profile);
    return experiment;
}

}  // namespace rtrays
