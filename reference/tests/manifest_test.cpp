// SPDX-License-Identifier: MIT
#include "reference/manifest.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "renderer/base/error.h"
#include "renderer/base/files.h"

namespace rtrays::reference {
namespace {

namespace fs = std::filesystem;

class ManifestFile : public testing::Test {
  protected:
    void SetUp() override {
        const auto *test = testing::UnitTest::GetInstance()->current_test_info();
        folder_ = fs::path(testing::TempDir()) / (std::string("manifest_") + test->name());
        fs::create_directories(folder_);
        image_a_ = folder_ / "box.embree.a.exr";
        image_b_ = folder_ / "box.embree.b.exr";
        manifest_ = folder_ / "manifest.json";
        write_file(image_a_, "abc");
        write_file(image_b_, "");
    }
    void TearDown() override { fs::remove_all(folder_); }

    Json entry(uint64_t seed) const {
        return {{"scene", "box"},     {"scene_hash", "0f"},  {"width", 4},
                {"height", 4},        {"seed", seed},        {"sample_range", {0, 16}},
                {"spp", 16},          {"strategies", "mis"}, {"max_depth", 0},
                {"commit", "c0ffee"}, {"seconds", 0.5},      {"engine_version", "embree 3.13.5"}};
    }

    fs::path folder_, image_a_, image_b_, manifest_;
};

TEST_F(ManifestFile, gains_and_replaces_entries) {
    update_manifest(manifest_, image_a_, entry(1));
    update_manifest(manifest_, image_b_, entry(2));
    update_manifest(manifest_, image_a_, entry(3));
    const Json references = load_manifest(manifest_).at("references");
    EXPECT_EQ(references.size(), 2u);
    EXPECT_EQ(references.at("box.embree.a.exr").at("seed"), 3);
    EXPECT_EQ(references.at("box.embree.b.exr").at("seed"), 2);
    EXPECT_EQ(references.at("box.embree.b.exr").at("engine"), "embree");
    // The example of FIPS 180-4 and the empty message.
    EXPECT_EQ(references.at("box.embree.a.exr").at("sha256"),
              "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    EXPECT_EQ(references.at("box.embree.b.exr").at("sha256"),
              "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
}

TEST_F(ManifestFile, refuses_incomplete_entries_and_keeps_what_it_had) {
    update_manifest(manifest_, image_a_, entry(1));
    const std::string before = read_file(manifest_);
    Json incomplete = entry(2);
    incomplete.erase("spp");
    EXPECT_THROW(update_manifest(manifest_, image_b_, incomplete), Error);
    Json unknown = entry(2);
    unknown["colour"] = "blue";
    EXPECT_THROW(update_manifest(manifest_, image_b_, unknown), Error);
    EXPECT_EQ(read_file(manifest_), before);
}

TEST_F(ManifestFile, lists_what_serves_a_request) {
    EXPECT_FALSE(manifest_lists(manifest_, image_a_, {{"spp", 16}}));
    update_manifest(manifest_, image_a_, entry(1));
    EXPECT_TRUE(manifest_lists(manifest_, image_a_, {{"spp", 16}, {"seed", 1}}));
    EXPECT_TRUE(manifest_lists(manifest_, image_a_, {{"spp", 15}, {"scene_hash", "0f"}}));
    EXPECT_FALSE(manifest_lists(manifest_, image_a_, {{"spp", 17}, {"seed", 1}}));
    EXPECT_FALSE(manifest_lists(manifest_, image_a_, {{"spp", 16}, {"seed", 2}}));
    EXPECT_FALSE(manifest_lists(manifest_, image_a_, {{"spp", 16}, {"scene_hash", "1f"}}));
    EXPECT_FALSE(manifest_lists(manifest_, image_b_, {{"spp", 16}, {"seed", 1}}));
    write_file(image_a_, "abcd");
    // The file has changed.
    EXPECT_FALSE(manifest_lists(manifest_, image_a_, {{"spp", 16}, {"seed", 1}}));
}

TEST_F(ManifestFile, refuses_a_manifest_of_another_kind) {
    write_file(manifest_, R"({"schema_version": 2, "references": {}})");
    EXPECT_THROW(load_manifest(manifest_), Error);
    EXPECT_THROW(update_manifest(manifest_, image_a_, entry(1)), Error);
}

TEST(ReferenceName, has_scene_engine_and_half) {
    const ReferenceName name = parse_reference_name("results/references/cornell_box.embree.b.exr");
    EXPECT_EQ(name.scene, "cornell_box");
    EXPECT_EQ(name.engine, "embree");
    EXPECT_EQ(name.half, "b");
    for (const char *wrong :
         {"box.exr", "box.embree.c.exr", "box.optix.a.exr", "box.embree.a.png", ".embree.a.exr"}) {
        EXPECT_THROW(parse_reference_name(wrong), Error) << wrong;
    }
}

}  // namespace
}  // namespace rtrays::reference
