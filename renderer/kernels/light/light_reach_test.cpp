// SPDX-License-Identifier: MIT
// Tests edge cases of the emission of light paths: curved surfaces, narrow cones, and scenes with
// planes that are lit from infinity.
#include <gtest/gtest.h>

#include "renderer/kernels/traversal/intersect_triangle.h"
#include "renderer/testing/light_paths.h"
#include "renderer/testing/shape_hits.h"

namespace rtrays {
namespace {

// Triangle, disc and sphere are convex, so any hit of the own surface would be a self-intersection.
TEST(Emission, RaysLeaveTheSurfaceTheyStartOn) {
    const CompiledScene scene = compile_light_scene();
    for (const uint32_t kind : {LIGHT_MESH, LIGHT_DISC, LIGHT_SPHERE}) {
        const uint32_t light = light_of(scene, kind);
        const LightRecord &record = scene.lights[light];
        for (uint32_t i = 0; i < 300'000; ++i) {
            const EmissionSample sample = emit_from(scene, light, i);
            ASSERT_GT(dot(sample.direction, sample.point.normal), 0.0f);
            if (kind != LIGHT_MESH) {
                ASSERT_FALSE(test::any_shape(&scene.shapes[record.first_triangle], 1, sample.origin,
                                             sample.direction, INFINITY))
                    << i;
                continue;
            }
            TraversalRay ray;
            const float3 corner = make_float3(9, 9, 9);
            ASSERT_TRUE(make_traversal_ray(sample.origin, sample.direction, -corner, corner, &ray));
            for (uint32_t k = 0; k < record.triangle_count; ++k) {
                const SurfaceTriangle &t =
                    scene.surface_triangles[scene.emitter_triangles[record.first_triangle + k]
                                                .triangle];
                if (dot(sample.point.normal, make_float3(t.normal[0], t.normal[1], t.normal[2])) <
                    0.99f) {
                    continue;  // the ray starts on the other triangle
                }
                LeafTriangle leaf{};
                for (int axis = 0; axis < 3; ++axis) {
                    leaf.coordinate[axis][0] = t.p0[axis];
                    leaf.coordinate[axis][1] = t.p1[axis];
                    leaf.coordinate[axis][2] = t.p2[axis];
                }
                Hit hit{};
                ASSERT_FALSE(intersect_triangle(&leaf, &ray, INFINITY, &hit)) << i;
            }
        }
    }
}

// Even between narrow cones, the fraction of the intensity falls linearly with the angle, and the
// weights of light paths stay within a factor of 2. Versines keep the angle's precision where
// cosines round to 1.
TEST(Emission, SpotsKeepTheirDigitsInNarrowCones) {
    for (const auto &[inner, outer] :
         {std::pair(0.0, 1e-4), std::pair(1e-3, 1.01e-3), std::pair(0.0, pi / 2),
          std::pair(1.5, pi / 2), std::pair(0.3, 0.3001)}) {
        LightRecord light{};
        light.kind = LIGHT_SPOT;
        light.radiance[1] = 1;
        light.axis_x[0] = light.axis_y[1] = light.axis_z[2] = 1;
        light.outer_angle = static_cast<float>(outer);
        light.angle_scale = static_cast<float>(1 / (outer - inner));
        light.versine_outer = static_cast<float>(2 * std::pow(std::sin(outer / 2), 2));
        light.versine_range =
            static_cast<float>(2 * std::sin((outer + inner) / 2) * std::sin((outer - inner) / 2));
        light.emission_selection = light.selection = 1;
        light.selection_end = ~0u;
        SceneView scene{};
        scene.lights = &light;
        scene.lighting.light_count = 1;
        Estimate power;
        double least = 1e30, largest = 0;
        for (uint32_t i = 0; i < 100'000; ++i) {
            const EmissionSample sample = sample_emission(&scene, words(i, 7), words(i, 8));
            const double angle = std::atan2(std::hypot(static_cast<double>(sample.direction.x),
                                                       static_cast<double>(sample.direction.y)),
                                            -static_cast<double>(sample.direction.z));
            const double share = std::clamp((outer - angle) / (outer - inner), 0.0, 1.0);
            const double weight = green(sample.weight);
            // A float direction represents the angle with an error of some u relative to 1 rad, or
            // relative to the angle if it is small.
            ASSERT_NEAR(weight * static_cast<double>(sample.pdf_direction), share,
                        1e-6 * outer / (outer - inner) + 1e-5);
            power.add(weight);
            least = std::min(least, weight);
            largest = std::max(largest, weight);
        }
        const double expected =
            2 * pi * (1 - (std::sin(outer) - std::sin(inner)) / (outer - inner));
        // The closed form suffers from cancellation in narrow cones.
        EXPECT_NEAR(
            power.mean() / expected, 1,
            3.3 * power.error() / expected + 1e-5 + 1e-15 / (outer * outer) / (outer - inner));
        EXPECT_LT(largest / least, 2.01);
    }
}

CompiledScene compile_text(const std::string &nodes) {
    const Scene scene =
        parse_scene_json(R"({"version": 1, "film": {"width": 8, "height": 8}, "nodes": [
        {"name": "camera", "transform": [{"look_at": {"origin": [0, 40, 90], "target": [0, 1, 0], "up": [0, 1, 0]}}],
         "camera": {"type": "pinhole", "fov": 45, "fov_axis": "smaller"}},)" +
                             nodes + "]}",
                         "test", "test");
    return compile_scene(scene, {});
}

const std::string ground = R"({"name": "ground", "geometry": {"type": "plane"},
    "transform": [{"rotate": {"axis": [1, 0, 0], "degrees": -80}}, {"translate": [0, -0.3, 0]}],
    "material": {"type": "lambert", "reflectance": [0.5, 0.5, 0.5]}},)";
