// SPDX-License-Identifier: MIT
#include "renderer/import/models/ply.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>

#include "renderer/base/error.h"
#include "renderer/base/files.h"
#include "renderer/base/progress.h"
#include "renderer/import/models/geometry.h"
#include "renderer/import/models/statements.h"
#include "renderer/scene/cores/texture.h"

namespace rtrays {

namespace {

enum class Scalar { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

struct ScalarName {
    const char *name;
    const char *other_name;
    Scalar scalar;
    size_t size;
};
constexpr ScalarName scalars[] = {
    {"char", "int8", Scalar::int8, 1},        {"uchar", "uint8", Scalar::uint8, 1},
    {"short", "int16", Scalar::int16, 2},     {"ushort", "uint16", Scalar::uint16, 2},
    {"int", "int32", Scalar::int32, 4},       {"uint", "uint32", Scalar::uint32, 4},
    {"float", "float32", Scalar::float32, 4}, {"double", "float64", Scalar::float64, 8},
};

struct PlyProperty {
    std::string name;
    Scalar scalar = Scalar::float32;
    std::optional<Scalar> list_count;  ///< type of the length of a list, empty for a scalar
};

struct PlyElement {
    std::string name;
    uint64_t count = 0;
    std::vector<PlyProperty> properties;
};

enum class Encoding { ascii, little_endian, big_endian };

struct PlyHeader {
    Encoding encoding = Encoding::ascii;
    std::vector<PlyElement> elements;
    size_t size = 0;  ///< offset of the data in bytes
};

Scalar scalar_of(const std::string &name) {
    for (const ScalarName &row : scalars) {
        if (name == row.name || name == row.other_name) {
            return row.scalar;
        }
    }
    throw input_error(
        fmt::format("header: unknown type '{}'; types are: char, uchar, short, "
                    "ushort, int, uint, float, double",
                    shown(name)));
}

/// Parses a line "property TYPE NAME" or "property list TYPE TYPE NAME" after its first word.
PlyProperty parse_property(std::istringstream &words) {
    PlyProperty property;
    std::string type;
    words >> type;
    if (type == "list") {
        words >> type;
        property.list_count = scalar_of(type);
        if (*property.list_count == Scalar::float32 || *property.list_count == Scalar::float64) {
            throw input_error("header: the length of a list must have an integer type");
        }
        words >> type;
    }
    property.scalar = scalar_of(type);
    if (!(words >> property.name)) {
        throw input_error("header: a property has no name");
    }
    return property;
}

PlyHeader parse_header(const std::string &content) {
    constexpr size_t longest = 1 << 16;
    PlyHeader header;
    bool has_format = false;
    size_t at = 0;
    for (size_t line_number = 1;; ++line_number) {
        const size_t end = content.find('\n', at);
        if (end == std::string::npos || end > longest) {
            throw input_error(line_number == 1 ? "is not a PLY file"
                                               : "header: missing end_header");
        }
        std::string line = content.substr(at, end - at);
        at = end + 1;
        if (!line.empty() && line.back() == '\r') {
            line.pop_back();
        }
        std::istringstream words(line);
        std::string keyword;
        words >> keyword;
        if (line_number == 1) {
            if (line != "ply") {
                throw input_error("is not a PLY file");
            }
        } else if (keyword == "format") {
            std::string format;
            words >> format;
            const std::string formats[] = {"ascii", "binary_little_endian", "binary_big_endian"};
            const auto *const found = std::find(std::begin(formats), std::end(formats), format);
            if (found == std::end(formats)) {
                throw input_error(
                    fmt::format("header: unknown format '{}'; formats are: ascii, "
                                "binary_little_endian, binary_big_endian",
                                shown(format)));
            }
            header.encoding = static_cast<Encoding>(found - std::begin(formats));
            has_format = true;
        } else if (keyword == "element") {
            PlyElement element;
            std::string count;
            words >> element.name >> count;
            const auto parsed =
                std::from_chars(count.data(), count.data() + count.size(), element.count);
            if (count.empty() || parsed.ec != std::errc() ||
                parsed.ptr != count.data() + count.size()) {
                throw input_error(
                    fmt::format("header: expected a number of elements, got '{}'", shown(count)));
            }
            for (const PlyElement &before : header.elements) {
                if (before.name == element.name) {
                    throw input_error(
                        fmt::format("header: duplicate element '{}'", shown(element.name)));
                }
            }
            header.elements.push_back(element);
        } else if (keyword == "property") {
            if (header.elements.empty()) {
                throw input_error("header: property before the first element");
            }
            std::vector<PlyProperty> &properties = header.elements.back().properties;
            properties.push_back(parse_property(words));
            for (size_t i = 0; i + 1 < properties.size(); ++i) {
                if (properties[i].name == properties.back().name) {
                    throw input_error(
                        fmt::format("header: duplicate property '{}'", shown(properties[i].name)));
                }
            }
        } else if (keyword == "end_header") {
            break;
        } else if (keyword != "comment" && keyword != "obj_info" && !keyword.empty()) {
            throw input_error(fmt::format("header: unknown keyword '{}'", shown(keyword)));
        }
    }
    if (!has_format) {
        throw input_error("header: missing format");
    }
    header.size = at;
    return header;
}

/// Reads the numbers of an ASCII file in sequence.
class AsciiData {
  public:
    explicit AsciiData(std::string_view data) : at_(data.data()), end_(data.data() + data.size()) {}

