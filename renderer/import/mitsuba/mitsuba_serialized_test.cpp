// SPDX-License-Identifier: MIT
// Tests the reader of Mitsuba's serialized meshes. Expected values are those of Mitsuba 3.9.
#include <zlib.h>

#include <cstring>

#include "renderer/base/error.h"
#include "renderer/import/mitsuba/serialized.h"
#include "renderer/testing/errors.h"
#include "renderer/testing/mitsuba_scenes.h"
#include "renderer/testing/temporary_folder.h"

namespace rtrays {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

template <typename T>
void append(std::string &bytes, T value) {
    bytes.append(reinterpret_cast<const char *>(&value), sizeof(T));
}

/// The content of one mesh: a square of two triangles, unless changed.
struct TestMesh {
    uint32_t flags =
        0x1000;  // 0x1000 float, 0x2000 double, 1 normals, 2 texture coordinates, 8 colours
    std::vector<double> positions = {0, 0, 0, 1, 0, 0, 1, 1, 0.5, 0, 1, 0};
    std::vector<double> others;  ///< normals, texture coordinates, colours
    std::vector<uint32_t> indices = {0, 1, 2, 0, 2, 3};
    std::string extra;  ///< bytes after the triangles

    std::string bytes(uint16_t version) const {
        std::string raw;
        append(raw, flags);
        raw += version == 4 ? std::string("square\0", 7) : std::string();
        append(raw, uint64_t{positions.size() / 3});
        append(raw, uint64_t{indices.size() / 3});
        for (const auto *numbers : {&positions, &others}) {
            for (const double number : *numbers) {
                if ((flags & 0x2000) != 0) {
                    append(raw, number);
                } else {
                    append(raw, static_cast<float>(number));
                }
            }
        }
        for (const uint32_t index : indices) {
            append(raw, index);
        }
        raw += extra;
        std::string packed(compressBound(raw.size()), '\0');
        uLongf size = packed.size();
        compress(reinterpret_cast<Bytef *>(packed.data()), &size,
                 reinterpret_cast<const Bytef *>(raw.data()), raw.size());
        std::string mesh;
        append(mesh, uint16_t{0x041c});
        append(mesh, version);
        return mesh + packed.substr(0, size);
    }
};

std::string file_of(uint16_t version, const std::vector<TestMesh> &meshes) {
    std::string bytes, table;
    for (const TestMesh &mesh : meshes) {
        if (version == 4) {
            append(table, uint64_t{bytes.size()});
        } else {
            append(table, static_cast<uint32_t>(bytes.size()));
        }
        bytes += mesh.bytes(version);
    }
    append(table, static_cast<uint32_t>(meshes.size()));
    return bytes + table;
}

MeshCore::Geometry parse(const std::string &bytes, size_t index = 0) {
    ModelNotes notes("in");
    return mitsuba::parse_serialized(bytes, index, "in", notes);
}

TestMesh with_everything(uint32_t precision) {
    TestMesh mesh;
    mesh.flags = precision | 0x1 | 0x2 | 0x8;
    mesh.others = {0, 0, 1, 0, 0, 1, 0, 0,    1, 0, 0, 1,   // normals
                   0, 0, 1, 0, 1, 1, 0, 0.25,               // texture coordinates
                   1, 0, 0, 1, 0, 0, 1, 0,    0, 1, 0, 0};  // colours
    return mesh;
}

TEST(MitsubaSerialized, BothVersionsAndPrecisions) {
    for (const uint16_t version : {uint16_t{3}, uint16_t{4}}) {
        for (const uint32_t precision : {0x1000u, 0x2000u}) {
            TestMesh moved;
            moved.flags = precision;
            moved.positions[0] = 0.1;
            const std::string bytes = file_of(version, {moved, with_everything(precision), moved});
            EXPECT_NEAR(parse(bytes, 0).vertices[0][0], 0.1, precision == 0x2000u ? 0 : 1e-8);
            EXPECT_TRUE(parse(bytes, 2).normals.empty());
            const MeshCore::Geometry mesh = parse(bytes, 1);
            EXPECT_EQ(mesh.vertices[2], Vector3d(1, 1, 0.5));
            EXPECT_EQ(mesh.normals, std::vector<Vector3d>(4, Vector3d(0, 0, 1)));
            EXPECT_EQ(mesh.uvs[3], Vector2d(0, 0.25));
            EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}}));
            expect_input_error("in: shape_index 3 is out of range; the file has 3 meshes",
                               [&] { parse(bytes, 3); });
        }
    }
}

