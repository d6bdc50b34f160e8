// SPDX-License-Identifier: MIT
// Tests the text of settings, their conversion, and the rules between them.
#include "renderer/session/settings.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "renderer/bvh/builder.h"
#include "renderer/session/setting_table.h"
#include "renderer/testing/errors.h"

namespace rtrays {
namespace {

RenderSettings with(const std::vector<std::string> &assignments) {
    RenderSettings settings;
    for (const std::string &assignment : assignments) {
        apply_setting(settings, assignment);
    }
    return settings;
}

TEST(Settings, PrintEveryNameThatTheyParse) {
    for (const auto *table : {&image_setting_table(), &device_setting_table()}) {
        for (const Setting &setting : *table) {
            std::vector<std::string> names;
            if (const auto *choice = std::get_if<ChoiceSetting>(&setting.kind)) {
                names = choice->names;
                EXPECT_GT(names.size(), 1u) << setting.name;
            } else if (const auto *count = std::get_if<CountSetting>(&setting.kind)) {
                for (const auto &[name, value] : count->names) {
                    names.push_back(name);
                }
                names.emplace_back("7");
            } else {
                names.emplace_back("0.25");
            }
            for (const std::string &name : names) {
                EXPECT_EQ(value_text(with({setting.name + "=" + name}), setting), name)
                    << setting.name;
            }
        }
    }
}

TEST(Settings, BecomeTheConstantsOfTheDevice) {
    const auto converted = [](const std::string &assignment) {
        return integrator_settings(with({assignment}));
    };
    EXPECT_EQ(converted("integrator.sampler=independent").sampler, SAMPLER_INDEPENDENT);
    EXPECT_EQ(converted("integrator.sampler=sobol").sampler, SAMPLER_SOBOL);
    EXPECT_EQ(converted("integrator.sampler=regular").sampler, SAMPLER_REGULAR);
    EXPECT_EQ(converted("integrator.termination=roulette").termination, TERMINATION_ROULETTE);
    EXPECT_EQ(converted("integrator.termination=fixed").termination, TERMINATION_FIXED);
    EXPECT_EQ(converted("integrator.termination=adaptive").termination, TERMINATION_ADAPTIVE);
    EXPECT_EQ(converted("integrator.strategies=implicit").strategies, STRATEGY_IMPLICIT);
    EXPECT_EQ(converted("integrator.strategies=explicit").strategies, STRATEGY_EXPLICIT);
    EXPECT_EQ(converted("integrator.max_depth=0").max_depth, UNLIMITED_DEPTH);
    BvhBuildParameters parameters{};
    choose_builder(
        with({"device.bvh_builder=hploc", "device.bvh_bins=8", "device.bvh_axes=widest"}),
        parameters);
    EXPECT_EQ(parameters.method, BvhMethod::hploc);
    EXPECT_EQ(parameters.bins, 8u);
    EXPECT_EQ(parameters.axes, 1u);
}

TEST(Settings, AreNamedInTheConfigurationOfAnImage) {
    const RenderSettings settings = with({"integrator.sampler=sobol", "device.group_size=8"});
    const nlohmann::json document = image_settings(settings);
    EXPECT_EQ(document.at("algorithm"), "path_tracing");
    EXPECT_EQ(document.at("integrator.sampler"), "sobol");
    EXPECT_FALSE(document.contains("device.group_size")) << "it does not decide the image";
    EXPECT_EQ(changed_settings(settings), std::vector<std::string>{"integrator.sampler=sobol"});
}

TEST(Settings, OfAlgorithmsWithoutRandomNumbersAreFixed) {
    RenderSettings settings;
    settings.algorithm = &algorithms::ray_casting;
    EXPECT_EQ(with_fixed_choices(settings).max_depth, 1u);
    settings.algorithm = &algorithms::whitted;
    EXPECT_EQ(with_fixed_choices(settings).max_depth, 8u);
    settings.max_depth = 3;
    const RenderSettings fixed = with_fixed_choices(settings);
    EXPECT_EQ(fixed.max_depth, 3u);
    EXPECT_EQ(fixed.sampler, Sampler::regular);
    EXPECT_EQ(fixed.termination, Termination::fixed);
    EXPECT_EQ(fixed.light_selection, LightSelection::independent);
}

TEST(Settings, OfTheProgramHaveTheBestSamplerOfTheAlgorithm) {
    for (const Algorithm *algorithm : all_algorithms()) {
        RenderSettings settings;
        settings.algorithm = algorithm;
        EXPECT_EQ(settings.sampler, Sampler::independent) << "that of experiments";
        settings.sampler = default_sampler(*algorithm);
        EXPECT_EQ(settings.sampler, algorithm->is_random ? Sampler::sobol : Sampler::regular);
        EXPECT_NO_THROW(require_consistent(settings)) << algorithm->name;
    }
    RenderSettings defaults;
    defaults.sampler = Sampler::sobol;
    EXPECT_NE(describe_settings(defaults).find("integrator.sampler = sobol "), std::string::npos);
}

TEST(Settings, NameTheAlternatives) {
    for (const auto &[assignment, fragment] :
         {std::pair("integrator.strategies=both", "implicit, explicit, mis"),
          std::pair("integrator.strategy=mis", "integrator.strategies"),
          std::pair("integrator.max_depth=-1", "number"),
          std::pair("integrator.max_depth=3x", "number"),
          std::pair("integrator.beta=nan", "number"), std::pair("integrator.beta=0", "above 0"),
          std::pair("integrator.beta", "NAME=VALUE")}) {
        RenderSettings settings;
        expect_input_error(fragment, [&, text = assignment] { apply_setting(settings, text); });
    }
    RenderSettings settings;
    EXPECT_NO_THROW(require_consistent(settings));
    settings.termination = Termination::fixed;
    expect_input_error("integrator.max_depth", [&] { require_consistent(settings); });
}

}  // namespace
}  // namespace rtrays
