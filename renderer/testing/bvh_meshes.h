// SPDX-License-Identifier: MIT
// Procedural meshes of the BVH and traversal tests.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

namespace rtrays::test {

using Random = std::mt19937_64;

inline float uniform(Random &random, float low = 0.0f, float high = 1.0f) {
    return std::uniform_real_distribution<float>(low, high)(random);
}

inline Eigen::Vector3f uniform_direction(Random &random) {
    std::normal_distribution<float> normal;
    return Eigen::Vector3f(normal(random), normal(random), normal(random)).normalized();
}

struct Mesh {
    std::string name;
    std::vector<Eigen::Vector3f> positions;
    std::vector<std::array<uint32_t, 3>> triangles;

    Eigen::Vector3f vertex(uint32_t triangle, uint32_t corner) const {
        return positions[triangles[triangle][corner]];
    }

    Eigen::AlignedBox3f box() const {
        Eigen::AlignedBox3f bounds;
        for (const Eigen::Vector3f &p : positions) {
            bounds.extend(p);
        }
        return bounds;
    }

    void add_triangle(const Eigen::Vector3f &a, const Eigen::Vector3f &b,
                      const Eigen::Vector3f &c) {
        const auto first = static_cast<uint32_t>(positions.size());
        positions.insert(positions.end(), {a, b, c});
        triangles.push_back({first, first + 1, first + 2});
    }

    void add_box(const Eigen::Vector3f &low, const Eigen::Vector3f &high) {
        const auto first = static_cast<uint32_t>(positions.size());
        for (uint32_t i = 0; i < 8; ++i) {
            positions.emplace_back(i & 1 ? high.x() : low.x(), i & 2 ? high.y() : low.y(),
                                   i & 4 ? high.z() : low.z());
        }
        static const uint32_t quads[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                             {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
        for (const auto &q : quads) {
            triangles.push_back({first + q[0], first + q[1], first + q[2]});
            triangles.push_back({first + q[0], first + q[2], first + q[3]});
        }
    }
};

/// Builds a closed sphere of 2 * segments * (rings - 1) triangles. Each vertex is moved along the
/// radius by up to `jitter` times the radius. Neighbours share vertices, so the sphere stays
/// closed.
inline Mesh sphere(uint32_t rings, uint32_t segments, float radius, float jitter,
                   const Eigen::Vector3f &centre, uint64_t seed = 1) {
    Random random(seed);
    Mesh mesh{"sphere", {}, {}};
    const auto point = [&](double theta, double phi) {
        const double r = static_cast<double>(radius * (1.0f + uniform(random, -jitter, jitter)));
        const Eigen::Vector3d p(std::sin(theta) * std::cos(phi), std::cos(theta),
                                std::sin(theta) * std::sin(phi));
        mesh.positions.push_back((centre.cast<double>() + r * p).cast<float>());
    };
    point(0, 0);
    for (uint32_t ring = 1; ring < rings; ++ring) {
        for (uint32_t segment = 0; segment < segments; ++segment) {
            point(M_PI * ring / rings, 2 * M_PI * segment / segments);
        }
    }
    point(M_PI, 0);
    const auto last = static_cast<uint32_t>(mesh.positions.size() - 1);
    const auto index = [&](uint32_t ring, uint32_t segment) {
        return ring == 0       ? 0
               : ring == rings ? last
                               : 1 + (ring - 1) * segments + segment % segments;
    };
    for (uint32_t ring = 0; ring < rings; ++ring) {
        for (uint32_t segment = 0; segment < segments; ++segment) {
            const uint32_t a = index(ring, segment), b = index(ring, segment + 1);
            const uint32_t c = index(ring + 1, segment), d = index(ring + 1, segment + 1);
            if (ring > 0) {
                mesh.triangles.push_back({a, b, d});
            }
            if (ring + 1 < rings) {
                mesh.triangles.push_back({a, d, c});
            }
        }
    }
    return mesh;
}

/// Builds independent triangles in the unit cube, with sizes over three decades.
inline Mesh soup(uint32_t count, uint64_t seed) {
    Random random(seed);
    Mesh mesh{"soup", {}, {}};
    for (uint32_t i = 0; i < count; ++i) {
        const Eigen::Vector3f centre(uniform(random), uniform(random), uniform(random));
        const float size = 0.5f * std::pow(10.0f, uniform(random, -3.0f, 0.0f)) *
                           std::pow(static_cast<float>(count), -1.0f / 3);
        mesh.add_triangle(centre + size * uniform_direction(random),
                          centre + size * uniform_direction(random),
                          centre + size * uniform_direction(random));
    }
    return mesh;
}

/// Builds a height field of 2 n^2 triangles with bumps of two frequencies and noise.
inline Mesh terrain(uint32_t n, uint64_t seed) {
    Random random(seed);
    Mesh mesh{"terrain", {}, {}};
    for (uint32_t j = 0; j <= n; ++j) {
        for (uint32_t i = 0; i <= n; ++i) {
            const float x = static_cast<float>(i) / static_cast<float>(n) * 10.0f;
            const float z = static_cast<float>(j) / static_cast<float>(n) * 10.0f;
            const float y = 0.5f * std::sin(1.3f * x) * std::cos(1.7f * z) +
                            0.1f * std::sin(9.0f * x + 5.0f * z) +
                            uniform(random, 0.0f, 3.0f / static_cast<float>(n));
            mesh.positions.emplace_back(x, y, z);
        }
    }
    for (uint32_t j = 0; j < n; ++j) {
        for (uint32_t i = 0; i < n; ++i) {
            const uint32_t a = j * (n + 1) + i, b = a + 1, c = a + n + 1, d = c + 1;
            mesh.triangles.push_back({a, c, b});
            mesh.triangles.push_back({b, c, d});
        }
    }
    return mesh;
}

/// Builds a closed room that contains two blocks. Its planes are axis-aligned, and its coordinates
/// have the size of the Cornell box.
inline Mesh room() {
    Mesh mesh{"room", {}, {}};
    mesh.add_box({0.0f, 0.0f, 0.0f}, {552.8f, 548.8f, 559.2f});
    mesh.add_box({130.0f, 0.0f, 65.0f}, {290.0f, 165.0f, 272.0f});
    mesh.add_box({265.0f, 0.0f, 296.0f}, {423.0f, 330.0f, 456.0f});
    return mesh;
}

}  // namespace rtrays::test
