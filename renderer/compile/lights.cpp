// SPDX-License-Identifier: MIT
// Compiles lights into records with selection probabilities.
#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "renderer/base/angles.h"
#include "renderer/base/error.h"
#include "renderer/compile/compile_scene.h"
#include "renderer/kernels/sampling/hemisphere.h"

namespace rtrays {

namespace {

double triangle_area(const MeshArrays &meshes, uint32_t triangle) {
    const Triangle &t = meshes.triangle[triangle];
    const Eigen::Vector3d p0 = meshes.position[t[0]].cast<double>();
    const Eigen::Vector3d e1 = meshes.position[t[1]].cast<double>() - p0;
    const Eigen::Vector3d e2 = meshes.position[t[2]].cast<double>() - p0;
    return 0.5 * e1.cross(e2).norm();
}

/// Areas of the triangles of a mesh light and the weights by which they are selected: the areas,
/// multiplied by the means of their emission if it has a texture.
struct TriangleWeights {
    std::vector<double> area, weight;
};

TriangleWeights triangle_weights(const MeshArrays &meshes, uint32_t mesh,
                                 const EmissionMeans *means) {
    TriangleWeights made;
    for (uint32_t i = 0; i < meshes.triangle_count[mesh]; ++i) {
        const uint32_t triangle = meshes.first_triangle[mesh] + i;
        made.area.push_back(triangle_area(meshes, triangle));
        made.weight.push_back(made.area.back());
        if (means != nullptr) {
            std::array<Eigen::Vector2f, 3> uv;
            for (size_t corner = 0; corner < 3; ++corner) {
                uv[corner] = meshes.uv.empty() ? Eigen::Vector2f(0, 0)
                                               : meshes.uv[meshes.triangle[triangle][corner]];
            }
            made.weight.back() *= means->of_triangle(uv);
        }
    }
    return made;
}

/// Sets the axes of a flat light: those about its normal.
void set_axes(float3 normal, LightRecord &light) {
    const Frame frame = frame_from_z(normal);
    copy3(Eigen::Vector3f(frame.x.x, frame.x.y, frame.x.z), light.axis_x);
    copy3(Eigen::Vector3f(frame.y.x, frame.y.y, frame.y.z), light.axis_y);
    copy3(Eigen::Vector3f(normal.x, normal.y, normal.z), light.axis_z);
}

void compile_mesh_light(const MeshArrays &meshes, uint32_t mesh, const TriangleWeights &weights,
                        LightRecord &light, CompiledScene &compiled) {
    const std::vector<double> &areas = weights.area;
    const SelectionTable table = selection_table(weights.weight);
    light.kind = LIGHT_MESH;
    light.first_triangle = static_cast<uint32_t>(compiled.emitter_triangles.size());
    light.triangle_count = meshes.triangle_count[mesh];
    const auto with_area =
        static_cast<size_t>(std::max_element(areas.begin(), areas.end()) - areas.begin());
    const float *normal =
        compiled.surface_triangles[meshes.first_triangle[mesh] + with_area].normal;
    set_axes(make_float3(normal[0], normal[1], normal[2]), light);
    for (uint32_t i = 0; i < areas.size(); ++i) {
        const uint32_t triangle = meshes.first_triangle[mesh] + i;
        compiled.surface_triangles[triangle].emitter =
            static_cast<uint32_t>(compiled.emitter_triangles.size());
        const double density = areas[i] > 0.0 ? table.probability[i] / areas[i] : 0.0;
        compiled.emitter_triangles.push_back({triangle,
                                              static_cast<uint32_t>(compiled.lights.size()),
                                              table.end[i], static_cast<float>(density)});
    }
}

/// A light's record without its selection probability, and its power in W (mean of the channels),
/// which drives selection. A light of power 0 is omitted.
struct Compiled {
    LightRecord record{};
    double power = 0;
};

/// Completes the record of an area light: a mesh, a disc or a sphere. Returns its power. If it is
/// 0, nothing is compiled.
double compile_area_light(const SceneArrays &scene, size_t i, SphereSampling sphere_sampling,
                          LightRecord &record, CompiledScene &compiled) {
    const LightArrays &lights = scene.lights;
    FeatureMask &features = compiled.light_features;
    record.texture = emission_texture(scene, i);
    std::optional<EmissionMeans> means;
    if (record.texture != NO_TEXTURE) {
        means.emplace(scene.textures, record.texture, lights.radiance[i]);
    }
    double power = pi * lights.area[i] *
                   (means ? means->of_image() : static_cast<double>(lights.radiance[i].mean()));
    if (lights.mesh[i] != no_index) {
        const TriangleWeights weights =
            triangle_weights(scene.meshes, lights.mesh[i], means ? &*means : nullptr);
        if (means) {
            power = pi * std::accumulate(weights.weight.begin(), weights.weight.end(), 0.0);
        }
        if (!(power > 0.0)) {
            return 0.0;
        }
        compile_mesh_light(scene.meshes, lights.mesh[i], weights, record, compiled);
        features = features.with(Feature::area_lights)
                       .with(Feature::light_triangles,
                             features.has(Feature::light_triangles) || record.triangle_count > 1);
        return power;
    }
    if (!(power > 0.0)) {
        return 0.0;
    }
    const bool is_disc = scene.shapes.kind[lights.shape[i]] == ShapeArrays::Kind::disc;
    record.kind = is_disc                                   ? LIGHT_DISC
                  : sphere_sampling == SphereSampling::area ? LIGHT_SPHERE_BY_AREA
                                                            : LIGHT_SPHERE;
    record.first_triangle = lights.shape[i];
    record.area = static_cast<float>(lights.area[i]);
    if (is_disc) {
        // The normal of `shape_point`, to the last bit.
        const auto &row = compiled.shapes[record.first_triangle].object_from_world[2];
        const float3 gradient = make_float3(row[0], row[1], row[2]);
        const float3 scaled = gradient / (std::abs(row[0]) + std::abs(row[1]) + std::abs(row[2]));
        set_axes(scaled / length(scaled), record);
    }
    compiled.shapes[lights.shape[i]].light = static_cast<uint32_t>(compiled.lights.size());
    features = features.with(Feature::shape_lights);
    return power;
}

/// Completes the record of a spot light. Returns the integral over directions of its intensity,
/// which is 1 in the inner cone and falls linearly with the angle between the cones.
double compile_spot_light(double inner, double outer, LightRecord &record) {
    record.kind = LIGHT_SPOT;
    record.outer_angle = static_cast<float>(outer);
    // Differences of cosines are written as products of sines to avoid cancellation.
    record.versine_outer = static_cast<float>(2.0 * std::pow(std::sin(0.5 * outer), 2));
    record.versine_range =
        static_cast<float>(2.0 * std::sin(0.5 * (outer + inner)) * std::sin(0.5 * (outer - inner)));
    record.angle_scale = static_cast<float>(1.0 / (outer - inner));
    // 2 pi (1 - mean cosine between the cones)
    return 2.0 * pi * (1.0 - (std::sin(outer) - std::sin(inner)) / (outer - inner));
}

/// Completes the record of a dome or an environment. Returns the integral of its radiance over all
/// directions, relative to the light's own radiance. Throws `Error` (bad input) if the scene has
/// such a light already.
double compile_infinite_light(const LightArrays &lights, size_t i, LightRecord &record,
                              CompiledScene &compiled) {
    if (compiled.lighting.infinite_light != NO_EMITTER) {
        throw input_error(fmt::format(
            "light '{}': the scene has another dome or environment; only one is allowed",
            lights.name[i]));
    }
    if (lights.kind[i] == LightArrays::Kind::dome) {
        record.kind = LIGHT_DOME;
        return 4.0 * pi;
    }
    record.kind = LIGHT_ENVIRONMENT;
    if (compiled.environment_image != lights.image[i]) {
        compiled.environment_image = lights.image[i];
        compiled.environment_integral = compile_environment(*lights.image[i], compiled);
    }
    return compiled.environment_integral;
}

Compiled compile_light(const SceneArrays &scene, size_t i, const CompileSettings &settings,
                       const SceneExtent &extent, CompiledScene &compiled) {
    using Kind = LightArrays::Kind;
    const LightArrays &lights = scene.lights;
    FeatureMask &features = compiled.light_features;
    Compiled light;
    LightRecord &record = light.record;
    record.texture = NO_TEXTURE;
    copy3(lights.radiance[i], record.radiance);
    const Eigen::Matrix4d &world = lights.world_from_light[i];
    copy3(Eigen::Vector3d(world.block<3, 1>(0, 0)), record.axis_x);
    copy3(Eigen::Vector3d(world.block<3, 1>(0, 1)), record.axis_y);
    copy3(Eigen::Vector3d(world.block<3, 1>(0, 2)), record.axis_z);
    copy3(Eigen::Vector3d(world.block<3, 1>(0, 3)), record.position);
    const double mean = static_cast<double>(lights.radiance[i].mean());
    // projected area of the scene's sphere, seen from infinity
    const double disc = pi * extent.radius * extent.radius;
    if (!(lights.radiance[i].maxCoeff() > 0.0f)) {
        return light;
    }
    switch (lights.kind[i]) {
        case Kind::diffuse_area:
            light.power = compile_area_light(scene, i, settings.sphere_sampling, record, compiled);
            break;
        case Kind::point:
            record.kind = LIGHT_POINT;
            light.power = 4.0 * pi * mean;
            features = features.with(Feature::point_lights);
            break;
        case Kind::spot:
            light.power =
                compile_spot_light(lights.inner_angle[i], lights.outer_angle[i], record) * mean;
            features = features.with(Feature::spot_lights);
            break;
        case Kind::directional:
            record.kind = LIGHT_DIRECTIONAL;
            light.power = disc * mean;
            features = features.with(Feature::directional_lights);
            break;
        case Kind::dome:
        case Kind::environment:
            light.power = disc * mean * compile_infinite_light(lights, i, record, compiled);
            if (light.power > 0.0) {
                compiled.lighting.infinite_light = static_cast<uint32_t>(compiled.lights.size());
                features =
                    features.with(Feature::infinite_lights)
                        .with(lights.kind[i] == Kind::dome ? Feature::dome : Feature::environment);
            }
            break;
    }
    return light;
}

/// Sets the selection probabilities of next-event estimation: uniform, in proportion to power, the
/// mean of both (which bounds the loss against either), or 1 for each light. A light path starts at
/// a single light; with `independent`, that light is selected by the mean of both.
void select_lights(const std::vector<double> &powers, LightSelection selection,
                   std::vector<LightRecord> &lights) {
    const double total = std::accumulate(powers.begin(), powers.end(), 0.0);
    const double by_power = selection == LightSelection::power     ? 1.0
                            : selection == LightSelection::uniform ? 0.0
                                                                   : 0.5;
    std::vector<double> weights(lights.size());
    for (size_t i = 0; i < lights.size(); ++i) {
        weights[i] =
            by_power * powers[i] / total + (1.0 - by_power) / static_cast<double>(lights.size());
    }
    const SelectionTable table = selection_table(weights);
    for (size_t i = 0; i < lights.size(); ++i) {
        lights[i].selection_end = table.end[i];
        lights[i].emission_selection = static_cast<float>(table.probability[i]);
        lights[i].selection =
            selection == LightSelection::independent ? 1.0f : lights[i].emission_selection;
    }
}

/// Returns a point light at the camera. A white diffuse surface at the centre of the scene that
/// faces it has radiance 1.
Compiled headlight(const SceneExtent &extent, CompiledScene &compiled) {
    const double away =
        (Eigen::Vector3f(compiled.camera.position).cast<double>() - extent.centre).norm();
    const double intensity = pi * std::pow(std::max(away, extent.radius), 2);
    Compiled light;
    light.record.kind = LIGHT_POINT;
    light.record.texture = NO_TEXTURE;
    copy3(Eigen::Vector3d::Constant(intensity).eval(), light.record.radiance);
    std::copy_n(compiled.camera.position, 3, light.record.position);
    light.power = 4.0 * pi * intensity;
    compiled.light_features = compiled.light_features.with(Feature::point_lights);
    return light;
}

}  // namespace

void compile_lights(const SceneArrays &scene, const CompileSettings &settings,
                    CompiledScene &compiled) {
    const SceneExtent &extent = compiled.extent;
    compiled.light_features = FeatureMask();
    LightingRecord &lighting = compiled.lighting;
    lighting.infinite_light = NO_EMITTER;
    copy3(extent.centre, lighting.scene_centre);
    lighting.scene_radius = static_cast<float>(extent.radius);
    compile_distances(compiled);
    const auto &kinds = scene.shapes.kind;
    const auto last_plane = std::find(kinds.rbegin(), kinds.rend(), ShapeArrays::Kind::plane);
    lighting.plane_end = static_cast<uint32_t>(kinds.rend() - last_plane);
    std::vector<double> powers;
    const auto add = [&](const Compiled &light) {
        if (light.power > 0.0) {
            compiled.lights.push_back(light.record);
            powers.push_back(light.power);
        }
    };
    for (size_t i = 0; i < scene.lights.name.size(); ++i) {
        add(compile_light(scene, i, settings, extent, compiled));
    }
    if (!compiled.light_features.has(Feature::environment)) {
        compiled.environment_image = nullptr;
        lighting.environment_width = lighting.environment_height = 0;
        compiled.environment_texels.clear();
        compiled.environment_ends.clear();
    }
    compiled.has_headlight = settings.headlight && compiled.lights.empty();
    if (compiled.has_headlight) {
        add(headlight(extent, compiled));
    }
    if (!compiled.lights.empty()) {
        select_lights(powers, settings.light_selection, compiled.lights);
    }
    lighting.light_count = static_cast<uint32_t>(compiled.lights.size());
    const bool several = compiled.lights.size() > 1;
    const bool independent = settings.light_selection == LightSelection::independent;
    compiled.light_features =
        compiled.light_features.with(Feature::lights, !compiled.lights.empty())
            .with(Feature::many_lights, several && !independent)
            .with(Feature::independent_lights, several && independent);
}

}  // namespace rtrays
