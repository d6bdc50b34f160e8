// SPDX-License-Identifier: MIT
// Tests the emission of light paths, with the device code compiled for the host: origins and
// directions against their densities, power against closed forms, and agreement with the lights as
// camera paths see them.
//
// Eleven chi-square tests share a family-wise level of 0.01 (Cells).
#include <gtest/gtest.h>

#include "renderer/testing/emission_cells.h"
#include "renderer/testing/light_paths.h"

namespace rtrays {
namespace {

constexpr uint32_t sample_count = 1'500'000;

/// Returns the cell of a direction, out of eight cells of equal probability for the density cos /
/// pi about a normal. For this density, cos^2 and azimuth are uniform.
size_t cosine_cell(const EmissionSample &sample) {
    const Eigen::Vector3d n = to_double(sample.point.normal), d = to_double(sample.direction);
    return part(n.dot(d) * n.dot(d), 4) * 2 + part(turn(n, d), 2);
}

/// Returns the cell of the point where a ray from infinity crosses the disc, out of eight cells of
/// equal area.
size_t disc_cell(const CompiledScene &scene, const EmissionSample &sample) {
    const Eigen::Vector3d d = to_double(sample.direction);
    const Eigen::Vector3d way =
        to_double(sample.origin) - Eigen::Vector3f(scene.lighting.scene_centre).cast<double>();
    const Eigen::Vector3d across = way - way.dot(d) * d;
    const double radius = static_cast<double>(scene.lighting.scene_radius);
    EXPECT_LT(across.norm(), radius * (1 + 1e-5));
    EXPECT_LE(way.dot(d), -radius * (1 - 1e-5));
    return part(across.squaredNorm() / (radius * radius), 4) * 2 + part(turn(d, across), 2);
}

TEST(Emission, StartsAtLightsByTheirSelection) {
    for (const LightSelection selection : {LightSelection::mixed, LightSelection::independent}) {
        const CompiledScene scene = compile_light_scene(LightArrays::Kind::environment, selection);
        std::vector<double> expected;
        for (const LightRecord &light : scene.lights) {
            expected.push_back(static_cast<double>(light.emission_selection));
            EXPECT_EQ(light.selection,
                      selection == LightSelection::mixed ? light.emission_selection : 1.0f);
        }
        Cells cells(expected);
        for (uint32_t i = 0; i < sample_count; ++i) {
            cells.add(emit(scene, i).light);
        }
        cells.expect_fit("selection");
    }
}

// Twelve cells of position on the two triangles, with probabilities proportional to area, and eight
// cells of direction. Position and direction are independent.
TEST(Emission, LeavesMeshesUniformlyByAreaAndByTheCosine) {
    const CompiledScene scene = compile_light_scene();
    const uint32_t light = light_of(scene, LIGHT_MESH);
    const std::array<double, 2> area = mesh_areas();
    std::vector<double> expected;
    for (size_t i = 0; i < 2 * 4 * 8; ++i) {
        expected.push_back(area[i / 32] / (area[0] + area[1]) / 32);
    }
    Cells cells(expected);
    for (uint32_t i = 0; i < sample_count; ++i) {
        const EmissionSample sample = emit_from(scene, light, i);
        const EmitterTriangle &first = scene.emitter_triangles[scene.lights[light].first_triangle];
        const SurfaceTriangle &t0 = scene.surface_triangles[first.triangle];
        const size_t triangle =
            dot(sample.point.normal, make_float3(t0.normal[0], t0.normal[1], t0.normal[2])) > 0.99f
                ? 0
                : 1;
        const SurfaceTriangle &t = scene.surface_triangles[first.triangle + triangle];
        // Barycentric coordinates, and the part of the medial subdivision.
        Eigen::Matrix3d corners;
        corners.col(0) = Eigen::Vector3f(t.p0).cast<double>();
        corners.col(1) = Eigen::Vector3f(t.p1).cast<double>();
        corners.col(2) = Eigen::Vector3f(t.p2).cast<double>();
        const Eigen::Vector3d b = corners.inverse() * to_double(sample.point.position);
        ASSERT_NEAR(b.sum(), 1, 1e-5);
        const size_t place = b[0] > 0.5 ? 0 : b[1] > 0.5 ? 1 : b[2] > 0.5 ? 2 : 3;
        cells.add((triangle * 4 + place) * 8 + cosine_cell(sample));
    }
    cells.expect_fit("mesh");
}

TEST(Emission, LeavesDiscsUniformlyByAreaAndByTheCosine) {
    const CompiledScene scene = compile_light_scene();
    const uint32_t light = light_of(scene, LIGHT_DISC);
    const ShapeRecord &shape = scene.shapes[scene.lights[light].first_triangle];
    Cells cells(8 * 8);
    for (uint32_t i = 0; i < sample_count; ++i) {
        const EmissionSample sample = emit_from(scene, light, i);
        const Eigen::Vector3d p =
            to_double(vector_to_object(&shape, sample.point.position - shape_centre(&shape)));
        ASSERT_NEAR(p.z(), 0, 1e-5);
        cells.add(
            (part(p.head<2>().squaredNorm(), 4) * 2 + part(turn(Eigen::Vector3d::UnitZ(), p), 2)) *
                8 +
            cosine_cell(sample));
    }
    cells.expect_fit("disc");
}

TEST(Emission, LeavesSpheresUniformlyByAreaAndByTheCosine) {
    // The emission is independent of the sampling from a point.
    for (const SphereSampling sampling : {SphereSampling::cone, SphereSampling::area}) {
        const bool by_area = sampling == SphereSampling::area;
        const CompiledScene scene =
            compile_light_scene(LightArrays::Kind::dome, LightSelection::mixed, sampling);
        const uint32_t light = light_of(scene, by_area ? LIGHT_SPHERE_BY_AREA : LIGHT_SPHERE);
        const ShapeRecord &shape = scene.shapes[scene.lights[light].first_triangle];
        Cells cells(8 * 8);
        for (uint32_t i = 0; i < sample_count; ++i) {
            const EmissionSample sample = emit_from(scene, light, i);
            const Eigen::Vector3d p =
                to_double(sample.point.position - shape_centre(&shape)).normalized();
            ASSERT_GT(p.dot(to_double(sample.point.normal)), 1 - 1e-5);
            cells.add(
                (part(0.5 + 0.5 * p.z(), 4) * 2 + part(turn(Eigen::Vector3d::UnitZ(), p), 2)) * 8 +
                cosine_cell(sample));
            if (by_area) {
                ASSERT_EQ(sample.pdf_origin, scene.lights[light].emission_selection *
                                                 (1.0f / scene.lights[light].area));
            }
        }
        cells.expect_fit("sphere");
    }
}

TEST(Emission, LeavesPointsUniformly) {
    const CompiledScene scene = compile_light_scene();
    const uint32_t light = light_of(scene, LIGHT_POINT);
    Cells cells(12 * 16);
    for (uint32_t i = 0; i < sample_count; ++i) {
        const EmissionSample sample = emit_from(scene, light, i);
        const Eigen::Vector3d d = to_double(sample.direction);
        ASSERT_EQ(sample.pdf_direction, 0.25f * INV_PI);
        ASSERT_EQ(length(sample.origin - to_float3({1.5, 2.5, 1})), 0.0f);
        cells.add(part(0.5 + 0.5 * d.z(), 12) * 16 + part(turn(Eigen::Vector3d::UnitZ(), d), 16));
    }
    cells.expect_fit("point");
}

// The rings have equal width in the versine. The density `spot_pdf_w` is integrated over each ring
// with many midpoints.
TEST(Emission, LeavesSpotsByTheirDensity) {
    const CompiledScene scene = compile_light_scene();
    const uint32_t light = light_of(scene, LIGHT_SPOT);
    const LightRecord &record = scene.lights[light];
    const Eigen::Vector3d axis = -Eigen::Vector3f(record.axis_z).cast<double>();
    const double outer = 1 - std::cos(spot_outer);
    constexpr int rings = 16, sectors = 16, steps = 4000;
    std::vector<double> expected;
    for (int ring = 0; ring < rings; ++ring) {
        double mass = 0;
        for (int i = 0; i < steps; ++i) {
            const double versine = outer * (ring + (i + 0.5) / steps) / rings;
            const Eigen::Vector3d d =
                (1 - versine) * axis + std::sqrt(versine * (2 - versine)) * axis.unitOrthogonal();
            mass += static_cast<double>(spot_pdf_w(record, spot_direction(record, to_float3(d)))) *
                    2 * pi * outer / rings / steps;
        }
        expected.insert(expected.end(), sectors, mass / sectors);
    }
    const double sum = std::accumulate(expected.begin(), expected.end(), 0.0);
    EXPECT_NEAR(sum, 1, 1e-5);
    Cells cells(expected);
    double least = 1e30, largest = 0;
    for (uint32_t i = 0; i < sample_count; ++i) {
        const EmissionSample sample = emit_from(scene, light, i);
        const Eigen::Vector3d d = to_double(sample.direction);
        const double versine = 1 - d.dot(axis);
        ASSERT_LT(versine, outer * (1 + 1e-5));
        const auto found =
            static_cast<double>(spot_pdf_w(record, spot_direction(record, sample.direction)));
        ASSERT_NEAR(static_cast<double>(sample.pdf_direction), found, 1e-5 * found + 2e-6);
        cells.add(part(versine / outer, rings) * sectors + part(turn(axis, d), sectors));
        least = std::min(least, green(sample.weight));
        largest = std::max(largest, green(sample.weight));
    }
    cells.expect_fit("spot");
    EXPECT_LT(largest / least, spot_outer / std::tan(0.5 * spot_outer) * 1.001);
}

TEST(Emission, OfDirectionalLightIsUniformOverTheDisc) {
    const CompiledScene scene = compile_light_scene();
    const uint32_t light = light_of(scene, LIGHT_DIRECTIONAL);
    Cells cells(8);
    for (uint32_t i = 0; i < sample_count; ++i) {
        const EmissionSample sample = emit_from(scene, light, i);
        ASSERT_EQ(sample.direction.y, -scene.lights[light].axis_z[1]);
        cells.add(disc_cell(scene, sample));
    }
    cells.expect_fit("directional");
}

TEST(Emission, OfDomesIsUniformInDirectionAndOverTheDisc) {
    const CompiledScene scene = compile_light_scene();
    const uint32_t light = light_of(scene, LIGHT_DOME);
    Cells cells(8 * 8 * 8);
    for (uint32_t i = 0; i < sample_count; ++i) {
        const EmissionSample sample = emit_from(scene, light, i);
        const Eigen::Vector3d d = to_double(sample.direction);
        cells.add((part(0.5 + 0.5 * d.y(), 8) * 8 + part(turn(Eigen::Vector3d::UnitY(), d), 8)) *
                      8 +
                  disc_cell(scene, sample));
    }
    cells.expect_fit("dome");
}

// The cells are those of the image, with the probabilities that camera paths use. A test in
// light_sampling_test.cpp compares environment_pdf_w with the sampler's directions.
TEST(Emission, OfEnvironmentsFollowsTheImageAndIsUniformOverTheDisc) {
    const CompiledScene scene = compile_light_scene(LightArrays::Kind::environment);
    const uint32_t light = light_of(scene, LIGHT_ENVIRONMENT);
    const uint32_t width = scene.lighting.environment_width,
                   rows = scene.lighting.environment_height + 1;
    std::vector<double> expected;
    for (uint32_t row = 0; row < rows; ++row) {
        for (uint32_t column = 0; column < width; ++column) {
            const double probability =
                static_cast<double>(
                    cell_pdf_w(scene.environment_ends.data(), scene.lighting, column, row)) *
                static_cast<double>(cell_solid_angle(scene.lighting, row));
            expected.insert(expected.end(), 8, probability / 8);
        }
    }
    Cells cells(expected);
    for (uint32_t i = 0; i < sample_count; ++i) {
        const EmissionSample sample = emit_from(scene, light, i);
        const EnvironmentPosition at = environment_position(
            scene.lighting, to_light_space(scene.lights[light], -sample.direction));
        cells.add((at.row * width + at.column) * 8 + disc_cell(scene, sample));
    }
    cells.expect_fit("environment");
}

/// Power of a light in W, in the green channel. It has a closed form, except for the environment,
/// whose power is estimated from uniform directions with the given standard error.
struct Power {
    double watts;
    double standard_error = 0;
};

Power power_of(const CompiledScene &scene, uint32_t index) {
    const LightRecord &light = scene.lights[index];
    const auto radiance = static_cast<double>(light.radiance[1]);
    const double disc = pi * std::pow(static_cast<double>(scene.lighting.scene_radius), 2);
    switch (light.kind) {
        case LIGHT_MESH:
            return {pi * (mesh_areas()[0] + mesh_areas()[1]) * radiance};
        case LIGHT_DISC:
        case LIGHT_SPHERE:
            return {pi * static_cast<double>(light.area) * radiance};
        case LIGHT_POINT:
            return {4 * pi * radiance};
        case LIGHT_SPOT: {
            // 2 pi times the integral of the linear falloff times the sine.
            const double i = spot_inner, o = spot_outer;
            return {2 * pi * (1 - (std::sin(o) - std::sin(i)) / (o - i)) * radiance};
        }
        case LIGHT_DIRECTIONAL:
            return {disc * radiance};
        case LIGHT_DOME:
            return {4 * pi * disc * radiance};
        default:
            break;
    }
    constexpr uint32_t n = 4'000'000;
    double sum = 0, squares = 0;
    for (uint32_t i = 0; i < n; ++i) {
        const uint4 w = words(i, 3);
        const float3 d = sample_uniform_sphere(uniform_float(w.x), uniform_float(w.y));
        const double value =
            4 * pi * disc * radiance *
            green(environment_radiance(scene.environment_texels.data(), scene.lighting, d));
        sum += value;
        squares += value * value;
    }
    return {sum / n, std::sqrt((squares / n - sum / n * sum / n) / n)};
}

// The mean weight is the power of all lights. Sixteen tests share a family-wise level of 0.01, so
// each may be 3.5 standard errors off.
TEST(Emission, CarriesThePowerOfTheLights) {
    for (const auto infinite : {LightArrays::Kind::dome, LightArrays::Kind::environment}) {
        const CompiledScene scene = compile_light_scene(infinite);
        double total = 0, squared_error = 0;
        for (uint32_t light = 0; light < scene.lights.size(); ++light) {
            const Power power = power_of(scene, light);
            total += power.watts;
            squared_error += power.standard_error * power.standard_error;
            double sum = 0, squares = 0;
            for (uint32_t i = 0; i < sample_count; ++i) {
                const EmissionSample sample = emit_from(scene, light, i);
                const double value = green(sample.weight) *
                                     static_cast<double>(scene.lights[light].emission_selection);
                sum += value;
                squares += value * value;
                const uint kind = scene.lights[light].kind;
                ASSERT_EQ(sample.is_delta,
                          kind == LIGHT_POINT || kind == LIGHT_SPOT || kind == LIGHT_DIRECTIONAL
                              ? 1u
                              : 0u);
                ASSERT_EQ(sample.at_infinity, kind >= LIGHT_DIRECTIONAL ? 1u : 0u);
                ASSERT_NEAR(length(sample.direction), 1.0f, 2e-6f);
                if (kind != LIGHT_SPOT && kind != LIGHT_ENVIRONMENT) {
                    ASSERT_NEAR(value, power.watts, 1e-5 * power.watts);
                }
            }
            const double mean = sum / sample_count;
            const double error =
                std::sqrt(std::max(squares / sample_count - mean * mean, 0.0) / sample_count);
            EXPECT_NEAR(mean, power.watts,
                        3.5 * std::hypot(error, power.standard_error) + 1e-5 * power.watts);
            EXPECT_LT(std::hypot(error, power.standard_error), 0.02 / 8 * power.watts)
                << "power of the test";
        }
        double sum = 0, squares = 0;
        for (uint32_t i = 0; i < sample_count; ++i) {
            const double value = green(emit(scene, i).weight);
            sum += value;
            squares += value * value;
        }
        const double mean = sum / sample_count;
        squared_error += (squares / sample_count - mean * mean) / sample_count;
        EXPECT_NEAR(mean, total, 3.5 * std::sqrt(squared_error));
        EXPECT_LT(std::sqrt(squared_error), 0.02 / 8 * total);
    }
}

/// A rectangle that all lights illuminate.
struct Patch {
    Eigen::Vector3d corner{-1, 0.2, 0.3}, x{2.4, 0, 0.1}, y{0.1, 0.3, -1.9};
    Eigen::Vector3d normal = x.cross(y).normalized();
    double area = x.cross(y).norm();

