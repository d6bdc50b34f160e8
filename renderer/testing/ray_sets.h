// SPDX-License-Identifier: MIT
// Fuzzed rays at a mesh: random, grazing its triangles, and axis-aligned through its vertices.
#pragma once

#include "renderer/kernels/traversal/ray_record.h"
#include "renderer/testing/bvh_meshes.h"

namespace rtrays::test {

inline RayRecord make_ray(const Eigen::Vector3f &origin, const Eigen::Vector3f &direction) {
    return {{origin.x(), origin.y(), origin.z()},
            INFINITY,
            {direction.x(), direction.y(), direction.z()},
            0};
}

inline Eigen::Vector3f ray_origin(const RayRecord &ray) {
    return {ray.origin[0], ray.origin[1], ray.origin[2]};
}
inline Eigen::Vector3f ray_direction(const RayRecord &ray) {
    return {ray.direction[0], ray.direction[1], ray.direction[2]};
}

/// Returns a point of a random triangle: a vertex, a point on an edge, or an inner point, chosen
/// cyclically by `turn`.
inline Eigen::Vector3f aim(const Mesh &mesh, size_t turn, Random &random) {
    const auto triangle = std::uniform_int_distribution<uint32_t>(
        0, static_cast<uint32_t>(mesh.triangles.size() - 1))(random);
    const Eigen::Vector3f a = mesh.vertex(triangle, 0), b = mesh.vertex(triangle, 1),
                          c = mesh.vertex(triangle, 2);
    const float s = uniform(random), t = uniform(random);
    return turn % 3 == 0   ? a
           : turn % 3 == 1 ? Eigen::Vector3f(a + s * (b - a))
                           : Eigen::Vector3f(a + s * (b - a) + (1 - s) * t * (c - a));
}

/// Returns `count` rays in equal parts of three types:
///   * random origin in twice the mesh's box, and random direction;
///   * grazing: from outside towards a point of a triangle, 1e-1 to 1e-5 from its plane;
///   * axis-aligned through a vertex or through the middle of an edge.
inline std::vector<RayRecord> fuzzed_rays(const Mesh &mesh, size_t count, uint64_t seed) {
    Random random(seed);
    const Eigen::AlignedBox3f box = mesh.box();
    const float size = box.diagonal().norm();
    std::vector<RayRecord> rays;
    for (size_t i = 0; i < count; ++i) {
        const auto triangle = std::uniform_int_distribution<uint32_t>(
            0, static_cast<uint32_t>(mesh.triangles.size() - 1))(random);
        const Eigen::Vector3f a = mesh.vertex(triangle, 0), b = mesh.vertex(triangle, 1),
                              c = mesh.vertex(triangle, 2);
        if (i % 3 == 0) {
            const Eigen::Vector3f spread(uniform(random, -1, 1), uniform(random, -1, 1),
                                         uniform(random, -1, 1));
            rays.push_back(make_ray(box.center() + spread.cwiseProduct(box.sizes()),
                                    uniform_direction(random)));
        } else if (i % 3 == 1) {
            const float s = uniform(random), t = uniform(random) * (1 - s);
            const Eigen::Vector3f target = a + s * (b - a) + t * (c - a);
            const Eigen::Vector3f normal = (b - a).cross(c - a).stableNormalized();
            const Eigen::Vector3f along =
                (uniform_direction(random).cross(normal)).stableNormalized();
            const Eigen::Vector3f direction =
                (along + std::pow(10.0f, uniform(random, -5, -1)) * normal).stableNormalized();
            rays.push_back(make_ray(target - size * direction, direction));
        } else {
            const Eigen::Vector3f target = i % 2 == 0 ? a : Eigen::Vector3f(0.5f * (a + b));
            Eigen::Vector3f direction = Eigen::Vector3f::Zero();
            const auto axis = static_cast<int>(i / 3 % 3);
            direction[axis] = i / 9 % 2 == 0 ? 1.0f : -1.0f;
            Eigen::Vector3f origin = target;
            origin[axis] -= direction[axis] * size;
            rays.push_back(make_ray(origin, direction));
        }
    }
    return rays;
}

}  // namespace rtrays::test
