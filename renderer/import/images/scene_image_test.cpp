// SPDX-License-Identifier: MIT
// Tests the import of image files. A damaged file must be an error, never a crash or a wrong
// texture.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>

#include "renderer/base/files.h"
#include "renderer/base/image.h"
#include "renderer/import/images/texture_file.h"
#include "renderer/import/json/scene_json.h"
#include "renderer/testing/scene_builder.h"

#ifdef __SANITIZE_ADDRESS__
#include <sanitizer/lsan_interface.h>
#endif

namespace rtrays {
namespace {

/// Ignores leaks of OpenImageIO's PNG reader. On an error, it uses longjmp and skips the
/// destructors of its strings, which leaks a few bytes.
struct IgnoreLeaksOfDamagedFiles {
#ifdef __SANITIZE_ADDRESS__
    __lsan::ScopedDisabler disabler;
#endif
};

class ImageFiles : public WithImages {};

using Bytes = std::vector<uint8_t>;
using Floats = std::vector<float>;

/// Writes a file with this content in the temporary folder and returns its path.
std::filesystem::path file(const std::string &name, const std::string &content) {
    const std::filesystem::path path = testing::TempDir() + name;
    std::ofstream(path, std::ios::binary) << content;
    return path;
}

std::string from_hex(const std::string &hex) {
    std::string bytes;
    for (size_t i = 0; i < hex.size(); i += 2) {
        bytes.push_back(static_cast<char>(std::stoi(hex.substr(i, 2), nullptr, 16)));
    }
    return bytes;
}

/// Returns a PNG of 2 x 1 texels with alpha: (10, 20, 30, 0) and (200, 100, 50, 255).
const std::string &png_with_alpha() {
    static const std::string png = from_hex(
        "89504e470d0a1a0a0000000d4948445200000002000000010806000000f4227f8a0000001149444154789c63e4"
        "129163d81720f21f0006b1025f15db4efc0000000049454e44ae426082");
    return png;
}

std::string pfm(const std::vector<float> &values) {
    return "PF\n" + std::to_string(values.size() / 3) + " 1\n-1.0\n" +
           std::string(reinterpret_cast<const char *>(values.data()),
                       values.size() * sizeof(float));
}

std::shared_ptr<const TextureImage> load(const std::filesystem::path &path,
                                         TextureEncoding encoding = TextureEncoding::linear) {
    return load_texture_file(path, encoding);
}

TEST_F(ImageFiles, EightBitsStayBytes) {
    const auto colours =
        load(file("c.ppm", "P6 2 1 255\n" + std::string("\x01\x02\x03\xfd\xfe\xff")),
             TextureEncoding::srgb);
    EXPECT_EQ(colours->bytes, (Bytes{1, 2, 3, 253, 254, 255}));
    EXPECT_TRUE(colours->srgb);
    EXPECT_TRUE(colours->floats.empty());
    EXPECT_EQ(load(file("g.pgm", "P5 1 2 255\n" + std::string("\x07\x08")))->bytes,
              (Bytes{7, 7, 7, 8, 8, 8}));
    const auto with_alpha = load(file("a.png", png_with_alpha()));
    EXPECT_EQ(with_alpha->bytes, (Bytes{10, 20, 30, 200, 100, 50}))
        << "alpha is dropped, not multiplied";
    EXPECT_FALSE(with_alpha->srgb);
    EXPECT_EQ(with_alpha->width, 2);
    EXPECT_EQ(with_alpha->height, 1);
}

TEST_F(ImageFiles, PalettesAndInksBecomeColours) {
    // A palette with (10, 20, 30) and (200, 100, 50), in the other order.
    const std::string palette =
        "89504e470d0a1a0a0000000d4948445200000002000000010803000000c3fc8fb800000006504c54450a141e"
        "c8643277a0b39c0000000b4944415478da63606400000005000242c2449f0000000049454e44ae426082";
    EXPECT_EQ(load(file("palette.png", from_hex(palette)))->bytes,
              (Bytes{200, 100, 50, 10, 20, 30}));
    // Grey with alpha.
    const std::string grey =
        "89504e470d0a1a0a0000000d49484452000000020000000108040000005e2bb7010000000d4944415478da63"
        "e06238f11f0002bc01d2e9e0ec590000000049454e44ae426082";
    const std::filesystem::path grey_file = file("grey.png", from_hex(grey));
    EXPECT_EQ(load(grey_file)->bytes, (Bytes{10, 10, 10, 200, 200, 200}));
    EXPECT_EQ(load(grey_file, TextureEncoding::alpha)->bytes, (Bytes{0, 0, 0, 255, 255, 255}));
    // A TIFF of the inks cyan, magenta, yellow and black: red and black.
    const std::string inks =
        "49492a00080000000a000001030001000000020000000101030001000000010000000201030004000000"
        "8600000003010300010000000100000006010300010000000500000011010400010000008e0000001501"
        "030001000000040000001601030001000000010000001701040001000000080000001c01030001000000"
        "0100000000000000080008000800080000ffff00000000ff";
    EXPECT_EQ(load(file("inks.tif", from_hex(inks)))->bytes, (Bytes{255, 0, 0, 0, 0, 0}));
}

TEST_F(ImageFiles, AlphaBecomesAGreyImage) {
    const std::filesystem::path with_alpha = file("a.png", png_with_alpha());
    const auto alpha = load(with_alpha, TextureEncoding::alpha);
    EXPECT_EQ(alpha->bytes, (Bytes{0, 0, 0, 255, 255, 255}));
    EXPECT_FALSE(alpha->srgb);
    EXPECT_TRUE(has_alpha_channel(with_alpha));
    const std::filesystem::path without =
        file("c.ppm", "P6 2 1 255\n" + std::string("\x01\x02\x03\xfd\xfe\xff"));
    EXPECT_FALSE(has_alpha_channel(without));
    expect_input_error("c.ppm: the image has no alpha channel",
                       [&] { load(without, TextureEncoding::alpha); });
    expect_input_error("cannot read as an image",
                       [] { has_alpha_channel(file("broken.png", "no image")); });
    TextureFiles files;
    EXPECT_NE(files.load(with_alpha, TextureEncoding::alpha),
              files.load(with_alpha, TextureEncoding::linear));
}

TEST_F(ImageFiles, EverythingElseBecomesLinearFloats) {
    EXPECT_EQ(load(file("f.pfm", pfm({0, 0.5f, 7e4f})))->floats, (Floats{0, 0.5f, 7e4f}));
    // 2 x 1 texels of one grey channel of 16 bits, 32768 and 65535.
    const auto sixteen =
        file("s.png", from_hex("89504e470d0a1a0a0000000d494844520000000200000001100000000081d9fc150"
                               "000000d49444154789c6368"
                               "60f8ff1f000502027f165ec4650000000049454e44ae426082"));
    const auto linear = load(sixteen);
    EXPECT_FLOAT_EQ(linear->floats[0], 32768.0f / 65535.0f);
    EXPECT_EQ(linear->floats[5], 1);
    const auto srgb = load(sixteen, TextureEncoding::srgb);
    EXPECT_NEAR(srgb->floats[2], std::pow((32768.0 / 65535 + 0.055) / 1.055, 2.4), 1e-7);
    EXPECT_EQ(srgb->floats[5], 1);
    EXPECT_FALSE(srgb->srgb) << "already decoded";

    // Radiance's RGBE format: mantissa / 256 * 2^(exponent - 128), rows from the top.
    const std::string header = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 1\n";
    const auto rgbe = load(file("r.hdr", header + from_hex("80402081"
                                                           "00000000")));
    EXPECT_EQ(rgbe->height, 2);
    EXPECT_NEAR(rgbe->floats[0], 1, 1.0 / 128);
    EXPECT_NEAR(rgbe->floats[2], 0.25, 1.0 / 128);
    EXPECT_EQ(rgbe->floats[3], 0);

    Image image(2, 1);
    image.add_channel("Z") = {9, 9};
    for (const std::string &name : rgb_names()) {
        image.add_channel(name) = {1.0f + static_cast<float>(name[0]), 2};
    }
    write_exr(image, testing::TempDir() + "layers.exr");
    EXPECT_EQ(load(testing::TempDir() + "layers.exr")->floats,
              (Floats{1 + 'R', 1 + 'G', 1 + 'B', 2, 2, 2}))
        << "channels are found by name, among any others";
}

TEST_F(ImageFiles, WhatIsNoTextureIsAnError) {
    [[maybe_unused]] const IgnoreLeaksOfDamagedFiles ignore;
    struct Case {
        std::string name;
        std::string content;
        std::string message;
    };
    const float nan = std::nanf("");
    for (const Case &c : std::vector<Case>{
             {"empty.png", "", "cannot read as an image: "},
             {"text.png", "hello", "cannot read as an image: Not a PNG file"},
             {"text.xyz", "hello", "cannot read as an image: "},
             {"zero.ppm", "P6 0 0 255\n", "unsupported image of 0 x 0 x 1 with 3 channels"},
             {"huge.ppm", "P6 100000 100000 255\n",
              "unsupported image of 100000 x 100000 x 1 with 3 channels"},
             {"cut.ppm", "P6 2 2 255\nabc", "damaged image: "},
             {"cut.png", png_with_alpha().substr(0, png_with_alpha().size() - 20),
              "damaged image: "},
             {"nan.pfm", pfm({1, 1, 1, 1, 1, nan}),
              "texel (1, 0) has the blue value nan; texels must be finite"},
             {"infinite.pfm", pfm({1, HUGE_VALF, 1}), "texel (0, 0) has the green value inf"},
             {"negative.pfm", pfm({-1, 0, 1}),
              "texel (0, 0) has the red value -1; texels must be finite and not negative"},
         }) {
        SCOPED_TRACE(c.name);
        const std::filesystem::path path = file(c.name, c.content);
        expect_input_error(path.string() + ": " + c.message, [&] { load(path); });
    }
    expect_input_error("nowhere.png: no such file",
                       [] { load(testing::TempDir() + "nowhere.png"); });
    expect_input_error(": no such file", [] { load(testing::TempDir()); });
    expect_input_error("floating-point images are linear; set \"encoding\" to \"linear\"", [] {
        load(file("f.pfm", pfm({0, 0, 0})), TextureEncoding::srgb);
    });
    Image image(1, 1);
    for (const char *name : {"X", "Y", "Z"}) {
        image.add_channel(name) = {1};
    }
    write_exr(image, testing::TempDir() + "xyz.exr");
    expect_input_error("unsupported channels X, Y, Z; expected R, G and B, or one grey channel",
                       [] { load(testing::TempDir() + "xyz.exr"); });
}

TEST_F(ImageFiles, ErrorsNameFileAndKeyOfTheScene) {
    const auto scene = [](const std::string &texture) {
        return R"({"version": 1, "film": {"width": 1, "height": 1}, "textures": {"wood":
)" + texture + R"(}, "nodes": []})";
    };
    const auto parse = [&](const std::string &texture) {
        parse_scene_json(scene(texture), "in.json", "in", testing::TempDir());
    };
    const std::string missing = testing::TempDir() + "nowhere.png: no such file";
    expect_input_error("in.json:2: /textures/wood/file: " + missing,
                       [&] { parse(R"({"file": "nowhere.png", "encoding": "srgb"})"); });
    expect_input_error("/textures/wood: a texture needs a file and its encoding",
                       [&] { parse(R"({"file": "nowhere.png"})"); });
    expect_input_error("\"gamma\" is not one of: srgb, linear",
                       [&] { parse(R"({"file": "nowhere.png", "encoding": "gamma"})"); });
    expect_input_error("uv_scale: [10000000, 1] is not within [-1000000, 1000000]", [&] {
        parse(R"({"file": "nowhere.png", "encoding": "srgb", "uv_scale": [1e7, 1]})");
    });
    expect_input_error(
        "in.json:2: /materials/m/reflectance_texture: unknown texture 'oak'; the scene defines: "
        "none",
        [] {
            parse_scene_json(
                "{\"version\": 1, \"film\": {\"width\": 1, \"height\": 1}, \"materials\": {\"m\":\n"
                R"({"type": "mirror", "reflectance": [1, 1, 1], "reflectance_texture": "oak"}}, "nodes": []})",
                "in.json", "in");
        });
    file("c.ppm", "P6 1 1 255\nabc");
    expect_input_error(
        "in.json:2: /nodes/0/light/file: file: an environment light needs a floating-point image "
        "(.hdr, .exr)",
        [] {
            parse_scene_json(
                R"({"version": 1, "film": {"width": 1, "height": 1}, "nodes": [{"name": "sky",
                             "light": {"type": "environment", "file": "c.ppm"}}]})",
                "in.json", "in", testing::TempDir());
        });
}

