// SPDX-License-Identifier: MIT
// Tests what an edit of a scene costs on the device, and that the film is then that of a new
// session. Also tests sessions that share a scene, and changes of the film's size.
#include <gtest/gtest.h>

#include <memory>

#include "renderer/compile/device_scene.h"
#include "renderer/import/json/scene_json.h"
#include "renderer/import/load_scene.h"
#include "renderer/session/shared_scenes.h"
#include "renderer/testing/errors.h"
#include "renderer/testing/session_films.h"

namespace rtrays {
namespace {

using test::device;

RenderSettings small(const std::string &algorithm = "truncated_bdpt",
                     const std::vector<std::string> &assignments = {}) {
    RenderSettings settings;
    settings.algorithm = &algorithm_named(algorithm);
    settings.width = 20;
    settings.height = 16;
    for (const std::string &assignment : assignments) {
        apply_setting(settings, assignment);
    }
    return settings;
}

Scene box() {
    return load_scene(RTRAYS_SCENES "/cornell_box/scene.json");
}

std::vector<int64_t> render(RenderSession &session) {
    return test::film_words(session, 2);
}

std::vector<int64_t> render_new(const Scene &scene, const RenderSettings &settings) {
    RenderSession session(scene, settings, device());
    return render(session);
}

std::shared_ptr<DeviceScene> shared_scene(const Scene &scene, const RenderSettings &settings) {
    return std::make_shared<DeviceScene>(scene, device_scene_settings(settings, device().info()),
                                         device());
}

/// Edits the scene and updates the session. Returns what the update asked of the device, and
/// expects the film of a new session.
DeviceTraffic cost_of(Scene &scene, RenderSession &session, const RenderSettings &settings,
                      const std::string &address, const std::string &value) {
    scene.set_property(address, value);
    scene.update(0);
    const DeviceTraffic before = device().traffic();
    session.update(scene);
    DeviceTraffic cost = device().traffic();
    cost.launches -= before.launches;
    cost.bytes_written -= before.bytes_written;
    cost.bytes_read -= before.bytes_read;
    cost.allocations -= before.allocations;
    EXPECT_EQ(render(session), render_new(scene, settings)) << address;
    EXPECT_EQ(session.film().config, RenderSession(scene, settings, device()).film().config);
    return cost;
}

TEST(SceneUpdate, MovedCameraCostsNothing) {
    Scene scene = box();
    RenderSession session(scene, small(), device());
    const std::vector<int64_t> before = render(session);
    const DeviceTraffic cost =
        cost_of(scene, session, small(), "camera.translation", "[250, 300, -700]");
    EXPECT_EQ(cost.launches, 0u);
    EXPECT_EQ(cost.bytes_written, 0u);
    EXPECT_EQ(cost.bytes_read, 0u);
    EXPECT_EQ(cost.allocations, 0u);
    EXPECT_NE(render_new(scene, small()), before);
}

TEST(SceneUpdate, ColourCostsItsRecord) {
    Scene scene = box();
    RenderSession session(scene, small(), device());
    const DeviceTraffic cost =
        cost_of(scene, session, small(), "materials.red.reflectance", "[0.1, 0.2, 0.9]");
    EXPECT_EQ(cost.launches, 0u);
    EXPECT_EQ(cost.bytes_written, sizeof(BxdfRecord));
    EXPECT_EQ(cost.allocations, 0u);
}

TEST(SceneUpdate, RadianceCostsItsRecord) {
    Scene scene = box();
    RenderSession session(scene, small(), device());
    const DeviceTraffic cost = cost_of(scene, session, small(), "luminaire.radiance", "[1, 2, 3]");
    EXPECT_EQ(cost.launches, 0u) << "the mesh of the light has not moved";
    EXPECT_EQ(cost.bytes_written, sizeof(LightRecord));
    EXPECT_EQ(cost.allocations, 0u);
}

TEST(SceneUpdate, MovedMeshCostsItsTrianglesAndTheHierarchy) {
    for (const char *update : {"device.bvh_update=rebuild", "device.bvh_update=refit"}) {
        const RenderSettings settings = small("truncated_bdpt", {update});
        Scene scene = box();
        RenderSession session(scene, settings, device());
        scene.set_property("floor.translation", "[0, -10, 0]");
        scene.update(0);
        const DeviceTraffic before = device().traffic();
        session.update(scene);
        const DeviceTraffic after = device().traffic();
        EXPECT_GT(after.launches, before.launches);
        const MeshArrays &meshes = scene.meshes();
        const size_t input =
            meshes.position.size() * sizeof(float) * 3 + meshes.triangle.size() * sizeof(Triangle);
        EXPECT_LT(after.bytes_written - before.bytes_written,
                  input + 2 * sizeof(SurfaceTriangle) + sizeof(LightRecord) + 4096)
            << "two of 32 triangles have moved";
        EXPECT_EQ(render(session), render_new(scene, small()));
    }
}

// The texels decide how lights and their triangles are selected.
TEST(SceneUpdate, TextureOfAnEmissionIsThatOfANewSession) {
    Scene scene = parse_scene_json(
        R"({"version": 1, "film": {"width": 20, "height": 16},
        "textures": {"checks": {"file": "assets/checker.png", "encoding": "srgb", "uv_scale": [0.25, 0.25]}}, "nodes": [
        {"name": "camera", "transform": [{"translate": [0, 2, 5]}], "camera": {"type": "pinhole", "fov": 45, "fov_axis": "smaller"}},
        {"name": "ground", "geometry": {"type": "rectangle"}, "material": {"type": "lambert", "reflectance": [0.6, 0.6, 0.6]},
         "transform": [{"rotate": {"axis": [1, 0, 0], "degrees": -90}}]},
        {"name": "lamp", "geometry": {"type": "rectangle"}, "transform": [{"translate": [0, 1, -1]}],
         "material": {"type": "lambert", "reflectance": [0, 0, 0], "emission": [3, 2, 1], "emission_texture": "checks"}},
        {"name": "ball", "geometry": {"type": "sphere", "radius": 0.3}, "transform": [{"translate": [0, 0.5, 0.5]}],
         "material": {"type": "lambert", "reflectance": [0, 0, 0], "emission": [1, 1, 1], "emission_texture": "checks"}}]})",
        "in.json", "in", RTRAYS_SCENES "/features");
    const RenderSettings settings = small("path_tracing");
    RenderSession session(scene, settings, device());
    const std::vector<int64_t> first = render(session);
    cost_of(scene, session, settings, "textures.checks.uv_offset", "[0.13, 0.27]");
    EXPECT_NE(render_new(scene, settings), first);
    cost_of(scene, session, settings, "textures.checks.wrap", "mirror");
    cost_of(scene, session, settings, "lamp.emission", "[0, 0, 0]");
}

