// SPDX-License-Identifier: MIT
#include "experiments/harness/models/rays.h"

#include "renderer/base/error.h"
#include "renderer/kernels/geometry/surface_point.h"

namespace rtrays {

namespace {

using test::Random;
using test::uniform;

float3 to_float3(const Eigen::Vector3f &v) {
    return {v.x(), v.y(), v.z()};
}
Eigen::Vector3f to_vector(float3 v) {
    return {v.x, v.y, v.z};
}

Eigen::Vector3f cosine_direction(const Eigen::Vector3f &normal, Random &random) {
    for (;;) {
        const Eigen::Vector3f direction = normal + test::uniform_direction(random);
        if (direction.norm() > 1e-3f) {
            return direction.normalized();
        }
    }
}

RayRecord ray_of(const Eigen::Vector3f &origin, const Eigen::Vector3f &direction, float t_max) {
    return {{origin.x(), origin.y(), origin.z()},
            t_max,
            {direction.x(), direction.y(), direction.z()},
            0};
}

std::vector<RayRecord> primary_rays(const View &view, size_t count, Random &random) {
    const auto width = static_cast<size_t>(std::ceil(std::sqrt(static_cast<double>(count))));
    const Eigen::Vector3f forward = view.direction.normalized();
    const Eigen::Vector3f right = forward.cross(Eigen::Vector3f::UnitY()).normalized();
    const Eigen::Vector3f up = right.cross(forward);
    const float half = std::tan(view.degrees * static_cast<float>(M_PI) / 360);
    std::vector<RayRecord> rays;
    for (size_t pixel = 0; pixel < width * width; ++pixel) {
        const auto across = [&](size_t i) {
            return half *
                   (2 * (static_cast<float>(i) + uniform(random)) / static_cast<float>(width) - 1);
        };
        const float x = across(pixel % width), y = across(pixel / width);
        rays.push_back(ray_of(view.origin, (forward + x * right + y * up).normalized(), INFINITY));
    }
    return rays;
}

/// Hit point of a ray, and the normal on the side from which the ray came.
struct Arrival {
    SurfacePoint point;
    Eigen::Vector3f normal;
};

Arrival arrive(const test::Mesh &mesh, const RayRecord &ray, const test::EmbreeHit &hit) {
    const SurfacePoint point = surface_point(to_float3(mesh.vertex(hit.triangle, 0)),
                                             to_float3(mesh.vertex(hit.triangle, 1)),
                                             to_float3(mesh.vertex(hit.triangle, 2)), hit.u, hit.v);
    const Eigen::Vector3f normal = to_vector(point.normal);
    const bool from_front =
        normal.dot(Eigen::Vector3f(ray.direction[0], ray.direction[1], ray.direction[2])) < 0;
    return {point, from_front ? normal : Eigen::Vector3f(-normal)};
}

}  // namespace

const std::vector<RayKind> &ray_kinds() {
    static const std::vector<RayKind> kinds = {{"primary", Query::nearest, true},
                                               {"shadow", Query::any, true},
                                               {"ambient_occlusion", Query::any, false},
                                               {"diffuse", Query::nearest, false}};
    return kinds;
}

std::vector<RayRecord> make_rays(const std::string &kind, const test::Mesh &mesh, const View &view,
                                 const test::EmbreeScene &embree, size_t count) {
    Random random(1);
    const Eigen::AlignedBox3f box = mesh.box();
    const Eigen::Vector3f lamp =
        box.min() + Eigen::Vector3f(0.5f, 0.9f, 0.5f).cwiseProduct(box.sizes());
    std::vector<RayRecord> rays;
    for (size_t turn = 0; rays.size() < count; ++turn) {
        for (const RayRecord &primary : primary_rays(view, count, random)) {
            if (kind == "primary") {
                rays.push_back(primary);
                continue;
            }
            const test::EmbreeHit found = embree.nearest_hit(primary);
            if (found.t == INFINITY) {
                continue;
            }
            const Arrival hit = arrive(mesh, primary, found);
            if (kind == "shadow") {
                const Eigen::Vector3f at(uniform(random, -0.05f, 0.05f), 0,
                                         uniform(random, -0.05f, 0.05f));
                const Eigen::Vector3f end = lamp + at.cwiseProduct(box.sizes());
                const float3 origin =
                    offset_ray_origin(hit.point, to_float3(end - to_vector(hit.point.position)));
                rays.push_back(ray_of(to_vector(origin), end - to_vector(origin), 1 - 0x1p-20f));
            } else {
                const Eigen::Vector3f direction = cosine_direction(hit.normal, random);
                const float3 origin = offset_ray_origin(hit.point, to_float3(direction));
                rays.push_back(ray_of(to_vector(origin), direction,
                                      kind == "diffuse" ? INFINITY : 0.1f * box.diagonal().norm()));
            }
        }
        if (rays.empty()) {
            throw run_error("the view of " + mesh.name + " sees no triangle");
        }
    }
    return rays;
}

}  // namespace rtrays
