// SPDX-License-Identifier: MIT
#include "renderer/import/mitsuba/serialized.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cstring>

#include "renderer/base/error.h"
#include "renderer/base/files.h"
#include "renderer/import/models/geometry.h"

namespace rtrays::mitsuba {

namespace {

static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "values are copied from little endian");

constexpr uint16_t magic = 0x041c;

// Flags of a mesh.
constexpr uint32_t has_normals = 0x1, has_uv = 0x2, has_colours = 0x8;
constexpr uint32_t single_precision = 0x1000, double_precision = 0x2000;

/// Returns the value at byte `at`. Throws if the file ends before.
template <typename T>
T value_at(const std::string &bytes, size_t at) {
    if (at > bytes.size() || sizeof(T) > bytes.size() - at) {
        throw input_error(
            fmt::format("the file ends at byte {}, before the value at byte {}", bytes.size(), at));
    }
    T value;
    std::memcpy(&value, bytes.data() + at, sizeof(T));
    return value;
}

/// The compressed data of one mesh.
class Inflated {
  public:
    /// The data are the bytes from `begin` to `end` of the file.
    Inflated(const std::string &bytes, size_t begin, size_t end) : begin_(begin), end_(end) {
        stream_.next_in =
            reinterpret_cast<Bytef *>(const_cast<char *>(bytes.data())) + begin;  // only read
        stream_.avail_in = static_cast<uInt>(std::min<size_t>(end - begin, ~uInt{0}));
        if (inflateInit(&stream_) != Z_OK) {
            throw run_error("zlib cannot begin to decompress");
        }
    }
    ~Inflated() { inflateEnd(&stream_); }
    Inflated(const Inflated &) = delete;
    Inflated &operator=(const Inflated &) = delete;

    template <typename T>
    T value() {
        T value;
        read(&value, sizeof(T));
        return value;
    }

    /// Returns `count` values. Memory grows with the data, not with the stated count.
    template <typename T>
    std::vector<T> values(uint64_t count) {
        constexpr uint64_t most = 1 << 16;
        std::vector<T> all;
        while (all.size() < count) {
            const size_t first = all.size();
            all.resize(first + static_cast<size_t>(std::min(count - first, most)));
            read(all.data() + first, (all.size() - first) * sizeof(T));
        }
        return all;
    }

    /// Throws unless the data end here and have the right checksum.
    void finish() {
        char more;
        stream_.next_out = reinterpret_cast<Bytef *>(&more);
        stream_.avail_out = 1;
        const int result = inflate(&stream_, Z_NO_FLUSH);
        if (result != Z_STREAM_END || stream_.avail_out == 0) {
            fail(stream_.avail_out == 0 ? "data are left over after the triangles"
                                        : reason(result));
        }
    }

  private:
    void read(void *to, size_t size) {
        auto *next = static_cast<Bytef *>(to);
        while (size > 0) {
            const auto wanted = static_cast<uInt>(std::min<size_t>(size, 1 << 30));
            stream_.next_out = next;
            stream_.avail_out = wanted;
            const int result = inflate(&stream_, Z_NO_FLUSH);
            const uInt read = wanted - stream_.avail_out;
            next += read;
            size -= read;
            if (size > 0 && result != Z_OK) {
                fail(reason(result));
            }
        }
    }
    std::string reason(int result) const {
        return result == Z_STREAM_END || result == Z_BUF_ERROR
                   ? "the data of the mesh end too early"
                   : fmt::format("damaged data ({})",
                                 stream_.msg != nullptr ? stream_.msg : "no reason known");
    }
    [[noreturn]] void fail(const std::string &what) const {
        const size_t at = end_ - begin_ < stream_.avail_in ? begin_ : end_ - stream_.avail_in;
        throw input_error(fmt::format("byte {}: {}", at, what));
    }

