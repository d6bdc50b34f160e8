// SPDX-License-Identifier: MIT
#include "experiments/harness/kinds/kinds.h"

#include "experiments/harness/kinds/convergence_control.h"
#include "experiments/harness/kinds/curves.h"
#include "experiments/harness/kinds/gate.h"
#include "experiments/harness/kinds/measurements/measurement.h"
#include "experiments/harness/kinds/scene_agreement.h"
#include "experiments/harness/kinds/scene_gains.h"
#include "experiments/harness/kinds/stability.h"
#include "experiments/harness/kinds/sweep.h"

namespace rtrays {

namespace {

constexpr auto profile = Option::profile, out = Option::out, compile = Option::compile;

Kind measurement(const char *name) {
    return {name, "measurement.schema.json", {profile, out}, Binaries::keep, make_measurement};
}

}  // namespace

const std::vector<Kind> &experiment_kinds() {
    constexpr Binaries by_driver = Binaries::by_driver;
    static const std::vector<Kind> kinds = {
        {"curves", "curves.schema.json", {profile, out, compile}, by_driver, make_curves},
        measurement("bvh_build"),
        measurement("bvh_animation"),
        measurement("ray_rates"),
        measurement("traversal"),
        measurement("frame_times"),
        measurement("bounces"),
        measurement("renderers"),
        measurement("ablations"),
        measurement("reference_agreement"),
        {"stability", "stability.schema.json", {profile, out, compile}, by_driver, make_stability},
        {"convergence_control",
         "convergence_control.schema.json",
         {profile, out},
         by_driver,
         make_convergence_control},
        {"sweep", "sweep.schema.json", {profile, out}, by_driver, make_sweep},
        {"scene_gains", "scene_gains.schema.json", {profile, out}, by_driver, make_scene_gains},
        {"agreement", "agreement.schema.json", {profile, out}, by_driver, make_agreement},
        {"gate",
         "gate.schema.json",
         {Option::check, Option::save, Option::update_baseline},
         by_driver,
         make_gate},
    };
    return kinds;
}

}  // namespace rtrays
