// SPDX-License-Identifier: MIT
// Geometry: rays that leave a surface must neither hit it again nor pass through a closed wall.
#include "reference/geometry.h"

#include <gtest/gtest.h>

#include <limits>
#include <map>

#include "reference/sampling.h"
#include "reference/tests/test_scenes.h"
#include "renderer/base/error.h"

namespace rtrays::reference {
namespace {

struct Escapes {
    int self_hits = 0;
    int misses = 0;
    int behind = 0;  ///< hits behind the origin of the ray
};

/// Walks `steps` diffuse bounces (every eighth one grazing) inside a closed mesh.
Escapes walk(const Geometry &geometry, const Vec3 &start, int steps, uint64_t seed) {
    Escapes escapes;
    Rng rng(seed, 0, 0);
    Ray ray{start, Vec3(0.3, -0.5, 0.8).normalized()};
    uint32_t last = no_index;
    for (int i = 0; i < steps; ++i) {
        SurfacePoint hit;
        if (!geometry.intersect(ray, Coherence::incoherent, hit)) {
            ++escapes.misses;
            ray.origin = start;
            last = no_index;
            continue;
        }
        escapes.self_hits += hit.primitive == last;
        escapes.behind += (hit.position - ray.origin).dot(ray.direction) <= 0.0;
        last = hit.primitive;
        const Vec3 normal = geometry.normal(hit);
        const Vec3 inward = normal.dot(ray.direction) < 0.0 ? normal : Vec3(-normal);
        Vec3 local = sample_cosine_hemisphere(rng);
        if (i % 8 == 0) {
            local.z() *= 1e-7 * rng.uniform();
            local.normalize();
        }
        ray.direction = Frame(inward).to_world(local);
        ray.origin = geometry.spawn_point(hit, ray.direction);
    }
    return escapes;
}

/// Adds a closed sphere of 20 * 4^level triangles, facing outwards.
void add_sphere(TestScene &scene, const Vec3 &centre, double radius, int level) {
    const double g = 0.5 * (1.0 + std::sqrt(5.0));
    std::vector<Vec3> v = {{-1, g, 0}, {1, g, 0}, {-1, -g, 0}, {1, -g, 0},
                           {0, -1, g}, {0, 1, g}, {0, -1, -g}, {0, 1, -g},
                           {g, 0, -1}, {g, 0, 1}, {-g, 0, -1}, {-g, 0, 1}};
    std::vector<Triangle> faces = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                                   {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                                   {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                                   {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
    for (int l = 0; l < level; ++l) {
        std::map<std::pair<uint32_t, uint32_t>, uint32_t> middles;
        const auto middle = [&](uint32_t a, uint32_t b) {
            const auto [place, added] =
                middles.try_emplace(std::minmax(a, b), static_cast<uint32_t>(v.size()));
            if (added) {
                v.push_back((v[a].normalized() + v[b].normalized()).normalized());
            }
            return place->second;
        };
        std::vector<Triangle> finer;
        for (const Triangle &f : faces) {
            const uint32_t a = middle(f[0], f[1]), b = middle(f[1], f[2]), c = middle(f[2], f[0]);
            finer.insert(finer.end(), {{f[0], a, c}, {f[1], b, a}, {f[2], c, b}, {a, b, c}});
        }
        faces = std::move(finer);
    }
    for (Vec3 &p : v) {
        p = centre + radius * p.normalized();
    }
    scene.add_mesh(v, faces, scene.add_material(Rgb::Constant(0.5f)));
}

struct Placement {
    const char *name;
    double scale;
    Vec3 offset;  ///< in units of the scale
};

class ClosedMesh : public testing::TestWithParam<Placement> {};

TEST_P(ClosedMesh, box_neither_leaks_nor_hits_itself) {
    const Placement &p = GetParam();
    const Vec3 centre = p.scale * p.offset;
    const TestScene scene = furnace_box(0.5f, Rgb::Zero(), centre, p.scale);
    const Escapes escapes = walk(Geometry(scene.meshes, scene.shapes), centre, 1000000, 51);
    EXPECT_EQ(escapes.self_hits, 0);
    EXPECT_EQ(escapes.misses, 0);
    EXPECT_EQ(escapes.behind, 0);
}

TEST_P(ClosedMesh, sphere_neither_leaks_nor_hits_itself) {
    const Placement &p = GetParam();
    TestScene scene;
    add_sphere(scene, p.scale * p.offset, p.scale, 4);
    const Escapes escapes =
        walk(Geometry(scene.meshes, scene.shapes), p.scale * p.offset, 1000000, 52);
    EXPECT_EQ(escapes.self_hits, 0);
    EXPECT_EQ(escapes.misses, 0);
}

INSTANTIATE_TEST_SUITE_P(placements, ClosedMesh,
                         testing::Values(Placement{"origin", 1.0, Vec3::Zero()},
                                         Placement{"tiny", 1e-6, Vec3::Zero()},
                                         Placement{"huge", 1e6, Vec3::Zero()},
                                         Placement{"moved", 1.0, Vec3(148.376, 12.34, -223.423)}),
                         [](const auto &param_info) { return std::string(param_info.param.name); });

TEST(Geometry, hit_points_are_exact_in_double) {
    // A plane far below a steep ray. The float hit is off by 1e-6 of the distance, the double hit
    // is not.
    TestScene scene;
    scene.add_quad(
        {Vec3(-4096, 0, -4096), Vec3(-4096, 0, 4096), Vec3(4096, 0, 4096), Vec3(4096, 0, -4096)},
        scene.add_material(Rgb::Constant(0.5f)));
    const Geometry geometry(scene.meshes, scene.shapes);
    Rng rng(53, 0, 0);
    for (int i = 0; i < 10000; ++i) {
        const Vec3 origin(100.0 * rng.uniform(), 1000.0, 100.0 * rng.uniform());
        const Vec3 direction = Vec3(rng.uniform(), -1.0, rng.uniform()).normalized();
        SurfacePoint hit;
        ASSERT_TRUE(geometry.intersect({origin, direction}, Coherence::incoherent, hit));
        const Vec3 expected = origin - direction * (origin.y() / direction.y());
        ASSERT_LT((hit.position - expected).norm(), 1e-9);
    }
}

TEST(Geometry, sees_occluders_between_points_and_nothing_beyond) {
    TestScene scene;
    scene.add_quad({Vec3(-1, 0, -1), Vec3(-1, 0, 1), Vec3(1, 0, 1), Vec3(1, 0, -1)},
                   scene.add_material(Rgb::Constant(0.5f)));
    const Geometry geometry(scene.meshes, scene.shapes);
    EXPECT_TRUE(geometry.occluded({0, 1, 0}, {0, -1, 0}));
    EXPECT_FALSE(geometry.occluded({0, 1, 0}, {0, 0.001, 0}));
    EXPECT_FALSE(geometry.occluded({0, 1, 0}, {2.5, -0.5, 0}));
}

TEST(Geometry, leaves_out_and_counts_triangles_without_area) {
    TestScene scene;
    scene.add_mesh({Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(2, 0, 0), Vec3(0, 1, 0)},
                   {{0, 1, 2}, {0, 1, 3}, {1, 1, 3}}, scene.add_material(Rgb::Constant(0.5f)));
    const Geometry geometry(scene.meshes, scene.shapes);
    EXPECT_EQ(geometry.stats().triangles, 1u);
    EXPECT_EQ(geometry.stats().degenerate_triangles, 2u);
    SurfacePoint hit;
    ASSERT_TRUE(
        geometry.intersect({Vec3(0.2, 0.2, 1), -Vec3::UnitZ()}, Coherence::incoherent, hit));
    EXPECT_EQ(geometry.normal(hit), Vec3::UnitZ());
}

TEST(Geometry, refuses_vertices_that_are_not_finite_and_accepts_an_empty_scene) {
    TestScene scene;
    const Geometry empty(scene.meshes, scene.shapes);
    SurfacePoint hit;
    EXPECT_FALSE(empty.intersect({Vec3::Zero(), Vec3::UnitX()}, Coherence::coherent, hit));
    scene.add_quad({Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0)},
                   scene.add_material(Rgb::Constant(0.5f)));
    scene.meshes.position[2].y() = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THROW(Geometry(scene.meshes, scene.shapes), Error);
}

}  // namespace
}  // namespace rtrays::reference