TEST(SceneUpdate, RepeatedUpdateCostsNothing) {
    Scene scene = box();
    RenderSession session(scene, small(), device());
    const DeviceTraffic before = device().traffic();
    scene.update(0);
    session.update(scene);
    EXPECT_EQ(device().traffic().launches, before.launches);
    EXPECT_EQ(device().traffic().bytes_written, before.bytes_written);
    EXPECT_EQ(render(session), render_new(scene, small()));
}

TEST(SceneUpdate, OtherFeaturesKeepTheHierarchy) {
    Scene scene = box();
    RenderSession session(scene, small(), device());
    // Without light, the passes of this algorithm are others.
    scene.set_property("luminaire.radiance", "[0, 0, 0]");
    scene.set_property("materials.white.emission", "[1, 1, 1]");
    scene.update(0);
    session.update(scene);
    EXPECT_EQ(render(session), render_new(scene, small()));
    scene.set_property("luminaire.radiance", "[1, 1, 1]");
    scene.update(0);
    session.update(scene);
    EXPECT_EQ(render(session), render_new(scene, small()));
    scene.set_property("floor.visible", "false");
    scene.update(0);
    session.update(scene);
    EXPECT_EQ(render(session), render_new(scene, small()));
}

// What depends on the camera besides its record: the length of shadow rays to infinity, the sphere
// of a scene that has only planes, and the light at the camera.
TEST(SceneUpdate, LightsFollowTheCamera) {
    const auto expect_following = [](Scene scene, const RenderSettings &settings) {
        RenderSession session(scene, settings, device());
        const std::string camera = scene.cameras().name.front();
        cost_of(scene, session, settings, camera + ".fov", "31");
        cost_of(scene, session, settings, camera + ".translation", "[0.5, 4, 7]");
    };
    for (const char *file : {"plane.json", "environment_light.json", "thin_lens.json"}) {
        expect_following(load_scene(std::string(RTRAYS_SCENES "/features/") + file),
                         small("path_tracing"));
    }
    Scene planes = parse_scene_json(
        R"({"version": 1, "film": {"width": 20, "height": 16}, "nodes": [
        {"name": "camera", "transform": [{"translate": [0, 2, 5]}], "camera": {"type": "pinhole", "fov": 45, "fov_axis": "smaller"}},
        {"name": "sky", "light": {"type": "directional", "irradiance": [1, 1, 1]},
         "transform": [{"rotate": {"axis": [1, 0, 0], "degrees": -80}}]},
        {"name": "ground", "geometry": {"type": "plane"}, "material": {"type": "lambert", "reflectance": [0.6, 0.6, 0.6]},
         "transform": [{"rotate": {"axis": [1, 0, 0], "degrees": -90}}]}]})",
        "planes", "planes");
    expect_following(std::move(planes), small());
    Scene dark = box();
    dark.set_property("luminaire.visible", "false");
    dark.update(0);
    expect_following(std::move(dark), small("whitted"));
}

