// SPDX-License-Identifier: MIT
// Reads the cases of a stability suite (schema/stability.schema.json): stiff and extreme scenes
// with their expected images.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "experiments/harness/core/description.h"
#include "renderer/scene/scene.h"
#include "renderer/session/settings.h"

namespace rtrays {

/// A scene file with changed properties: addresses and values as in `--set scene.`.
struct SceneVariant {
    std::filesystem::path path;
    std::vector<std::pair<std::string, std::string>> properties;

    Scene load() const;
};

/// What a case's image is compared with.
enum class Expectation {
    closed_form,  ///< one value for all pixels, computed by a formula
    reference,    ///< the Embree reference, in double precision
    like,         ///< another scene rendered with the same algorithm, seed and samples
    /// Nothing: samples beyond the film's range must be counted and reported, not clamped or
    /// wrapped.
    saturates
};

/// One of the algorithms that render a case.
struct StabilityRun {
    std::string name;  ///< includes the values of its own settings: "path_tracing implicit"
    RenderSettings settings;
};

struct StabilityCase {
    std::string name;      ///< includes the values of its sweep: "furnace rho=0.5"
    std::string group;     ///< name without the sweep
    double stiffness = 0;  ///< value of the swept parameter named by "stiffness", or 0
    std::string title;     ///< describes the case and the source of the expected value
    SceneVariant scene;
    Expectation expectation = Expectation::closed_form;
    std::array<double, 3> expected{};  ///< closed form: radiance by channel
    SceneVariant other;                ///< `like`: the other scene
    std::array<size_t, 3> channels{};  ///< `like`: channel of `other` that each channel must equal
    std::vector<StabilityRun> runs;    ///< including the size
    std::map<std::string, std::string> unseen;  ///< algorithms that cannot render it, and why
    uint64_t spp = 0;                           ///< total over all batches
    uint64_t reference_spp = 0;
    uint64_t first_sample = 0;
    double within = 0;   ///< largest relative half width of the mean's interval
    double bound = 0;    ///< relative deviation that float32 may cause
    std::string reason;  ///< reason for a bound that differs from the suite's
};

struct StabilitySuite {
    std::string name;
    std::string profile;
    double bound = 0;     ///< bound of cases that state none
    bool survey = false;  ///< only non-finite and out-of-range values are failures
    std::vector<StabilityCase> cases;
};

/// Reads the cases of a profile and expands their sweeps. Throws `Error` (bad input) naming the
/// file, the case and the remedy.
StabilitySuite read_stability(const DescriptionFile &file, const std::string &profile);

}  // namespace rtrays