    double next(Scalar) {
        skip_blanks();
        at_ += at_ != end_ && *at_ == '+' ? 1 : 0;
        double value = 0;
        const auto parsed = std::from_chars(at_, end_, value);
        if (parsed.ec == std::errc::result_out_of_range) {
            // Too small numbers become zero. Too large ones become infinite, and the check of
            // vertices reports them.
            value = 0;
            const std::string_view digits(at_, static_cast<size_t>(parsed.ptr - at_));
            if (digits.find("e-") == std::string_view::npos &&
                digits.find("E-") == std::string_view::npos) {
                value = HUGE_VAL;
            }
        } else if (parsed.ec != std::errc()) {
            throw input_error(at_ == end_ ? "unexpected end of file" : "expected a number");
        }
        at_ = parsed.ptr;
        return value;
    }

    /// Minimum size of a row in bytes: one digit and one separator per number.
    static uint64_t smallest_row(const PlyElement &element) {
        return 2 * element.properties.size();
    }

    /// Number of bytes left, plus one because the last row may lack its end of line.
    size_t left() const { return static_cast<size_t>(end_ - at_) + 1; }

    /// Number of bytes after the last number, without blanks.
    size_t extra() {
        skip_blanks();
        return static_cast<size_t>(end_ - at_);
    }

  private:
    void skip_blanks() {
        while (at_ != end_ && (*at_ == ' ' || (*at_ >= '\t' && *at_ <= '\r'))) {
            ++at_;
        }
    }

    const char *at_;
    const char *end_;
};

/// Reads the numbers of a binary file in sequence. `swapped` is true for big-endian files.
template <bool swapped>
class BinaryData {
  public:
    explicit BinaryData(std::string_view data)
        : at_(data.data()), end_(data.data() + data.size()) {}

    double next(Scalar scalar) {
        switch (scalar) {
            case Scalar::int8:
                return take<int8_t>();
            case Scalar::uint8:
                return take<uint8_t>();
            case Scalar::int16:
                return take<int16_t>();
            case Scalar::uint16:
                return take<uint16_t>();
            case Scalar::int32:
                return take<int32_t>();
            case Scalar::uint32:
                return take<uint32_t>();
            case Scalar::float32:
                return take<float>();
            case Scalar::float64:
                return take<double>();
        }
        return 0;
    }

    static uint64_t smallest_row(const PlyElement &element) {
        uint64_t size = 0;
        for (const PlyProperty &property : element.properties) {
            size +=
                scalars[static_cast<size_t>(property.list_count.value_or(property.scalar))].size;
        }
        return size;
    }

    size_t left() const { return static_cast<size_t>(end_ - at_); }

    /// Number of bytes after the last element.
    size_t extra() const { return left(); }

  private:
    template <typename T>
    T take() {
        if (left() < sizeof(T)) {
            throw input_error("unexpected end of file");
        }
        char bytes[sizeof(T)];
        std::memcpy(bytes, at_, sizeof(T));
        at_ += sizeof(T);
        if (swapped) {
            std::reverse(std::begin(bytes), std::end(bytes));
        }
        T value;
        std::memcpy(&value, bytes, sizeof(T));
        return value;
    }