TEST(SceneUpdate, InvalidEditIsRejectedUntilItIsUndone) {
    Scene scene = load_scene(RTRAYS_SCENES "/features/julia.json");
    const RenderSettings settings = small();
    RenderSession session(scene, settings, device());
    const std::string shape = scene.arrays().shapes.name.front();
    scene.set_property("floor.reflectance", "[0.1, 0.2, 0.3]");
    scene.set_property(shape + ".slice", "3.9");
    const auto update = [&] {
        scene.update(0);
        session.update(scene);
    };
    expect_input_error("does not reach slice", update);
    expect_input_error("update the session", [&] { session.render(0, 1); });
    scene.set_property(shape + ".slice", "0.1");
    update();
    EXPECT_EQ(render(session), render_new(scene, settings));
}

TEST(SharedScene, IsBuiltOnceForSeveralSessions) {
    const Scene scene = box();
    const auto shared = shared_scene(scene, small());
    RenderSession first(shared, scene, small("path_tracing"));
    const double built = shared->bvh_wall_seconds();
    const uint64_t written = device().traffic().bytes_written;
    RenderSession second(shared, scene, small("truncated_bdpt"));
    RenderSession third(shared, scene, small("bdpt", {"integrator.bdpt_vertices=3"}));
    EXPECT_EQ(shared->bvh_wall_seconds(), built);
    EXPECT_LT(device().traffic().bytes_written - written, 1024u) << "counters of streams alone";
    EXPECT_EQ(render(first), render_new(scene, small("path_tracing")));
    EXPECT_EQ(render(second), render_new(scene, small("truncated_bdpt")));
    EXPECT_EQ(render(third), render_new(scene, small("bdpt", {"integrator.bdpt_vertices=3"})));
}

TEST(SharedScene, MustBeUpdatedInEverySession) {
    Scene scene = box();
    const auto shared = shared_scene(scene, small());
    RenderSession first(shared, scene, small());
    RenderSession second(shared, scene, small("path_tracing"));
    scene.set_property("materials.white.reflectance", "[0.2, 0.2, 0.2]");
    scene.set_property("floor.translation", "[0, -10, 0]");
    scene.update(0);
    first.update(scene);
    expect_input_error("update the session", [&] { second.render(0, 1); });
    const DeviceTraffic before = device().traffic();
    second.update(scene);
    EXPECT_EQ(device().traffic().launches, before.launches);
    EXPECT_EQ(device().traffic().bytes_written, before.bytes_written);
    EXPECT_EQ(render(first), render_new(scene, small()));
    EXPECT_EQ(render(second), render_new(scene, small("path_tracing")));
}