TEST_F(ImageFiles, EachIsLoadedOnce) {
    const std::filesystem::path path = file("once.ppm", "P6 1 1 255\nabc");
    TextureFiles files;
    const auto first = files.load(path, TextureEncoding::srgb);
    EXPECT_EQ(files.load(testing::TempDir() + "./once.ppm", TextureEncoding::srgb), first);
    EXPECT_NE(files.load(path, TextureEncoding::linear), first)
        << "another encoding gives other values";
    EXPECT_EQ(files.loaded(), 2u);
}

TEST_F(ImageFiles, TruncatedOrDamagedFilesLoadOrAreErrors) {
    [[maybe_unused]] const IgnoreLeaksOfDamagedFiles ignore;
    Image image = Image::rgb(16, 16);
    for (const std::string &name : rgb_names()) {
        for (size_t i = 0; i < 256; ++i) {
            image.channel(name)[i] = static_cast<float>(i * 7 % 256);
        }
    }
    write_exr(image, testing::TempDir() + "whole.exr");
    const std::string exr = read_file(testing::TempDir() + "whole.exr");
    std::string hdr = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 4 +X 4\n";
    for (int i = 0; i < 16; ++i) {
        hdr += from_hex("80402081");
    }
    std::minstd_rand random(3);
    int refused = 0;
    int loaded = 0;
    /// Loads an image. Returns nullptr after an error of bad input; other errors fail the test.
    const auto try_load = [&](const std::string &name,
                              const std::string &content) -> std::shared_ptr<const TextureImage> {
        try {
            const auto texture = load(file(name, content));
            const auto size =
                3 * static_cast<size_t>(texture->width) * static_cast<size_t>(texture->height);
            EXPECT_EQ(texture->bytes.size() + texture->floats.size(), size);
            ++loaded;
            return texture;
        } catch (const Error &error) {
            EXPECT_EQ(error.exit_code(), ExitCode::bad_input) << error.what();
            ++refused;
            return nullptr;
        }
    };
    for (const auto &[name, whole] : {std::pair<std::string, std::string>{"damaged.exr", exr},
                                      {"damaged.hdr", hdr},
                                      {"damaged.png", png_with_alpha()},
                                      {"damaged.ppm", "P6 2 2 255\nabcdefghijkl"}}) {
        SCOPED_TRACE(name);
        const auto intact = try_load(name, whole);
        ASSERT_NE(intact, nullptr);
        for (size_t size = 0; size < whole.size(); size += 1 + whole.size() / 100) {
            // A cut after the last texel may load, but must not change the image.
            if (const auto cut = try_load(name, whole.substr(0, size))) {
                EXPECT_EQ(cut->bytes, intact->bytes)
                    << "cut after " << size << " of " << whole.size() << " bytes";
                EXPECT_EQ(cut->floats, intact->floats)
                    << "cut after " << size << " of " << whole.size() << " bytes";
            }
        }
        for (int round = 0; round < 100; ++round) {
            std::string damaged = whole;
            damaged[random() % damaged.size()] = static_cast<char>(random() % 256);
            try_load(name, damaged);
        }
    }
    EXPECT_GT(loaded, 50) << "some damage must change only colours";
    EXPECT_GT(refused, 100);
}

}  // namespace
}  // namespace rtrays
