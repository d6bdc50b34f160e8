// SPDX-License-Identifier: MIT
#include "reference/checkpoint.h"

#include <gtest/gtest.h>

#include <cstring>

#include "reference/tests/test_scenes.h"
#include "renderer/base/error.h"
#include "renderer/base/files.h"

namespace rtrays::reference {
namespace {

namespace fs = std::filesystem;

class CheckpointFile : public testing::Test {
  protected:
    void SetUp() override {
        const auto *test = testing::UnitTest::GetInstance()->current_test_info();
        folder_ = fs::path(testing::TempDir()) / (std::string("checkpoint_") + test->name());
        fs::create_directories(folder_);
        path_ = folder_ / "film.state";
    }
    void TearDown() override { fs::remove_all(folder_); }

    /// Returns the message of the error that `action` throws.
    template <class Action>
    std::string error_of(const Action &action) {
        try {
            action();
        } catch (const Error &error) {
            EXPECT_EQ(error.exit_code(), ExitCode::bad_input);
            return error.what();
        }
        return "no error";
    }

    fs::path folder_, path_;
};

Checkpoint rendered_checkpoint() {
    const ReferenceSettings settings = small_settings(8, 1);
    auto renderer = cornell_like_box().renderer(settings);
    renderer.render(0, 5);
    return {make_config("box", "abc123", settings, "embree 3.13.5"),
            renderer.film(),
            {0, 20},
            1.25,
            {"c0ffee", "beef"}};
}

TEST_F(CheckpointFile, comes_back_bit_by_bit) {
    const Checkpoint saved = rendered_checkpoint();
    save_checkpoint(saved, path_);
    const Checkpoint loaded = load_checkpoint(path_);
    EXPECT_EQ(loaded.config, saved.config);
    EXPECT_EQ(loaded.film.ranges, (SampleRanges{{0, 5}}));
    EXPECT_EQ(loaded.wanted, (SampleRange{0, 20}));
    EXPECT_FALSE(loaded.finished());
    EXPECT_EQ(loaded.seconds, 1.25);
    EXPECT_EQ(loaded.commits, saved.commits);
    ASSERT_EQ(loaded.film.pixels.size(), saved.film.pixels.size());
    EXPECT_EQ(
        std::memcmp(loaded.film.pixels.data(), saved.film.pixels.data(), 64 * sizeof(PixelSums)),
        0);
}

TEST_F(CheckpointFile, is_refused_when_any_byte_is_damaged) {
    save_checkpoint(rendered_checkpoint(), path_);
    const std::string good = read_file(path_);
    for (size_t i = 0; i < good.size(); i += 37) {
        std::string bad = good;
        bad[i] = static_cast<char>(bad[i] ^ 0x10);
        write_file(path_, bad);
        EXPECT_THROW(load_checkpoint(path_), Error) << "byte " << i;
    }
    for (const size_t length :
         {size_t{0}, size_t{7}, size_t{40}, good.size() / 2, good.size() - 1}) {
        write_file(path_, good.substr(0, length));
        EXPECT_THROW(load_checkpoint(path_), Error) << "length " << length;
    }
}

TEST_F(CheckpointFile, names_what_differs) {
    const Checkpoint checkpoint = rendered_checkpoint();
    ReferenceSettings settings = small_settings(8, 1);
    const auto message = [&](const std::string &scene_hash) {
        const Json config = make_config("box", scene_hash, settings, "embree 3.13.5");
        return error_of([&] { require_continues(checkpoint, config, {0, 20}, path_); });
    };
    EXPECT_EQ(message("abc123"), "no error");
    EXPECT_NE(message("def456").find("scene_hash = \"abc123\", this run requests \"def456\""),
              std::string::npos);
    settings.seed = 2;
    EXPECT_NE(message("abc123").find("seed = 1, this run requests 2"), std::string::npos);
    settings = small_settings(8, 1, Strategies::implicit_only);
    EXPECT_NE(message("abc123").find("strategies = \"mis\""), std::string::npos);
    settings = small_settings(9, 1);
    EXPECT_NE(message("abc123").find("height = 8"), std::string::npos);
    settings = small_settings(8, 1);
    settings.max_depth = 3;
    EXPECT_NE(message("abc123").find("max_depth = 0"), std::string::npos);
    settings.max_depth = 0;
    settings.threads = 7;  // changes no bit, so the number is not compared
    EXPECT_EQ(message("abc123"), "no error");
}

TEST_F(CheckpointFile, may_be_extended_but_not_cut) {
    const Checkpoint checkpoint = rendered_checkpoint();
    const auto message = [&](uint64_t begin, uint64_t end) {
        return error_of([&] {
            require_continues(checkpoint, checkpoint.config, {begin, end}, path_);
        });
    };
    EXPECT_EQ(message(0, 1000), "no error");
    EXPECT_EQ(message(0, 5), "no error");
    EXPECT_NE(message(0, 4).find("holds the samples 0:5"), std::string::npos);
    EXPECT_NE(message(1, 9).find("holds the samples 0:5"), std::string::npos);
}

TEST(MergedCheckpoint, has_the_bits_of_one_render) {
    const ReferenceSettings settings = small_settings(8, 1);
    const TestScene scene = cornell_like_box();
    const Json config = make_config("box", "abc123", settings, "embree 3.13.5");
    const auto part = [&](uint64_t begin, uint64_t end, const std::string &commit) {
        auto renderer = scene.renderer(settings);
        renderer.render(begin, end);
        return Checkpoint{config, renderer.film(), {begin, end}, 0.5, {commit}};
    };
    Checkpoint merged = part(7, 12, "b");
    merge_checkpoint(merged, part(0, 3, "a"));
    EXPECT_FALSE(merged.finished());
    merge_checkpoint(merged, part(3, 7, "b"));
    const Checkpoint whole = part(0, 12, "a");
    EXPECT_TRUE(merged.finished());
    EXPECT_EQ(merged.film.ranges, whole.film.ranges);
    EXPECT_EQ(
        std::memcmp(merged.film.pixels.data(), whole.film.pixels.data(), 64 * sizeof(PixelSums)),
        0);
    EXPECT_EQ(merged.seconds, 1.5);
    EXPECT_EQ(merged.commits, (std::vector<std::string>{"b", "a"}));
    EXPECT_THROW(merge_checkpoint(merged, part(11, 13, "a")), Error);
    Checkpoint other = part(12, 13, "a");
    other.config["seed"] = 2;
    try {
        merge_checkpoint(merged, other);
        FAIL() << "another seed was merged";
    } catch (const Error &error) {
        EXPECT_EQ(error.what(), std::string("films differ in seed (1 and 2) and cannot be merged"));
    }
    EXPECT_EQ(merged.film.ranges, whole.film.ranges);
}

}  // namespace
}  // namespace rtrays::reference
