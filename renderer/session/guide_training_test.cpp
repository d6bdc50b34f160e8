// SPDX-License-Identifier: MIT
// Tests the guides of emission that a pilot trains: gain, bits, films, and what is refused.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <numeric>
#include <string>
#include <vector>

#include "renderer/compile/guide_table.h"
#include "renderer/import/json/scene_json.h"
#include "renderer/import/load_scene.h"
#include "renderer/session/pilot.h"
#include "renderer/testing/errors.h"
#include "renderer/testing/session_films.h"

namespace rtrays {
namespace {

using test::device;
using test::film_words;
using test::pilot_of;

// A ring of mirrors under three lamps: only a few in a thousand of their rays meet it.
Scene ring() {
    return load_scene(RTRAYS_SCENES "/mirror_ring/scene.json");
}

/// Returns settings of 64 x 64 pixels and 1024 light paths.
RenderSettings settings_with(const std::string &guided_emission, uint32_t light_paths = 1024) {
    RenderSettings settings =
        test::settings_of("truncated_bdpt", {"integrator.guided_emission=" + guided_emission});
    settings.light_paths = light_paths;
    settings.width = settings.height = 64;
    return settings;
}

struct Estimate {
    explicit Estimate(const std::vector<double> &values) {
        const auto n = static_cast<double>(values.size());
        mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
        for (const double value : values) {
            error += (value - mean) * (value - mean);
        }
        error = std::sqrt(error / (n - 1) / n);
    }
    double mean = 0, error = 0;
};

/// Mean over the pixels of an image, and of the variances of its pixels.
struct ImageEstimates {
    Estimate value, variance;
};

ImageEstimates rendered(const Scene &scene, const RenderSettings &settings) {
    RenderSession session(scene, settings, device());
    std::vector<double> values, variances;
    for (uint32_t seed = 10; seed < 26; ++seed) {
        session.restart(seed);
        session.render(0, 16);
        const Image image = session.develop();
        const auto mean = [&](const char *channel) {
            const std::vector<float> &pixels = image.channel(channel);
            return std::accumulate(pixels.begin(), pixels.end(), 0.0) /
                   static_cast<double>(pixels.size());
        };
        values.push_back(mean("G"));
        variances.push_back(mean("variance.G"));
    }
    return {Estimate(values), Estimate(variances)};
}

TEST(GuideTraining, LowersTheVarianceAndKeepsTheMean) {
    const ImageEstimates flat = rendered(ring(), settings_with("flat")),
                         trained = rendered(ring(), settings_with("trained"));
    EXPECT_NEAR(trained.value.mean, flat.value.mean,
                4 * std::hypot(trained.value.error, flat.value.error));
    EXPECT_LT(trained.value.error, 0.01 * flat.value.mean) << "statistical power";
    EXPECT_GT(flat.variance.mean - trained.variance.mean,
              4 * std::hypot(flat.variance.error, trained.variance.error))
        << flat.variance.mean << " " << trained.variance.mean;
}

TEST(GuideTraining, GivesTheSameTableWhateverTheStreams) {
    RenderSettings settings = settings_with("trained");
    const Pilot expected = pilot_of(ring(), settings);
    EXPECT_TRUE(expected.trials.empty());
    EXPECT_EQ(expected.light_paths, 1024u);
    EXPECT_GT(expected.seconds, 0);
    settings.stream_capacity = 300;
    settings.group_size = 16;
    settings.stream_chunk = 7;
    EXPECT_EQ(pilot_of(ring(), settings).emission_guide->words, expected.emission_guide->words);
    settings.seed = 7;
    EXPECT_NE(pilot_of(ring(), settings).emission_guide->words, expected.emission_guide->words);
}

// Powers of two keep all digits. Squares of the contributions would overflow, or vanish.
TEST(GuideTraining, DoesNotDependOnTheUnitOfRadiance) {
    const auto words = [](double scale) {
        Scene scene = ring();
        const auto set = [&](const char *name, double r, double g, double b) {
            scene.set_property(std::string(name) + ".radiance",
                               nlohmann::json({r * scale, g * scale, b * scale}).dump());
        };
        set("light_0", 19, 17, 13.5);
        set("light_1", 17, 9.5, 5);
        set("light_2", 6, 10.5, 19);
        scene.update(0);
        return pilot_of(scene, settings_with("trained")).emission_guide->words;
    };
    const std::vector<uint32_t> expected = words(1);
    EXPECT_EQ(words(0x1p80), expected);
    EXPECT_EQ(words(0x1p-80), expected);
}

// Every session trains the same guide. Its hash is part of the film's configuration.
TEST(GuideTraining, MergesAndResumesFilmsOfOneTable) {
    const Scene scene = ring();
    const RenderSettings settings = settings_with("trained");
    const auto film = [&](const RenderSettings &own, uint64_t begin, uint64_t end) {
        RenderSession session(scene, own, device());
        session.render(begin, end);
        return session.film();
    };
    const FilmState expected = film(settings, 0, 4), first = film(settings, 0, 1);
    FilmState merged = first;
    merge_film(merged, film(settings, 1, 4));
    EXPECT_EQ(merged.words, expected.words);
    RenderSession resumed(scene, settings, device());
    resumed.restore(first);
    resumed.render(1, 4);
    EXPECT_EQ(resumed.film().words, expected.words);

    RenderSettings other = settings;
    other.emission_guide =
        std::make_shared<const EmissionGuide>(flat_guide(compile_scene(scene, {})));
    for (const RenderSettings &wrong : {other, settings_with("flat")}) {
        const FilmState second = film(wrong, 1, 2);
        EXPECT_THROW(merge_film(merged, second), Error);
        EXPECT_THROW(resumed.restore(second), Error);
    }
}

TEST(GuideTraining, IsRecordedAndItsTimeIsCounted) {
    RenderSettings settings = settings_with("trained", LIGHT_PATHS_AUTO);
    settings.width = settings.height = 256;
    const RenderSession session(ring(), settings, device());
    const nlohmann::json report = session.report(), &pilot = report.at("pilot");
    ASSERT_GT(pilot.at("light_paths"), 0);
    EXPECT_EQ(pilot.at("trials").size(), LIGHT_PATH_TRIALS);
    EXPECT_EQ(pilot.at("guide"), guide_hash(session.settings().emission_guide->words));
    EXPECT_EQ(report.at("settings").at("integrator.guided_emission"), "trained");
    // Nothing is rendered yet: the times are those of the pilot.
    EXPECT_GT(pilot.at("seconds"), 0);
    EXPECT_EQ(report.at("seconds").at("device"), pilot.at("seconds"));
    EXPECT_EQ(report.at("seconds").at("wall"), pilot.at("seconds_wall"));
}

// Few paths find the caustic in a small image, where light paths do not pay off. The render is one
// of path tracing then.
TEST(GuideTraining, HasNoTablesWithoutLightPaths) {
    RenderSettings settings = settings_with("trained", LIGHT_PATHS_AUTO),
                   path_tracing = settings_with("off", LIGHT_PATHS_LIKE_PIXELS);
    path_tracing.algorithm = &algorithms::path_tracing;
    settings.width = settings.height = path_tracing.width = path_tracing.height = 16;
    RenderSession session(ring(), settings, device());
    EXPECT_EQ(session.settings().light_paths, 0u);
    EXPECT_EQ(session.settings().guided_emission, GuidedEmission::off);
    for (const auto &feature : session.report().at("features")) {
        EXPECT_NE(feature, "guided_emission");
    }
    EXPECT_EQ(film_words(session, 4), film_words(ring(), path_tracing));
}

TEST(GuideTraining, FollowsSceneAndSize) {
    Scene scene = ring();
    const RenderSettings settings = settings_with("trained", LIGHT_PATHS_LIKE_PIXELS);
    RenderSession session(scene, settings, device());
    const std::string before = session.report().at("pilot").at("guide");
    scene.set_property("light_0.radiance", "[600, 600, 600]");
    scene.update(0);
    session.update(scene);
    EXPECT_NE(session.report().at("pilot").at("guide"), before);
    EXPECT_EQ(film_words(session, 4), film_words(scene, settings));
    // The guide stays at a change of the size, and there is still a light path for every pixel.
    RenderSettings larger = session.settings();
    larger.width = larger.height = 70;
    session.resize(70, 70);
    EXPECT_EQ(session.settings().light_paths, LIGHT_PATHS_LIKE_PIXELS);
    EXPECT_EQ(film_words(session, 4), film_words(scene, larger));
}

/// Returns an empty scene with the given lights.
Scene lit_by(const std::string &nodes) {
    return parse_scene_json(
        R"({"version": 1, "film": {"width": 16, "height": 16}, "nodes": [)" + nodes + R"(
            {"name": "camera", "camera": {"type": "pinhole", "fov": 50, "fov_axis": "x"}}]})",
        "lights", "lights");
}

