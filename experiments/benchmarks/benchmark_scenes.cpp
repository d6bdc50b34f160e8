// SPDX-License-Identifier: MIT
#include "experiments/benchmarks/benchmark_scenes.h"

#include <cstdlib>
#include <filesystem>

#include "renderer/base/error.h"
#include "renderer/scene/scene.h"

namespace rtrays::benchmarks {

namespace {

namespace fs = std::filesystem;

test::Mesh load_mesh(const fs::path &file) {
    const Scene scene = load_scene(file.string());
    return {file.stem().string(), scene.meshes().position, scene.meshes().triangle};
}

test::Mesh cornell_box() {
    return load_mesh(RTRAYS_SOURCE "/scenes/cornell_box/scene.json");
}
test::Mesh bumpy_sphere(uint32_t rings, uint32_t segments) {
    return test::sphere(rings, segments, 1.0f, 0.02f, {0, 0, 0});
}

/// A mesh is made by a function, or read from a file of the models' folder.
struct Source {
    const char *name;
    float view[7];  ///< as of View
    test::Mesh (*make)();
    const char *model;
};

// Views of the models: cameras.txt beside them, where there is one.
constexpr Source sources[] = {
    {"cornell_box", {278, 273, -800, 0, 0, 1, 39}, cornell_box, nullptr},
    {"sphere_10K", {0.5f, 1, -2.5f, -0.5f, -1, 2.5f, 45}, [] { return bumpy_sphere(51, 100); }, nullptr},
    {"sphere_100K", {0.5f, 1, -2.5f, -0.5f, -1, 2.5f, 45}, [] { return bumpy_sphere(251, 200); }, nullptr},
    {"sphere_1M", {0.5f, 1, -2.5f, -0.5f, -1, 2.5f, 45}, [] { return bumpy_sphere(1001, 500); }, nullptr},
    {"terrain_1M", {-1, 3, -1, 6, -3, 6, 60}, [] { return test::terrain(707, 1); }, nullptr},
    {"soup_100K", {-0.8f, 1.2f, -1.1f, 1.3f, -0.7f, 1.6f, 50}, [] { return test::soup(100000, 1); }, nullptr},
    {"bunny", {-0.02f, 0.12f, 0.3f, 0, 0, -1, 40}, nullptr, "bunny/bunny.ply"},
    {"sibenik", {-15, -9, 0, 1, -0.05f, 0, 75}, nullptr, "sibenik/sibenik-75k-geometry.ply"},
    {"conference", {-800, 400, 500, 0.75f, -0.3f, -0.6f, 80}, nullptr, "conference/conference-clean.ply"},
    {"bistro_interior",
     {150, 160, -60, 0.8f, -0.12f, -0.45f, 80},
     nullptr,
     "bistro-interior/bistro-interior.ply"},
    {"sponza_crytek", {-1300, 250, 0, 1, 0.05f, 0.05f, 80}, nullptr, "sponza-crytek/sponza-crytek.ply"},
};

fs::path model_file(const Source &source) {
    const char *folder = std::getenv("RTRAYS_MESHES");
    return fs::path(folder == nullptr ? RTRAYS_SOURCE "/../shared/meshes" : folder) / source.model;
}

}  // namespace

std::vector<BenchmarkScene> benchmark_scenes() {
    std::vector<BenchmarkScene> scenes;
    for (const Source &source : sources) {
        if (source.make != nullptr || fs::exists(model_file(source))) {
            const float(&v)[7] = source.view;
            scenes.push_back({source.name, {{v[0], v[1], v[2]}, {v[3], v[4], v[5]}, v[6]}});
        }
    }
    return scenes;
}

test::Mesh load_benchmark_mesh(const std::string &name) {
    for (const Source &source : sources) {
        if (source.name == name) {
            return source.make != nullptr ? source.make() : load_mesh(model_file(source));
        }
    }
    throw run_error("no benchmark scene is called " + name);
}

}  // namespace rtrays::benchmarks
