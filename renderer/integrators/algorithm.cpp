// SPDX-License-Identifier: MIT
// The registry of algorithms.
#include "renderer/integrators/algorithm.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "renderer/base/error.h"

namespace rtrays {

const std::vector<const Algorithm *> &all_algorithms() {
    static const std::vector<const Algorithm *> all = {
        &algorithms::ray_casting,   &algorithms::whitted, &algorithms::path_tracing,
        &algorithms::light_tracing, &algorithms::bdpt,    &algorithms::truncated_bdpt};
    return all;
}

const std::vector<std::string> &algorithm_names() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> list;
        for (const Algorithm *algorithm : all_algorithms()) {
            list.emplace_back(algorithm->name);
        }
        return list;
    }();
    return names;
}

const Algorithm &algorithm_named(const std::string &name) {
    const auto &all = all_algorithms();
    const auto found =
        std::find_if(all.begin(), all.end(), [&](const Algorithm *a) { return a->name == name; });
    if (found == all.end()) {
        throw input_error(fmt::format("unknown algorithm '{}'; algorithms are: {}", name,
                                      fmt::join(algorithm_names(), ", ")));
    }
    return **found;
}

std::vector<Pass> algorithm_passes(const Algorithm &algorithm, PassRequest request) {
    FeatureMask others;
    for (const Algorithm *other : all_algorithms()) {
        others = others | other->features;
    }
    request.features = request.features.without(others.without(algorithm.features));
    return algorithm.passes(request);
}

}  // namespace rtrays