    const char *at_;
    const char *end_;
};

uint32_t index_of(double value, const char *what) {
    if (!(value >= 0 && value < no_index) || value != std::floor(value)) {
        throw input_error(fmt::format("{} is not a valid {}", value, what));
    }
    return static_cast<uint32_t>(value);
}

/// The data of a file before its faces are split into triangles.
struct Rows {
    MeshCore::Geometry geometry;
    std::vector<uint32_t> corners;       ///< vertex indices of all faces
    std::vector<uint32_t> corner_count;  ///< number of corners of each face
    std::vector<int64_t> material;       ///< material index of each face
};

enum Coordinate {
    x,
    y,
    z,
    nx,
    ny,
    nz,
    u,
    v,
    red,
    green,
    blue,
    coordinate_count,
    unknown = coordinate_count
};
constexpr std::pair<const char *, Coordinate> coordinate_names[] = {
    {"x", x},         {"y", y},         {"z", z},         {"nx", nx},       {"ny", ny},
    {"nz", nz},       {"u", u},         {"v", v},         {"s", u},         {"t", v},
    {"texture_u", u}, {"texture_v", v}, {"texture_s", u}, {"texture_t", v}, {"red", red},
    {"green", green}, {"blue", blue},   {"r", red},       {"g", green},     {"b", blue}};

/// Returns the value that means 1 in a colour of that type: 0 if the type is not one of colours.
double one_of(Scalar scalar) {
    switch (scalar) {
        case Scalar::uint8:
            return 255;
        case Scalar::uint16:
            return 65535;
        case Scalar::float32:
        case Scalar::float64:
            return 1;
        default:
            return 0;
    }
}

/// Reads the data that follow the header.
template <typename Data>
class BodyReader {
  public:
    BodyReader(Data data, ModelNotes &notes, Progress &progress, size_t total)
        : data_(data), notes_(notes), progress_(progress), total_(total) {}

    Rows read(const PlyHeader &header) {
        for (const PlyElement &element : header.elements) {
            if (element.properties.empty()) {
                continue;  // rows without properties have no data
            }
            if (element.count > data_.left() / Data::smallest_row(element)) {
                throw input_error(
                    fmt::format("the file is too short for the {} rows of '{}' of its header",
                                element.count, element.name));
            }
            if (element.name == "vertex") {
                read_vertices(element);
            } else if (element.name == "face") {
                read_faces(element);
            } else {
                notes_.add("unknown elements are ignored", shown(element.name));
                rows_of(element, [&] {
                    for (const PlyProperty &property : element.properties) {
                        skip(property);
                    }
                });
            }
        }
        if (const size_t extra = data_.extra(); extra > 0) {
            throw input_error(fmt::format(
                "{} bytes follow the last element; the header states too few elements, or the file "
                "was damaged by a change of line endings",
                extra));
        }
        return std::move(rows_);
    }

  private:
    template <typename Row>
    void rows_of(const PlyElement &element, const Row &row) {
        for (uint64_t i = 0; i < element.count; ++i) {
            if (i % 0x10000 == 0) {
                if (interrupted()) {
                    throw Error(ExitCode::interrupted, "interrupted");
                }
                progress_.update(total_ - std::min(total_, data_.left()));
            }
            try {
                row();
            } catch (const Error &error) {
                throw input_error(fmt::format("{} {}: {}", element.name, i, error.what()));
            }
        }
    }

    void skip(const PlyProperty &property) {
        const uint32_t count = property.list_count
                                   ? index_of(data_.next(*property.list_count), "length of a list")
                                   : 1;
        for (uint32_t i = 0; i < count; ++i) {
            data_.next(property.scalar);
        }
    }

    void note_unused(const PlyElement &element, const PlyProperty &property) {
        notes_.add("unknown properties are ignored", shown(element.name + " " + property.name));
    }

    void read_vertices(const PlyElement &element) {
        std::vector<Coordinate> meaning;
        std::array<bool, coordinate_count + 1> has{};
        std::array<double, coordinate_count + 1> one{};  // values that mean 1
        for (const PlyProperty &property : element.properties) {
            Coordinate found = unknown;
            for (const auto &[name, coordinate] : coordinate_names) {
                const bool is_usable = coordinate < red || one_of(property.scalar) > 0;
                if (property.name == name && !property.list_count && !has[coordinate] &&
                    is_usable) {
                    found = coordinate;
                    one[coordinate] = one_of(property.scalar);
                }
            }
            if (found == unknown) {
                note_unused(element, property);
            }
            has[found] = true;
            meaning.push_back(found);
        }
        if (!has[x] || !has[y] || !has[z]) {
            throw input_error("vertices require the properties x, y and z");
        }
        if (element.count >= no_index) {
            throw input_error("the file has more than 2^32 vertices");
        }
        const bool has_normals = has[nx] && has[ny] && has[nz];
        const bool has_uvs = has[u] && has[v];
        const bool has_colours = has[red] && has[green] && has[blue];
        if (!has_colours && (has[red] || has[green] || has[blue])) {
            notes_.add("vertex colours without all of red, green and blue are ignored");
        }
        if (has_colours && one[red] > 1) {
            notes_.add("vertex colours that are integers are decoded by the sRGB curve");
        }
        rows_.geometry.vertices.reserve(element.count);
        rows_.geometry.normals.reserve(has_normals ? element.count : 0);
        rows_.geometry.uvs.reserve(has_uvs ? element.count : 0);
        rows_.geometry.colours.reserve(has_colours ? element.count : 0);
        std::array<double, coordinate_count + 1> value{};
        rows_of(element, [&] {
            for (size_t i = 0; i < meaning.size(); ++i) {
                const PlyProperty &property = element.properties[i];
                if (property.list_count) {
                    skip(property);
                } else {
                    value[meaning[i]] = data_.next(property.scalar);
                }
            }
            rows_.geometry.vertices.emplace_back(value[x], value[y], value[z]);
            if (has_normals) {
                rows_.geometry.normals.emplace_back(value[nx], value[ny], value[nz]);
            }
            if (has_uvs) {
                rows_.geometry.uvs.emplace_back(value[u], value[v]);
            }
            if (has_colours) {
                const auto linear = [&](Coordinate channel) {
                    const double part = value[channel] / one[channel];
                    return one[channel] > 1 ? srgb_decoded(part) : part;
                };
                rows_.geometry.colours.emplace_back(linear(red), linear(green), linear(blue));
            }
        });
    }

