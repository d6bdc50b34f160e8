// SPDX-License-Identifier: MIT
#include "experiments/harness/models/meshes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "experiments/harness/models/buildings.h"
#include "experiments/harness/models/san_miguel.h"
#include "renderer/base/error.h"
#include "renderer/base/resources.h"
#include "renderer/import/load_scene.h"

namespace rtrays {

namespace {

namespace fs = std::filesystem;

test::Mesh load_mesh(const fs::path &file) {
    const Scene scene = load_scene(file.string());
    return {file.stem().string(), scene.meshes().position, scene.meshes().triangle};
}

test::Mesh load_first(const std::vector<fs::path> &files) {
    return load_mesh(files.front());
}

/// Places two decimations of the Stanford dragon side by side.
test::Mesh two_dragons(const std::vector<fs::path> &files) {
    test::Mesh both = load_mesh(files[0]);
    const test::Mesh second = load_mesh(files[1]);
    const auto first_vertex = static_cast<uint32_t>(both.positions.size());
    const Eigen::Vector3f beside(0, 0, both.box().sizes().z());
    for (const Eigen::Vector3f &position : second.positions) {
        both.positions.push_back(position + beside);
    }
    for (const auto &[a, b, c] : second.triangles) {
        both.triangles.push_back({first_vertex + a, first_vertex + b, first_vertex + c});
    }
    return both;
}

test::Mesh bumpy_sphere(uint32_t rings, uint32_t segments) {
    return test::sphere(rings, segments, 1.0f, 0.02f, {0, 0, 0});
}

template <uint32_t rings, uint32_t segments>
test::Mesh bumpy_sphere_of(const std::vector<fs::path> &) {
    return bumpy_sphere(rings, segments);
}

template <SanMiguelPart part>
test::Mesh san_miguel_of(const std::vector<fs::path> &files) {
    return load_san_miguel(files[0], files[1], part);
}

/// A named mesh. It is read from files in the models' folder or in this repository ("scenes/..."),
/// or it is procedural and has no files.
struct Source {
    const char *name;
    float view[7];  ///< members of `View` in order
    test::Mesh (*make)(const std::vector<fs::path> &);
    std::vector<const char *> files;
};

// The views of the models come from the files cameras.txt beside them, if present.
const std::vector<Source> &sources() {
    const char *const san_miguel = "san-miguel/san-miguel.ply.gz";
    const char *const instances = "san-miguel/san-miguel.instances";
    static const std::vector<Source> all = {
        {"cornell_box",
         {278, 273, -800, 0, 0, 1, 39},
         load_first,
         {"scenes/cornell_box/scene.json"}},
        {"sphere_10K", {0.5f, 1, -2.5f, -0.5f, -1, 2.5f, 45}, bumpy_sphere_of<51, 100>, {}},
        {"sphere_100K", {0.5f, 1, -2.5f, -0.5f, -1, 2.5f, 45}, bumpy_sphere_of<251, 200>, {}},
        {"sphere_1M", {0.5f, 1, -2.5f, -0.5f, -1, 2.5f, 45}, bumpy_sphere_of<1001, 500>, {}},
        {"terrain_1M",
         {-1, 3, -1, 6, -3, 6, 60},
         [](const std::vector<fs::path> &) { return test::terrain(707, 1); },
         {}},
        {"soup_100K",
         {-0.8f, 1.2f, -1.1f, 1.3f, -0.7f, 1.6f, 50},
         [](const std::vector<fs::path> &) { return test::soup(100000, 1); },
         {}},
        {"bunny", {-0.02f, 0.12f, 0.3f, 0, 0, -1, 40}, load_first, {"bunny/bunny.ply"}},
        {"sibenik",
         {-15, -9, 0, 1, -0.05f, 0, 75},
         load_first,
         {"sibenik/sibenik-75k-geometry.ply"}},
        {"cloth_ball",
         {18, 16, 18, -1, -0.7f, -1, 50},
         load_first,
         {"cloth-ball/cloth_ball92.ply"}},
        {"cloth_ball_next",
         {18, 16, 18, -1, -0.7f, -1, 50},
         load_first,
         {"cloth-ball/cloth_ball93.ply"}},
        {"conference",
         {-800, 400, 500, 0.75f, -0.3f, -0.6f, 80},
         load_first,
         {"conference/conference-clean.ply"}},
        {"bistro_interior",
         {150, 160, -60, 0.8f, -0.12f, -0.45f, 80},
         load_first,
         {"bistro-interior/bistro-interior.ply"}},
        {"two_dragons",
         {-0.35f, 0.2f, 0.04f, 1, -0.25f, 0, 45},
         two_dragons,
         {"dragon/dragon_vrip_res2.ply", "dragon/dragon_vrip_res3.ply"}},
        {"sponza_crytek",
         {-1300, 250, 0, 1, 0.05f, 0.05f, 80},
         load_first,
         {"sponza-crytek/sponza-crytek.ply"}},
        {"san_miguel_2M",
         {26.6878f, 7.31451f, -2.71626f, -0.821536f, 0.0630028f, 0.566665f, 79},
         san_miguel_of<SanMiguelPart::building_and_furniture>,
         {san_miguel, instances}},
        {"san_miguel_3M",
         {26.6878f, 7.31451f, -2.71626f, -0.821536f, 0.0630028f, 0.566665f, 79},
         san_miguel_of<SanMiguelPart::building_and_plants>,
         {san_miguel, instances}},
        {"san_miguel",
         {26.6878f, 7.31451f, -2.71626f, -0.821536f, 0.0630028f, 0.566665f, 79},
         san_miguel_of<SanMiguelPart::whole>,
         {san_miguel, instances}},
    };
    return all;
}

std::vector<fs::path> files_of(const Source &source) {
    std::vector<fs::path> files;
    for (const char *file : source.files) {
        files.push_back(measured_file(file));
    }
    return files;
}

bool is_present(const Source &source) {
    const std::vector<fs::path> files = files_of(source);
    return std::all_of(files.begin(), files.end(),
                       [](const fs::path &file) { return fs::exists(file); });
}

fs::path scene_file(const std::string &name) {
    return resource_folder() / "scenes" / name / "scene.json";
}

/// Scatters spheres on a hilly floor of 10 x 10. The floor has a quarter of the triangles.
test::Mesh scattered(uint32_t count) {
    test::Random random(count);
    test::Mesh mesh = test::terrain(std::max(1u, static_cast<uint32_t>(std::sqrt(count / 8.0))), 1);
    const float spacing = 10 / std::cbrt(static_cast<float>(count) / 1000 + 8);
    while (mesh.triangles.size() < count) {
        const auto rings = std::uniform_int_distribution<uint32_t>(8, 30)(random);
        const float radius = spacing * std::pow(10.0f, test::uniform(random, -2, 0));
        const Eigen::Vector3f centre(test::uniform(random, 0, 10),
                                     radius + test::uniform(random, 0, 2),
                                     test::uniform(random, 0, 10));
        append(mesh, test::sphere(rings, 2 * rings, radius, 0.05f, centre, random()));
    }
    mesh.triangles.resize(count);
    return mesh;
}

struct Procedure {
    const char *head;  ///< the name without the triangle count N
    test::Mesh (*make)(uint32_t count);
    View view;
};

const std::vector<Procedure> &procedures() {
    static const std::vector<Procedure> all = {
        {"scattered_", scattered, {{-2, 4, -2}, {6, -3, 6}, 60}},
        {"hall_", hall, {{6, 1.7f, 1}, {0, 0.05f, 1}, 75}},
        {"court_", court, {{6, 1.7f, 1}, {0, 0.05f, 1}, 75}},
        {"city_", city, {{15, 75, -20}, {0.6f, -0.5f, 1}, 75}},
    };
    return all;
}

/// Returns the procedure of a name and its N, or {nullptr, 0} for any other name.
std::pair<const Procedure *, uint32_t> procedure_of(const std::string &name) {
    for (const Procedure &procedure : procedures()) {
        const std::string head = procedure.head;
        if (name.rfind(head, 0) == 0 && name.size() > head.size() &&
            name.size() < head.size() + 9 &&
            name.find_first_not_of("0123456789", head.size()) == std::string::npos) {
            return {&procedure, static_cast<uint32_t>(std::stoul(name.substr(head.size())))};
        }
    }
    return {nullptr, 0};
}

/// Finds a named mesh; returns null for an unknown name.
const Source *find(const std::string &name) {
    const auto found = std::find_if(sources().begin(), sources().end(),
                                    [&](const Source &source) { return source.name == name; });
    return found == sources().end() ? nullptr : &*found;
}

Error cannot_load(const std::string &name, const char *reason) {
    return input_error(fmt::format(
        "cannot load mesh '{}': {}; meshes are: {}, scattered_N, hall_N, court_N, city_N; set "
        "RTRAYS_MESHES to a folder of models for more",
        name, reason, fmt::join(measured_meshes(), ", ")));
}

}  // namespace

std::vector<std::string> measured_meshes() {
    std::vector<std::string> names;
    for (const Source &source : sources()) {
        if (is_present(source)) {
            names.emplace_back(source.name);
        }
    }
    return names;
}

bool has_measured_mesh(const std::string &name) {
    const Source *source = find(name);
    return is_procedural(name) ||
           (source == nullptr ? fs::exists(scene_file(name)) : is_present(*source));
}

void require_mesh_name(const std::string &name) {
    if (!is_procedural(name) && find(name) == nullptr && !fs::exists(scene_file(name))) {
        throw cannot_load(name, "unknown name");
    }
}

bool is_procedural(const std::string &name) {
    return procedure_of(name).second > 0;
}

fs::path measured_file(const std::string &file) {
    if (file.rfind("scenes/", 0) == 0) {
        return resource_folder() / file;
    }
    const char *folder = std::getenv("RTRAYS_MESHES");
    return folder == nullptr ? fs::path() : fs::path(folder) / file;
}

void append(test::Mesh &mesh, const test::Mesh &part) {
    const auto first = static_cast<uint32_t>(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), part.positions.begin(), part.positions.end());
    for (const auto &[a, b, c] : part.triangles) {
        mesh.triangles.push_back({first + a, first + b, first + c});
    }
}

MeasuredMesh load_measured_mesh(const std::string &name) {
    if (const auto [procedure, count] = procedure_of(name); count > 0) {
        test::Mesh mesh = procedure->make(count);
        mesh.name = name;
        return {std::move(mesh), procedure->view};
    }
    const Source *source = find(name);
    if (source == nullptr && fs::exists(scene_file(name))) {
        test::Mesh mesh = load_mesh(scene_file(name));
        const Eigen::AlignedBox3f box = mesh.box();
        const Eigen::Vector3f away = Eigen::Vector3f(-0.6f, 0.8f, -1.0f).cwiseProduct(box.sizes());
        mesh.name = name;
        return {std::move(mesh), {box.center() + away, -away, 60}};
    }
    require_mesh_name(name);
    if (!is_present(*source)) {
        throw cannot_load(name, "its files are missing");
    }
    const float(&v)[7] = source->view;
    test::Mesh mesh = source->make(files_of(*source));
    mesh.name = name;
    return {std::move(mesh), {{v[0], v[1], v[2]}, {v[3], v[4], v[5]}, v[6]}};
}

}  // namespace rtrays
