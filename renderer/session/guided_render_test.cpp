// SPDX-License-Identifier: MIT
// Tests renders with guided emission: means, planted errors, bits, and films of different guides.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <memory>
#include <random>

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
using test::settings_of;

const std::string sphere = R"({"name": "sphere", "geometry": {"type": "sphere", "radius": 0.3},
    "transform": [{"translate": [-0.5, 1, -0.2]}], "material": "grey",
    "light": {"type": "diffuse_area", "radiance": [6, 6, 6]}},)";
const std::string panel =
    R"({"name": "panel", "geometry": {"type": "rectangle"}, "material": "grey",
    "transform": [{"scale": [0.3, 0.2, 1]}, {"rotate": {"axis": [1, 0, 0], "degrees": 90}}, {"translate": [0.6, 1.9, 0]}],
    "light": {"type": "diffuse_area", "radiance": [9, 9, 9]}},)";
const std::string coin =
    R"({"name": "coin", "geometry": {"type": "disc", "radius": 0.2}, "material": "grey",
    "transform": [{"rotate": {"axis": [0, 1, 0], "degrees": 80}}, {"translate": [-1.4, 0.8, 0.3]}],
    "light": {"type": "diffuse_area", "radiance": [9, 9, 9]}},)";
const std::string point = R"({"name": "point", "transform": [{"translate": [0.2, 1.2, 0.4]}],
    "light": {"type": "point", "intensity": [0.3, 0.3, 0.3]}},)";
const std::string dome =
    R"({"name": "sky", "light": {"type": "dome", "radiance": [0.1, 0.1, 0.1]}},)";

/// Returns a room that is open to the camera, with the given lights and other nodes.
Scene room(const std::string &nodes) {
    return parse_scene_json(
        R"({"version": 1, "film": {"width": 16, "height": 16},
        "materials": {"grey": {"type": "lambert", "reflectance": [0.6, 0.6, 0.6]},
                      "black": {"type": "lambert", "reflectance": [0, 0, 0]}},
        "nodes": [)" +
            nodes + R"(
            {"name": "camera", "transform": [{"look_at": {"origin": [0, 1, 4], "target": [0, 0.9, 0], "up": [0, 1, 0]}}],
             "camera": {"type": "pinhole", "fov": 50, "fov_axis": "x"}},
            {"name": "floor", "geometry": {"type": "rectangle"}, "material": "grey",
             "transform": [{"scale": [2, 2, 1]}, {"rotate": {"axis": [1, 0, 0], "degrees": -90}}]},
            {"name": "wall", "geometry": {"type": "rectangle"}, "material": "grey",
             "transform": [{"scale": [2, 2, 1]}, {"translate": [0, 1, -1.5]}]}]})",
        "room", "room");
}

/// Returns moments of all lights with the given bins full, and the others a thousandth of that.
EmissionMoments moments_of(const CompiledScene &scene, const std::vector<size_t> &bins) {
    EmissionMoments moments(scene.lights.size());
    for (size_t i = 0; i < moments.size(); ++i) {
        moments[i].assign(takes_guide_table(scene, i) ? GUIDE_BINS : 1, i % 2 == 0 ? 1e-6 : 1e-4);
        for (const size_t bin : bins) {
            moments[i][bin % moments[i].size()] = i % 2 == 0 ? 1.0 : 100.0;
        }
    }
    return moments;
}

/// Returns a guide that is far from flat, from one light to the next and from bin to bin.
std::shared_ptr<const EmissionGuide> steep_guide(const Scene &scene) {
    const CompiledScene compiled = compile_scene(scene, {});
    std::mt19937 random(2);
    EmissionMoments moments(compiled.lights.size());
    for (size_t i = 0; i < moments.size(); ++i) {
        moments[i].resize(takes_guide_table(compiled, i) ? GUIDE_BINS : 1);
        for (double &moment : moments[i]) {
            moment = (i % 2 == 0 ? 1.0 : 25.0) * (random() % 4 == 0 ? 1.0 : 1e-4);
        }
    }
    return std::make_shared<const EmissionGuide>(make_guide(compiled, moments));
}