    bool hit_by(const EmissionSample &sample) const {
        const Eigen::Vector3d d = to_double(sample.direction),
                              from = to_double(sample.origin) - corner;
        const double t = -from.dot(normal) / d.dot(normal);
        if (!(t > 0 && d.dot(normal) < 0)) {
            return false;
        }
        Eigen::Matrix<double, 3, 2> axes;
        axes << x, y;
        const Eigen::Vector2d at =
            (axes.transpose() * axes).inverse() * (axes.transpose() * (from + t * d));
        return at.minCoeff() >= 0 && at.maxCoeff() < 1;
    }
};

// Compares two estimates of the irradiance of a patch: light samples from its points, and light
// paths that hit it. Fourteen tests share a family-wise level of 0.01, so each may be 3.5 standard
// errors off.
TEST(Emission, BringsTheIrradianceThatLightSamplesFind) {
    const Patch patch;
    for (const auto infinite : {LightArrays::Kind::dome, LightArrays::Kind::environment}) {
        const auto selection = infinite == LightArrays::Kind::dome ? LightSelection::mixed
                                                                   : LightSelection::independent;
        const CompiledScene scene = compile_light_scene(infinite, selection);
        const SceneView view = view_of(scene);
        for (uint32_t light = 0; light < scene.lights.size(); ++light) {
            const LightRecord &record = scene.lights[light];
            Estimate sampled, emitted;
            for (uint32_t i = 0; i < 1'000'000; ++i) {
                const uint4 w = words(i, 4);
                const Eigen::Vector3d from = patch.corner +
                                             static_cast<double>(uniform_float(w.x)) * patch.x +
                                             static_cast<double>(uniform_float(w.y)) * patch.y;
                const LightSample sample =
                    sample_lights(&view, light, to_float3(from), words(i, 5));
                const double cosine = patch.normal.dot(to_double(sample.wi));
                sampled.add(sample.pdf_w > 0.0f && cosine > 0
                                ? patch.area * green(sample.radiance) * cosine *
                                      static_cast<double>(record.selection / sample.pdf_w)
                                : 0.0);
            }
            for (uint32_t i = 0; i < 3'000'000; ++i) {
                const EmissionSample sample = emit_from(scene, light, i);
                emitted.add(patch.hit_by(sample)
                                ? green(sample.weight) *
                                      static_cast<double>(record.emission_selection)
                                : 0.0);
            }
            const double error = std::hypot(sampled.error(), emitted.error());
            EXPECT_NEAR(sampled.mean(), emitted.mean(), 3.5 * error)
                << "light of kind " << record.kind;
            EXPECT_LT(error, 0.02 / 5 * sampled.mean())
                << "power of the test for a light of kind " << record.kind;
        }
    }
}

// (a) The emission density that a camera path computes where it hits a light is the density that
// the light path along the same line had.
TEST(Emission, HitsHaveTheDensityOfTheLineFromTheLight) {
    for (const auto infinite : {LightArrays::Kind::dome, LightArrays::Kind::environment}) {
        const CompiledScene scene = compile_light_scene(
            infinite, infinite == LightArrays::Kind::dome ? LightSelection::independent
                                                          : LightSelection::mixed);
        const SceneView view = view_of(scene);
        int other_cell = 0;
        for (uint32_t i = 0; i < 200'000; ++i) {
            const EmissionSample sample = emit(scene, i);
            const LightRecord &light = scene.lights[sample.light];
            const double emitted =
                static_cast<double>(sample.pdf_origin) * static_cast<double>(sample.pdf_direction);
            double computed = 0, expected = emitted;
            if (sample.at_infinity != 0u && sample.is_delta == 0u) {
                const float3 met = sample.origin + sample.direction * scene.lighting.scene_radius;
                computed = static_cast<double>(infinite_line_pdf(&view, met, -sample.direction));
                if (std::abs(computed / expected - 1) > 1e-5) {
                    ++other_cell;  // rounding of the direction selects another texel
                    continue;
                }
            } else if (sample.is_delta == 0u) {
                uint primitive = SHAPE_BIT | light.first_triangle, emitter = sample.light;
                if (light.kind == LIGHT_MESH) {
                    emitter = light.first_triangle;
                    const SurfaceTriangle &t =
                        scene.surface_triangles[scene.emitter_triangles[emitter].triangle];
                    emitter += dot(sample.point.normal,
                                   make_float3(t.normal[0], t.normal[1], t.normal[2])) > 0.99f
                                   ? 0u
                                   : 1u;
                    primitive = scene.emitter_triangles[emitter].triangle;
                }
                computed = static_cast<double>(
                    emission_line_pdf(&view, light, primitive, emitter, sample.direction));
                expected =
                    emitted / static_cast<double>(dot(sample.point.normal, sample.direction));
                ASSERT_NEAR(static_cast<double>(emission_pdf_a(&view, light, primitive, emitter)),
                            static_cast<double>(sample.pdf_origin),
                            1e-6 * static_cast<double>(sample.pdf_origin));
                // At grazing angles, rounding of the direction dominates the cosine.
                ASSERT_NEAR(computed, expected,
                            (1e-5 + 1e-6 / static_cast<double>(
                                               dot(sample.point.normal, sample.direction))) *
                                expected);
                continue;
            } else {
                continue;
            }
            ASSERT_NEAR(computed, expected, 1e-5 * expected) << light.kind;
        }
        EXPECT_LT(other_cell, 20);
    }
}

// (b) The ratio of densities that a light sample returns, combined with the density of the sample
// and the geometry term, gives the density of light paths.
TEST(Emission, LightSamplesHaveTheDensityOfLightPaths) {
    test::Random random(5);
    for (const auto infinite : {LightArrays::Kind::dome, LightArrays::Kind::environment}) {
        for (const LightSelection selection :
             {LightSelection::mixed, LightSelection::uniform, LightSelection::independent}) {
            const CompiledScene scene = compile_light_scene(infinite, selection);
            const SceneView view = view_of(scene);
            const double disc = pi * std::pow(static_cast<double>(scene.lighting.scene_radius), 2);
            for (uint32_t i = 0; i < 100'000; ++i) {
                const uint32_t index = i % static_cast<uint32_t>(scene.lights.size());
                const LightRecord &light = scene.lights[index];
                const float3 from =
                    to_float3(Eigen::Vector3f(scene.lighting.scene_centre).cast<double>() +
                              1.5 * test::uniform(random) * test::uniform_direction(random));
                const LightSample sample = sample_lights(&view, index, from, words(i, 6));
                if (!(sample.pdf_w > 0.0f)) {
                    continue;
                }
                const auto emission = static_cast<double>(light.emission_selection);
                const auto ratio = 1 / static_cast<double>(sample.sampling_over_emission);
                const auto pdf_w = static_cast<double>(sample.pdf_w);
                const Eigen::Vector3d way = to_double(sample.target) - to_double(from);
                const double spread = light.kind < LIGHT_DIRECTIONAL ? way.squaredNorm() : 1;
                const double direction_pdf = static_cast<double>(sample.arrival_pdf_a) * spread;
                SurfacePoint on{};
                on.position = sample.target;
                if (light.kind <= LIGHT_SPHERE) {
                    on.normal = normal_at(scene, light, sample.target);
                    const double cosine = -to_double(on.normal).dot(way.normalized());
                    if (cosine < 0.05 || way.norm() < 0.1) {
                        // The target is slightly off the surface, so the cosine is inaccurate.
                        continue;
                    }
                    const double area = light.kind == LIGHT_MESH ? mesh_areas()[0] + mesh_areas()[1]
                                                                 : static_cast<double>(light.area);
                    const double sampling_pdf_a = pdf_w * cosine / way.squaredNorm();
                    ASSERT_NEAR(ratio * sampling_pdf_a * area / emission, 1, 1e-3) << light.kind;
                    ASSERT_NEAR(direction_pdf * pi / cosine, 1, 1e-3) << light.kind;
                } else if (light.kind == LIGHT_POINT) {
                    ASSERT_NEAR(direction_pdf * 4 * pi, 1, 1e-6);
                } else if (light.kind == LIGHT_SPOT) {
                    ASSERT_NEAR(
                        direction_pdf,
                        static_cast<double>(spot_pdf_w(light, spot_direction(light, -sample.wi))),
                        1e-6);
                } else {
                    ASSERT_NEAR(direction_pdf * disc, 1, 1e-5);
                }
                if (light.kind > LIGHT_SPHERE) {
                    ASSERT_NEAR(ratio * static_cast<double>(light.selection) / emission, 1, 1e-6);
                }
                ASSERT_NEAR(
                    ratio * static_cast<double>(sampling_over_emission(&view, light, from, on)), 1,
                    1e-3)
                    << light.kind;
            }
        }
    }
}

}  // namespace
}  // namespace rtrays
