// SPDX-License-Identifier: MIT
#include "renderer/export/ply_file.h"

#include <fmt/format.h>

#include <string>

#include "renderer/base/files.h"

namespace rtrays {

namespace {

static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__,
              "bytes are written in the byte order of the machine");

template <typename T>
void append(std::string &bytes, const T *values, size_t count) {
    bytes.append(reinterpret_cast<const char *>(values), count * sizeof(T));
}

}  // namespace

void write_ply(const MeshArrays &meshes, uint32_t mesh, const std::filesystem::path &path,
               bool with_colours) {
    const uint32_t first_vertex = meshes.first_vertex[mesh];
    const uint32_t vertices = meshes.vertex_count[mesh];
    const uint32_t triangles = meshes.triangle_count[mesh];
    const bool has_normals = meshes.has_normals[mesh] != 0;
    const bool has_uv = meshes.has_uv[mesh] != 0;
    std::string bytes = fmt::format(
        "ply\nformat binary_little_endian 1.0\nelement vertex {}\n"
        "property float x\nproperty float y\nproperty float z\n{}{}{}"
        "element face {}\nproperty list uchar uint vertex_indices\nend_header\n",
        vertices, has_normals ? "property float nx\nproperty float ny\nproperty float nz\n" : "",
        has_uv ? "property float u\nproperty float v\n" : "",
        with_colours ? "property float r\nproperty float g\nproperty float b\n" : "", triangles);
    const size_t vertex_size =
        4 * (3 + (has_normals ? 3 : 0) + (has_uv ? 2 : 0) + (with_colours ? 3 : 0));
    bytes.reserve(bytes.size() + vertices * vertex_size + triangles * size_t{13});
    for (uint32_t i = first_vertex; i < first_vertex + vertices; ++i) {
        append(bytes, meshes.position[i].data(), 3);
        if (has_normals) {
            append(bytes, meshes.normal[i].data(), 3);
        }
        if (has_uv) {
            append(bytes, meshes.uv[i].data(), 2);
        }
        if (with_colours) {
            const Rgb colour = meshes.colour.empty() ? Rgb(Rgb::Ones()) : meshes.colour[i];
            append(bytes, colour.data(), 3);
        }
    }
    for (uint32_t i = 0; i < triangles; ++i) {
        bytes += '\x03';
        for (const uint32_t vertex : meshes.triangle[meshes.first_triangle[mesh] + i]) {
            const uint32_t index = vertex - first_vertex;
            append(bytes, &index, 1);
        }
    }
    write_file(path, bytes);
}

}  // namespace rtrays