TEST(MitsubaSerialized, ShapesAreReadAsInMitsuba) {
    const TemporaryFolder folder;
    const std::string path =
        folder.write("two.serialized", file_of(4, {TestMesh(), with_everything(0x1000)})).string();
    const auto shape = [&](const std::string &properties) {
        return parse_elements("<shape type=\"serialized\"><string name=\"filename\" value=\"" +
                              path + "\"/>" + properties + "</shape>");
    };
    // Without stored normals, Mitsuba computes them.
    const Scene smooth = shape("");
    const Eigen::Vector3f corner(-0.23570228f, -0.23570228f, 0.9428091f);
    EXPECT_LT((smooth.meshes().normal[0] - corner).norm(), 1e-6f);
    EXPECT_TRUE(shape("<boolean name=\"face_normals\" value=\"true\"/>").meshes().normal.empty());
    const Scene second = shape("<integer name=\"shape_index\" value=\"1\"/>");
    EXPECT_EQ(second.meshes().normal[0], Eigen::Vector3f(0, 0, 1));
    EXPECT_EQ(second.meshes().uv[3], Eigen::Vector2f(0, 0.25f));
    expect_input_error(
        "in.xml:4: <integer name=\"shape_index\">: expected an integer from 0, got 0.5",
        [&] { shape("\n<integer name=\"shape_index\" value=\"0.5\"/>"); });
}

TEST(MitsubaSerialized, DamageIsAnErrorThatNamesTheByte) {
    const std::string good = file_of(4, {TestMesh(), with_everything(0x2000)});
    expect_input_error("in: the file ends at byte 1, before the value at byte 0",
                       [] { parse("\x1c"); });
    expect_input_error("in: byte 0: expected a mesh of version 3 or 4, got the bytes",
                       [&] { parse("ply\n" + good); });
    const auto changed = [&](size_t at, const std::string &bytes) {
        std::string copy = good;
        return copy.replace(at, bytes.size(), bytes);
    };
    expect_input_error("the file is too short for 4294967295 meshes",
                       [&] { parse(changed(good.size() - 4, "\xff\xff\xff\xff")); });
    const std::string bad_offset("\xff\xff\xff\0\0\0\0\0", 8);
    expect_input_error("the mesh cannot begin at byte 16777215",
                       [&] { parse(changed(good.size() - 20, bad_offset)); });
    expect_input_error("in: byte 6: damaged data", [&] { parse(changed(4, "\xff\xff")); });

    TestMesh mesh;
    mesh.extra = "more";
    expect_input_error("data are left over after the triangles",
                       [&] { parse(file_of(3, {mesh})); });
    mesh.extra.clear();
    mesh.indices[3] = 4;
    expect_input_error("triangle 1 refers to vertex 4, but there are only 4 vertices",
                       [&] { parse(file_of(3, {mesh})); });
    mesh.flags = 0x3000;
    expect_input_error("byte 4: flags 0x3000: expected either single or double precision",
                       [&] { parse(file_of(3, {mesh})); });
    mesh = with_everything(0x1000);
    mesh.others.pop_back();
    expect_input_error("the data of the mesh end too early", [&] { parse(file_of(3, {mesh})); });
}

TEST(MitsubaSerialized, AnyChangeOfAByteLoadsOrIsAnError) {
    const std::string good = file_of(4, {with_everything(0x1000)});
    size_t loaded = 0;
    for (size_t at = 0; at < good.size(); ++at) {
        for (const char flip : {'\x01', '\x80', '\xff'}) {
            std::string bytes = good;
            bytes[at] = static_cast<char>(bytes[at] ^ flip);
            try {
                parse(bytes);
                ++loaded;
            } catch (const Error &error) {
                EXPECT_EQ(error.exit_code(), ExitCode::bad_input) << error.what();
            }
        }
    }
    EXPECT_LT(loaded, 20u);  // the checksum covers all but the table and headers
    for (size_t size = 0; size < good.size(); ++size) {
        EXPECT_THROW(parse(good.substr(0, size)), Error);
    }
}

}  // namespace
}  // namespace rtrays