RenderSettings guided(const char *algorithm, std::shared_ptr<const EmissionGuide> guide,
                      uint32_t seed = 2) {
    RenderSettings settings = settings_of(algorithm);
    settings.emission_guide = std::move(guide);
    settings.seed = seed;
    return settings;
}

// Fourteen comparisons share a level of 0.01, so each may be 3.4 errors off.
TEST(GuidedRender, HasTheMeanOfPathTracing) {
    const Scene scene = room(sphere + panel + coin + point + dome);
    const auto guide = steep_guide(scene);
    const ImageMean expected = mean_of(scene, settings_of("path_tracing"), 1024);
    EXPECT_LT(expected.error, 0.005 * expected.value) << "statistical power";
    for (const char *algorithm : {"truncated_bdpt", "bdpt"}) {
        const ImageMean found = mean_of(scene, guided(algorithm, guide), 512);
        EXPECT_LT(errors_off(found, expected), 3.4)
            << algorithm << " " << found.value << " " << expected.value;
        EXPECT_LT(found.error, 0.006 * expected.value) << "statistical power";
    }
    // Light tracing does not show the sky.
    const Scene inside = room(sphere + panel + coin + point);
    const auto without_sky = steep_guide(inside);
    EXPECT_LT(errors_off(mean_of(inside, guided("light_tracing", without_sky), 1024),
                         mean_of(inside, settings_of("path_tracing"), 1024)),
              3.4);
}

// A place that forgets the table must show. Large lights are near the floor, so all strategies have
// similar densities. The scene has no triangles, which keeps programs small.
TEST(GuidedRender, FailsWhereAPlaceForgetsTheTable) {
    const Scene scene = parse_scene_json(
        R"({"version": 1, "film": {"width": 16, "height": 16},
        "materials": {"grey": {"type": "lambert", "reflectance": [0.8, 0.8, 0.8]}},
        "nodes": [
            {"name": "camera", "transform": [{"look_at": {"origin": [0, 1.5, 3], "target": [0, 0.1, 0], "up": [0, 1, 0]}}],
             "camera": {"type": "pinhole", "fov": 30, "fov_axis": "x"}},
            {"name": "lamp", "geometry": {"type": "sphere", "radius": 0.5}, "material": "grey",
             "transform": [{"translate": [-0.6, 0.8, -0.2]}], "light": {"type": "diffuse_area", "radiance": [2, 2, 2]}},
            {"name": "plate", "geometry": {"type": "disc", "radius": 0.5}, "material": "grey",
             "transform": [{"rotate": {"axis": [1, 0, 0], "degrees": 90}}, {"translate": [0.6, 0.5, 0]}],
             "light": {"type": "diffuse_area", "radiance": [2, 2, 2]}},
            {"name": "floor", "geometry": {"type": "disc", "radius": 1}, "material": "grey",
             "transform": [{"rotate": {"axis": [1, 0, 0], "degrees": -90}}]}]})",
        "discs", "discs");
    const auto guide = steep_guide(scene);
    const ImageMean expected = mean_of(scene, settings_of("path_tracing"), 4096);
    const auto off = [&](const char *light_paths, const SourceOverlays &overlays) {
        RenderSettings settings = guided("truncated_bdpt", guide);
        apply_setting(settings, std::string("integrator.light_paths=") + light_paths);
        settings.source_overlays = overlays;
        return errors_off(mean_of(scene, settings, 1024), expected);
    };
    const char *const emission = "kernels/light/emission.h", *const light = "kernels/light/light.h";
    const std::array<const char *, 5> errors[] = {
        {"the weight", "pixels", emission, "sample->weight = sample->weight / sample->guide;", ""},
        {"the density of the direction", "1024", emission, "cosine * INV_PI * sample->guide",
         "cosine * INV_PI"},
        {"p_d", "pixels", "kernels/path/light_start.h", "emission.guide * INV_PI", "INV_PI"},
        {"hits", "pixels", light, "guide_density(scene, light, d);", "1.0f;"},
        {"light samples", "1024", light,
         "sample.arrival_pdf_a *= guide_density(scene, light, -sample.wi);", ""},
        {"the selection", "1024", "kernels/light/emission_guide.h",
         "light.emission_selection =", "light.angle_scale ="},
        {"the start that the camera sees", "1024", emission, "light.guide_table = NO_GUIDE_TABLE;",
         ""},
    };
    EXPECT_LT(off("pixels", {}), 3.4);
    EXPECT_LT(off("1024", {}), 3.4);
    for (const auto &[what, light_paths, file, search, replacement] : errors) {
        std::string text = device_source(file);
        const size_t at = text.find(search);
        ASSERT_NE(at, std::string::npos) << what;
        text.replace(at, std::strlen(search), replacement);
        EXPECT_GT(off(light_paths, {{file, text}}), 5) << what;
    }
}

