// SPDX-License-Identifier: MIT
// Tests renderer/base: files, images, hashes, errors and exit codes.
#include <sys/resource.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <iterator>
#include <limits>

#include "renderer/base/commit.h"
#include "renderer/base/files.h"
#include "renderer/base/image.h"
#include "renderer/base/named.h"
#include "renderer/base/process.h"
#include "renderer/base/progress.h"
#include "renderer/base/shell.h"
#include "renderer/base/suggestion.h"
#include "renderer/testing/errors.h"

namespace rtrays {
namespace {

namespace fs = std::filesystem;

/// Fixture that gives every test its own folder and deletes it afterwards.
class Files : public testing::Test {
  protected:
    Files() { fs::create_directory(folder_); }
    ~Files() override { fs::remove_all(folder_); }

    fs::path path(const std::string &name) const { return folder_ / name; }
    size_t file_count() const {
        return static_cast<size_t>(
            std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
    }

  private:
    fs::path folder_ =
        fs::temp_directory_path() / ("rtrays_" + std::to_string(getpid()) + "_" +
                                     testing::UnitTest::GetInstance()->current_test_info()->name());
};

using Images = Files;

/// Simulates a full disk: a write beyond `bytes` of a file fails.
class FullDisk {
  public:
    explicit FullDisk(rlim_t bytes) : previous_handler_(std::signal(SIGXFSZ, SIG_IGN)) {
        getrlimit(RLIMIT_FSIZE, &previous_);
        const rlimit limit{bytes, previous_.rlim_max};
        setrlimit(RLIMIT_FSIZE, &limit);
    }
    ~FullDisk() {
        setrlimit(RLIMIT_FSIZE, &previous_);
        std::signal(SIGXFSZ, previous_handler_);
    }