    void read_faces(const PlyElement &element) {
        const auto is_corners = [](const PlyProperty &property) {
            return property.list_count &&
                   (property.name == "vertex_indices" || property.name == "vertex_index");
        };
        const auto is_material = [](const PlyProperty &property) {
            return !property.list_count && property.name == "material_index";
        };
        // A file with lists of both names is ambiguous.
        if (std::count_if(element.properties.begin(), element.properties.end(), is_corners) != 1) {
            throw input_error("faces require one list 'vertex_indices' or 'vertex_index'");
        }
        for (const PlyProperty &property : element.properties) {
            if (!is_corners(property) && !is_material(property)) {
                note_unused(element, property);
            }
        }
        rows_.corner_count.reserve(element.count);
        rows_.corners.reserve(3 * element.count);
        rows_of(element, [&] {
            for (const PlyProperty &property : element.properties) {
                if (is_corners(property)) {
                    read_corners(property);
                } else if (is_material(property)) {
                    rows_.material.push_back(static_cast<int64_t>(
                        index_of(data_.next(property.scalar), "material index")));
                } else {
                    skip(property);
                }
            }
        });
    }

    void read_corners(const PlyProperty &property) {
        const uint32_t count = index_of(data_.next(*property.list_count), "number of corners");
        for (uint32_t i = 0; i < count; ++i) {
            rows_.corners.push_back(index_of(data_.next(property.scalar), "vertex index"));
        }
        rows_.corner_count.push_back(count);
    }

    Data data_;
    ModelNotes &notes_;
    Progress &progress_;
    size_t total_;
    Rows rows_;
};

Rows read_rows(const PlyHeader &header, std::string_view data, ModelNotes &notes,
               Progress &progress) {
    const auto read = [&](auto source) {
        return BodyReader<decltype(source)>(source, notes, progress, data.size()).read(header);
    };
    switch (header.encoding) {
        case Encoding::ascii:
            return read(AsciiData(data));
        case Encoding::little_endian:
            return read(BinaryData<false>(data));
        case Encoding::big_endian:
            return read(BinaryData<true>(data));
    }
    return {};
}

}  // namespace

PlyFile read_ply(const std::filesystem::path &path, ModelNotes &notes, bool quiet) {
    const std::string content = read_file(path);
    try {
        const PlyHeader header = parse_header(content);
        const std::string_view data = std::string_view(content).substr(header.size);
        const std::string name = path.filename().string();
        Progress progress("reading " + name, data.size(), "bytes", quiet);
        Rows rows = read_rows(header, data, notes, progress);
        progress.update(data.size());

        PlyFile file;
        file.geometry = std::move(rows.geometry);
        file.geometry.triangles.reserve(rows.corner_count.size());
        const uint32_t *corners = rows.corners.data();
        for (size_t face = 0; face < rows.corner_count.size(); ++face) {
            const size_t added =
                add_face(corners, rows.corner_count[face], face, name, file.geometry, notes);
            corners += rows.corner_count[face];
            if (!rows.material.empty()) {
                file.material.insert(file.material.end(), added, rows.material.at(face));
            }
        }
        if (file.geometry.triangles.empty()) {
            throw input_error("the file has no faces");
        }
        repair_normals(file.geometry, name, notes);
        clamp_colours(file.geometry, name, notes);
        return file;
    } catch (const Error &error) {
        throw Error(error.exit_code(), fmt::format("{}: {}", path.string(), error.what()));
    }
}

}  // namespace rtrays
