// SPDX-License-Identifier: MIT
// Renders surfaces that are not opaque: closed forms, limits, and the same bits for every way of
// tracing.
#include <gtest/gtest.h>

#include <cmath>

#include "renderer/device/context.h"
#include "renderer/import/json/scene_json.h"
#include "renderer/session/render_session.h"
#include "renderer/testing/errors.h"
#include "renderer/testing/session_films.h"

namespace rtrays {
namespace {

using test::device;
using test::film_words;
using test::settings_of;

const std::string camera =
    R"({"name": "camera", "camera": {"type": "pinhole", "fov": 30, "fov_axis": "x"}})";

std::string sheet(const std::string &name, double z, const std::string &material) {
    return R"({"name": ")" + name + R"(", "geometry": {"type": "rectangle"}, "material": )" +
           material + R"(, "transform": [{"scale": [3, 3, 1]}, {"translate": [0, 0, )" +
           std::to_string(z) + "]}]}";
}

std::string lambert(double reflectance, const std::string &keys = "") {
    const std::string value = std::to_string(reflectance);
    return R"({"type": "lambert", "reflectance": [)" + value + ", " + value + ", " + value + "]" +
           keys + "}";
}

std::string opacity(double value) {
    return ", \"opacity\": " + std::to_string(value);
}

Scene scene_of(const std::vector<std::string> &nodes) {
    std::string text = R"({"version": 1, "film": {"width": 16, "height": 16}, "nodes": [)" + camera;
    for (const std::string &node : nodes) {
        text += ",\n" + node;
    }
    return parse_scene_json(text + "]}", "opacity", "opacity");
}

const std::string lamp =
    R"({"name": "lamp", "geometry": {"type": "rectangle"}, "material": {"type": "lambert", "reflectance": [0, 0, 0]},
    "transform": [{"scale": [4, 4, 1]}, {"translate": [0, 0, -4]}], "light": {"type": "diffuse_area", "radiance": [1, 2, 4]}})";

void expect_mean(const Scene &scene, const RenderSettings &settings, double expected,
                 const char *what) {
    test::expect_mean(scene, settings, expected, 1e-6, what);
}

TEST(Opacity, OfSheetsMultipliesWhatIsBehindThem) {
    // Black sheets before a lamp, which the camera sees directly.
    std::vector<std::string> nodes = {lamp};
    double transmittance = 1;
    for (const double alpha : {0.3, 0.5, 0.1}) {
        nodes.push_back(sheet("sheet_" + std::to_string(nodes.size()),
                              -1 - 0.5 * static_cast<double>(nodes.size()),
                              lambert(0, opacity(alpha))));
        transmittance *= 1 - alpha;
    }
    const Scene scene = scene_of(nodes);
    for (const char *algorithm : {"path_tracing", "truncated_bdpt"}) {
        expect_mean(scene, settings_of(algorithm), transmittance, "three sheets");
    }
}

TEST(Opacity, MixesASheetWithWhatIsBehindIt) {
    // Under a dome of radiance 1, on both sides, a sheet of reflectance r has the radiance r.
    const Scene scene =
        scene_of({R"({"name": "sky", "light": {"type": "dome", "radiance": [1, 1, 1]}})",
                  sheet("sheet", -2, lambert(0.2, opacity(0.7)))});
    expect_mean(scene, settings_of("path_tracing"), 0.7 * 0.2 + 0.3 * 1, "a sheet under a dome");
}

TEST(Opacity, OfAShapeCountsAtBothOfItsHits) {
    // A black ball around the camera is hit once, one before it twice.
    const auto ball = [](const std::string &name, double z, double radius) {
        return R"({"name": ")" + name + R"(", "geometry": {"type": "sphere", "radius": )" +
               std::to_string(radius) + R"(}, "material": )" + lambert(0, opacity(0.5)) +
               R"(, "transform": [{"translate": [0, 0, )" + std::to_string(z) + "]}]}";
    };
    const std::string sky = R"({"name": "sky", "light": {"type": "dome", "radiance": [1, 1, 1]}})";
    const RenderSettings settings = settings_of("path_tracing");
    expect_mean(scene_of({sky, ball("around", 0, 1)}), settings, 0.5, "from inside");
    expect_mean(scene_of({sky, ball("before", -4, 2.5)}), settings, 0.25, "from outside");
}

