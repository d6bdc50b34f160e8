// SPDX-License-Identifier: MIT
// Tests of stored references and arrays.
#include "renderer/base/files.h"

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <random>

#include "experiments/harness/core/array_file.h"
#include "experiments/harness/core/compare.h"
#include "experiments/harness/core/references.h"
#include "reference/manifest.h"
#include "renderer/base/error.h"

namespace rtrays {
namespace {

namespace fs = std::filesystem;

Image noise_image(int width, int height, uint32_t seed) {
    std::mt19937 engine(seed);
    std::normal_distribution<float> noise(1.0f, 0.1f);
    Image image = Image::rgb(width, height);
    for (const auto &name : rgb_names()) {
        for (float &value : image.channel(name)) {
            value = noise(engine);
        }
    }
    for (const auto &name : rgb_names("variance")) {
        image.add_channel(name).assign(image.pixel_count(), 0.01f);
    }
    return image;
}

/// A folder for the halves of a reference of the scene "box".
class StoredReferences : public testing::Test {
  protected:
    void SetUp() override {
        folder_ = fs::path(testing::TempDir()) /
                  ("references_" +
                   std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
        fs::remove_all(folder_);
        fs::create_directories(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }

    void store(const std::string &half, uint32_t seed, int spp = 64) {
        const fs::path path = folder_ / ("box.embree." + half + ".exr");
        write_exr(noise_image(8, 8, seed), path);
        reference::update_manifest(folder_ / "manifest.json", path,
                                   {{"scene", "box"},
                                    {"scene_hash", "abc123"},
                                    {"width", 8},
                                    {"height", 8},
                                    {"seed", seed},
                                    {"sample_range", {0, spp}},
                                    {"spp", spp},
                                    {"strategies", "mis"},
                                    {"max_depth", 0},
                                    {"engine_version", "embree 3"},
                                    {"commit", "0"},
                                    {"seconds", 1.0}});
    }

    ReferenceRequest request(int size = 8, const std::string &hash = "abc123") const {
        return {folder_, "box", hash, "embree", size, size, "box.json"};
    }

    ExitCode error_code(const ReferenceRequest &wanted, const std::string &expected_text) {
        try {
            load_reference(wanted);
        } catch (const Error &error) {
            EXPECT_NE(std::string(error.what()).find(expected_text), std::string::npos)
                << error.what();
            return error.exit_code();
        }
        return ExitCode::ok;
    }

    fs::path folder_;
};

TEST_F(StoredReferences, HalvesAreAveragedAndTheirNoiseEstimated) {
    store("a", 1);
    store("b", 2);
    const auto stored = load_reference(request());
    EXPECT_EQ(stored.description.at("spp"), 128);
    EXPECT_NEAR(stored.reference.noise_mse, 0.005, 0.0015);
    EXPECT_FLOAT_EQ(stored.reference.image.channel("variance.R")[0], 0.005f);
}

TEST_F(StoredReferences, ASmallerFilmIsAveraged) {
    store("a", 1);
    store("b", 2);
    EXPECT_EQ(load_reference(request(4)).description.at("reduced_by"), 2);
    EXPECT_EQ(error_code(request(3), "not a multiple of the film size"), ExitCode::bad_input);
    EXPECT_EQ(error_code(request(16), "not a multiple of the film size"), ExitCode::bad_input);
}

TEST_F(StoredReferences, AMissingHalfNamesTheCommand) {
    EXPECT_EQ(error_code(request(), "rtrays-reference box.json"), ExitCode::reference_missing);
    EXPECT_EQ(error_code(request(), "box.embree.a.exr"), ExitCode::reference_missing);
    EXPECT_EQ(error_code(request(), "box.embree.b.exr"), ExitCode::reference_missing);
    store("a", 1);
    EXPECT_EQ(
        error_code(request(), "box.embree.b.exr --engine embree --spp 64 --size 8x8 --seed 2"),
        ExitCode::reference_missing);
}

TEST_F(StoredReferences, CommandsQuoteWhatAShellWouldSplit) {
    ReferenceRequest wanted = request();
    wanted.scene_path = "my scenes/it's.json";
    EXPECT_EQ(error_code(wanted, R"(rtrays-reference 'my scenes/it'\''s.json' -o )"),
              ExitCode::reference_missing);
}

TEST_F(StoredReferences, WrongSceneSeedAndDamageAreRefused) {
    store("a", 1);
    store("b", 1);
    EXPECT_EQ(error_code(request(), "not independent"), ExitCode::bad_input);
    store("b", 2, 32);
    EXPECT_EQ(error_code(request(), "spp"), ExitCode::bad_input);
    store("b", 2);
    EXPECT_EQ(error_code(request(8, "fff"), "another version of the scene"),
              ExitCode::reference_missing);
    EXPECT_EQ(error_code(request(8, "fff"), "box.embree.b.exr --engine"),
              ExitCode::reference_missing)
        << "commands for both halves";
    write_exr(noise_image(8, 8, 3), folder_ / "box.embree.b.exr");
    EXPECT_EQ(error_code(request(), "SHA-256"), ExitCode::bad_input);
}

TEST_F(StoredReferences, CompareHasTheKeysOfRuns) {
    write_exr(noise_image(8, 8, 1), folder_ / "a.exr");
    write_exr(noise_image(8, 8, 2), folder_ / "b.exr");
    const auto comparison = compare_images(folder_ / "a.exr", folder_ / "b.exr");
    for (const char *key : {"l2", "rmse", "mae", "relmse", "mse"}) {
        EXPECT_GT(comparison.at(key).get<double>(), 0) << key;
    }
    EXPECT_TRUE(comparison.at("agreement").at("agrees"));
    EXPECT_NE(comparison_text(comparison).find("rmse"), std::string::npos);
    EXPECT_EQ(compare_images(folder_ / "a.exr", folder_ / "a.exr").at("l2"), 0.0);
}

TEST(ArrayFile, HasNumPysLayout) {
    Image image = Image::rgb(2, 1);
    image.channel("R") = {1, 4};
    image.channel("G") = {2, 5};
    image.channel("B") = {3, 6};
    const fs::path path = fs::path(testing::TempDir()) / "array.npy";
    write_array(image, path);
    const std::string bytes = read_file(path);
    EXPECT_EQ(bytes.substr(0, 8), std::string("\x93NUMPY\x01\x00", 8));
    const size_t header =
        10 + static_cast<unsigned char>(bytes[8]) + 256u * static_cast<unsigned char>(bytes[9]);
    EXPECT_EQ(header % 64, 0u);
    EXPECT_NE(bytes.find("'shape': (1, 2, 3)"), std::string::npos);
    ASSERT_EQ(bytes.size(), header + 6 * sizeof(float));
    float values[6];
    std::memcpy(values, bytes.data() + header, sizeof values);
    for (int i = 0; i < 6; ++i) {
        EXPECT_EQ(values[i], static_cast<float>(i + 1));
    }
}

}  // namespace
}  // namespace rtrays
