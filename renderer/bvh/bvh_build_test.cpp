// SPDX-License-Identifier: MIT
// Tests the two-wide hierarchy of every build method: invariants, cost, determinism and limits.
#include <cstring>
#include <limits>

#include "renderer/testing/bvh_tree.h"
#include "renderer/testing/errors.h"

namespace rtrays {
namespace {

using namespace test;

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr float infinity = std::numeric_limits<float>::infinity();

/// Fixture for each build method.
class BvhBuild : public testing::TestWithParam<Named<BvhMethod>> {
  protected:
    static HostBvh build(const Mesh &mesh) {
        return build_bvh(mesh, {BvhLayout::bvh2, GetParam().value});
    }

    /// Builds with the given group, chunk and subtree sizes.
    static HostBvh build(const Mesh &mesh, BvhBuildParameters parameters) {
        parameters.method = GetParam().value;
        return HostBvh(BvhBuilder(test_device(), parameters).build(mesh.positions, mesh.triangles));
    }

    static bool is_binned() { return GetParam().value == BvhMethod::binned_sah; }
};
INSTANTIATE_TEST_SUITE_P(Methods, BvhBuild, testing::ValuesIn(bvh_methods),
                         [](const auto &test) { return std::string(test.param.name); });

TreeFacts expect_valid(const HostBvh &bvh, const Mesh &mesh) {
    TreeFacts facts = inspect_tree(bvh, mesh);
    EXPECT_EQ(facts.fault, "") << mesh.name;
    EXPECT_EQ(facts.nodes, bvh.report.nodes);
    EXPECT_EQ(facts.leaves, bvh.report.leaves);
    EXPECT_EQ(facts.depth, bvh.report.depth);
    EXPECT_LE(facts.depth, BVH_STACK_SIZE);
    EXPECT_NEAR(facts.sah_cost, bvh.report.sah_cost, 1e-3 * facts.sah_cost);
    EXPECT_EQ(bvh.report.triangles + bvh.report.rejected(), mesh.triangles.size());
    return facts;
}

TEST_P(BvhBuild, TreeIsValidOfEverySize) {
    for (uint32_t count = 1; count < 40; ++count) {
        const Mesh mesh = soup(count, count);
        expect_valid(build(mesh), mesh);
    }
    for (const uint32_t count : {1023u, 1024u, 1025u, 4097u, 30000u}) {
        const Mesh mesh = soup(count, count);
        expect_valid(build(mesh), mesh);
    }
}

TEST_P(BvhBuild, CostIsNearFullSweep) {
    const std::vector<Mesh> meshes = {soup(20000, 1), terrain(100, 2),
                                      sphere(80, 160, 1.0f, 0.05f, {0, 0, 0}), room()};
    double mean = 0;
    for (const Mesh &mesh : meshes) {
        const TreeFacts facts = expect_valid(build(mesh), mesh);
        const double ratio = facts.sah_cost / full_sweep_cost(mesh);
        RecordProperty("sah_over_sweep_" + mesh.name, std::to_string(ratio));
        EXPECT_LT(ratio, is_binned() ? 1.08 : 1.25) << mesh.name;
        mean += ratio / static_cast<double>(meshes.size());
    }
    EXPECT_LT(mean, is_binned() ? 1.02 : 1.2);
}

TEST_P(BvhBuild, BitsDoNotDependOnTheDistributionOfWork) {
    const Mesh mesh = terrain(80, 5);
    const HostBvh expected = build(mesh, {1, 1024, 256});
    const auto same_bytes = [](const auto &a, const auto &b) {
        return a.size() == b.size() &&
               std::memcmp(a.data(), b.data(), a.size() * sizeof(a[0])) == 0;
    };
    for (const BvhBuildParameters &parameters : {BvhBuildParameters{8, 1024, 256},
                                                 {64, 1024, 256},
                                                 {1, 100, 256},
                                                 {7, 333, 256},
                                                 {4, 1, 256}}) {
        const HostBvh bvh = build(mesh, parameters);
        EXPECT_TRUE(same_bytes(bvh.nodes, expected.nodes))
            << parameters.group_size << ' ' << parameters.chunk_size;
        EXPECT_TRUE(same_bytes(bvh.triangles, expected.triangles))
            << parameters.group_size << ' ' << parameters.chunk_size;
        EXPECT_EQ(bvh.report.sah_cost, expected.report.sah_cost);
    }
    // Uses parameters of a GPU, which sum costs in another order.
    BvhBuildParameters of_groups{64, 100, 256};
    of_groups.one_group = 32;
    of_groups.parts = 5;
    const HostBvh by_groups = build(mesh, of_groups);
    EXPECT_TRUE(same_bytes(by_groups.nodes, expected.nodes));
    EXPECT_TRUE(same_bytes(by_groups.triangles, expected.triangles));
    EXPECT_NEAR(by_groups.report.sah_cost, expected.report.sah_cost,
                1e-5 * expected.report.sah_cost);
    // The subtree size moves the nodes of binned_sah in memory, but the tree is the same.
    const TreeFacts tree = inspect_tree(expected, mesh);
    for (const uint32_t subtree_size : {4u, 50u, 5000u, 100000u}) {
        const HostBvh bvh = build(mesh, {2, 512, subtree_size});
        const TreeFacts other = expect_valid(bvh, mesh);
        EXPECT_EQ(other.boxes, tree.boxes) << subtree_size;
        EXPECT_EQ(other.leaf_ids, tree.leaf_ids) << subtree_size;
        EXPECT_TRUE(is_binned() || same_bytes(bvh.nodes, expected.nodes)) << subtree_size;
    }
}

TEST_P(BvhBuild, NothingToHit) {
    const Mesh mesh{"empty", {}, {}};
    const HostBvh bvh = build(mesh);
    expect_valid(bvh, mesh);
    EXPECT_EQ(bvh.nodes.size(), 1u);
    Random random(1);
    for (int i = 0; i < 1000; ++i) {
        EXPECT_EQ(bvh.nearest({0, 0, 0}, uniform_direction(random)).triangle, NO_HIT);
    }
    EXPECT_EQ(bvh.nearest({0, 0, 0}, {0, 0, -1}).triangle, NO_HIT);
}

TEST_P(BvhBuild, OneTriangle) {
    Mesh mesh{"one triangle", {}, {}};
    mesh.add_triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    const HostBvh bvh = build(mesh);
    expect_valid(bvh, mesh);
    const Hit hit = bvh.nearest({0.25f, 0.5f, 2.0f}, {0, 0, -1});
    EXPECT_EQ(hit.triangle, 0u);
    EXPECT_FLOAT_EQ(hit.t, 2.0f);
    EXPECT_FLOAT_EQ(hit.u, 0.25f);
    EXPECT_FLOAT_EQ(hit.v, 0.5f);
    EXPECT_EQ(bvh.nearest({0.25f, 0.5f, -3.0f}, {0, 0, 2}).t, 1.5f)
        << "triangles are two-sided, and t is in lengths of the direction";
    EXPECT_EQ(bvh.nearest({0.75f, 0.5f, 2.0f}, {0, 0, -1}).triangle, NO_HIT);
}

TEST_P(BvhBuild, FaultyTrianglesAreLeftOutAndCounted) {
    Mesh mesh = soup(3000, 3);
    mesh.positions[3 * 7] = {nan, 0, 0};
    mesh.positions[3 * 500 + 1] = {0, infinity, 0};
    mesh.positions[3 * 2999 + 2] = {0, 0, -infinity};
    mesh.positions[3 * 42] = {1e30f, 0, 0};
    mesh.positions[3 * 100] = mesh.positions[3 * 100 + 1];         // two vertices coincide
    mesh.add_triangle({1, 2, 3}, {1, 2, 3}, {1, 2, 3});            // a point
    mesh.add_triangle({0, 0, 0}, {0.25f, 0.5f, 1}, {0.5f, 1, 2});  // a line
    const HostBvh bvh = build(mesh);
    expect_valid(bvh, mesh);
    EXPECT_EQ(bvh.report.not_finite, 4u);
    EXPECT_EQ(bvh.report.degenerate, 3u);

    Mesh hopeless{"hopeless", {}, {}};
    for (int i = 0; i < 5000; ++i) {
        hopeless.add_triangle({nan, nan, nan}, {1, 0, 0}, {0, 1, 0});
    }
    const HostBvh none = build(hopeless);
    expect_valid(none, hopeless);
    EXPECT_EQ(none.report.not_finite, 5000u);
    EXPECT_EQ(none.nearest({0.1f, 0.1f, 1}, {0, 0, -1}).triangle, NO_HIT);
}

TEST_P(BvhBuild, CoincidentTrianglesEnd) {
    Mesh mesh{"coincident", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {}};
    mesh.triangles.assign(1000000, {0, 1, 2});
    const HostBvh bvh = build(mesh);
    const TreeFacts facts = expect_valid(bvh, mesh);
    EXPECT_LE(facts.depth, is_binned() ? 18u : 30u) << "a split in halves gives 10^6 / 2^18 < 4";
    EXPECT_FLOAT_EQ(bvh.nearest({0.2f, 0.2f, 1}, {0, 0, -1}).t, 1.0f);
}

TEST_P(BvhBuild, EqualCentroidsEnd) {
    Mesh mesh{"equal centroids", {}, {}};
    for (int i = 1; i <= 3000; ++i) {
        const auto r = static_cast<float>(i);
        mesh.add_triangle({-r, -r, 0}, {r, -r, 0}, {0, r, 0});
    }
    expect_valid(build(mesh), mesh);
}

TEST_P(BvhBuild, DepthIsBoundedWhereSahPeelsOffOneByOne) {
    // Along each axis, distances from the corner shrink by a factor of 20 from one triangle to the
    // next. Therefore, 16 bins separate one distant triangle from all others in the first bin.
    Mesh mesh{"exponential", {}, {}};
    for (int axis = 0; axis < 3; ++axis) {
        float distance = 1e11f;
        for (int i = 0; i < 31; ++i, distance /= 20) {
            const Eigen::Vector3f p = distance * Eigen::Vector3f::Unit(axis);
            const float size = 1e-3f * distance;
            mesh.add_triangle(p, p + size * Eigen::Vector3f(1, 2, 3),
                              p + size * Eigen::Vector3f(3, 1, 2));
        }
    }
    const HostBvh bvh = build(mesh);
    expect_valid(bvh, mesh);
    if (is_binned()) {
        EXPECT_GT(bvh.report.depth, BVH_AREA_DEPTH) << "the case must reach the bound";
    }
    EXPECT_LE(bvh.report.depth, 62u);
}

TEST_P(BvhBuild, ScalesAreAlike) {
    const Mesh mesh = soup(2000, 9);
    const HostBvh reference = build(mesh);
    for (const float scale : {0x1p-20f, 0x1p20f}) {
        Mesh scaled = mesh;
        for (Eigen::Vector3f &p : scaled.positions) {
            p *= scale;
        }
        const HostBvh bvh = build(scaled);
        const TreeFacts facts = expect_valid(bvh, scaled);
        EXPECT_EQ(facts.leaf_ids, inspect_tree(reference, mesh).leaf_ids)
            << "scaling by powers of two must not change a decision";
    }
}

TEST(BvhBinning, OtherBinsAndAxesGiveOtherTrees) {
    const auto build = [](const Mesh &mesh, uint32_t bins, uint32_t axes) {
        BvhBuildParameters parameters{1, 1024, 256};
        parameters.bins = bins;
        parameters.axes = axes;
        return HostBvh(BvhBuilder(test_device(), parameters).build(mesh.positions, mesh.triangles));
    };
    for (const Mesh &mesh : {soup(20000, 1), terrain(100, 2)}) {
        const double usual = build(mesh, 16, 3).report.sah_cost;
        // Other subtrees sum the cost in another order.
        EXPECT_NEAR(usual, build_bvh(mesh).report.sah_cost, 1e-5 * usual);
        for (const auto &[bins, axes] :
             {std::pair(2u, 3u), std::pair(4u, 3u), std::pair(64u, 3u), std::pair(16u, 1u)}) {
            const double ratio = expect_valid(build(mesh, bins, axes), mesh).sah_cost / usual;
            EXPECT_NE(ratio, 1) << mesh.name << ' ' << bins << ' ' << axes;
            EXPECT_NEAR(ratio, 1, 0.15) << mesh.name << ' ' << bins << ' ' << axes;
        }
    }
    // Two rows along x with a gap along y that is smaller than their length. Testing three axes
    // finds the gap at once.
    Mesh rows{"two rows", {}, {}};
    for (uint32_t i = 0; i < 2000; ++i) {
        const Eigen::Vector3f at(1.1f * static_cast<float>(i / 2) / 1000, static_cast<float>(i % 2),
                                 0);
        rows.add_triangle(at, at + Eigen::Vector3f(1e-4f, 0, 0), at + Eigen::Vector3f(0, 0, 1e-4f));
    }
    EXPECT_GT(build(rows, 16, 1).report.sah_cost, 1.01 * build(rows, 16, 3).report.sah_cost);
}

TEST(BvhBuildInput, WrongInputIsAnError) {
    BvhBuilder &builder = builder_of(BvhLayout::bvh2);
    const std::vector<Eigen::Vector3f> three(3, Eigen::Vector3f::Zero());
    expect_input_error("1 triangles refer to a vertex that does not exist; there are 3 vertices",
                       [&] {
                           builder.build(three, {{0, 1, 3}});
                       });
    expect_input_error("there are 0 vertices", [&] {
        builder.build(std::vector<Eigen::Vector3f>(), {{0, 0, 0}});
    });
    const Buffer<float> positions(test_device(), "positions", std::vector<float>(9));
    const Buffer<uint32_t> indices(test_device(), "indices", std::vector<uint32_t>(4));
    expect_input_error("expected multiples of 3, got 9 coordinates and 4 vertex indices",
                       [&] { builder.build(positions, indices); });
    for (const BvhBuildParameters &bad :
         {BvhBuildParameters{0, 1024, 1024}, {1, 0, 1024}, {1, 1024, 3}}) {
        expect_input_error("BVH build parameters", [&] { BvhBuilder(test_device(), bad); });
    }
    BvhBuildParameters bad{1, 1024, 1024};
    bad.bins = 1;
    expect_input_error("bins 1 must be 2 to 64", [&] { BvhBuilder(test_device(), bad); });
    bad.bins = 16;
    bad.axes = 2;
    expect_input_error("axes 2 must be 1 or 3", [&] { BvhBuilder(test_device(), bad); });
    bad = {1, 1024, 1024};
    bad.one_group = 3;
    expect_input_error("one_group 3 must be a power of two",
                       [&] { BvhBuilder(test_device(), bad); });
}

TEST(BvhBuildInput, TooManyTrianglesAreRefusedBeforeAllocation) {
    const DeviceInfo &device = test_device().info();
    EXPECT_NO_THROW(require_build_memory(device, 1000, 24000));
    const std::string message = error_of(
        ExitCode::bad_input, [&] { require_build_memory(device, (uint64_t{1} << 26) + 1, 0); });
    EXPECT_NE(message.find("67108865 triangles"), std::string::npos) << message;
    EXPECT_NE(message.find("GiB"), std::string::npos) << message;
    DeviceInfo small = device;
    small.global_memory = 1 << 20;
    small.max_allocation = 1 << 20;
    expect_input_error("GiB per allocation", [&] { require_build_memory(small, 100000, 0); });
    EXPECT_NO_THROW(require_build_memory(small, 1000, 0));
    expect_input_error("GiB per allocation", [&] { require_build_memory(small, 1000, 1 << 20); });
}

}  // namespace
}  // namespace rtrays