TEST(Opacity, OfASheetLightensItsShadow) {
    // A sheet beside the camera, between the floor and a point light at distance 2 from its middle.
    const auto image = [](double alpha) {
        const Scene scene = scene_of({sheet("wall", -2, lambert(0.8)),
                                      R"({"name": "light", "transform": [{"translate": [0, 0, 2]}],
                 "light": {"type": "point", "intensity": [10, 10, 10]}})",
                                      sheet("screen", 1, lambert(0, opacity(alpha)))});
        RenderSession session(scene, settings_of("truncated_bdpt", {"integrator.max_depth=1"}),
                              device());
        session.render(0, 512);
        return session.develop();
    };
    const auto mean = [](const Image &of) {
        double sum = 0;
        for (const float value : of.channel("R")) {
            sum += static_cast<double>(value) / 256;
        }
        return sum;
    };
    const double lit = mean(image(0)), half = mean(image(0.6));
    EXPECT_NEAR(half / lit, 0.4, 0.01);
    EXPECT_EQ(mean(image(1)), 0);
}

/// A scene of which one sheet, with these keys, is within the bounds of the others.
Scene room(const std::string &keys, bool with_sheet = true) {
    std::vector<std::string> nodes = {lamp, sheet("wall", 4, lambert(0.6))};
    if (with_sheet) {
        nodes.push_back(sheet("sheet", -2, lambert(0.5, keys)));
    }
    return scene_of(nodes);
}

TEST(Opacity, OfOneOrZeroIsExact) {
    const RenderSettings settings = settings_of("truncated_bdpt");
    const std::vector<int64_t> opaque = film_words(room(""), settings);
    EXPECT_EQ(film_words(room(", \"opacity\": 1"), settings), opaque);
    EXPECT_EQ(film_words(room(", \"opacity\": 0.7, \"opacity_cutoff\": 0.7"), settings), opaque);
    const std::vector<int64_t> nothing = film_words(room("", false), settings);
    EXPECT_EQ(film_words(room(", \"opacity\": 0"), settings), nothing);
    EXPECT_EQ(film_words(room(", \"opacity\": 0.69, \"opacity_cutoff\": 0.7"), settings), nothing);
}

TEST(Opacity, GivesTheSameBitsHoweverRaysAreTraced) {
    const Scene scene = room(opacity(0.4));
    const std::vector<int64_t> expected = film_words(scene, settings_of("path_tracing"));
    for (const char *assignment :
         {"device.bvh_layout=bvh2", "device.bvh_layout=bvh2_stackless", "device.bvh_layout=wide8",
          "device.pipeline=megakernel", "device.features=all"}) {
        EXPECT_EQ(film_words(scene, settings_of("path_tracing", {assignment})), expected)
            << assignment;
    }
    EXPECT_NE(film_words(room(opacity(0.5)), settings_of("path_tracing")), expected);
}

TEST(Opacity, CanBeEditedInASession) {
    const RenderSettings settings = settings_of("truncated_bdpt");
    Scene scene = room(opacity(0.4));
    RenderSession session(scene, settings, device());
    const std::vector<int64_t> first = film_words(session, 4);
    std::vector<int64_t> last;
    for (const char *value : {"0.9", "1", "0", "0.4"}) {
        scene.set_property("sheet.opacity", value);
        scene.update(0);
        session.update(scene);
        last = film_words(session, 4);
        EXPECT_EQ(last, film_words(scene, settings)) << value;
    }
    EXPECT_EQ(last, first);
}

TEST(Opacity, OfALightOrAJuliaSetIsAnError) {
    const std::string emits = lambert(0, ", \"emission\": [1, 1, 1], \"opacity\": 0.5");
    expect_input_error("an area light must be opaque",
                       [&] { scene_of({sheet("sheet", -2, emits)}); });
    expect_input_error("a Julia set must be opaque", [] {
        scene_of(
            {R"({"name": "set", "geometry": {"type": "julia", "constant": [-0.2, 0.8, 0, 0], "iterations": 10},
                      "material": )" +
             lambert(0.5, opacity(0.5)) + "}"});
    });
    Scene scene = scene_of({lamp});
    scene.set_property("lamp.opacity", "0.5");
    expect_input_error("an area light must be opaque", [&] { scene.update(0); });
}

}  // namespace
}  // namespace rtrays