const std::string ball =
    R"({"name": "ball", "geometry": {"type": "sphere"}, "transform": [{"translate": [0, 1, 0]}],
    "material": {"type": "lambert", "reflectance": [0.5, 0.5, 0.5]}},)";
const std::string dome = R"({"name": "sky", "light": {"type": "dome", "radiance": [1, 1, 1]}})";

// The bounding sphere for light from infinity contains the bounded surfaces, but neither the camera
// nor planes.
TEST(Emission, FromInfinityReachesAllBoundedSurfacesAndLittleElse) {
    const CompiledScene scene = compile_text(ground + ball + dome);
    EXPECT_NEAR(scene.lighting.scene_centre[1], 1, 1e-6);
    EXPECT_GT(scene.lighting.scene_radius, 1.0f);
    EXPECT_LT(scene.lighting.scene_radius, 1.01f);
    const CompiledScene cube =
        compile_text(R"({"name": "box", "geometry": {"type": "box"}, "material": {"type": "mirror",
        "reflectance": [1, 1, 1]}},)" +
                     dome);
    EXPECT_GT(cube.lighting.scene_radius, std::sqrt(3.0f));
    EXPECT_LT(cube.lighting.scene_radius, std::sqrt(3.0f) * 1.01f);
    // Compares with points of shapes under affine maps in double precision.
    const CompiledScene shapes = compile_text(R"(
        {"name": "cone", "geometry": {"type": "cone", "radius": 2, "height": 0.5}, "transform": [{"translate": [3, 0, 0]}],
         "material": {"type": "mirror", "reflectance": [1, 1, 1]}},
        {"name": "tower", "geometry": {"type": "hyperboloid", "radius": 1, "height": 4, "flare": 2},
         "transform": [{"rotate": {"axis": [1, 1, 0], "degrees": 50}}, {"translate": [-3, 1, 0]}],
         "material": {"type": "mirror", "reflectance": [1, 1, 1]}},
        {"name": "egg", "geometry": {"type": "ellipsoid", "radii": [0.2, 3, 1]},
         "transform": [{"rotate": {"axis": [0, 1, 1], "degrees": 20}}], "material": {"type": "mirror", "reflectance": [1, 1, 1]}},)" +
                                              dome);
    const Eigen::Vector3d centre = Eigen::Vector3f(shapes.lighting.scene_centre).cast<double>();
    const auto farthest = [&](size_t shape, const Eigen::Vector3d &object_point) {
        return (to_double(vector_to_world(&shapes.shapes[shape], to_float3(object_point)) +
                          shape_centre(&shapes.shapes[shape])) -
                centre)
            .norm();
    };
    double largest = 0;
    for (int i = 0; i < 360; ++i) {
        const double c = std::cos(i * pi / 180), s = std::sin(i * pi / 180);
        largest = std::max(largest, farthest(0, {c, s, -1}));
        for (const double z : {-1.0, 1.0}) {
            largest = std::max(largest, farthest(1, {std::sqrt(3) * c, std::sqrt(3) * s, z}));
        }
        for (int j = 0; j < 180; ++j) {
            const double height = std::cos(j * pi / 180), r = std::sqrt(1 - height * height);
            largest = std::max(largest, farthest(2, {r * c, r * s, height}));
        }
    }
    const auto radius = static_cast<double>(shapes.lighting.scene_radius);
    EXPECT_GT(radius, largest);
    EXPECT_LT(radius, 1.5 * largest);
}

