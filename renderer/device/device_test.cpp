// SPDX-License-Identifier: MIT
// Tests the OpenCL layer: include resolver, program cache, argument checks and device selection.
#include <unistd.h>

#include <cstdlib>
#include <filesystem>

#include "renderer/base/files.h"
#include "renderer/device/kernel.h"
#include "renderer/testing/errors.h"

namespace rtrays {
namespace {

namespace fs = std::filesystem;

TEST(Source, ExpandsIncludesOnceWithLineDirectives) {
    const SourceOverlays files = {
        {"kernels/a.cl", "#include \"b.h\"\n#include \"kernels/b.h\"\nint a;\n"},
        {"kernels/b.h", "#pragma once\nint b;\n"}};
    EXPECT_EQ(
        expand_source({"kernels/a.cl"}, files),
        "#line 1 \"kernels/a.cl\"\n#line 1 \"kernels/b.h\"\n\nint b;\n#line 2 \"kernels/a.cl\"\n"
        "#line 3 \"kernels/a.cl\"\nint a;\n");
    EXPECT_EQ(source_place("#define X 1\n" + expand_source({"kernels/a.cl"}, files), 5),
              "kernels/b.h:2");
    EXPECT_EQ(source_place("#define X 1\n" + expand_source({"kernels/a.cl"}, files), 8),
              "kernels/a.cl:3");
    EXPECT_EQ(source_place("#define X 1\n", 1), "defines:1");
}

TEST(Source, ResolvesRelativeToTheIncludingFileFirst) {
    const SourceOverlays files = {
        {"kernels/x/a.cl", "#include \"b.h\"\n"}, {"kernels/x/b.h", "near\n"}, {"b.h", "far\n"}};
    const std::string text = expand_source({"kernels/x/a.cl"}, files);
    EXPECT_NE(text.find("near"), std::string::npos);
    EXPECT_EQ(text.find("far"), std::string::npos);
}

TEST(Source, NamesFileAndLineOfAMissingInclude) {
    const SourceOverlays files = {{"kernels/a.cl", "\n#include \"nowhere.h\"\n"}};
    EXPECT_NE(
        expand_source({"kernels/a.cl"}, files).find("#error kernels/a.cl:2: include \"nowhere.h\""),
        std::string::npos);
    expect_run_error("'kernels/none.cl' does not exist",
                     [] { expand_source({"kernels/none.cl"}); });
    expect_run_error("'kernels/none.cl' does not exist", [] { device_source("kernels/none.cl"); });
}

TEST(Source, CutsCycles) {
    const SourceOverlays files = {{"a.h", "#include \"b.h\"\nx\n"},
                                  {"b.h", "#include \"a.h\"\ny\n"}};
    EXPECT_EQ(expand_source({"a.h"}, files),
              "#line 1 \"a.h\"\n#line 1 \"b.h\"\n#line 2 \"b.h\"\ny\n#line 2 \"a.h\"\nx\n");
}

/// Fixture that gives every test its own device and cache directory.
class Device : public testing::Test {
  protected:
    Device()
        : directory_(fs::temp_directory_path() /
                     fs::path("rtrays_cache_" + std::to_string(getpid()))) {
        fs::create_directories(directory_);
        setenv("RTRAYS_CACHE_DIR", directory_.c_str(), 1);
    }
    ~Device() override { fs::remove_all(directory_); }

    static SourceOverlays kernel_source(const std::string &body) {
        return {{"kernels/test.cl",
                 "__kernel void test(__global uint *values, uint count, float factor) {\n" + body +
                     "\n}\n"}};
    }

    fs::path binary() const {
        for (const auto &entry : fs::directory_iterator(directory_)) {
            if (entry.path().extension() == ".clbin") {
                return entry.path();
            }
        }
        return {};
    }

