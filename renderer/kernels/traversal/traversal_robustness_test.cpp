// SPDX-License-Identifier: MIT
// Tests watertightness, self-intersections and leaks of traversal, with the device functions
// compiled for the host.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "renderer/kernels/geometry/surface_point.h"
#include "renderer/testing/double_intersector.h"
#include "renderer/testing/ray_sets.h"
#include "renderer/testing/tree_test.h"

namespace rtrays {
namespace {

using namespace test;

class Watertight : public TreeTest {};
EACH_TREE(Watertight);
class Secondary : public TreeTest {};
EACH_TREE(Secondary);
class BadRays : public TreeTest {};
EACH_TREE(BadRays);

constexpr int million = 1000000;

/// Counts rays from inside a closed mesh that hit nothing.
int count_misses(const Mesh &mesh, TreeKind kind, const Eigen::Vector3f &centre, float spread,
                 int rays) {
    const HostBvh bvh = build_bvh(mesh, kind);
    Random random(11);
    int misses = 0;
    for (int i = 0; i < rays; ++i) {
        const Eigen::Vector3f origin =
            centre + spread * uniform(random) * uniform_direction(random);
        const Eigen::Vector3f direction =
            i % 2 == 0 ? uniform_direction(random)
                       : Eigen::Vector3f(aim(mesh, static_cast<size_t>(i / 2), random) - origin);
        misses += bvh.nearest(origin, direction).triangle == NO_HIT ? 1 : 0;
    }
    return misses;
}

TEST_P(Watertight, ClosedSphereFromInside) {
    EXPECT_EQ(count_misses(sphere(64, 128, 1.0f, 0.05f, {0, 0, 0}), GetParam(), {0, 0, 0}, 0.5f,
                           million / 2),
              0);
}

TEST_P(Watertight, ClosedRoomOnAxesAndEdges) {
    EXPECT_EQ(count_misses(room(), GetParam(), {450.0f, 400.0f, 200.0f}, 60.0f, million / 2), 0);
    const HostBvh bvh = build_bvh(room(), GetParam());
    Random random(5);
    // Rays along the planes of the blocks, with the coordinates of their edges.
    for (int i = 0; i < 10000; ++i) {
        const Eigen::Vector3f origin(i % 2 ? 130.0f : 423.0f, uniform(random, 331.0f, 540.0f),
                                     i % 4 < 2 ? 65.0f : 456.0f);
        Eigen::Vector3f direction = Eigen::Vector3f::Zero();
        direction[i % 3] = i % 5 < 3 ? 1.0f : -1.0f;
        EXPECT_NE(bvh.nearest(origin, direction).triangle, NO_HIT);
    }
}

TEST_P(Watertight, FarFromTheCoordinateOrigin) {
    const Eigen::Vector3f offset(148376.0f, 1234.0f, -223423.0f);  // as in Embree's tests
    EXPECT_LE(
        count_misses(sphere(64, 128, 10.0f, 0.05f, offset), GetParam(), offset, 5.0f, million), 20);
}

/// An open grid must be watertight inside its outline, too.
TEST_P(Watertight, GridFromAbove) {
    const Mesh mesh = terrain(60, 3);
    const HostBvh bvh = build_bvh(mesh, GetParam());
    Random random(7);
    int misses = 0;
    for (int i = 0; i < 200000; ++i) {
        const Eigen::Vector3f origin(uniform(random, 2, 8), 5, uniform(random, 2, 8));
        Eigen::Vector3f target = aim(mesh, static_cast<size_t>(i), random)
                                     .cwiseMax(Eigen::Vector3f(2, -10, 2))
                                     .cwiseMin(Eigen::Vector3f(8, 10, 8));
        misses += bvh.nearest(origin, target - origin).triangle == NO_HIT ? 1 : 0;
    }
    EXPECT_EQ(misses, 0);
}

TEST(EdgeFunction, HasTheExactSign) {
    Random random(2);
    for (int i = 0; i < million; ++i) {
        float v[4];
        for (float &x : v) {  // few bits give many exact ties and near ties
            x = static_cast<float>(std::uniform_int_distribution<int>(-4100, 4100)(random)) *
                (i % 2 ? 1.0f : 4097.0f);
        }
        const double exact = static_cast<double>(v[0]) * static_cast<double>(v[3]) -
                             static_cast<double>(v[1]) * static_cast<double>(v[2]);
        const float forwards = edge_function(v[0], v[1], v[2], v[3]);
        const float backwards = edge_function(v[2], v[3], v[0], v[1]);
        ASSERT_EQ((forwards > 0) - (forwards < 0), (exact > 0) - (exact < 0));
        ASSERT_EQ((backwards > 0) - (backwards < 0), (exact < 0) - (exact > 0))
            << "neighbours agree";
        ASSERT_NEAR(forwards, exact, 2e-7 * std::abs(exact));
    }
}

LeafTriangle leaf_of(const Eigen::Vector3f &a, const Eigen::Vector3f &b, const Eigen::Vector3f &c) {
    LeafTriangle leaf{};
    for (int axis = 0; axis < 3; ++axis) {
        leaf.coordinate[axis][0] = a[axis];
        leaf.coordinate[axis][1] = b[axis];
        leaf.coordinate[axis][2] = c[axis];
    }
    return leaf;
}

/// Returns the weights of vertices 1 and 2 of a point on a triangle, uniform by area.
std::pair<float, float> uniform_weights(Random &random) {
    const float u = uniform(random), v = uniform(random);
    return u + v > 1 ? std::pair(1 - u, 1 - v) : std::pair(u, v);
}

/// Rays leave random points of 1000 triangles: scales from 1e-6 to 1e6, far from the origin, and
/// slivers.
TEST(SelfHit, SingleTriangles) {
    Random random(4);
    int self_hits = 0, rays = 0;
    for (int n = 0; n < 1000; ++n) {
        const float scale = std::pow(10.0f, uniform(random, -6, 6));
        const float offset = n % 3 == 0 ? 100.0f : 0.0f;
        Mesh mesh{"", {}, {}};
        const Eigen::Vector3f centre = offset * scale * uniform_direction(random);
        const Eigen::Vector3f a = centre + scale * uniform_direction(random);
        const Eigen::Vector3f b = centre + scale * uniform_direction(random);
        Eigen::Vector3f c = centre + scale * uniform_direction(random);
        if (n % 4 == 1) {  // slivers: aspect ratios up to 1e4
            c = a + uniform(random) * (b - a) +
                scale * std::pow(10.0f, uniform(random, -4, 0)) * uniform_direction(random);
        }
        if (n % 8 == 2) {  // axis-aligned
            mesh.add_triangle({a.x(), centre.y(), a.z()}, {b.x(), centre.y(), b.z()},
                              {c.x(), centre.y(), c.z()});
        } else {
            mesh.add_triangle(a, b, c);
        }
        const LeafTriangle leaf = leaf_of(mesh.positions[0], mesh.positions[1], mesh.positions[2]);
        const float3 lower = to_float3(mesh.box().min()), upper = to_float3(mesh.box().max());
        for (int i = 0; i < 1000; ++i, ++rays) {
            const auto [u, v] = uniform_weights(random);
            const SurfacePoint point =
                surface_point(to_float3(mesh.positions[0]), to_float3(mesh.positions[1]),
                              to_float3(mesh.positions[2]), u, v);
            Eigen::Vector3f d = uniform_direction(random);
            if (i % 4 == 0) {  // grazing
                const Eigen::Vector3f normal(point.normal.x, point.normal.y, point.normal.z);
                d = (d - normal * normal.dot(d) * (1 - std::pow(10.0f, uniform(random, -7, -1))))
                        .normalized();
            }
            const float3 direction = to_float3(d);
            TraversalRay ray;
            Hit hit;
            ASSERT_TRUE(make_traversal_ray(offset_ray_origin(point, direction), direction, lower,
                                           upper, &ray));
            self_hits += intersect_triangle(&leaf, &ray, INFINITY, &hit) ? 1 : 0;
        }
    }
    EXPECT_EQ(rays, million);
    EXPECT_EQ(self_hits, 0);
}

/// Start of a secondary ray: a random point of the mesh, uniform by area or within 1e-3 of an edge.
struct Departure {
    uint32_t triangle;
    float u, v;  ///< weights of vertices 1 and 2
    SurfacePoint point;
};

Departure depart(const Mesh &mesh, const std::vector<double> &sums, bool near_edge,
                 Random &random) {
    const double pick = static_cast<double>(uniform(random)) * sums.back();
    const auto triangle = static_cast<uint32_t>(std::min<size_t>(
        static_cast<size_t>(std::upper_bound(sums.begin(), sums.end(), pick) - sums.begin()),
        sums.size() - 1));
    const auto [weight, v] = uniform_weights(random);
    const float u = near_edge ? 1e-3f * weight : weight;
    return {triangle, u, v,
            surface_point(to_float3(mesh.vertex(triangle, 0)), to_float3(mesh.vertex(triangle, 1)),
                          to_float3(mesh.vertex(triangle, 2)), u, v)};
}

std::vector<double> area_sums(const Mesh &mesh) {
    std::vector<double> sums;
    for (uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        const Eigen::Vector3d a = mesh.vertex(i, 0).cast<double>(),
                              b = mesh.vertex(i, 1).cast<double>(),
                              c = mesh.vertex(i, 2).cast<double>();
        sums.push_back((sums.empty() ? 0 : sums.back()) + (b - a).cross(c - a).norm());
    }
    return sums;
}

/// A ray that hit nothing.
struct Escape {
    Departure start;
    float3 origin;  ///< origin of the ray, offset from the surface
};

struct SecondaryRays {
    int self_hits = 0;
    std::vector<Escape> escapes;
};

/// Traces diffuse secondary rays on one side of the surface: `side` is +1 along the normals, -1
/// against them.
SecondaryRays trace_secondary(const Mesh &mesh, TreeKind kind, float side, int rays,
                              bool near_edges) {
    const HostBvh bvh = build_bvh(mesh, kind);
    const std::vector<double> sums = area_sums(mesh);
    Random random(21);
    SecondaryRays result;
    for (int i = 0; i < rays; ++i) {
        const Departure start = depart(mesh, sums, near_edges, random);
        const Eigen::Vector3f normal(start.point.normal.x, start.point.normal.y,
                                     start.point.normal.z);
        const Eigen::Vector3f direction =
            (side * normal + 0.9999f * uniform_direction(random)).normalized();
        const float3 origin = offset_ray_origin(start.point, to_float3(direction));
        const Hit hit = bvh.nearest({origin.x, origin.y, origin.z}, direction);
        result.self_hits += hit.triangle == start.triangle ? 1 : 0;
        if (hit.triangle == NO_HIT) {
            result.escapes.push_back({start, origin});
        }
    }
    return result;
}

TEST_P(Secondary, NoSelfHitAndNoLeakInAClosedRoom) {
    Mesh box{"box", {}, {}};
    box.add_box({0, 0, 0}, {552.8f, 548.8f, 559.2f});
    for (const bool near_edges : {false, true}) {
        const SecondaryRays inside =
            trace_secondary(box, GetParam(), -1.0f, million / 2, near_edges);
        EXPECT_EQ(inside.self_hits, 0);
        EXPECT_EQ(inside.escapes.size(), 0u);
        const SecondaryRays outside =
            trace_secondary(box, GetParam(), 1.0f, million / 4, near_edges);
        EXPECT_EQ(outside.escapes.size(), size_t{million / 4})
            << "a convex body must not shadow itself";
    }
}

TEST_P(Secondary, NoSelfHitAndNoLeakInAClosedSphere) {
    for (const float radius : {1e-6f, 1.0f, 1e6f}) {
        const SecondaryRays rays = trace_secondary(sphere(40, 80, radius, 0.02f, {0, 0, 0}),
                                                   GetParam(), -1.0f, million / 3, false);
        EXPECT_EQ(rays.self_hits, 0) << radius;
        EXPECT_EQ(rays.escapes.size(), 0u) << radius;
    }
}

/// Returns the offset from the exact point of the triangle to the origin of the ray.
Eigen::Vector3d step_off_the_surface(const Mesh &mesh, const Escape &escape) {
    const Departure &start = escape.start;
    const double u = static_cast<double>(start.u), v = static_cast<double>(start.v);
    return Eigen::Vector3d(escape.origin.x, escape.origin.y, escape.origin.z) -
           (1 - u - v) * mesh.vertex(start.triangle, 0).cast<double>() -
           u * mesh.vertex(start.triangle, 1).cast<double>() -
           v * mesh.vertex(start.triangle, 2).cast<double>();
}

/// Returns whether that offset crosses another triangle, computed in double precision.
bool leads_through_a_fold(const Mesh &mesh, const Escape &escape) {
    const Eigen::Vector3d step = step_off_the_surface(mesh, escape);
    const Eigen::Vector3d point =
        Eigen::Vector3d(escape.origin.x, escape.origin.y, escape.origin.z) - step;
    for (uint32_t triangle = 0; triangle < mesh.triangles.size(); ++triangle) {
        const DoubleHit hit = intersect_double(mesh, triangle, point, step);
        if (triangle != escape.start.triangle && hit.crosses && hit.t >= 0 && hit.t <= 1) {
            return true;
        }
    }
    return false;
}

/// Rays start within 1e-3 of the edges of a crumpled sphere, whose faces meet at acute angles near
/// its poles. Zero leaks, as in the tests above, are impossible here. An origin must be offset from
/// its face by h, the error of its position and of the next triangle test, or the ray hits the face
/// again. An offset origin nearer than h / tan(angle) to the edge is already beyond the other face
/// of the fold, where nothing stops the ray.
///
/// Every leak must be such a start, and h must stay below 1e-6 of the coordinates. With coordinates
/// of 1 and triangles of 0.1, h is gamma(7) + 16 u 0.1 = 5.2e-7 along each axis (surface_point.h),
/// and sqrt(3) times that in total.
TEST_P(Secondary, OnlyFoldsThinnerThanTheOffsetLeak) {
    const Mesh mesh = sphere(40, 80, 1.0f, 0.02f, {0, 0, 0});
    const SecondaryRays rays = trace_secondary(mesh, GetParam(), -1.0f, million, true);
    EXPECT_EQ(rays.self_hits, 0);
    RecordProperty("leaks_of_1e6", static_cast<int>(rays.escapes.size()));
    for (const Escape &escape : rays.escapes) {
        EXPECT_LT(step_off_the_surface(mesh, escape).norm(), 1e-6);
        EXPECT_TRUE(leads_through_a_fold(mesh, escape));
    }

    // The test must not excuse a start in the middle of a face.
    const uint32_t triangle = 1000;
    const SurfacePoint middle =
        surface_point(to_float3(mesh.vertex(triangle, 0)), to_float3(mesh.vertex(triangle, 1)),
                      to_float3(mesh.vertex(triangle, 2)), 0.25f, 0.25f);
    EXPECT_FALSE(leads_through_a_fold(
        mesh, {{triangle, 0.25f, 0.25f, middle}, offset_ray_origin(middle, -middle.normal)}));
}

TEST_P(BadRays, HitNothing) {
    const HostBvh bvh = build_bvh(room(), GetParam());
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float infinity = std::numeric_limits<float>::infinity();
    const Eigen::Vector3f inside(450, 400, 200), down(0, -1, 0);
    EXPECT_NE(bvh.nearest(inside, down).triangle, NO_HIT);
    for (const float bad : {nan, infinity, -infinity}) {
        for (int axis = 0; axis < 3; ++axis) {
            Eigen::Vector3f origin = inside, direction = down;
            origin[axis] = bad;
            direction[axis] = bad;
            EXPECT_EQ(bvh.nearest(origin, down).triangle, NO_HIT);
            EXPECT_EQ(bvh.nearest(inside, direction).triangle, NO_HIT);
            EXPECT_FALSE(bvh.any(inside, direction, infinity));
        }
    }
    EXPECT_EQ(bvh.nearest(inside, {0, 0, 0}).triangle, NO_HIT);
    EXPECT_EQ(bvh.nearest(inside, down, nan).triangle, NO_HIT);
    EXPECT_EQ(bvh.nearest(inside, down, 0).triangle, NO_HIT);
    EXPECT_NE(bvh.nearest({1e20f, 1, 1}, {-1, 0, 0}).t, 0.0f) << "ends";
}

TEST(BadTriangles, AreNeverHit) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float infinity = std::numeric_limits<float>::infinity();
    Random random(9);
    for (int i = 0; i < 100000; ++i) {
        const Eigen::Vector3f v[3] = {uniform_direction(random), uniform_direction(random),
                                      uniform_direction(random)};
        // One coordinate is not finite (even i), or two vertices coincide (odd i).
        LeafTriangle leaf = i % 2 == 0 ? leaf_of(v[0], v[1], v[2]) : leaf_of(v[0], v[0], v[1]);
        if (i % 2 == 0) {
            leaf.coordinate[i / 2 % 3][i / 6 % 3] = i % 4 == 0 ? nan : infinity;
        }
        const Eigen::Vector3f target = (v[0] + v[1] + v[2]) / 3,
                              origin = 3 * uniform_direction(random);
        TraversalRay ray;
        Hit hit;
        ASSERT_TRUE(make_traversal_ray(to_float3(origin), to_float3(target - origin), {-1, -1, -1},
                                       {1, 1, 1}, &ray));
        EXPECT_FALSE(intersect_triangle(&leaf, &ray, infinity, &hit)) << i;
    }
}

}  // namespace
}  // namespace rtrays