TEST(SharedScene, IsSharedByAllSessionsThatCan) {
    const Scene scene = box();
    SharedScenes scenes(scene, device());
    RenderSession first = scenes.session(small("path_tracing"));
    const uint64_t launches = device().traffic().launches;
    const uint64_t written = device().traffic().bytes_written;
    RenderSession second = scenes.session(small("path_tracing", {"integrator.beta=1"}));
    EXPECT_LT(device().traffic().bytes_written - written, 1024u);
    EXPECT_LT(device().traffic().launches - launches, 200u) << "no hierarchy is built";
    RenderSession other = scenes.session(small("whitted"));
    EXPECT_EQ(render(first), render_new(scene, small("path_tracing")));
    EXPECT_EQ(render(other), render_new(scene, small("whitted")));
}

TEST(SharedScene, RefusesOtherSettings) {
    const Scene scene = box();
    const auto shared = shared_scene(scene, small());
    for (const char *other :
         {"integrator.light_selection=power", "device.bvh_layout=bvh2_stackless",
          "device.bvh_builder=hploc", "device.features=all"}) {
        expect_input_error("light selection", [&] {
            RenderSession session(shared, scene, small("truncated_bdpt", {other}));
        });
    }
    expect_input_error("whitted", [&] { RenderSession session(shared, scene, small("whitted")); });
}

TEST(Resize, KeepsKernelsAndScene) {
    const Scene scene = box();
    for (const std::vector<std::string> &assignments :
         {std::vector<std::string>{},
          {"integrator.light_paths=700"},
          {"integrator.convergence.error=0.2", "integrator.convergence.start=2",
           "integrator.convergence.interval=2"}}) {
        RenderSettings settings = small("truncated_bdpt", assignments);
        RenderSession session(scene, settings, device());
        render(session);
        for (const auto &[width, height] : {std::pair(7, 31), std::pair(40, 24)}) {
            const DeviceTraffic before = device().traffic();
            session.resize(width, height);
            EXPECT_LE(device().traffic().launches - before.launches, 3u)
                << "list of live pixels, with convergence control";
            settings.width = width;
            settings.height = height;
            EXPECT_EQ(render(session), render_new(scene, settings));
            EXPECT_EQ(session.develop().width(), width);
        }
    }
}

TEST(Resize, KeepsThePilotsLightPathsPerPixel) {
    Scene scene = load_scene(RTRAYS_SCENES "/cornell_mirrors/scene.json");
    RenderSession session(scene, small("truncated_bdpt", {"integrator.light_paths=auto"}),
                          device());
    const auto light_paths = [&] {
        return std::stoul(
            session.report().at("settings").at("integrator.light_paths").get<std::string>());
    };
    const unsigned long chosen = light_paths();
    ASSERT_GT(chosen, 0u);
    session.resize(40, 32);
    EXPECT_EQ(light_paths(), 4 * chosen);
    // The scene now has more lights, so the passes are compiled again.
    scene.set_property("materials.white.emission", "[1, 1, 1]");
    scene.update(0);
    session.update(scene);
    EXPECT_EQ(light_paths(), 4 * chosen);
    session.resize(20, 16);
    EXPECT_EQ(light_paths(), chosen);
}

TEST(Resize, RejectsEmptyAndHugeFilms) {
    RenderSession session(box(), small(), device());
    expect_input_error("0 x 4 pixels", [&] { session.resize(0, 4); });
    expect_input_error("2^30", [&] { session.resize(1 << 16, 1 << 16); });
    expect_run_error("allocates at most", [&] { session.resize(1 << 15, 1 << 15); });
    EXPECT_EQ(render(session), render_new(box(), small()));
}

}  // namespace
}  // namespace rtrays