  private:
    rlimit previous_{};
    void (*previous_handler_)(int);
};

/// Returns an image with values that compress badly, including special values.
Image test_image(int width, int height) {
    Image image = Image::rgb(width, height);
    image.add_channel("samples");
    image.add_channel("variance.R");
    uint32_t state = 1;
    for (const Image::Channel &channel : image.channels()) {
        for (float &value : image.channel(channel.name)) {
            state = state * 1664525u + 1013904223u;
            value = static_cast<float>(state) * 1e-5f;
        }
    }
    image.channel("R")[0] = std::numeric_limits<float>::max();
    image.channel("G")[0] = -std::numeric_limits<float>::denorm_min();
    image.channel("B")[0] = std::numeric_limits<float>::infinity();
    return image;
}

TEST_F(Images, ExrKeepsEveryBitOfChannelsAndAttributes) {
    Image image = test_image(7, 5);
    image.attributes() = {{"samplesPerPixel", 12},
                          {"rtrays:seed", std::string("4294967295")},
                          {"renderTimeSeconds", 0.1},
                          {"rtrays:beta", 2.5f}};
    write_exr(image, path("a.exr"));
    const Image read = read_exr(path("a.exr"));
    ASSERT_EQ(read.width(), 7);
    ASSERT_EQ(read.height(), 5);
    ASSERT_EQ(read.channels().size(), image.channels().size());
    EXPECT_EQ(read.channels()[0].name, "R");
    EXPECT_EQ(read.channels()[2].name, "B");
    for (const Image::Channel &channel : image.channels()) {
        const std::vector<float> &values = read.channel(channel.name);
        EXPECT_EQ(std::memcmp(values.data(), channel.values.data(), values.size() * sizeof(float)),
                  0)
            << channel.name;
    }
    for (const auto &[name, value] : image.attributes()) {
        ASSERT_EQ(read.attributes().count(name), 1u) << name;
        EXPECT_EQ(read.attributes().at(name), value) << name;
    }
    EXPECT_EQ(file_count(), 1u);
}

TEST(RemainingTime, IgnoresTheFirstStepAndWhatWasComplete) {
    RemainingTime left;
    EXPECT_FALSE(left.until(100));
    left.update(10, 0.0);  // resumed
    left.update(10, 3.0);
    EXPECT_FALSE(left.until(100));
    left.update(12, 60.0);  // compiled kernels
    EXPECT_FALSE(left.until(100));
    left.update(14, 61.0);
    left.update(20, 64.0);
    EXPECT_DOUBLE_EQ(left.until(100).value(), 40.0);
    left.update(100, 104.0);
    EXPECT_DOUBLE_EQ(left.until(100).value(), 0.0);
}

TEST_F(Images, ExrKeepsTheDataWindow) {
    Image image = test_image(7, 5);
    image.move_to(-3, 40);
    write_exr(image, path("crop.exr"));
    const Image read = read_exr(path("crop.exr"));
    EXPECT_EQ(read.width(), 7);
    EXPECT_EQ(read.height(), 5);
    EXPECT_EQ(read.left(), -3);
    EXPECT_EQ(read.top(), 40);
    EXPECT_EQ(std::memcmp(read.channel("G").data(), image.channel("G").data(),
                          image.pixel_count() * sizeof(float)),
              0);
}

TEST_F(Images, ChannelsAreFoundByNameOnly) {
    Image image = Image::rgb(2, 2);
    expect_input_error("unknown channel 'A'; channels are: R, G, B", [&] { image.channel("A"); });
    expect_run_error("channel 'R' already exists", [&] { image.add_channel("R"); });
    EXPECT_EQ(rgb_names("variance"),
              (std::vector<std::string>{"variance.R", "variance.G", "variance.B"}));
}

TEST_F(Images, DamagedExrIsAnErrorThatNamesIt) {
    write_exr(test_image(16, 16), path("whole.exr"));
    const std::string whole = read_file(path("whole.exr"));
    for (size_t size = 0; size < whole.size(); size += size < 600 ? 11 : 197) {
        write_file(path("cut.exr"), whole.substr(0, size));
        expect_input_error("cut.exr", [&] { read_exr(path("cut.exr")); });
    }
    write_file(path("text.exr"), "not an image");
    expect_input_error("text.exr: cannot be read as an EXR image",
                       [&] { read_exr(path("text.exr")); });
    expect_input_error("none.exr: no such file", [&] { read_exr(path("none.exr")); });
    expect_input_error("cannot be read as an EXR image", [&] { read_exr(path(".")); });
}

TEST_F(Files, ReadAndWriteBytes) {
    const std::string bytes("a\0b\r\n\xff", 6);
    write_file(path("f"), bytes);
    EXPECT_EQ(read_file(path("f")), bytes);
    write_file(path("f"), "");
    EXPECT_EQ(read_file(path("f")), "");
    EXPECT_EQ(file_count(), 1u);
    expect_input_error("none: cannot be read: No such file", [&] { read_file(path("none")); });
    expect_input_error("is a directory", [&] { read_file(path(".")); });
    // The name exceeds the limit of the file system, so even a lookup fails.
    const fs::path unthinkable = path(std::string(5000, 'x'));
    expect_input_error("cannot be read: File name too long", [&] { read_file(unthinkable); });
    expect_input_error("cannot be written: File name too long",
                       [&] { require_writable(unthinkable); });
    expect_input_error("cannot be read as an EXR image", [&] { read_exr(unthinkable); });
}

TEST_F(Files, FailedWriteLeavesTheOldFileAndNothingElse) {
    write_file(path("f"), "old");
    expect_run_error("lost power", [&] {
        write_atomically(path("f"), [&](const fs::path &temporary) {
            write_file(temporary, "half");
            throw run_error("lost power");
        });
    });
    EXPECT_EQ(read_file(path("f")), "old");
    EXPECT_EQ(file_count(), 1u);
}

TEST_F(Files, FullDiskIsAnErrorAndLeavesTheOldFile) {
    write_file(path("f"), "old");
    write_exr(test_image(2, 2), path("f.exr"));
    const std::string old_exr = read_file(path("f.exr"));
    {
        const FullDisk disk(4096);
        expect_run_error("f: cannot be written: File too large",
                         [&] { write_file(path("f"), std::string(100000, 'x')); });
        expect_run_error("f.exr: cannot be written",
                         [&] { write_exr(test_image(64, 64), path("f.exr")); });
    }
    EXPECT_EQ(read_file(path("f")), "old");
    EXPECT_EQ(read_file(path("f.exr")), old_exr);
    EXPECT_EQ(file_count(), 2u);
}

TEST_F(Files, UnwritablePlacesAreFoundBeforeARun) {
    // The test does not use permissions, because it may run as root.
    for (const fs::path &place : {path("no/such/folder/out.exr"), fs::path("/proc/out.exr")}) {
        expect_input_error(place.string() + ": cannot be written",
                           [&] { require_writable(place); });
        expect_run_error(place.string(), [&] { write_file(place, "x"); });
        expect_run_error(place.string(), [&] { write_exr(test_image(2, 2), place); });
    }
    expect_input_error("is a directory", [&] { require_writable(path(".")); });
    write_file(path("f"), "old");
    require_writable(path("f"));
    require_writable(path("new"));
    EXPECT_EQ(read_file(path("f")), "old");
    EXPECT_EQ(file_count(), 1u);
}

TEST(ContentHash, IsXxh3Of128Bits) {
    // Published value of XXH128 for empty input and seed 0.
    EXPECT_EQ(content_hash(""), "99aa06d3014798d86001c324468d497f");
    EXPECT_NE(content_hash("a"), content_hash("b"));
    EXPECT_NE(content_hash(std::string("a\0", 2)), content_hash("a"));
}

TEST(Named, PrintsAndParsesEveryRow) {
    constexpr Named<int> table[] = {{3, "three"}, {1, "one"}};
    for (const auto &[value, name] : table) {
        EXPECT_STREQ(name_in(table, value), name);
        EXPECT_EQ(find_named(table, name), value);
    }
    EXPECT_EQ(find_named(table, "thre"), std::nullopt);
    EXPECT_EQ(find_named(table, ""), std::nullopt);
}

TEST(RunMain, TurnsErrorsIntoExitCodes) {
    EXPECT_EQ(run_main("p", [] { return ExitCode::ok; }), 0);
    EXPECT_EQ(run_main("p", []() -> ExitCode { throw input_error("bad"); }), 2);
    EXPECT_EQ(run_main("p", []() -> ExitCode { throw run_error("failed"); }), 1);
    EXPECT_EQ(run_main("p", []() -> ExitCode { throw std::runtime_error("other"); }), 1);
    EXPECT_EQ(run_main("p", []() -> ExitCode { throw std::bad_alloc(); }), 1);
}

TEST(Process, answers_line_by_line) {
    Process cat({"cat"});
    EXPECT_TRUE(cat.write("one\ntwo\n"));
    EXPECT_EQ(cat.read_line(), "one");
    EXPECT_EQ(cat.read_line(), "two");
}

TEST(Process, ends_with_its_exit_code) {
    Process shell({"sh", "-c", "echo $WORD; exit 5"}, {{"WORD", "told"}});
    EXPECT_EQ(shell.read_line(), "told");
    EXPECT_EQ(shell.read_line(), std::nullopt);
    EXPECT_EQ(shell.wait(), 5);
}

TEST(Process, is_found_before_it_starts) {
    for (const char *program : {"cat", "/bin/cat"}) {
        EXPECT_TRUE(program_exists(program)) << program;
    }
    for (const char *program :
         {"rtrays-no-such-program", "/bin/rtrays-no-such-program", "/bin", ""}) {
        EXPECT_FALSE(program_exists(program)) << program;
    }
}

TEST(Process, that_is_not_there_says_nothing) {
    Process nothing({"rtrays-no-such-program"});
    EXPECT_EQ(nothing.read_line(), std::nullopt);
    EXPECT_EQ(nothing.wait(), 127);
    EXPECT_FALSE(nothing.write("anyone?\n"));
}

TEST(Process, that_is_not_waited_for_is_stopped) {
    const auto start = std::chrono::steady_clock::now();
    { Process sleeper({"sleep", "60"}); }
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(30));
}

TEST(Commit, is_no_part_of_the_program_hash) {
    const std::string program = read_file("/proc/self/exe");
    EXPECT_NE(program.find(commit()), std::string::npos);
    EXPECT_NE(program_hash(), content_hash(program));
    std::string elsewhere = program;
    elsewhere.replace(elsewhere.find(commit()), commit().size(), commit().size(), '-');
    EXPECT_EQ(program_hash(), content_hash(elsewhere))
        << "the program must contain the commit exactly once";
}

TEST(Shell, QuotesWhatItWouldSplitOrExpand) {
    EXPECT_EQ(in_shell("scenes/box-1_2.json"), "scenes/box-1_2.json");
    EXPECT_EQ(in_shell("my scene.json"), "'my scene.json'");
    EXPECT_EQ(in_shell("it's $HOME"), R"('it'\''s $HOME')");
    EXPECT_EQ(in_shell(""), "''");
    EXPECT_TRUE(std::filesystem::exists(sibling_program("base_test")));
}

TEST(Suggestion, IsTheNearestName) {
    const std::vector<std::string> names = {"radius", "radiance", "max_depth", "spp"};
    EXPECT_EQ(suggestion("max_dept", names), "did you mean 'max_depth'? ");
    EXPECT_EQ(suggestion("radiuss", names), "did you mean 'radius'? ");
    EXPECT_EQ(suggestion("raidance", names), "did you mean 'radiance'? ");
    EXPECT_EQ(suggestion("colour", names), "");
    EXPECT_EQ(suggestion("sp", names), "") << "two of three letters say little";
    EXPECT_EQ(suggestion("", names), "");
    EXPECT_EQ(suggestion("x", {}), "");
}

}  // namespace
}  // namespace rtrays
