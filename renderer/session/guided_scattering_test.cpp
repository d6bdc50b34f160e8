// SPDX-License-Identifier: MIT
// Tests renders with guided scattering: means, planted errors, gain, bits, films, and what is
// refused.
#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <string>

#include "renderer/device/source.h"
#include "renderer/import/json/scene_json.h"
#include "renderer/testing/errors.h"
#include "renderer/testing/session_films.h"

namespace rtrays {
namespace {

using test::device;
using test::errors_off;
using test::film_words;
using test::ImageMean;
using test::mean_of;
using test::pilot_of;
using test::settings_of;

/// Returns a ceiling and a floor next to a lamp, which also shines on them by way of a mirror at
/// the side. The camera looks at a mirror that lies on the floor and shows the ceiling; it may have
/// another material. A lid keeps the lamp's direct light from the ceiling. All variants have the
/// same programs, which have no triangles.
Scene mirrored_ceiling(const std::string &sky = "0.001", const std::string &lying = "mirror") {
    return parse_scene_json(
        R"({"version": 1, "film": {"width": 16, "height": 16},
        "materials": {"grey": {"type": "oren_nayar", "reflectance": [0.7, 0.7, 0.7], "sigma": 0.2},
                      "mirror": {"type": "mirror", "reflectance": [0.9, 0.9, 0.9]}},
        "nodes": [
            {"name": "sky", "light": {"type": "dome", "radiance": [)" +
            sky + ", " + sky + ", " + sky + R"(]}},
            {"name": "lid", "geometry": {"type": "disc", "radius": 0.6}, "material": "grey",
             "transform": [{"rotate": {"axis": [1, 0, 0], "degrees": -90}}, {"translate": [-1.4, 0.9, -0.8]}]},
            {"name": "camera", "transform": [{"look_at": {"origin": [0, 0.9, 1.2], "target": [0, 0, 0], "up": [0, 1, 0]}}],
             "camera": {"type": "pinhole", "fov": 30, "fov_axis": "x"}},
            {"name": "floor", "geometry": {"type": "disc", "radius": 1.5}, "material": "grey",
             "transform": [{"rotate": {"axis": [1, 0, 0], "degrees": -90}}, {"translate": [0, -0.01, 0]}]},
            {"name": "lying", "geometry": {"type": "disc", "radius": 0.35}, "material": ")" +
            lying + R"(", "transform": [{"rotate": {"axis": [1, 0, 0], "degrees": -90}}]},
            {"name": "ceiling", "geometry": {"type": "disc", "radius": 1}, "material": "grey",
             "transform": [{"rotate": {"axis": [1, 0, 0], "degrees": 90}}, {"translate": [0, 1.2, -1.4]}]},
            {"name": "side", "geometry": {"type": "disc", "radius": 0.5}, "material": "mirror",
             "transform": [{"rotate": {"axis": [0, 1, 0], "degrees": -90}}, {"rotate": {"axis": [0, 0, 1], "degrees": -15}}, {"translate": [1.3, 0.5, -0.8]}]},
            {"name": "lamp", "geometry": {"type": "sphere", "radius": 0.3}, "material": "grey",
             "transform": [{"translate": [-1.5, 0.5, -0.8]}],
             "light": {"type": "diffuse_area", "radiance": [9, 9, 9]}}]})",
        "mirrored ceiling", "mirrored ceiling");
}

RenderSettings guided(const std::vector<std::string> &assignments = {}) {
    RenderSettings settings =
        settings_of("truncated_bdpt", {"integrator.guided_scattering=trained"});
    for (const std::string &assignment : assignments) {
        apply_setting(settings, assignment);
    }
    return settings;
}

TEST(GuidedScattering, KeepsTheMean) {
    const Scene scene = mirrored_ceiling("1");
    const ImageMean expected = mean_of(scene, settings_of("path_tracing"), 8192),
                    found = mean_of(scene, guided(), 2048);
    EXPECT_LT(errors_off(found, expected), 3.4) << found.value << " " << expected.value;
    EXPECT_LT(found.error, 0.005 * expected.value) << "statistical power";
}

TEST(GuidedScattering, LowersTheVarianceOfCausticsInMirrors) {
    const Scene scene = mirrored_ceiling();
    EXPECT_LT(mean_of(scene, guided(), 1024).variance,
              0.85 * mean_of(scene, settings_of("truncated_bdpt"), 1024).variance);
}

// The camera pass alone has the same mean with and without a guide. The surfaces are not Lambert's,
// whose ratios of densities do not depend on the direction.
TEST(GuidedScattering, FailsWhereAPlaceForgetsTheGuide) {
    struct {
        const char *what, *file, *search, *replacement;
        Scene scene;
    } const errors[] = {
        {"the density", "kernels/bsdf/guided_scattering.h", "GUIDE_SHARE * g;", "0.6f * g;",
         mirrored_ceiling()},
        {"the weight", "kernels/bsdf/guided_scattering.h", "sample.weight *= *by_material;", "",
         mirrored_ceiling()},
        {"that only tails are guided", "kernels/path/scatter_table.h",
         "get_log_running_ratio(path) > -INFINITY", "false", mirrored_ceiling("0.001", "grey")},
        {"light samples", "kernels/path/light_sample.h",
         "guided_pdf_w(scene, table, bsdf.pdf_w, light.wi)", "bsdf.pdf_w", mirrored_ceiling("1")},
    };
    for (const auto &[what, file, search, replacement, scene] : errors) {
        RenderSettings settings = settings_of("truncated_bdpt");
        settings.only_pass = PassKind::camera;
        const ImageMean expected = mean_of(scene, settings, 8192);
        settings.scatter_guide = pilot_of(scene, guided()).scatter_guide;
        const ImageMean found = mean_of(scene, settings, 2048);
        EXPECT_LT(errors_off(found, expected), 3.4) << what;
        std::string text = device_source(file);
        const size_t at = text.find(search);
        ASSERT_NE(at, std::string::npos) << what;
        text.replace(at, std::strlen(search), replacement);
        settings.source_overlays = {{file, text}};
        const double off = errors_off(mean_of(scene, settings, 2048), expected);
        EXPECT_GT(off, 5) << what;
    }
}

TEST(GuidedScattering, TrainsTheSameGuideWhateverTheStreams) {
    const Scene scene = mirrored_ceiling();
    const std::vector<uint32_t> expected = pilot_of(scene, guided()).scatter_guide->words;
    EXPECT_GT(expected.size(), GUIDE_TABLE_WORDS);
    const RenderSettings other = guided({"device.group_size=16", "device.stream_capacity=300"});
    EXPECT_EQ(pilot_of(scene, other).scatter_guide->words, expected);
    RenderSettings seeded = guided();
    seeded.seed = 7;
    EXPECT_NE(pilot_of(scene, seeded).scatter_guide->words, expected);
    // With emission guided, other light paths train the guide.
    const Pilot both = pilot_of(scene, guided({"integrator.guided_emission=trained"}));
    EXPECT_NE(both.emission_guide, nullptr);
    EXPECT_NE(both.scatter_guide->words, expected);
}

TEST(GuidedScattering, GivesTheSameBitsHoweverTheWorkIsCut) {
    const Scene scene = mirrored_ceiling();
    const std::vector<int64_t> words = film_words(scene, guided());
    EXPECT_NE(words, film_words(scene, settings_of("truncated_bdpt")));
    const RenderSettings other = guided({"device.group_size=16", "device.stream_capacity=300"});
    RenderSession session(scene, other, device());
    session.render(0, 1);
    session.render(1, 4);
    EXPECT_EQ(session.film().words, words);
}

TEST(GuidedScattering, KeepsTheBitsWhereTheCameraSeesNoMirror) {
    const Scene seen = mirrored_ceiling("1", "grey");
    EXPECT_EQ(film_words(seen, guided()), film_words(seen, settings_of("truncated_bdpt")));
}

// Films of different guides are not merged or resumed.
TEST(GuidedScattering, IsPartOfTheConfiguration) {
    const Scene scene = mirrored_ceiling();
    const auto film = [&](const RenderSettings &settings, uint64_t begin) {
        RenderSession session(scene, settings, device());
        session.render(begin, begin + 1);
        return session.film();
    };
    FilmState first = film(guided(), 0);
    EXPECT_NO_THROW(merge_film(first, film(guided(), 1)));
    const FilmState off = film(settings_of("truncated_bdpt"), 2);
    EXPECT_THROW(merge_film(first, off), Error);
}

TEST(GuidedScattering, IsTrainedAnewWhereTheSceneChanges) {
    Scene scene = mirrored_ceiling();
    RenderSession session(scene, guided(), device());
    film_words(session, 4);
    scene.set_property("lamp.radius", "0.2");
    scene.update(0);
    session.update(scene);
    EXPECT_EQ(film_words(session, 4), film_words(scene, guided()));
}

TEST(GuidedScattering, RejectsAlgorithmsWithoutIt) {
    for (const char *algorithm : {"path_tracing", "bdpt", "light_tracing"}) {
        expect_input_error(std::string("and ") + algorithm + " has none", [&] {
            RenderSession(mirrored_ceiling(),
                          settings_of(algorithm, {"integrator.guided_scattering=trained"}),
                          device());
        });
    }
    expect_input_error("integrator.light_paths=0 has none", [&] {
        RenderSession(mirrored_ceiling(), guided({"integrator.light_paths=0"}), device());
    });
}

}  // namespace
}  // namespace rtrays
