// SPDX-License-Identifier: MIT
// The cases of a stability suite (schema/stability.schema.json): stiff and extreme scenes with what
// they must come to.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "experiments/description.h"
#include "renderer/pipeline/settings.h"
#include "renderer/scene/scene.h"

namespace rtrays {

/// A scene file with properties set: addresses and values of `--set scene.`.
struct SceneVariant {
    std::filesystem::path path;
    std::vector<std::pair<std::string, std::string>> properties;

    Scene load() const;
};

/// What a case's image is held against.
enum class Expectation {
    closed_form,  ///< every pixel has one value, computed by a formula
    reference,    ///< the Embree reference, in double precision
    like,         ///< another scene by the same algorithm, seed and samples
    saturates     ///< samples beyond the film's range must be counted and reported, not clamped or
                  ///< wrapped
};

/// One of the algorithms that render a case.
struct StabilityRun {
    std::string name;  ///< with the values of its own settings: "path_tracing implicit"
    RenderSettings settings;
};

struct StabilityCase {
    std::string name;      ///< with the values of its sweep: "furnace rho=0.5"
    std::string group;     ///< without
    double stiffness = 0;  ///< the swept parameter named by "stiffness"; 0 without one
    std::string title;     ///< what it is and where the expected value comes from
    SceneVariant scene;
    Expectation expectation = Expectation::closed_form;
    std::array<double, 3> expected{};  ///< radiance by channel, of a closed form
    SceneVariant other;                ///< of `like`
    std::array<size_t, 3> channels{};  ///< of `like`: the channel of `other` that each must equal
    std::vector<StabilityRun> runs;    ///< with size
    std::map<std::string, std::string> unseen;  ///< algorithms that cannot render it, and why
    uint64_t spp = 0;                           ///< of all batches together
    uint64_t reference_spp = 0;
    uint64_t first_sample = 0;
    double within = 0;   ///< largest half width of the interval of the mean, relative
    double bound = 0;    ///< deviation that float32 is allowed, relative
    std::string reason;  ///< of a bound other than the suite's
};

struct StabilitySuite {
    std::string name;
    std::string profile;
    double bound = 0;     ///< of cases without one of their own
    bool survey = false;  ///< only values that are not finite or out of range are failures
    std::vector<StabilityCase> cases;
};

/// Cases of a profile, sweeps written out. Throws `Error` (bad input) naming file, case and remedy.
StabilitySuite load_stability(const std::filesystem::path &path, const std::string &profile);

}  // namespace rtrays
