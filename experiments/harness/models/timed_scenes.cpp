// SPDX-License-Identifier: MIT
#include "experiments/harness/models/timed_scenes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <optional>

#include "experiments/harness/models/meshes.h"
#include "experiments/harness/models/san_miguel.h"
#include "renderer/base/error.h"
#include "renderer/base/notice.h"
#include "renderer/import/load_scene.h"
#include "renderer/import/models/model_file.h"
#include "renderer/scene/cores/camera.h"
#include "renderer/scene/cores/light.h"
#include "renderer/scene/cores/material.h"
#include "renderer/scene/cores/mesh.h"
#include "renderer/scene/cores/transform.h"
#include "renderer/scene/graph.h"

namespace rtrays {

namespace {

namespace fs = std::filesystem;
using Eigen::Vector2d;
using Eigen::Vector3d;

/// Lights of a scene: rectangles, or a dome and a directional light (thesis, section 4.4.3).
struct Lights {
    std::optional<Vector3d> sun;  ///< direction of the sunlight, under a sky of radiance 1
    std::vector<Vector3d> lamps;  ///< centres of rectangles that face down
    double lamp_side = 0;
};

/// Contents of a scene: a model with materials or a mesh, and optionally a dragon in front.
struct Place {
    std::string name;
    std::string model;  ///< file of the models' folder; the list of instances for San Miguel
    std::string mesh;   ///< name for `load_measured_mesh`
    View view;          ///< its angle is the horizontal field of view
    Lights lights;
    bool dragon = false;
};

const Vector3d high_sun(0.3, -1, 0.15);
const char *const dragon_file = "dragon/dragon_vrip_res3.ply";

// The views of the models come from the files cameras.txt beside them, if present.
const std::vector<Place> &models() {
    static const std::vector<Place> all = {
        {"sponza_dragon",
         "sponza-dabrovic/sponza-dabrovic.ply",
         "",
         {{-13, 3, 0}, {1, -0.05f, 0}, 80},
         {high_sun, {}},
         true},
        {"sponza_outside",
         "sponza-crytek/sponza-crytek.ply",
         "",
         {{-950, 300, -20}, {1, 0.25f, 0.05f}, 80},
         {high_sun, {}}},
        {"sponza_inside",
         "sponza-crytek/sponza-crytek.ply",
         "",
         {{-1150, 220, -20}, {1, -0.06f, 0.06f}, 80},
         {high_sun, {}}},
        {"conference",
         "",
         "conference",
         {{-800, 400, 500}, {0.75f, -0.3f, -0.6f}, 80},
         {{}, {{0, 600, 0}, {600, 600, 0}}, 200}},
        {"sibenik",
         "sibenik/sibenik.ply",
         "",
         {{-15, -9, 0}, {1, -0.05f, 0}, 75},
         {{}, {{-8, 6, 0}, {4, 6, 0}}, 6}},
        {"san_miguel_ground",
         "san-miguel/san-miguel.instances",
         "",
         {{27.6255f, 1.49616f, 2.42353f}, {-0.967323f, -0.0081302f, -0.253416f}, 75},
         {high_sun, {}}},
        {"san_miguel_upper",
         "san-miguel/san-miguel.instances",
         "",
         {{26.6878f, 7.31451f, -2.71626f}, {-0.821536f, 0.0630028f, 0.566665f}, 79},
         {high_sun, {}}},
    };
    return all;
}

/// A procedural scene of N triangles. Its name is `head`, N and `tail`; its mesh is `mesh` and N.
struct Procedure {
    std::string head, tail, mesh;
    View view;
    Lights lights;
};

const std::vector<Procedure> &procedures() {
    static const std::vector<Procedure> all = {
        {"court_", "", "court_", {{6, 1.7f, 1}, {0, 0.15f, 1}, 80}, {high_sun, {}}},
        {"court_", "_upper", "court_", {{1.2f, 5.7f, 1}, {0.4f, -0.15f, 1}, 80}, {high_sun, {}}},
        {"hall_",
         "",
         "hall_",
         {{6, 1.7f, 1}, {0, 0.05f, 1}, 80},
         {{}, {{6, 7.8, 6}, {6, 7.8, 18}, {6, 7.8, 30}}, 2}},
        {"landscape_", "", "scattered_", {{-3, 6, -3}, {6, -4, 6}, 60}, {high_sun, {}}},
        {"city_", "", "city_", {{15, 75, -20}, {0.6f, -0.5f, 1}, 75}, {high_sun, {}}},
    };
    return all;
}

/// Returns the contents of a procedural scene, or nothing for any other name.
std::optional<Place> procedural_place(const std::string &name) {
    for (const Procedure &procedure : procedures()) {
        const size_t around = procedure.head.size() + procedure.tail.size();
        if (name.size() > around && name.rfind(procedure.head, 0) == 0 &&
            name.compare(name.size() - procedure.tail.size(), std::string::npos, procedure.tail) ==
                0) {
            const std::string mesh =
                procedure.mesh + name.substr(procedure.head.size(), name.size() - around);
            if (is_procedural(mesh)) {
                return Place{name, "", mesh, procedure.view, procedure.lights};
            }
        }
    }
    return std::nullopt;
}

bool is_present(const Place &place) {
    return (place.model.empty() ? has_measured_mesh(place.mesh)
                                : fs::exists(measured_file(place.model))) &&
           (!place.dragon || fs::exists(measured_file(dragon_file)));
}

/// Returns the contents of a model scene or a procedural scene, or nothing for any other name.
std::optional<Place> known_place(const std::string &name) {
    const auto found = std::find_if(models().begin(), models().end(),
                                    [&](const Place &place) { return place.name == name; });
    return found == models().end() ? procedural_place(name) : *found;
}

/// Returns the contents of a model scene or a procedural scene if its files exist.
std::optional<Place> place_of(const std::string &name) {
    std::optional<Place> place = known_place(name);
    return place && is_present(*place) ? place : std::nullopt;
}

std::string scene_file(const std::string &name) {
    return measured_file("scenes/" + name + "/scene.json").string();
}

std::shared_ptr<MaterialCore> lambert() {
    return std::make_shared<MaterialCore>(
        "diffuse", "lambert", ParameterValues{{"reflectance", Vector3d(0.6, 0.6, 0.6)}});
}

std::shared_ptr<MaterialCore> lambert_and_blinn() {
    return std::make_shared<MaterialCore>("gloss", "lambert_blinn",
                                          ParameterValues{{"reflectance", Vector3d(0.5, 0.5, 0.5)},
                                                          {"specular", Vector3d(0.15, 0.15, 0.15)},
                                                          {"exponent", 64.0}});
}

Node &add_node(Scene &scene, const std::string &name, const Eigen::Matrix4d &transform) {
    auto node = std::make_unique<Node>(name);
    node->set_core(std::make_shared<TransformCore>("", transform));
    return scene.graph().root().add_child(std::move(node));
}

void add_mesh(Scene &scene, const test::Mesh &mesh, const Eigen::Matrix4d &transform) {
    MeshCore::Geometry geometry;
    geometry.vertices.reserve(mesh.positions.size());
    for (const Eigen::Vector3f &position : mesh.positions) {
        geometry.vertices.push_back(position.cast<double>());
    }
    geometry.triangles.assign(mesh.triangles.begin(), mesh.triangles.end());
    Node &node = add_node(scene, "measured " + mesh.name, transform);
    node.set_core(std::make_shared<MeshCore>(mesh.name, std::move(geometry)));
    node.set_core(lambert_and_blinn());
}

/// Adds the Stanford dragon, four metres long, on the floor of the atrium.
void add_dragon(Scene &scene) {
    Node &node = add_node(
        scene, "measured dragon",
        translation({-7, -1, 0}) * rotation(Vector3d::UnitY(), M_PI / 3) * scaling({20, 20, 20}));
    node.set_core(load_mesh_file(measured_file(dragon_file), "dragon"));
    node.set_core(
        std::make_shared<MaterialCore>("jade", "plastic",
                                       ParameterValues{{"reflectance", Vector3d(0.2, 0.55, 0.3)},
                                                       {"eta", 1.5},
                                                       {"roughness", Vector2d(0.1, 0.1)}}));
}

void add_view(Scene &scene, const View &view) {
    const Vector3d origin = view.origin.cast<double>();
    Node &node =
        add_node(scene, "measured view",
                 look_at(origin, origin + view.direction.cast<double>(), Vector3d::UnitY()));
    node.set_core(
        std::make_shared<CameraCore>("", "pinhole",
                                     ParameterValues{{"fov", static_cast<double>(view.degrees)},
                                                     {"fov_axis", std::string("x")}}));
}

void add_light(Scene &scene, const std::string &name, const Eigen::Matrix4d &transform,
               const std::string &type, const std::string &parameter, double value) {
    add_node(scene, name, transform)
        .set_core(std::make_shared<LightCore>(
            "", type, ParameterValues{{parameter, Vector3d(Vector3d::Constant(value))}}));
}

void add_lights(Scene &scene, const Lights &lights) {
    visit_subtree(scene.graph().root(), [](Node &node) { node.remove_core(CoreRole::light); });
    if (lights.sun) {
        add_light(scene, "measured sky", Eigen::Matrix4d::Identity(), "dome", "radiance", 1);
        add_light(scene, "measured sun", look_at(Vector3d::Zero(), *lights.sun, Vector3d::UnitZ()),
                  "directional", "irradiance", 6);
    }
    for (size_t i = 0; i < lights.lamps.size(); ++i) {
        const double half = 0.5 * lights.lamp_side;
        const std::string name = fmt::format("measured lamp {}", i);
        add_light(scene, name,
                  translation(lights.lamps[i]) * rotation(Vector3d::UnitX(), M_PI / 2) *
                      scaling({half, half, 1}),
                  "diffuse_area", "radiance", 20);
        Node &node = *scene.graph().find(name);
        node.set_core(std::make_shared<MeshCore>(name, rectangle()));
        node.set_core(lambert());
    }
}

std::string describe(const Place &place, Surfaces surfaces) {
    std::string text = surfaces == Surfaces::diffuse ? "diffuse"
                       : place.model.empty()         ? "Lambert and Blinn"
                                                     : "the model's materials and textures";
    return text + (place.lights.sun ? "; sun and sky"
                                    : fmt::format("; {} area lights", place.lights.lamps.size()));
}

Scene make_scene(const Place &place) {
    // Suppresses the notices about missing cameras and lights, which are replaced here.
    const NoticeReceiver silence([](const std::string &) {});
    if (!place.model.empty()) {
        const fs::path file = measured_file(place.model);
        return file.extension() == ".instances"
                   ? load_san_miguel_scene(fs::path(file).replace_extension(".ply.gz"), file,
                                           fs::path(file).replace_extension(".mtl"))
                   : load_scene(file.string());
    }
    Scene scene;
    add_mesh(scene, load_measured_mesh(place.mesh).mesh, Eigen::Matrix4d::Identity());
    return scene;
}

Error cannot_load(const std::string &name, const char *reason) {
    return input_error(fmt::format(
        "cannot load scene '{}': {}; scenes are: {}, and the folders of scenes/; set RTRAYS_MESHES "
        "to a folder of models for more",
        name, reason, fmt::join(timed_scenes(), ", ")));
}

}  // namespace

std::vector<std::string> timed_scenes() {
    std::vector<std::string> names;
    for (const Place &place : models()) {
        if (is_present(place)) {
            names.push_back(place.name);
        }
    }
    for (const Procedure &procedure : procedures()) {
        names.push_back(procedure.head + "N" + procedure.tail);
    }
    return names;
}

bool has_timed_scene(const std::string &name) {
    return place_of(name).has_value() || fs::exists(scene_file(name));
}

void require_scene_name(const std::string &name) {
    if (!known_place(name) && !fs::exists(scene_file(name))) {
        throw cannot_load(name, "unknown name");
    }
}

TimedScene load_timed_scene(const std::string &name, Surfaces surfaces) {
    require_scene_name(name);
    const std::optional<Place> place = place_of(name);
    if (!place && !fs::exists(scene_file(name))) {
        throw cannot_load(name, "its files are missing");
    }
    Scene scene = place ? make_scene(*place) : load_scene(scene_file(name));
    if (place) {
        if (place->dragon) {
            add_dragon(scene);
        }
        add_view(scene, place->view);
        add_lights(scene, place->lights);
    }
    if (surfaces == Surfaces::diffuse) {
        const std::shared_ptr<MaterialCore> diffuse = lambert();
        visit_subtree(scene.graph().root(), [&](Node &node) {
            if (node.core(CoreRole::material) != nullptr) {
                node.set_core(diffuse);
            }
        });
    }
    scene.update(0);
    if (place) {
        scene.set_active_camera("measured view");
    }
    return {std::move(scene), place && is_procedural(place->mesh),
            place ? describe(*place, surfaces) : "as in the scene file"};
}

}  // namespace rtrays