    z_stream stream_{};
    size_t begin_, end_;
};

/// Returns `count` vectors of float or double numbers.
template <typename Vector>
std::vector<Vector> vectors(Inflated &data, uint64_t count, bool is_double) {
    constexpr auto size = static_cast<uint64_t>(Vector::SizeAtCompileTime);
    std::vector<double> numbers;
    if (is_double) {
        numbers = data.values<double>(size * count);
    } else {
        const std::vector<float> floats = data.values<float>(size * count);
        numbers.assign(floats.begin(), floats.end());
    }
    std::vector<Vector> result;
    result.reserve(static_cast<size_t>(count));
    for (size_t i = 0; i < numbers.size(); i += size) {
        result.push_back(Eigen::Map<const Vector>(numbers.data() + i));
    }
    return result;
}

/// The range of bytes of a mesh, without its header.
struct Part {
    size_t begin;
    size_t end;
    uint16_t version;
};

/// Finds a mesh by the table at the end of the file.
Part find_mesh(const std::string &bytes, size_t index) {
    const auto check_header = [&](size_t at) {
        const auto found = value_at<uint16_t>(bytes, at);
        const auto version = value_at<uint16_t>(bytes, at + 2);
        if (found != magic || (version != 3 && version != 4)) {
            throw input_error(
                fmt::format("byte {}: expected a mesh of version 3 or 4, got the bytes {:#06x}, {}",
                            at, found, version));
        }
        return version;
    };
    const uint16_t version = check_header(0);
    const size_t table_end = bytes.size() - 4;
    const auto count = value_at<uint32_t>(bytes, table_end);
    const size_t entry = version == 4 ? 8 : 4;
    if (count == 0 || count > table_end / entry) {
        throw input_error(
            fmt::format("byte {}: the file is too short for {} meshes", table_end, count));
    }
    if (index >= count) {
        throw input_error(
            fmt::format("shape_index {} is out of range; the file has {} meshes", index, count));
    }
    const size_t table = table_end - entry * count;
    const auto offset = [&](size_t i) {
        const size_t at = table + entry * i;
        const uint64_t value =
            version == 4 ? value_at<uint64_t>(bytes, at) : value_at<uint32_t>(bytes, at);
        if (value > table) {
            throw input_error(fmt::format("byte {}: the mesh cannot begin at byte {}", at, value));
        }
        return static_cast<size_t>(value);
    };
    const size_t header = offset(index);
    const uint16_t own_version = check_header(header);
    return {header + 4, table, own_version};
}

MeshCore::Geometry parse_mesh(const std::string &bytes, size_t index, const std::string &name,
                              ModelNotes &notes) {
    const Part part = find_mesh(bytes, index);
    if (part.begin > part.end) {
        throw input_error(fmt::format("byte {}: the mesh has no data", part.begin));
    }
    Inflated data(bytes, part.begin, part.end);
    const auto flags = data.value<uint32_t>();
    const bool is_double = (flags & double_precision) != 0;
    if (is_double == ((flags & single_precision) != 0)) {
        throw input_error(fmt::format(
            "byte {}: flags {:#x}: expected either single or double precision", part.begin, flags));
    }
    while (part.version == 4 && data.value<char>() != 0) {  // the name of the mesh
    }
    const auto vertices = data.value<uint64_t>(), triangles = data.value<uint64_t>();
    if (vertices >= no_index || triangles >= no_index) {
        throw input_error(fmt::format("byte {}: {} vertices and {} triangles are too many",
                                      part.begin, vertices, triangles));
    }
    MeshCore::Geometry geometry;
    geometry.vertices = vectors<Eigen::Vector3d>(data, vertices, is_double);
    if ((flags & has_normals) != 0) {
        geometry.normals = vectors<Eigen::Vector3d>(data, vertices, is_double);
    }
    if ((flags & has_uv) != 0) {
        geometry.uvs = vectors<Eigen::Vector2d>(data, vertices, is_double);
    }
    if ((flags & has_colours) != 0) {
        vectors<Eigen::Vector3d>(data, vertices, is_double);
        notes.add("vertex colours are ignored", name);
    }
    geometry.triangles = data.values<Triangle>(triangles);
    data.finish();
    for (size_t i = 0; i < geometry.triangles.size(); ++i) {
        for (const uint32_t vertex : geometry.triangles[i]) {
            if (vertex >= vertices) {
                throw input_error(
                    fmt::format("triangle {} refers to vertex {}, but there are only {} vertices",
                                i, vertex, vertices));
            }
        }
    }
    return geometry;
}

}  // namespace

MeshCore::Geometry parse_serialized(const std::string &bytes, size_t index, const std::string &name,
                                    ModelNotes &notes) {
    try {
        MeshCore::Geometry geometry = parse_mesh(bytes, index, name, notes);
        repair_normals(geometry, name, notes);
        return geometry;
    } catch (const Error &error) {
        throw Error(error.exit_code(), fmt::format("{}: {}", name, error.what()));
    }
}

MeshCore::Geometry read_serialized(const std::filesystem::path &path, size_t index) {
    ModelNotes notes(path.string());
    MeshCore::Geometry geometry = parse_serialized(read_file(path), index, path.string(), notes);
    notes.tell();
    return geometry;
}

}  // namespace rtrays::mitsuba
