// SPDX-License-Identifier: MIT
// Fuzz tests of the loaders with damaged inputs of every format. Each input must either load as a
// consistent scene or be an error of bad input. The sanitizers also detect accesses out of bounds
// and undefined behaviour. The inputs are files of the corpus, changed at random with a fixed seed.
#include <gtest/gtest.h>

#include <chrono>
#include <optional>
#include <random>

#include "renderer/base/notice.h"
#include "renderer/import/images/texture_file.h"
#include "renderer/import/load_scene.h"
#include "renderer/scene/graph.h"
#include "renderer/testing/errors.h"
#include "renderer/testing/scene_builder.h"
#include "renderer/testing/temporary_folder.h"

#ifdef __SANITIZE_ADDRESS__
#include <sanitizer/lsan_interface.h>
#endif

namespace rtrays {
namespace {

using Random = std::mt19937_64;

const std::filesystem::path corpus = RTRAYS_CORPUS;

/// Applies one to four changes that typically break parsers: flipped bits, bytes, cuts,
/// repetitions, and words that are too large, negative or not a number.
std::string damaged(std::string bytes, Random &random) {
    const auto below = [&](size_t n) { return n == 0 ? 0 : static_cast<size_t>(random() % n); };
    static const std::string words[] = {"999999999",
                                        "-1",
                                        "4294967295",
                                        "nan",
                                        "1e400",
                                        "0",
                                        {"\xff\xff\xff\x7f", 4},
                                        {"\xff\xff\xff\xff", 4},
                                        {"\0\0\0\0", 4},
                                        "{",
                                        "[",
                                        "<",
                                        "\"",
                                        "\n",
                                        "1e-400",
                                        "18446744073709551616"};
    const size_t changes = 1 + below(4);
    for (size_t i = 0; i < changes && !bytes.empty(); ++i) {
        const size_t at = below(bytes.size());
        switch (below(7)) {
            case 0:
                bytes[at] = static_cast<char>(random());
                break;
            case 1:
                bytes[at] = static_cast<char>(bytes[at] ^ (1 << below(8)));
                break;
            case 2:
                bytes.resize(at);
                break;
            case 3:
                bytes.erase(at, below(64));
                break;
            case 4:
                bytes.insert(at, bytes.substr(below(bytes.size()), below(64)));
                break;
            case 5:
                bytes.replace(at, below(8), words[below(std::size(words))]);
                break;
            case 6: {
                const size_t first = bytes.find_first_of("0123456789", at);
                if (first != std::string::npos) {
                    const size_t last =
                        std::min(bytes.find_first_not_of("0123456789", first), bytes.size());
                    bytes.replace(first, last - first,
                                  std::to_string(static_cast<int64_t>(random()) >> below(64)));
                }
                break;
            }
        }
    }
    return bytes;
}

/// Number of damaged files that loaded, and number that were refused.
struct Outcome {
    int read = 0;
    int refused = 0;
};

/// Runs `load` on damaged versions of a file, which are written to `folder` under the file's name.
template <typename Load>
Outcome fuzz(const TemporaryFolder &folder, const std::string &name, int count, const Load &load) {
    const std::string whole = bytes_of(corpus / name);
    EXPECT_FALSE(whole.empty()) << name;
    Random random(20130501);
    Outcome outcome;
    for (int i = 0; i < count; ++i) {
        const std::string content = damaged(whole, random);
        folder.write(name, content);
        const NoticeReceiver silence([](const std::string &) {});
        const auto start = std::chrono::steady_clock::now();
        try {
            load();
            ++outcome.read;
        } catch (const Error &error) {
            ++outcome.refused;
            EXPECT_EQ(error.exit_code(), ExitCode::bad_input)
                << name << " " << i << ": " << error.what();
            EXPECT_STRNE(error.what(), "");
        } catch (const std::exception &error) {
            ADD_FAILURE() << name << " " << i
                          << ": expected an rtrays::Error, got: " << error.what();
        }
        const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
        EXPECT_LT(seconds.count(), 10) << name << " " << i;
    }
    folder.write(name, whole);
    EXPECT_GT(outcome.refused, count / 20) << name << ": too few files are damaged";
    return outcome;
}

/// Copies the corpus into one folder, because its files reference one another.
struct FuzzInputs : WithImages {
    FuzzInputs() {
        for (const auto &entry : std::filesystem::directory_iterator(corpus)) {
            std::filesystem::copy(entry.path(), folder.path());
        }
    }

    /// Damages `name` and loads `scene`.
    void fuzz_scene(const std::string &name, const std::string &scene, int count) {
        const auto load = [&] {
            Scene loaded = load_scene((folder.path() / scene).string());
            expect_consistent(loaded.graph());
        };
        ASSERT_NO_THROW(load()) << scene;  // undamaged
        fuzz(folder, name, count, load);
    }

    TemporaryFolder folder;
};

TEST_F(FuzzInputs, SceneJson) {
    fuzz_scene("scene.json", "scene.json", 500);
}
TEST_F(FuzzInputs, PlyAscii) {
    fuzz_scene("square.ply", "square.ply", 300);
    fuzz_scene("painted.ply", "painted.ply", 200);
}
TEST_F(FuzzInputs, PlyBinary) {
    fuzz_scene("square_little.ply", "square_little.ply", 200);
    fuzz_scene("square_big.ply", "square_big.ply", 200);
}
TEST_F(FuzzInputs, Obj) {
    fuzz_scene("materials.obj", "materials.obj", 100);
}
TEST_F(FuzzInputs, Mtl) {
    fuzz_scene("materials.mtl", "materials.obj", 100);
}
#if RTRAYS_MODELS
TEST_F(FuzzInputs, Stl) {
    fuzz_scene("triangle.stl", "triangle.stl", 150);
}
TEST_F(FuzzInputs, Gltf) {
    fuzz_scene("triangles.gltf", "triangles.gltf", 150);
}
TEST_F(FuzzInputs, Collada) {
    fuzz_scene("plane.dae", "plane.dae", 150);
}
#endif
TEST_F(FuzzInputs, Images) {
#ifdef __SANITIZE_ADDRESS__
    const __lsan::ScopedDisabler libpng_leaves_by_longjmp;
#endif
    for (const char *name : {"checker.png", "sky.hdr"}) {
        const TextureEncoding encoding =
            std::string(name) == "sky.hdr" ? TextureEncoding::linear : TextureEncoding::srgb;
        fuzz(folder, name, 150, [&] { load_texture_file(folder.path() / name, encoding); });
    }
}

/// Loads every beginning of a file, as a full disk or a broken download leaves it.
TEST_F(FuzzInputs, TruncatedPly) {
    for (const char *name : {"square.ply", "square_little.ply", "painted.ply"}) {
        const std::string whole = bytes_of(corpus / name);
        for (size_t size = 0; size + 3 < whole.size(); ++size) {  // cuts at least the last number
            const auto path = folder.write("cut.ply", whole.substr(0, size));
            error_of(ExitCode::bad_input, [&] { load_scene(path.string()); });
        }
    }
}

}  // namespace
}  // namespace rtrays
