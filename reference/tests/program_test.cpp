// SPDX-License-Identifier: MIT
// The program rtrays-reference: command line, interruption, resumption and refused input.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include "reference/checkpoint.h"
#include "reference/manifest.h"
#include "renderer/base/error.h"
#include "renderer/base/files.h"
#include "renderer/base/image.h"

namespace rtrays::reference {
namespace {

namespace fs = std::filesystem;

const std::string cornell_box = RTRAYS_SCENES "/cornell_box/scene.json";
const std::string furnace = RTRAYS_SCENES "/analytic/furnace_050.json";

/// A running `rtrays-reference` with its output in a file.
class Process {
  public:
    Process(const std::vector<std::string> &arguments, const fs::path &log) {
        std::vector<std::string> words{RTRAYS_REFERENCE_PROGRAM};
        words.insert(words.end(), arguments.begin(), arguments.end());
        std::vector<char *> argv;
        for (std::string &word : words) {
            argv.push_back(word.data());
        }
        argv.push_back(nullptr);
        pid_ = fork();
        if (pid_ == 0) {
            const int file = open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
            dup2(file, STDOUT_FILENO);
            dup2(file, STDERR_FILENO);
            execv(argv[0], argv.data());
            _exit(126);
        }
    }

    void send(int signal) const { kill(pid_, signal); }

    /// Waits for the program. Returns its exit code, or minus the number of the signal that ended
    /// it.
    int wait() {
        int status = 0;
        waitpid(pid_, &status, 0);
        return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
    }