// Stiff cases: a light with one open direction, tables with all weight in a single bin, and a light
// that no path leaves towards the camera. Training must cope with them, and if nothing is seen.
TEST(GuidedRender, KeepsTheMeanInStiffCases) {
    const auto box = [](const std::string &name, const std::string &place) {
        return R"({"name": ")" + name + R"(", "geometry": {"type": "box"}, "material": "black",
            "transform": [)" +
               place + "]},";
    };
    // The point light is in a tube that is open above the floor.
    const std::string tube =
        box("left", R"({"scale": [0.05, 0.3, 0.2]}, {"translate": [0.05, 1.2, 0.4]})") +
        box("right", R"({"scale": [0.05, 0.3, 0.2]}, {"translate": [0.35, 1.2, 0.4]})") +
        box("front", R"({"scale": [0.2, 0.3, 0.05]}, {"translate": [0.2, 1.2, 0.6]})") +
        box("back", R"({"scale": [0.2, 0.3, 0.05]}, {"translate": [0.2, 1.2, 0.2]})") +
        box("lid", R"({"scale": [0.2, 0.05, 0.25]}, {"translate": [0.2, 1.5, 0.4]})");
    const std::string hidden =
        box("case", R"({"scale": [0.4, 0.4, 0.4]}, {"translate": [-0.5, 1, -0.2]})");
    const Scene scene = room(point + sphere + panel + tube + hidden);
    const CompiledScene compiled = compile_scene(scene, {});
    const ImageMean expected = mean_of(scene, settings_of("path_tracing"), 2048);
    EXPECT_LT(expected.error, 0.02 * expected.value) << "statistical power";
    EmissionMoments nothing(3);
    nothing[0].assign(GUIDE_BINS, 1.0);
    nothing[1].assign(GUIDE_BINS, 0.0);  // the sphere in its case
    EmissionMoments down = nothing;
    for (size_t bin = 0; bin < GUIDE_BINS; ++bin) {
        // Directions with a y below -0.7 are those of columns around three quarters of a turn.
        const size_t row = bin / GUIDE_COLUMNS, column = bin % GUIDE_COLUMNS;
        down[0][bin] = row > 4 && row < 11 && column > 20 && column < 27 ? 1.0 : 0.0;
    }
    for (const EmissionMoments &moments :
         {moments_of(compiled, {0}), moments_of(compiled, {300}), nothing, down}) {
        const auto guide = std::make_shared<const EmissionGuide>(make_guide(compiled, moments));
        for (const char *algorithm : {"truncated_bdpt", "light_tracing"}) {
            const ImageMean found = mean_of(scene, guided(algorithm, guide), 512);
            EXPECT_LT(errors_off(found, expected), 3.4)
                << algorithm << " " << found.value << " " << expected.value;
        }
    }
    const RenderSettings trained =
        settings_of("truncated_bdpt", {"integrator.guided_emission=trained"});
    const ImageMean found = mean_of(scene, trained, 512);
    EXPECT_LT(errors_off(found, expected), 3.4) << found.value << " " << expected.value;
    const Scene blind =
        room(point + sphere + panel + tube + hidden +
             box("blind", R"({"scale": [0.1, 0.1, 0.1]}, {"translate": [0, 1, 4]})"));
    EXPECT_EQ(RenderSession(blind, trained, device()).settings().emission_guide->words,
              flat_guide(compile_scene(blind, {})).words);
}

