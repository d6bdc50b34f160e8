// SPDX-License-Identifier: MIT
// Benchmarks edits of a scene in a session, by mesh: the camera moves, a colour changes, a light
// changes, the mesh moves. The time is that of the scene's and the session's update; nothing is
// rendered.
#include "renderer/session/render_session.h"

#include <benchmark/benchmark.h>

#include <memory>

#include "experiments/harness/benchmarks/benchmark_program.h"
#include "renderer/import/load_scene.h"
#include "renderer/scene/cores/mesh.h"
#include "renderer/scene/graph.h"

namespace rtrays::benchmarks {

namespace {

/// The Cornell box with a mesh in it, and a session that renders it.
struct EditedScene {
    EditedScene(const std::string &mesh, DeviceContext &device)
        : scene(load_scene(measured_file("scenes/cornell_box/scene.json"))) {
        const test::Mesh model = load_measured_mesh(mesh).mesh;
        std::vector<Eigen::Vector3d> vertices;
        for (const Eigen::Vector3f &position : model.positions) {
            vertices.push_back(position.cast<double>());
        }
        scene.graph().find("floor")->set_core(
            std::make_shared<MeshCore>(mesh, std::move(vertices), model.triangles));
        scene.update(0);
        RenderSettings settings;
        settings.width = settings.height = 256;
        session = std::make_unique<RenderSession>(scene, settings, device);
    }

    Scene scene;
    std::unique_ptr<RenderSession> session;
};

struct Edit {
    const char *name;
    const char *address;
    const char *values[2];
};

constexpr Edit edits[] = {
    {"camera", "camera.translation", {"[278, 273, -800]", "[278, 273, -799]"}},
    {"colour", "materials.red.reflectance", {"[0.5, 0, 0]", "[0.6, 0, 0]"}},
    {"light", "luminaire.radiance", {"[18, 11, 3]", "[18, 12, 3]"}},
    {"mesh", "floor.translation", {"[0, 0, 0]", "[0, 1, 0]"}},
};

}  // namespace

void register_benchmarks(DeviceContext &device) {
    for (const std::string &mesh : benchmark_meshes()) {
        for (const Edit &edit : edits) {
            const auto run = [=, &device](benchmark::State &state) {
                EditedScene edited(mesh, device);
                size_t next = 0;
                for (auto _ : state) {
                    edited.scene.set_property(edit.address, edit.values[++next % 2]);
                    edited.scene.update(0);
                    edited.session->update(edited.scene);
                    device.finish();
                }
            };
            benchmark::RegisterBenchmark((mesh + "/" + edit.name).c_str(), run)
                ->UseRealTime()
                ->Unit(benchmark::kMillisecond);
        }
    }
}

}  // namespace rtrays::benchmarks
