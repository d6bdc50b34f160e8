// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <numeric>

#include "renderer/base/error.h"
#include "renderer/pipeline/compile_scene.h"

namespace rtrays {

namespace {

constexpr double pi = 3.14159265358979323846;

double triangle_area(const MeshArrays &meshes, uint32_t triangle) {
    const Triangle &t = meshes.triangle[triangle];
    const Eigen::Vector3d p0 = meshes.position[t[0]].cast<double>();
    const Eigen::Vector3d e1 = meshes.position[t[1]].cast<double>() - p0;
    const Eigen::Vector3d e2 = meshes.position[t[2]].cast<double>() - p0;
    return 0.5 * e1.cross(e2).norm();
}

/// A sphere around all finite surfaces and the camera.
struct Extent {
    Eigen::Vector3d centre;
    double radius;
};

Extent extent_of(const SceneArrays &scene, const CameraRecord &camera) {
    Eigen::AlignedBox3d box;
    box.extend(Eigen::Vector3f(camera.position).cast<double>());
    for (const Eigen::Vector3f &position : scene.meshes.position) {
        box.extend(position.cast<double>());
    }
    for (size_t i = 0; i < scene.shapes.name.size(); ++i) {
        if (scene.shapes.kind[i] == ShapeArrays::Kind::plane) {
            continue;
        }
        // Every canonical surface lies within this distance of its origin, per axis.
        const double reach = scene.shapes.kind[i] == ShapeArrays::Kind::julia         ? 4.0
                             : scene.shapes.kind[i] == ShapeArrays::Kind::hyperboloid ? std::sqrt(1.0 + scene.shapes.flare[i])
                                                                                      : 1.0;
        const Eigen::Matrix4d &m = scene.shapes.world_from_object[i];
        const Eigen::Vector3d centre = m.block<3, 1>(0, 3);
        const Eigen::Vector3d half = reach * m.topLeftCorner<3, 3>().cwiseAbs() * Eigen::Vector3d::Ones();
        box.extend(centre + half);
        box.extend(centre - half);
    }
    return {box.center(), 0.5 * box.diagonal().norm()};
}

void compile_mesh_light(const MeshArrays &meshes, uint32_t mesh, LightRecord &light, CompiledScene &compiled) {
    std::vector<double> areas(meshes.triangle_count[mesh]);
    for (uint32_t i = 0; i < areas.size(); ++i) {
        areas[i] = triangle_area(meshes, meshes.first_triangle[mesh] + i);
    }
    const SelectionTable table = selection_table(areas);
    light.kind = LIGHT_MESH;
    light.first_triangle = static_cast<uint32_t>(compiled.emitter_triangles.size());
    light.triangle_count = meshes.triangle_count[mesh];
    for (uint32_t i = 0; i < areas.size(); ++i) {
        const uint32_t triangle = meshes.first_triangle[mesh] + i;
        compiled.surface_triangles[triangle].emitter = static_cast<uint32_t>(compiled.emitter_triangles.size());
        const double density = areas[i] > 0.0 ? table.probability[i] / areas[i] : 0.0;
        compiled.emitter_triangles.push_back({triangle, static_cast<uint32_t>(compiled.lights.size()), table.end[i],
                                              static_cast<float>(density)});
    }
}

/// One light's record, without selection, and its power in W (mean of the channels), which drives selection. A power
/// of 0: it is no light.
struct Compiled {
    LightRecord record{};
    double power = 0;
};

Compiled compile_light(const SceneArrays &scene, size_t i, const CompileSettings &settings, const Extent &extent,
                       CompiledScene &compiled) {
    using Kind = LightArrays::Kind;
    const LightArrays &lights = scene.lights;
    Compiled light;
    LightRecord &record = light.record;
    copy3(lights.radiance[i], record.radiance);
    const Eigen::Matrix4d &world = lights.world_from_light[i];
    copy3(Eigen::Vector3d(world.block<3, 1>(0, 0)), record.axis_x);
    copy3(Eigen::Vector3d(world.block<3, 1>(0, 1)), record.axis_y);
    copy3(Eigen::Vector3d(world.block<3, 1>(0, 2)), record.axis_z);
    copy3(Eigen::Vector3d(world.block<3, 1>(0, 3)), record.position);
    const double mean = static_cast<double>(lights.radiance[i].mean());
    const double disc = pi * extent.radius * extent.radius;  // of the scene, seen from infinity
    if (!(lights.radiance[i].maxCoeff() > 0.0f)) {
        return light;
    }
    switch (lights.kind[i]) {
    case Kind::diffuse_area:
        light.power = pi * lights.area[i] * mean;
        if (lights.mesh[i] != no_index) {
            compile_mesh_light(scene.meshes, lights.mesh[i], record, compiled);
            compiled.features = compiled.features.with(Feature::area_lights)
                                    .with(Feature::light_triangles,
                                          compiled.features.has(Feature::light_triangles) || record.triangle_count > 1);
        } else {
            const bool is_disc = scene.shapes.kind[lights.shape[i]] == ShapeArrays::Kind::disc;
            record.kind = is_disc ? LIGHT_DISC : settings.spheres_by_area ? LIGHT_SPHERE_BY_AREA : LIGHT_SPHERE;
            record.first_triangle = lights.shape[i];
            record.area = static_cast<float>(lights.area[i]);
            compiled.shapes[lights.shape[i]].light = static_cast<uint32_t>(compiled.lights.size());
            compiled.features = compiled.features.with(Feature::shape_lights);
        }
        break;
    case Kind::point:
        record.kind = LIGHT_POINT;
        light.power = 4.0 * pi * mean;
        compiled.features = compiled.features.with(Feature::point_lights);
        break;
    case Kind::spot: {
        record.kind = LIGHT_SPOT;
        const double inner = lights.inner_angle[i], outer = lights.outer_angle[i];
        record.outer_angle = static_cast<float>(outer);
        record.cos_outer = static_cast<float>(std::cos(outer));
        record.angle_scale = static_cast<float>(1.0 / (outer - inner));
        // The integral of the linear fall: 2 pi (1 - sinc-like mean of the cosines between the cones).
        light.power = 2.0 * pi * (1.0 - (std::sin(outer) - std::sin(inner)) / (outer - inner)) * mean;
        compiled.features = compiled.features.with(Feature::spot_lights);
        break;
    }
    case Kind::directional:
        record.kind = LIGHT_DIRECTIONAL;
        light.power = disc * mean;
        compiled.features = compiled.features.with(Feature::directional_lights);
        break;
    case Kind::dome:
    case Kind::environment: {
        if (compiled.lighting.infinite_light != NO_EMITTER) {
            throw input_error(fmt::format("light '{}': the scene has another dome or environment; there can be one", lights.name[i]));
        }
        const bool dome = lights.kind[i] == Kind::dome;
        record.kind = dome ? LIGHT_DOME : LIGHT_ENVIRONMENT;
        light.power = disc * mean * (dome ? 4.0 * pi : compile_environment(*lights.image[i], compiled));
        if (light.power > 0.0) {
            compiled.lighting.infinite_light = static_cast<uint32_t>(compiled.lights.size());
            compiled.features = compiled.features.with(Feature::infinite_lights).with(dome ? Feature::dome : Feature::environment);
        }
        break;
    }
    }
    return light;
}

/// Selection probabilities: uniform, by power, the mean of both (which bounds the loss of either), or 1 for each.
void select_lights(const std::vector<double> &powers, LightSelection selection, std::vector<LightRecord> &lights) {
    const double total = std::accumulate(powers.begin(), powers.end(), 0.0);
    const double by_power = selection == LightSelection::power ? 1.0 : selection == LightSelection::mixed ? 0.5 : 0.0;
    std::vector<double> weights(lights.size());
    for (size_t i = 0; i < lights.size(); ++i) {
        weights[i] = by_power * powers[i] / total + (1.0 - by_power) / static_cast<double>(lights.size());
    }
    const SelectionTable table = selection_table(weights);
    for (size_t i = 0; i < lights.size(); ++i) {
        lights[i].selection_end = table.end[i];
        lights[i].selection =
            selection == LightSelection::independent ? 1.0f : static_cast<float>(table.probability[i]);
    }
}

}  // namespace

void compile_lights(const SceneArrays &scene, const CompileSettings &settings, CompiledScene &compiled) {
    const Extent extent = extent_of(scene, compiled.camera);
    compiled.lighting.infinite_light = NO_EMITTER;
    // Beyond any point of the scene, planes apart, whose horizon is cut a million radii away; in lengths of such a
    // shadow ray hits keep their relative precision.
    compiled.lighting.far_distance = static_cast<float>(0x1p20 * extent.radius);
    std::vector<double> powers;
    for (size_t i = 0; i < scene.lights.name.size(); ++i) {
        const Compiled light = compile_light(scene, i, settings, extent, compiled);
        if (light.power > 0.0) {
            compiled.lights.push_back(light.record);
            powers.push_back(light.power);
        }
    }
    if (!compiled.lights.empty()) {
        select_lights(powers, settings.light_selection, compiled.lights);
    }
    compiled.lighting.light_count = static_cast<uint32_t>(compiled.lights.size());
    const bool several = compiled.lights.size() > 1;
    const bool independent = settings.light_selection == LightSelection::independent;
    compiled.features = compiled.features.with(Feature::lights, !compiled.lights.empty())
                            .with(Feature::many_lights, several && !independent)
                            .with(Feature::independent_lights, several && independent);
}

}  // namespace rtrays