    DeviceContext device_{"", Binaries::keep};
    fs::path directory_;
    const std::string body_ =
        "if (get_global_id(0) < count) values[get_global_id(0)] += (uint)(factor * FACTOR);";
};

TEST_F(Device, RunsAKernelWithCheckedArguments) {
    const Program program(device_, {"kernels/test.cl"}, {{"FACTOR", "2"}}, kernel_source(body_));
    Kernel kernel(program, "test", 8);
    Buffer<uint32_t> values(device_, "values", std::vector<uint32_t>{1, 2, 3, 4, 5});
    kernel.bind({values, 5u, 3.0f});
    kernel.enqueue(5);
    device_.finish();
    EXPECT_EQ(values.read(), (std::vector<uint32_t>{7, 8, 9, 10, 11}));
    EXPECT_EQ(device_.profiler().stages().at("test").launches, 1u);

    expect_run_error("expected 3 arguments, got 2", [&] { kernel.bind({values, 5u}); });
    expect_run_error("argument 1 of kernel 'test': expected 'uint', got 'float'", [&] {
        kernel.bind({values, 5.0f, 3.0f});
    });
    expect_run_error("expected an argument index below 3, got 3", [&] { kernel.bind(3, 1.0f); });
    const Buffer<float> wrong(device_, "wrong", 5);
    expect_run_error("expected 'uint*', got 'float*'", [&] { kernel.bind({wrong, 5u, 3.0f}); });
    expect_run_error("buffer 'values': expected 5 items, got 4", [&] {
        values.write({1, 2, 3, 4});
    });
    expect_run_error("creating kernel 'none'", [&] { Kernel(program, "none", 8); });
}

TEST_F(Device, CachesProgramsByContent) {
    const auto build = [&](const std::string &factor, const std::string &body) {
        DeviceContext later("", Binaries::keep);
        return Program(later, {"kernels/test.cl"}, {{"FACTOR", factor}}, kernel_source(body))
            .from_cache();
    };
    EXPECT_FALSE(build("2", body_));
    EXPECT_TRUE(build("2", body_));
    EXPECT_FALSE(build("3", body_)) << "a define changed";
    EXPECT_FALSE(build("2", body_ + " ")) << "the source changed";
}

TEST_F(Device, KeepsTheProgramsThatItUsedLast) {
    DeviceContext device;
    const auto is_kept = [&](uint32_t factor) {
        return Program(device, {"kernels/test.cl"}, {{"FACTOR", std::to_string(factor)}},
                       kernel_source(body_))
            .from_cache();
    };
    EXPECT_FALSE(is_kept(0));
    EXPECT_TRUE(is_kept(0));
    for (uint32_t factor = 1; factor < 32; ++factor) {
        EXPECT_FALSE(is_kept(factor));
        EXPECT_TRUE(is_kept(0)) << "used after " << factor << " others";
    }
    EXPECT_FALSE(is_kept(32));
    EXPECT_FALSE(is_kept(1)) << "the one used longest ago made room";
    EXPECT_TRUE(is_kept(0));
}

TEST_F(Device, RebuildsADamagedCacheFile) {
    const auto from_cache = [&] {
        DeviceContext later("", Binaries::keep);
        return Program(later, {"kernels/test.cl"}, {{"FACTOR", "2"}}, kernel_source(body_))
            .from_cache();
    };
    EXPECT_FALSE(from_cache());
    std::string content = read_file(binary());
    content[content.size() / 2] = static_cast<char>(content[content.size() / 2] + 1);
    write_file(binary(), content);
    EXPECT_FALSE(from_cache()) << "wrong checksum";
    EXPECT_TRUE(from_cache());
    write_file(binary(), content_hash("no program") + "no program");
    EXPECT_FALSE(from_cache()) << "right checksum, but no program";
    write_file(binary(), "");
    EXPECT_FALSE(from_cache()) << "empty";
}

TEST_F(Device, WorksWithoutAWritableCache) {
    setenv("RTRAYS_CACHE_DIR", "/proc/nowhere", 1);
    EXPECT_FALSE(Program(device_, {"kernels/test.cl"}, {{"FACTOR", "2"}}, kernel_source(body_))
                     .from_cache());
}

TEST_F(Device, KeepsNoBinaryWhereNoneIsWanted) {
    const auto build = [&](DeviceContext &device) {
        return Program(device, {"kernels/test.cl"}, {{"FACTOR", "2"}}, kernel_source(body_));
    };
    DeviceContext leaving;
    EXPECT_EQ(build(leaving).binary_bytes(), 0u);
    EXPECT_EQ(binary(), fs::path());
    EXPECT_GT(build(device_).binary_bytes(), 0u);
    EXPECT_TRUE(build(leaving).from_cache())
        << "a program cached by another context must be loaded";
}

TEST_F(Device, ShowsTheBuildLogWithTheRealFileName) {
    const std::string message = error_of(ExitCode::run_failed, [&] {
        Program(device_, {"kernels/test.cl"}, {{"FACTOR", "2"}},
                kernel_source("\n  undeclared = 1;"));
    });
    EXPECT_NE(message.find("kernels/test.cl:3"), std::string::npos) << message;
    EXPECT_NE(message.find("undeclared"), std::string::npos) << message;
}

TEST_F(Device, NamesTheDevicesWhenNoneMatches) {
    const std::string message =
        error_of(ExitCode::bad_input, [] { DeviceContext("no such device"); });
    EXPECT_NE(message.find("'no such device'"), std::string::npos);
    EXPECT_NE(message.find(device_.info().name), std::string::npos);
}

TEST_F(Device, RefusesABufferBeyondTheDevice) {
    expect_run_error("buffer 'huge': needs",
                     [&] { Buffer<uint64_t>(device_, "huge", size_t{1} << 50); });
}

}  // namespace
}  // namespace rtrays