  private:
    pid_t pid_;
};

class Program : public testing::Test {
  protected:
    void SetUp() override {
        const auto *test = testing::UnitTest::GetInstance()->current_test_info();
        folder_ = fs::path(testing::TempDir()) / (std::string("reference_program_") + test->name());
        fs::remove_all(folder_);
        fs::create_directories(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }

    std::string in_folder(const std::string &name) const { return (folder_ / name).string(); }
    fs::path log() const { return folder_ / "log"; }

    int run(const std::vector<std::string> &arguments) { return Process(arguments, log()).wait(); }

    /// Runs the program. Expects exit code 2 and a message of one line that contains `text`.
    void expect_refused(const std::vector<std::string> &arguments, const std::string &text) {
        EXPECT_EQ(run(arguments), static_cast<int>(ExitCode::bad_input));
        const std::string message = read_file(log());
        EXPECT_NE(message.find(text), std::string::npos) << message;
        EXPECT_EQ(std::count(message.begin(), message.end(), '\n'), 1) << message;
    }

    std::vector<std::string> long_render(const std::string &output) const {
        return {cornell_box,
                "-o",
                in_folder(output),
                "--spp",
                "1024",
                "--size",
                "64x64",
                "--seed",
                "5",
                "--quiet",
                "--checkpoint-interval",
                "0"};
    }

    /// Waits until the state holds more samples than `before`. Returns the end of its samples.
    uint64_t wait_for_progress(const std::string &state, uint64_t before) const {
        for (int i = 0; i < 20000; ++i) {
            if (fs::exists(state)) {
                const uint64_t done = load_checkpoint(state).film.count();
                if (done > before) {
                    return done;
                }
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(3));
        }
        ADD_FAILURE() << "no progress in a minute";
        return before;
    }

    /// Expects images that are equal bit by bit, except for the render time.
    static void expect_same_image(const std::string &path_a, const std::string &path_b) {
        Image a = read_exr(path_a), b = read_exr(path_b);
        ASSERT_EQ(a.channels().size(), 7u);
        ASSERT_EQ(b.channels().size(), 7u);
        for (const auto &channel : a.channels()) {
            EXPECT_EQ(channel.values, b.channel(channel.name)) << channel.name;
        }
        a.attributes().erase("renderTimeSeconds");
        b.attributes().erase("renderTimeSeconds");
        EXPECT_EQ(a.attributes(), b.attributes());
    }

    fs::path folder_;
};

TEST_F(Program, killed_and_resumed_equals_uninterrupted) {
    ASSERT_EQ(run(long_render("whole.exr")), 0) << read_file(log());

    auto arguments = long_render("killed.exr");
    arguments.push_back("--resume");
    const std::string state = in_folder("killed.exr.state");
    uint64_t done = 0;
    for (const int delay : {0, 11, 37}) {
        Process process(arguments, log());
        done = wait_for_progress(state, done);
        // The kill falls somewhere within a batch or a save.
        std::this_thread::sleep_for(std::chrono::milliseconds(delay));
        process.send(SIGKILL);
        ASSERT_EQ(process.wait(), -SIGKILL);
        EXPECT_FALSE(fs::exists(in_folder("killed.exr")));
        done = load_checkpoint(state).film.count();
        ASSERT_LT(done, 1024u);
    }
    arguments.insert(arguments.end(), {"--threads", "1"});  // the rest uses one thread
    ASSERT_EQ(run(arguments), 0) << read_file(log());
    expect_same_image(in_folder("whole.exr"), in_folder("killed.exr"));
    for (const float samples : read_exr(in_folder("killed.exr")).channel("samples")) {
        ASSERT_EQ(samples, 1024.0f);
    }
}

TEST_F(Program, terminated_leaves_a_state_that_continues) {
    ASSERT_EQ(run(long_render("whole.exr")), 0) << read_file(log());
    auto arguments = long_render("cut.exr");
    for (const int signal : {SIGTERM, SIGINT}) {
        Process process(arguments, log());
        wait_for_progress(
            in_folder("cut.exr.state"),
            signal == SIGINT ? load_checkpoint(in_folder("cut.exr.state")).film.count() : 0);
        process.send(signal);
        EXPECT_EQ(process.wait(), static_cast<int>(ExitCode::interrupted));
        EXPECT_NE(read_file(log()).find("--resume"), std::string::npos);
        EXPECT_FALSE(fs::exists(in_folder("cut.exr")));
        if (signal == SIGTERM) {
            // A typing error must not overwrite hours of work.
            expect_refused(arguments, "unfinished run");
            arguments.push_back("--resume");
        }
    }
    ASSERT_EQ(run(arguments), 0) << read_file(log());
    expect_same_image(in_folder("whole.exr"), in_folder("cut.exr"));
}

TEST_F(Program, extends_a_finished_run) {
    const std::vector<std::string> common{furnace, "--size", "16x16", "--quiet", "--resume"};
    const auto render = [&](const std::string &output, const std::string &spp) {
        auto arguments = common;
        arguments.insert(arguments.end(), {"-o", in_folder(output), "--spp", spp});
        return run(arguments);
    };
    ASSERT_EQ(render("grown.exr", "20"), 0) << read_file(log());
    ASSERT_EQ(render("grown.exr", "20"), 0) << read_file(log());  // nothing left to do
    ASSERT_EQ(render("grown.exr", "50"), 0) << read_file(log());
    ASSERT_EQ(render("whole.exr", "50"), 0) << read_file(log());
    expect_same_image(in_folder("whole.exr"), in_folder("grown.exr"));
    EXPECT_EQ(render("grown.exr", "30"), 2);  // samples cannot be removed
}

TEST_F(Program, sample_ranges_are_disjoint_parts_of_one_run) {
    const auto render = [&](const std::string &output, const std::string &range) {
        ASSERT_EQ(
            run({furnace, "-o", in_folder(output), "--samples", range, "--size", "8x8", "--quiet"}),
            0);
    };
    render("low.exr", "0:16");
    render("high.exr", "16:32");
    render("all.exr", "0:32");
    const auto low = read_exr(in_folder("low.exr")).channel("R");
    const auto high = read_exr(in_folder("high.exr")).channel("R");
    const auto all = read_exr(in_folder("all.exr")).channel("R");
    for (size_t i = 0; i < all.size(); ++i) {
        EXPECT_NEAR(0.5f * (low[i] + high[i]), all[i], 1e-6f * all[i]);
    }
}

TEST_F(Program, merges_ranges_to_the_bits_of_one_run) {
    const auto render = [&](const std::string &name, const std::string &range) {
        return run({cornell_box, "-o", in_folder(name + ".exr"), "--samples", range, "--size",
                    "12x8", "--state", in_folder(name), "--quiet"});
    };
    for (const auto &[name, range] :
         {std::pair("whole", "0:40"), {"one", "0:7"}, {"two", "25:40"}, {"three", "7:25"}}) {
        ASSERT_EQ(render(name, range), 0) << read_file(log());
    }
    const std::string merged = in_folder("cornell_box.embree.a.exr"), state = in_folder("merged"),
                      manifest = in_folder("manifest.json");
    const auto parts = [&](std::vector<std::string> names, const std::vector<std::string> &more) {
        for (std::string &name : names) {
            name = in_folder(name);
        }
        names.insert(names.begin(), "merge");
        names.insert(names.end(), {"-o", merged});
        names.insert(names.end(), more.begin(), more.end());
        return names;
    };
    expect_refused(parts({"two", "one"}, {"--manifest", manifest}),
                   "the samples 0:7 25:40 are not one range");
    EXPECT_FALSE(fs::exists(merged));
    ASSERT_EQ(run(parts({"three", "one", "two"}, {"--state", state, "--manifest", manifest})), 0)
        << read_file(log());
    expect_same_image(in_folder("whole.exr"), merged);
    EXPECT_EQ(load_manifest(manifest).at("references").begin()->at("spp"), 40);
    ASSERT_EQ(run({cornell_box, "-o", in_folder("more.exr"), "--spp", "44", "--size", "12x8",
                   "--state", state, "--resume", "--quiet"}),
              0);
    ASSERT_EQ(render("whole44", "0:44"), 0);
    expect_same_image(in_folder("whole44.exr"), in_folder("more.exr"));

    expect_refused(parts({"one", "two", "one"}, {}), "samples 0:7 overlap 0:7");
    expect_refused(parts({"one"}, {"--state", state}), "--overwrite replaces it");
    ASSERT_EQ(run({cornell_box, "-o", in_folder("seed.exr"), "--samples", "40:41", "--size", "12x8",
                   "--state", in_folder("seed"), "--seed", "9", "--quiet"}),
              0);
    expect_refused(parts({"one", "seed"}, {}), "films differ in seed (1 and 9)");
}

/// A state with gaps is filled, as after a merge of some ranges.
TEST_F(Program, resumes_a_state_with_gaps) {
    const auto render = [&](const std::string &name, const std::vector<std::string> &more) {
        std::vector<std::string> arguments{cornell_box,     "-o",     in_folder(name + ".exr"),
                                           "--size",        "12x8",   "--state",
                                           in_folder(name), "--quiet"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return run(arguments);
    };
    ASSERT_EQ(render("whole", {"--spp", "20"}), 0);
    ASSERT_EQ(render("low", {"--samples", "2:5"}), 0);
    ASSERT_EQ(render("high", {"--samples", "11:14"}), 0);
    ASSERT_EQ(run({"merge", in_folder("low"), in_folder("high"), "-o", in_folder("x.exr"),
                   "--state", in_folder("gaps")}),
              0);
    EXPECT_EQ(render("gaps", {"--spp", "20"}), 2);  // unfinished
    ASSERT_EQ(render("gaps", {"--spp", "20", "--resume"}), 0) << read_file(log());
    expect_same_image(in_folder("whole.exr"), in_folder("gaps.exr"));
}

TEST_F(Program, renders_windows_of_the_picture) {
    const auto render = [&](const std::string &scene, const std::string &output,
                            std::vector<std::string> more) {
        more.insert(more.begin(), {scene, "-o", in_folder(output), "--spp", "8", "--quiet"});
        EXPECT_EQ(run(more), 0) << read_file(log());
        return read_exr(in_folder(output));
    };
    const Image full = render(cornell_box, "full.exr", {"--size", "16x12"});
    const auto expect_window = [&](const Image &part, size_t left, size_t top) {
        ASSERT_EQ(part.channels().size(), full.channels().size());
        for (const auto &channel : full.channels()) {
            for (size_t i = 0; i < part.pixel_count(); ++i) {
                const size_t x = i % static_cast<size_t>(part.width()),
                             y = i / static_cast<size_t>(part.width());
                ASSERT_EQ(part.channel(channel.name)[i], channel.values[16 * (y + top) + x + left])
                    << channel.name << " " << x << ", " << y;
            }
        }
    };
    const Image part = render(cornell_box, "part.exr", {"--size", "16x12", "--crop", "5,3,7x6"});
    ASSERT_EQ(part.width(), 7);
    ASSERT_EQ(part.height(), 6);
    expect_window(part, 5, 3);

    // The window of the scene, which the option replaces.
    Json json = load_json(cornell_box);
    json["film"] = {
        {"width", 16}, {"height", 12}, {"crop", {{"x", 1}, {"y", 2}, {"width", 4}, {"height", 3}}}};
    const std::string cropped = in_folder("cropped.json");
    write_file(cropped, json.dump());
    expect_window(render(cropped, "scene.exr", {}), 1, 2);
    expect_window(render(cropped, "other.exr", {"--crop", "0,11,16x1"}), 0, 11);
    const Image all = render(cropped, "all.exr", {"--crop", "none"});
    EXPECT_EQ(all.pixel_count(), full.pixel_count());
    expect_window(all, 0, 0);

    const std::string out = in_folder("x.exr");
    const auto refused = [&](const std::string &scene, std::vector<std::string> more,
                             const std::string &text) {
        more.insert(more.begin(), {scene, "-o", out, "--spp", "1"});
        expect_refused(more, text);
    };
    refused(cropped, {"--size", "8x8"}, "give --crop, too, or --crop none");
    refused(cropped, {"--crop", "13,0,4x4"}, "is not in the film of 16 x 12");
    refused(cropped, {"--crop", "0,0,0x4"}, "is not in the film of 16 x 12");
    refused(cropped, {"--crop", "1,2"}, "expected X,Y,WxH");
    refused(cropped, {"--crop", "4x4"}, "expected X,Y,WxH");
    refused(cropped, {"--manifest", in_folder("manifest.json")}, "SCENE.ENGINE.HALF.exr");
    refused(cropped, {"--engine", "mitsuba"}, "a crop of the film excludes");
}

TEST_F(Program, refuses_the_state_of_other_settings) {
    const std::string out = in_folder("a.exr");
    ASSERT_EQ(run({furnace, "-o", out, "--spp", "8", "--size", "8x8", "--quiet"}), 0)
        << read_file(log());
    const std::string before = read_file(out);
    const auto refused = [&](const std::string &scene, std::vector<std::string> more,
                             const std::string &text) {
        more.insert(more.begin(), {scene, "-o", out, "--spp", "8", "--resume", "--quiet"});
        expect_refused(more, text);
    };
    refused(cornell_box, {"--size", "8x8"}, "scene");
    refused(furnace, {"--size", "8x9"}, "height = 8, this run requests 9");
    refused(furnace, {"--size", "8x8", "--seed", "2"}, "seed = 1, this run requests 2");
    refused(furnace, {"--size", "8x8", "--max-depth", "2"}, "max_depth");
    refused(furnace, {"--size", "8x8", "--strategies", "implicit"}, "strategies");
    refused(furnace, {"--size", "8x9", "--crop", "0,0,8x8"}, "crop = null, this run requests [0,");
    EXPECT_EQ(read_file(out), before);
    fs::remove(out + ".state");
    ASSERT_EQ(run({furnace, "-o", out, "--spp", "8", "--size", "8x9", "--crop", "0,1,8x8"}), 0);
    refused(furnace, {"--size", "8x8"}, "crop = [0,1,8,9], this run requests null");
    const std::string window = read_file(out);
    write_file(out + ".state", "nonsense");
    refused(furnace, {"--size", "8x8"}, "not a state file");
    EXPECT_EQ(read_file(out), window);
}

TEST_F(Program, adds_a_complete_manifest_entry) {
    const std::string image = in_folder("furnace_050.embree.a.exr"),
                      manifest = in_folder("manifest.json");
    ASSERT_EQ(run({furnace, "-o", image, "--spp", "8", "--size", "8x8", "--seed", "3", "--quiet",
                   "--manifest", manifest, "--stats", in_folder("stats.json")}),
              0)
        << read_file(log());
    const Json entry = load_manifest(manifest).at("references").at("furnace_050.embree.a.exr");
    EXPECT_EQ(entry.at("sha256"), sha256_of(image));
    EXPECT_EQ(entry.at("seed"), 3);
    EXPECT_EQ(entry.at("spp"), 8);
    const Image exr = read_exr(image);
    EXPECT_EQ(std::get<std::string>(exr.attributes().at("rtrays:sceneHash")),
              entry.at("scene_hash"));
    EXPECT_EQ(std::get<std::string>(exr.attributes().at("rtrays:engine")),
              entry.at("engine_version"));
    EXPECT_EQ(std::get<int>(exr.attributes().at("samplesPerPixel")), 8);
    const Json stats = load_json(in_folder("stats.json"));
    EXPECT_EQ(stats.at("rays").at("camera"), 8 * 8 * 8);
    EXPECT_GT(stats.at("samples_per_second"), 0.0);
    // A listed image is not rendered again, unless more samples are requested or the file has
    // changed.
    const auto again = [&](const std::string &spp) {
        fs::remove(image + ".state");
        EXPECT_EQ(run({furnace, "-o", image, "--spp", spp, "--size", "8x8", "--seed", "3",
                       "--quiet", "--manifest", manifest, "--skip-if-listed"}),
                  0);
        return fs::exists(image + ".state");
    };
    EXPECT_FALSE(again("8"));
    // More samples continue from the image, because its state is gone.
    const std::string whole = in_folder("whole.exr");
    ASSERT_EQ(run({furnace, "-o", whole, "--spp", "20", "--size", "8x8", "--seed", "3", "--quiet"}),
              0);
    ASSERT_EQ(run({furnace, "-o", image, "--spp", "20", "--size", "8x8", "--seed", "3", "--quiet",
                   "--manifest", manifest, "--resume", "--stats", in_folder("stats.json")}),
              0);
    EXPECT_EQ(load_json(in_folder("stats.json")).at("rays").at("camera"), 8 * 8 * 12);
    EXPECT_EQ(load_manifest(manifest).at("references").at("furnace_050.embree.a.exr").at("spp"),
              20);
    const Image grown = read_exr(image), uninterrupted = read_exr(whole);
    for (const auto &[channel, tolerance] :
         {std::pair("R", 1e-6f), std::pair("B", 1e-6f), std::pair("variance.G", 1e-5f)}) {
        for (size_t i = 0; i < 64; ++i) {
            const float expected = uninterrupted.channel(channel)[i];
            EXPECT_NEAR(grown.channel(channel)[i], expected, tolerance * expected)
                << channel << ' ' << i;
        }
    }
    EXPECT_TRUE(again("21"));
    EXPECT_FALSE(again("21"));
    write_file(image, "damaged");
    EXPECT_TRUE(again("9"));
    const auto refused = [&](const std::string &output, const std::string &text) {
        expect_refused({furnace, "-o", in_folder(output), "--spp", "1", "--manifest", manifest},
                       text);
    };
    refused("x.exr", "SCENE.ENGINE.HALF.exr");
    refused("furnace_050.cycles.a.exr", "does not match engine embree");
    fs::create_directory(folder_ / "elsewhere");
    refused("elsewhere/furnace_050.embree.a.exr", "in the folder of its manifest");
}

TEST_F(Program, refuses_bad_usage_with_code_2_and_one_line) {
    const std::string out = in_folder("x.exr");
    expect_refused({furnace, "-o", out}, "--spp or --samples is required");
    expect_refused({furnace, "-o", out, "--spp", "0"}, "--spp");
    expect_refused({furnace, "-o", out, "--spp", "many"}, "--spp");
    expect_refused({furnace, "-o", out, "--spp", "1", "--samples", "0:1"}, "--samples");
    expect_refused({furnace, "-o", out, "--samples", "4:4"}, "BEGIN < END");
    expect_refused({furnace, "-o", out, "--spp", "1", "--size", "8"}, "WIDTHxHEIGHT");
    expect_refused({furnace, "-o", out, "--spp", "1", "--size", "8x-8"}, "WIDTHxHEIGHT");
    expect_refused({furnace, "-o", out, "--spp", "1", "--strategies", "naive"},
                   "implicit, explicit, mis");
    expect_refused({furnace, "-o", out, "--spp", "1", "--checkpoint-interval", "601"},
                   "--checkpoint-interval");
    expect_refused({furnace, "-o", out, "--spp", "1", "--denoise"}, "--denoise");
    expect_refused({furnace, "-o", in_folder("missing/x.exr"), "--spp", "1"}, "cannot be written");
    expect_refused({in_folder("missing.json"), "-o", out, "--spp", "1"}, "missing.json");
    EXPECT_FALSE(fs::exists(out));
    EXPECT_FALSE(fs::exists(out + ".state"));
    EXPECT_EQ(run({"--help"}), 0);
    EXPECT_NE(read_file(log()).find("--resume"), std::string::npos);
    EXPECT_EQ(run({"--version"}), 0);
}

/// Tests the other renderers if they are installed: an extended reference, its manifest entry, and
/// its image against Embree's.
TEST_F(Program, other_engines_go_on_from_their_state) {
    ASSERT_EQ(run({cornell_box, "-o", in_folder("cornell_box.embree.a.exr"), "--spp", "512",
                   "--size", "16x16", "--quiet"}),
              0);
    const Image reference = read_exr(in_folder("cornell_box.embree.a.exr"));
    size_t installed = 0;
    for (const std::string engine : {"mitsuba", "cycles"}) {
        const std::string image = in_folder("cornell_box." + engine + ".a.exr"),
                          manifest = in_folder("manifest.json");
        const auto render = [&](const std::string &spp) {
            return run({cornell_box, "-o", image, "--engine", engine, "--spp", spp, "--size",
                        "16x16", "--resume", "--manifest", manifest, "--quiet"});
        };
        if (const int code = render("500"); code == static_cast<int>(ExitCode::skipped)) {
            EXPECT_NE(read_file(log()).find("scripts/install --peers"), std::string::npos);
            continue;
        } else {
            ASSERT_EQ(code, 0) << read_file(log());
        }
        ++installed;
        EXPECT_EQ(manifest_entry(manifest, image).at("spp"), 512);  // full steps
        ASSERT_EQ(render("1024"), 0) << read_file(log());
        EXPECT_EQ(manifest_entry(manifest, image).at("spp"), 1024);
        EXPECT_FALSE(fs::exists(image + ".state.scene"));
        const Image made = read_exr(image);
        double sum = 0, expected = 0;
        for (const std::string &name : rgb_names()) {
            for (size_t i = 0; i < made.pixel_count(); ++i) {
                sum += static_cast<double>(made.channel(name)[i]);
                expected += static_cast<double>(reference.channel(name)[i]);
                EXPECT_GE(made.channel("variance." + name)[i], 0.0f);
            }
        }
        EXPECT_NEAR(sum / expected, 1.0, 0.05) << engine;
        EXPECT_EQ(made.channel("samples")[0], 1024.0f);
    }
    if (installed == 0) {
        GTEST_SKIP() << "neither Mitsuba nor Blender is installed";
    }
}

}  // namespace
}  // namespace rtrays::reference
