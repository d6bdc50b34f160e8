// SPDX-License-Identifier: MIT
#include "renderer/pipeline/compile_scene.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "renderer/kernels/geometry/surface_point.h"

namespace rtrays {

namespace {

constexpr double pi = 3.14159265358979323846;

void copy(const Eigen::Vector3d &from, float (&to)[3]) {
    for (int i = 0; i < 3; ++i) {
        to[i] = static_cast<float>(from[i]);
    }
}

void copy(const Eigen::Vector3f &from, float (&to)[3]) { std::copy(from.data(), from.data() + 3, to); }

double triangle_area(const MeshArrays &meshes, uint32_t triangle) {
    const Triangle &t = meshes.triangle[triangle];
    const Eigen::Vector3d p0 = meshes.position[t[0]].cast<double>();
    const Eigen::Vector3d e1 = meshes.position[t[1]].cast<double>() - p0;
    const Eigen::Vector3d e2 = meshes.position[t[2]].cast<double>() - p0;
    return 0.5 * e1.cross(e2).norm();
}

/// Adds the light of one emitting mesh and its triangles; selection among lights is filled in later.
void add_mesh_light(const MeshArrays &meshes, uint32_t mesh, const Rgb &radiance, CompiledScene &compiled) {
    std::vector<double> areas(meshes.triangle_count[mesh]);
    for (uint32_t i = 0; i < areas.size(); ++i) {
        areas[i] = triangle_area(meshes, meshes.first_triangle[mesh] + i);
    }
    const SelectionTable table = selection_table(areas);

    LightRecord light{};
    copy(radiance, light.radiance);
    light.first_triangle = static_cast<uint32_t>(compiled.emitter_triangles.size());
    light.triangle_count = meshes.triangle_count[mesh];
    for (uint32_t i = 0; i < areas.size(); ++i) {
        const uint32_t triangle = meshes.first_triangle[mesh] + i;
        compiled.surface_triangles[triangle].emitter = static_cast<uint32_t>(compiled.emitter_triangles.size());
        const double density = areas[i] > 0.0 ? table.probability[i] / areas[i] : 0.0;
        compiled.emitter_triangles.push_back({triangle, static_cast<uint32_t>(compiled.lights.size()), table.end[i],
                                              static_cast<float>(density)});
    }
    compiled.lights.push_back(light);
}

/// Selection probabilities: uniform, by power Phi = pi A L, or the mean of both (which bounds the loss of either).
void select_lights(const std::vector<double> &powers, LightSelection selection, std::vector<LightRecord> &lights) {
    const double total = std::accumulate(powers.begin(), powers.end(), 0.0);
    const double by_power = selection == LightSelection::uniform ? 0.0 : selection == LightSelection::power ? 1.0 : 0.5;
    std::vector<double> weights(lights.size());
    for (size_t i = 0; i < lights.size(); ++i) {
        weights[i] = by_power * powers[i] / total + (1.0 - by_power) / static_cast<double>(lights.size());
    }
    const SelectionTable table = selection_table(weights);
    for (size_t i = 0; i < lights.size(); ++i) {
        lights[i].selection_end = table.end[i];
        lights[i].selection = static_cast<float>(table.probability[i]);
    }
}

}  // namespace

SelectionTable selection_table(const std::vector<double> &weights) {
    const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
    constexpr double scale = 0x1p32;
    SelectionTable table;
    double sum = 0;
    double previous = 0;
    for (size_t i = 0; i < weights.size(); ++i) {
        sum += weights[i];
        // Every end but the last stays below 2^32; the last stands for 2^32 itself.
        const double end = i + 1 == weights.size() ? scale : std::min(std::round(sum / total * scale), scale - 1.0);
        table.probability.push_back((end - previous) / scale);
        table.end.push_back(static_cast<uint32_t>(std::min(end, scale - 1.0)));
        previous = end;
    }
    return table;
}

CameraRecord compile_camera(const CameraArrays &cameras, size_t index, int width, int height) {
    const Eigen::Matrix4d &world = cameras.world_from_camera[index];
    const Eigen::Vector3d right = world.block<3, 1>(0, 0);
    const Eigen::Vector3d up = world.block<3, 1>(0, 1);
    const Eigen::Vector3d forward = -world.block<3, 1>(0, 2);
    using FovAxis = CameraArrays::FovAxis;
    const FovAxis axis = cameras.fov_axis[index];
    const bool along_x = axis == FovAxis::x || (axis == FovAxis::smaller && width <= height) ||
                         (axis == FovAxis::larger && width >= height);
    // Pixels are square: one size, on the plane at unit distance.
    const double pixel = 2.0 * std::tan(0.5 * cameras.fov[index]) / (along_x ? width : height);

    CameraRecord camera{};
    camera.width = static_cast<uint32_t>(width);
    camera.height = static_cast<uint32_t>(height);
    camera.pixel_area = static_cast<float>(pixel * pixel);
    copy(Eigen::Vector3d(world.block<3, 1>(0, 3)), camera.position);
    copy(Eigen::Vector3d(forward - 0.5 * pixel * width * right + 0.5 * pixel * height * up), camera.corner);
    copy(Eigen::Vector3d(pixel * right), camera.step_x);
    copy(Eigen::Vector3d(-pixel * up), camera.step_y);
    return camera;
}

CompiledScene compile_scene(const Scene &scene, int width, int height, LightSelection selection) {
    const MeshArrays &meshes = scene.meshes();
    CompiledScene compiled;
    compiled.camera = compile_camera(scene.cameras(), static_cast<size_t>(scene.active_camera()), width, height);

    compiled.surface_triangles.reserve(meshes.triangle.size());
    for (size_t i = 0; i < meshes.triangle.size(); ++i) {
        const Triangle &t = meshes.triangle[i];
        SurfaceTriangle surface{};
        copy(meshes.position[t[0]], surface.p0);
        copy(meshes.position[t[1]], surface.p1);
        copy(meshes.position[t[2]], surface.p2);
        const float3 p0 = make_float3(surface.p0[0], surface.p0[1], surface.p0[2]);
        const float3 p1 = make_float3(surface.p1[0], surface.p1[1], surface.p1[2]);
        const float3 p2 = make_float3(surface.p2[0], surface.p2[1], surface.p2[2]);
        const float3 normal = triangle_normal(p0, p1, p2);
        copy(Eigen::Vector3f(normal.x, normal.y, normal.z), surface.normal);
        surface.extent = triangle_extent(p0, p1, p2);
        surface.material = meshes.material[meshes.triangle_mesh[i]];
        surface.emitter = NO_EMITTER;
        compiled.surface_triangles.push_back(surface);
    }

    const MaterialArrays &materials = scene.materials();
    bool scattering = false;
    for (size_t i = 0; i < materials.name.size(); ++i) {
        compiled.materials.push_back({materials.first_component[i], materials.component_count[i], 0, 0});
    }
    for (const BxdfComponent &component : materials.component) {
        BxdfRecord record{};
        record.kind = BXDF_LAMBERT;
        record.texture = NO_TEXTURE;
        copy(component.weight, record.weight);
        compiled.components.push_back(record);
        scattering = scattering || component.weight.maxCoeff() > 0.0f;
    }

    const LightArrays &lights = scene.lights();
    std::vector<double> powers;
    bool light_triangles = false;
    for (size_t i = 0; i < lights.mesh.size(); ++i) {
        const uint32_t mesh = lights.mesh[i];
        if (mesh == no_index || !(lights.area[i] > 0.0) || !(lights.radiance[i].maxCoeff() > 0.0f)) {
            continue;  // a light that emits nothing is no emitter
        }
        add_mesh_light(meshes, mesh, lights.radiance[i], compiled);
        powers.push_back(pi * lights.area[i] * static_cast<double>(lights.radiance[i].mean()));
        light_triangles = light_triangles || meshes.triangle_count[mesh] > 1;
    }
    if (!compiled.lights.empty()) {
        select_lights(powers, selection, compiled.lights);
    }

    compiled.features = FeatureMask()
                            .with(Feature::triangles, !compiled.surface_triangles.empty())
                            .with(Feature::area_lights, !compiled.emitter_triangles.empty())
                            .with(Feature::lights, !compiled.lights.empty())
                            .with(Feature::many_lights, compiled.lights.size() > 1)
                            .with(Feature::light_triangles, light_triangles)
                            .with(Feature::scattering, scattering)
                            .with(Feature::lambert, scattering);
    return compiled;
}

}  // namespace rtrays
