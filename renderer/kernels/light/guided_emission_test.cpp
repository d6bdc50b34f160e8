// SPDX-License-Identifier: MIT
// Tests guided emission, with the device code compiled for the host: starts of light paths against
// the densities of their tables, and the densities that hits and light samples report.
//
// Eight chi-square tests share a family-wise level of 0.01 (Cells).
#include <gtest/gtest.h>

#include "renderer/testing/emission_cells.h"
#include "renderer/testing/guided_lights.h"
#include "renderer/testing/shape_hits.h"

namespace rtrays {
namespace {

constexpr uint32_t sample_count = 1'500'000;

Eigen::Vector3d axis(const float (&of)[3]) {
    return Eigen::Vector3f(of).cast<double>();
}

/// Returns the cell, out of eight of equal probability, of a point on the light, given the
/// direction.
size_t position_cell(const CompiledScene &scene, uint32_t light, const EmissionSample &sample) {
    const LightRecord &record = scene.lights[light];
    if (record.kind == LIGHT_MESH) {
        // The rectangle has its corners in the order of its two triangles.
        const SurfaceTriangle &t =
            scene.surface_triangles[scene.emitter_triangles[record.first_triangle].triangle];
        const Eigen::Vector3d side = axis(t.p1) - axis(t.p0), across = axis(t.p2) - axis(t.p1);
        const Eigen::Vector3d from = to_double(sample.point.position) - axis(t.p0);
        return part(from.dot(side) / side.squaredNorm(), 4) * 2 +
               part(from.dot(across) / across.squaredNorm(), 2);
    }
    const ShapeRecord &shape = scene.shapes[record.first_triangle];
    if (record.kind == LIGHT_DISC) {
        const Eigen::Vector3d p =
            to_double(vector_to_object(&shape, sample.point.position - shape_centre(&shape)));
        return part(p.head<2>().squaredNorm(), 4) * 2 + part(turn(Eigen::Vector3d::UnitZ(), p), 2);
    }
    // The silhouette of the sphere.
    const Eigen::Vector3d d = to_double(sample.direction);
    const Eigen::Vector3d from = to_double(sample.point.position - shape_centre(&shape));
    const Eigen::Vector3d across = from - from.dot(d) * d;
    const double radius2 = static_cast<double>(record.area) / (4 * pi);
    EXPECT_NEAR(from.squaredNorm() / radius2, 1, 1e-5);
    EXPECT_GT(from.dot(d), 0);
    return part(across.squaredNorm() / radius2, 4) * 2 + part(turn(d, across), 2);
}

// Direction by the bins of the table, and coarse direction together with the position.
TEST(GuidedEmission, FollowsItsTables) {
    const GuidedScene guided(compile_guided_scene(), random_moments(compile_guided_scene(), 4));
    for (const uint32_t light :
         {light_of(guided.scene, LIGHT_DISC), light_of(guided.scene, LIGHT_SPHERE),
          light_of(guided.scene, LIGHT_POINT), panel_of(guided.scene)}) {
        ASSERT_TRUE(takes_guide_table(guided.scene, light));
        const bool has_surface = guided.scene.lights[light].kind != LIGHT_POINT;
        std::vector<double> bins(GUIDE_BINS), coarse(16 * 8);
        const auto part_of = [](size_t bin) { return bin / 128 * 4 + bin % 32 / 8; };
        for (size_t bin = 0; bin < GUIDE_BINS; ++bin) {
            bins[bin] = guided.density(light, bin) / GUIDE_BINS;
            for (size_t position = 0; position < 8; ++position) {
                coarse[part_of(bin) * 8 + position] += bins[bin] / 8;
            }
        }
        Cells by_bin(bins), by_position(coarse);
        for (uint32_t i = 0; i < sample_count; ++i) {
            const EmissionSample sample = guided.emit_from(light, i);
            ASSERT_EQ(sample.light, light);
            ASSERT_NEAR(length(sample.direction), 1.0f, 2e-6f);
            const size_t bin = guided.bin_of(light, to_double(sample.direction));
            by_bin.add(bin);
            if (has_surface) {
                by_position.add(part_of(bin) * 8 + position_cell(guided.scene, light, sample));
            }
        }
        by_bin.expect_fit("directions, kind " + std::to_string(guided.scene.lights[light].kind));
        if (has_surface) {
            by_position.expect_fit("positions");
        }
    }
}

TEST(GuidedEmission, SelectsLightsByTheRootsOfTheirMoments) {
    const GuidedScene guided(compile_guided_scene(), random_moments(compile_guided_scene(), 4));
    std::vector<double> probability;
    double sum = 0;
    for (const std::vector<double> &moments : guided.moments) {
        double mean = 0;
        for (const double moment : moments) {
            mean += std::sqrt(moment) / static_cast<double>(moments.size());
        }
        probability.push_back(mean);
        sum += mean;
    }
    for (size_t i = 0; i < probability.size(); ++i) {
        probability[i] = 0.75 * probability[i] / sum +
                         0.25 * static_cast<double>(guided.scene.lights[i].emission_selection);
        EXPECT_NEAR(static_cast<double>(guided.record(static_cast<uint32_t>(i)).emission_selection),
                    probability[i], 1e-7);
    }
    Cells cells(probability);
    const SceneView view = guided.view();
    for (uint32_t i = 0; i < sample_count; ++i) {
        cells.add(sample_emission(&view, words(i, 0), words(i, 1)).light);
    }
    cells.expect_fit("selection");
}

// A flat table has g = 1 exactly. It keeps all bits with two exceptions: spheres sample the
// direction first, and triangles of a mesh share a frame although their normals may differ by
// rounding.
TEST(GuidedEmission, ByFlatTablesIsTheUsualEmission) {
    const CompiledScene scene = compile_guided_scene();
    const EmissionGuide flat = flat_guide(scene);
    const SceneView usual = view_of(scene);
    SceneView guided = usual;
    guided.emission_guide = flat.words.data();
    for (uint32_t i = 0; i < 200'000; ++i) {
        const uint4 a = words(i, 0), b = words(i, 1);
        const EmissionSample expected = sample_emission(&usual, a, b),
                             found = sample_emission(&guided, a, b),
                             seen = sample_seen_emission(&guided, a, b);
        ASSERT_EQ(found.light, expected.light);
        ASSERT_EQ(found.guide, 1.0f);
        ASSERT_EQ(found.pdf_origin, expected.pdf_origin);
        ASSERT_EQ(found.weight.y, expected.weight.y);
        ASSERT_EQ(length(seen.origin - expected.origin), 0.0f);
        ASSERT_EQ(seen.pdf_origin, expected.pdf_origin);
        if (scene.lights[found.light].kind != LIGHT_SPHERE) {
            ASSERT_EQ(found.pdf_direction, expected.pdf_direction);
            ASSERT_LE(length(found.direction - expected.direction),
                      scene.lights[found.light].kind == LIGHT_MESH ? 1e-6f : 0.0f);
            ASSERT_EQ(length(found.origin - expected.origin), 0.0f);
        }
        const LightSample sample = sample_lights(&usual, SELECT_LIGHT, {0, 0.2f, 0.1f}, b),
                          same = sample_lights(&guided, SELECT_LIGHT, {0, 0.2f, 0.1f}, b);
        ASSERT_EQ(sample.pdf_w, same.pdf_w);
        if (sample.pdf_w > 0.0f) {
            ASSERT_EQ(sample.arrival_pdf_a, same.arrival_pdf_a);
            ASSERT_EQ(sample.sampling_over_emission, same.sampling_over_emission);
        }
    }
}

// Stratified words stay stratified, and words of every range are in their bin.
TEST(GuidedEmission, KeepsTheOrderOfWords) {
    const CompiledScene compiled = compile_guided_scene();
    for (const EmissionMoments &moments :
         {random_moments(compiled, 9), one_bin(compiled, 0), one_bin(compiled, GUIDE_BINS - 1)}) {
        const GuidedScene guided(compiled, moments);
        const SceneView view = guided.view();
        const LightRecord light = guided.record(light_of(guided.scene, LIGHT_POINT));
        float u = 0, v = 0;
        for (uint64_t i = 0; i <= 1u << 16; ++i) {
            const auto word = static_cast<uint32_t>(std::min(i << 16, uint64_t{0xffffffff}));
            const GuideSample at = sample_guide(&view, light, word, 0x80000000u),
                              across = sample_guide(&view, light, 0x80000000u, word);
            ASSERT_GE(at.u, u);
            ASSERT_GE(across.v, v);
            u = at.u;
            v = across.v;
        }
        EXPECT_GT(u, 0.9999f);
        EXPECT_LT(u, 1.0f);
        EXPECT_GT(v, 0.9999f);
        EXPECT_LT(v, 1.0f);
    }
}

/// Returns the two tables that the densities are tested with.
std::vector<GuidedScene> guided_scenes() {
    std::vector<GuidedScene> scenes;
    for (const SphereSampling sampling : {SphereSampling::cone, SphereSampling::area}) {
        const CompiledScene scene = compile_guided_scene(sampling);
        scenes.emplace_back(scene, random_moments(scene, 5));
    }
    return scenes;
}

// Where a camera path hits a light, it computes the density that the light path along the same line
// had. Rounding may find the neighbouring bin, for a share of about 2^-20 of all lines.
TEST(GuidedEmission, HitsHaveTheDensityOfTheLineFromTheLight) {
    for (const GuidedScene &guided : guided_scenes()) {
        const SceneView view = guided.view();
        int other_bin = 0, compared = 0;
        for (uint32_t i = 0; i < 1'000'000; ++i) {
            const EmissionSample sample = sample_emission(&view, words(i, 0), words(i, 1));
            const LightRecord light = light_at(&view, sample.light);
            if (light.kind > LIGHT_SPHERE_BY_AREA ||
                (light.kind == LIGHT_MESH && sample.light != panel_of(guided.scene))) {
                continue;
            }
            const bool is_mesh = light.kind == LIGHT_MESH;
            const uint emitter = is_mesh ? light.first_triangle : sample.light;
            const uint primitive = is_mesh ? guided.scene.emitter_triangles[emitter].triangle
                                           : SHAPE_BIT | light.first_triangle;
            const double cosine = static_cast<double>(dot(sample.point.normal, sample.direction));
            const double expected = static_cast<double>(sample.pdf_origin) *
                                    static_cast<double>(sample.pdf_direction) / cosine;
            const auto computed = static_cast<double>(
                emission_line_pdf(&view, light, primitive, emitter, sample.direction));
            ++compared;
            // At grazing angles, rounding of the direction dominates the cosine.
            if (std::abs(computed / expected - 1) > 1e-5 + 1e-6 / cosine) {
                ++other_bin;
                continue;
            }
            const double g = guided.density(
                sample.light, guided.bin_of(sample.light, to_double(sample.direction)));
            other_bin += std::abs(static_cast<double>(sample.guide) / g - 1) < 1e-6 ? 0 : 1;
            ASSERT_NEAR(static_cast<double>(emission_pdf_a(&view, light, primitive, emitter)),
                        static_cast<double>(sample.pdf_origin),
                        1e-6 * static_cast<double>(sample.pdf_origin));
        }
        EXPECT_GT(compared, 100'000);
        EXPECT_LT(other_bin, 100);
    }
}

// A light sample reports the density of light paths along its line.
TEST(GuidedEmission, LightSamplesHaveTheDensityOfLightPaths) {
    test::Random random(5);
    for (const GuidedScene &guided : guided_scenes()) {
        const SceneView view = guided.view(), usual = view_of(guided.scene);
        int other_bin = 0;
        for (uint32_t i = 0; i < 200'000; ++i) {
            const uint32_t index = i % static_cast<uint32_t>(guided.scene.lights.size());
            const LightRecord &light = guided.scene.lights[index];
            const float3 from =
                to_float3(axis(guided.scene.lighting.scene_centre) +
                          1.5 * test::uniform(random) * test::uniform_direction(random));
            const LightSample sample = sample_lights(&view, index, from, words(i, 6)),
                              unguided = sample_lights(&usual, index, from, words(i, 6));
            ASSERT_EQ(sample.pdf_w, unguided.pdf_w);
            if (!(sample.pdf_w > 0.0f)) {
                continue;
            }
            const double g = guided.density(index, guided.bin_of(index, -to_double(sample.wi)));
            const double expected = static_cast<double>(unguided.arrival_pdf_a) * g;
            other_bin +=
                std::abs(static_cast<double>(sample.arrival_pdf_a) - expected) <= 1e-6 * expected
                    ? 0
                    : 1;
            ASSERT_NEAR(static_cast<double>(sample.sampling_over_emission),
                        static_cast<double>(unguided.sampling_over_emission) *
                            static_cast<double>(light.emission_selection) /
                            static_cast<double>(guided.record(index).emission_selection),
                        1e-6 * static_cast<double>(sample.sampling_over_emission));
        }
        EXPECT_LT(other_bin, 20);
    }
}

// Weights make up for the table: any receiver gets the same power from each light.
TEST(GuidedEmission, BringsTheSameLightToAnyPlace) {
    const CompiledScene scene = compile_guided_scene();
    for (const EmissionMoments &moments : {random_moments(scene, 8), one_bin(scene, 77)}) {
        const GuidedScene guided(scene, moments);
        for (uint32_t light = 0; light < scene.lights.size(); ++light) {
            // By half-spaces of the normal and of the direction: eight receivers.
            std::array<Estimate, 8> usual, found;
            const auto add = [&](const EmissionSample &sample, double selection,
                                 std::array<Estimate, 8> &estimates) {
                const size_t receiver =
                    (sample.point.normal.x - 0.2f * sample.point.normal.y > 0.0f ? 4u : 0u) +
                    (sample.direction.x + 0.4f * sample.direction.z > 0.0f ? 2u : 0u) +
                    (sample.direction.y + 0.2f * sample.direction.x > 0.0f ? 1u : 0u);
                for (size_t i = 0; i < 8; ++i) {
                    estimates[i].add(i == receiver ? green(sample.weight) * selection : 0.0);
                }
            };
            const auto selection = static_cast<double>(guided.record(light).emission_selection);
            for (uint32_t i = 0; i < 200'000; ++i) {
                add(emit_from(scene, light, i),
                    static_cast<double>(scene.lights[light].emission_selection), usual);
                add(guided.emit_from(light, i + 500'000), selection, found);
            }
            for (size_t i = 0; i < 8; ++i) {
                const double error = std::hypot(usual[i].error(), found[i].error());
                EXPECT_NEAR(usual[i].mean(), found[i].mean(), 4.2 * error + 1e-6 * usual[i].mean())
                    << "light of kind " << scene.lights[light].kind << ", receiver " << i;
            }
        }
    }
}

// The sphere is convex, so any hit of itself would be a self-intersection.
TEST(GuidedEmission, LeavesTheSphereItStartsOn) {
    const GuidedScene guided(compile_guided_scene(), random_moments(compile_guided_scene(), 6));
    const uint32_t light = light_of(guided.scene, LIGHT_SPHERE);
    const ShapeRecord &shape = guided.scene.shapes[guided.scene.lights[light].first_triangle];
    for (uint32_t i = 0; i < 300'000; ++i) {
        const EmissionSample sample = guided.emit_from(light, i);
        ASSERT_GT(dot(sample.direction, sample.point.normal), 0.0f);
        ASSERT_FALSE(test::any_shape(&shape, 1, sample.origin, sample.direction, INFINITY)) << i;
    }
}

// Directions at the poles of the square, along its seam and at the horizon have a bin.
TEST(GuidedEmission, FindsABinOfEveryDirection) {
    const CompiledScene scene = compile_guided_scene();
    for (const uint32_t index : {light_of(scene, LIGHT_SPHERE), light_of(scene, LIGHT_DISC)}) {
        const LightRecord &light = scene.lights[index];
        const bool is_disc = light.kind == LIGHT_DISC;
        const Eigen::Vector3d x = is_disc ? axis(light.axis_x) : Eigen::Vector3d::UnitX(),
                              y = is_disc ? axis(light.axis_y) : Eigen::Vector3d::UnitY(),
                              z = is_disc ? axis(light.axis_z) : Eigen::Vector3d::UnitZ();
        EXPECT_NEAR(x.cross(y).dot(z), 1, 1e-6);
        EXPECT_EQ(guide_bin(light, to_float3(z)).row, 0u);
        EXPECT_EQ(guide_bin(light, to_float3(-z)).row, is_disc ? 0u : GUIDE_ROWS - 1u);
        for (const Eigen::Vector3d &side : {x, Eigen::Vector3d(-x), y, Eigen::Vector3d(-y)}) {
            for (const double tilt : {0.0, 1e-9, -1e-9, 1e-7, -1e-7}) {
                const GuideBin bin =
                    guide_bin(light, to_float3((side + tilt * (x + y + z)).normalized()));
                EXPECT_LT(bin.row, GUIDE_ROWS);
                EXPECT_LT(bin.column, GUIDE_COLUMNS);
            }
        }
        const GuideBin seam = guide_bin(light, to_float3((x - 1e-3 * y).normalized()));
        EXPECT_EQ(seam.column, GUIDE_COLUMNS - 1u);
    }
}

}  // namespace
}  // namespace rtrays