// Light from below a plane must never start above it, and surfaces above must receive all their
// light. The origin is on the same side as infinity, and the ray still passes through the disc.
TEST(Emission, FromInfinityStartsBeforePlanes) {
    const CompiledScene scene = compile_text(ground + ball + dome);
    ASSERT_EQ(scene.lighting.plane_end, 1u);
    const ShapeRecord &plane = scene.shapes[0];
    int moved = 0;
    for (uint32_t i = 0; i < 500'000; ++i) {
        const EmissionSample sample = emit(scene, i);
        const float height = vector_to_object(&plane, sample.origin - shape_centre(&plane)).z;
        const float slope = vector_to_object(&plane, sample.direction).z;
        // Grazing rays that cross the plane beyond the reach of shadow rays are exempt.
        ASSERT_TRUE(height * slope < 0.0f || fabsf(slope) < 1e-5f) << height << ' ' << slope;
        const Eigen::Vector3d d = to_double(sample.direction);
        const Eigen::Vector3d way =
            to_double(sample.origin) - Eigen::Vector3f(scene.lighting.scene_centre).cast<double>();
        const double across = (way - way.dot(d) * d).norm();
        ASSERT_LT(across, static_cast<double>(scene.lighting.scene_radius) + 1e-6 * way.norm());
        moved += way.norm() > 1.5 * static_cast<double>(scene.lighting.scene_radius) ? 1 : 0;
    }
    EXPECT_GT(moved, 10'000);
}

// Light paths do not reach a plane outside the shadow of the sphere. The density that other
// strategies use must be 0 there.
TEST(Emission, FromInfinityHasNoDensityBeyondItsDisc) {
    const CompiledScene scene = compile_text(ground + ball + dome);
    const SceneView view = view_of(scene);
    const float3 down = make_float3(0, 1, 0);
    const float inside = infinite_line_pdf(&view, make_float3(0.9f, -0.3f, 0), down);
    EXPECT_NEAR(inside,
                0.25 / pi / (pi * std::pow(static_cast<double>(scene.lighting.scene_radius), 2)),
                1e-6);
    EXPECT_EQ(infinite_line_pdf(&view, make_float3(1.1f, -0.3f, 0), down), 0.0f);
    EXPECT_GT(infinite_line_pdf(&view, make_float3(0, 1e3f, 0), down), 0.0f);
    int reached = 0, beyond = 0;
    for (uint32_t i = 0; i < 1000; ++i) {
        const float3 from = make_float3(2, -0.3f, 0);
        const LightSample sample = sample_lights(&view, SELECT_LIGHT, from, words(i, 9));
        ASSERT_EQ(sample.arrival_pdf_a, disc_pdf_a(scene.lighting, from, sample.wi));
        ++(sample.arrival_pdf_a > 0.0f ? reached : beyond);
    }
    EXPECT_GT(reached, 50);
    EXPECT_GT(beyond, 500);
    // A scene of planes alone has a disc about the camera.
    const CompiledScene bare = compile_text(ground + dome);
    EXPECT_GT(bare.lighting.scene_radius, 0.5f);
    EXPECT_NEAR(bare.lighting.scene_centre[1], 40, 1e-4);
    EXPECT_TRUE(std::isfinite(green(emit(bare, 1).weight)));
}

}  // namespace
}  // namespace rtrays