TEST(GuideTraining, RefusesWhatItCannotTrain) {
    const auto refuse = [](const std::string &message, const std::string &nodes) {
        expect_input_error(
            message, [&] { RenderSession(lit_by(nodes), settings_with("trained"), device()); });
    };
    std::string lamps;
    for (int i = 0; i < 65; ++i) {
        lamps += R"({"name": "l)" + std::to_string(i) +
                 R"(", "light": {"type": "point", "intensity": [1, 1, 1]}},)";
    }
    refuse("65 lights, and at most 64", lamps);
    refuse("trained: the scene has no light to guide; use off", "");
    refuse("trained: the only light of the scene",
           R"({"name": "sky", "light": {"type": "dome", "radiance": [1, 1, 1]}},)");
    const auto inconsistent = [](const std::string &message, const char *algorithm,
                                 uint32_t light_paths) {
        RenderSettings settings = settings_with("trained", light_paths);
        settings.algorithm = &algorithm_named(algorithm);
        expect_input_error(message, [&] { require_consistent(settings); });
    };
    const uint32_t pixels = LIGHT_PATHS_LIKE_PIXELS;
    inconsistent("path_tracing traces no light paths; use off", "path_tracing", pixels);
    inconsistent("not supported by bdpt; use off or truncated_bdpt", "bdpt", pixels);
    inconsistent("not supported by light_tracing; use off", "light_tracing", pixels);
    inconsistent("light_paths=0 leaves nothing to guide", "truncated_bdpt", 0);
}

}  // namespace
}  // namespace rtrays