// Discs, point lights and rectangles along the axes keep all directions under flat tables.
TEST(GuidedRender, ByFlatTablesKeepsTheBits) {
    const Scene scene = room(panel + coin + point + dome);
    for (const char *algorithm : {"light_tracing", "truncated_bdpt"}) {
        EXPECT_EQ(film_words(scene, settings_of(algorithm, {"integrator.guided_emission=flat"})),
                  film_words(scene, settings_of(algorithm)))
            << algorithm;
    }
}

TEST(GuidedRender, GivesTheSameBitsHoweverTheWorkIsCut) {
    const Scene scene = room(sphere + panel + point);
    const auto guide = steep_guide(scene);
    const std::vector<int64_t> words = film_words(scene, guided("truncated_bdpt", guide));
    RenderSettings other = guided("truncated_bdpt", guide);
    for (const char *assignment :
         {"device.group_size=16", "device.stream_capacity=300", "device.path_layout=arrays"}) {
        apply_setting(other, assignment);
    }
    RenderSession session(scene, other, device());
    session.render(0, 1);
    session.render(1, 4);
    EXPECT_EQ(session.film().words, words);
}

// Films of different guides are not merged or resumed.
TEST(GuidedRender, IsPartOfTheConfiguration) {
    const Scene scene = room(sphere + panel);
    const auto film = [&](const RenderSettings &settings, uint64_t begin) {
        RenderSession session(scene, settings, device());
        session.render(begin, begin + 1);
        return session.film();
    };
    const auto guide = steep_guide(scene);
    const RenderSettings steep = guided("light_tracing", guide),
                         off = guided("light_tracing", nullptr);
    RenderSettings flat = off;
    apply_setting(flat, "integrator.guided_emission=flat");
    FilmState first = film(steep, 0);
    EXPECT_NO_THROW(merge_film(first, film(steep, 1)));
    for (const RenderSettings &other : {off, flat}) {
        const FilmState second = film(other, 2);
        EXPECT_THROW(merge_film(first, second), Error);
        RenderSession session(scene, steep, device());
        EXPECT_THROW(session.restore(second), Error);
    }
}

TEST(GuidedRender, FollowsTheScene) {
    Scene scene = room(sphere + panel);
    const RenderSettings flat = settings_of("truncated_bdpt", {"integrator.guided_emission=flat"});
    RenderSession session(scene, flat, device());
    film_words(session, 4);
    scene.set_property("sphere.radiance", "[60, 60, 60]");  // changes the selection of lights
    scene.update(0);
    session.update(scene);
    EXPECT_EQ(film_words(session, 4), film_words(scene, flat));
}

TEST(GuidedRender, RejectsWhatItCannotGuide) {
    const Scene scene = room(sphere + panel), other = room(sphere);
    expect_input_error("does not fit the lights", [&] {
        RenderSession(other, guided("light_tracing", steep_guide(scene)), device());
    });
    expect_input_error("path_tracing traces no light paths", [&] {
        RenderSession(scene, settings_of("path_tracing", {"integrator.guided_emission=flat"}),
                      device());
    });
    std::string lamps;
    for (int i = 0; i < 65; ++i) {
        lamps += R"({"name": "l)" + std::to_string(i) +
                 R"(", "light": {"type": "point", "intensity": [1, 1, 1]}},)";
    }
    expect_input_error("65 lights, and at most 64", [&] {
        RenderSession(room(lamps),
                      settings_of("light_tracing", {"integrator.guided_emission=flat"}), device());
    });
    // Without light paths there is nothing to guide.
    EXPECT_NO_THROW(RenderSession(scene,
                                  settings_of("truncated_bdpt", {"integrator.guided_emission=flat",
                                                                 "integrator.light_paths=0"}),
                                  device()));
}

}  // namespace
}  // namespace rtrays
