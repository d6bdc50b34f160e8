// SPDX-License-Identifier: MIT
#include "renderer/import/models/obj.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <string_view>
#include <tuple>
#include <utility>

#include "renderer/base/error.h"
#include "renderer/base/files.h"
#include "renderer/base/progress.h"
#include "renderer/import/models/geometry.h"
#include "renderer/import/models/statements.h"
#include "renderer/scene/cores/texture.h"

namespace rtrays {

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// Indices of the attributes of a corner, from 0. Absent attributes have `no_index`.
struct Corner {
    uint32_t vertex = no_index;
    uint32_t uv = no_index;
    uint32_t normal = no_index;
};

struct Face {
    uint32_t corners;  ///< number of corners
    uint32_t line;
};

/// Faces that become one mesh.
struct Group {
    std::string object;
    std::string material;
    bool has_uvs = false;
    bool has_normals = false;
    bool is_smoothed = false;
    std::vector<Corner> corners;
    std::vector<Face> faces;
};

class ObjReader {
  public:
    ObjReader(std::string_view text, const std::string &name, ModelNotes &notes)
        : reader_(text), name_(name), notes_(notes) {}

    ObjFile read(Progress &progress) {
        Statement statement;
        for (size_t i = 0; reader_.next(statement); ++i) {
            if (i % 0x10000 == 0) {
                if (interrupted()) {
                    throw Error(ExitCode::interrupted, "interrupted");
                }
                progress.update(reader_.position());
            }
            line_ = statement.line;
            read(statement);
        }
        for (Group &group : groups_) {
            file_.meshes.push_back({group.object, group.material, build(group)});
            group = {};
        }
        return std::move(file_);
    }

    /// Line of the statement that is read.
    size_t line() const { return line_; }

  private:
    void read(const Statement &statement) {
        const std::string_view keyword = statement.keyword;
        const std::string_view rest = statement.rest;
        if (keyword == "v") {
            read_vertex(without_comment(rest));
        } else if (keyword == "vn") {
            const std::array<double, 8> n = numbers(without_comment(rest), 3, 3, "a normal").first;
            normals_.emplace_back(n[0], n[1], n[2]);
        } else if (keyword == "vt") {
            const std::array<double, 8> t =
                numbers(without_comment(rest), 1, 3, "a texture coordinate").first;
            uvs_.emplace_back(t[0], t[1]);
        } else if (keyword == "f" || keyword == "fo") {
            read_face(without_comment(rest));
        } else if (keyword == "o" || keyword == "g") {
            object_ = name_of(rest);
        } else if (keyword == "usemtl") {
            material_ = name_of(rest);
        } else if (keyword == "mtllib") {
            file_.libraries.push_back({name_of(rest), statement.line});
        } else if (keyword == "s") {
            const std::string group = name_of(rest);
            is_smoothed_ = group != "off" && group != "0";
        } else if (keyword == "p" || keyword == "l") {
            notes_.add("points and lines are ignored", fmt::format("line {}", line_));
        } else {
            notes_.add("statements that are unsupported here are ignored",
                       fmt::format("'{}' in line {}", shown(keyword), line_));
        }
    }

    /// Returns the numbers of a statement, and how many there are.
    std::pair<std::array<double, 8>, size_t> numbers(std::string_view rest, size_t least,
                                                     size_t most, const char *what) const {
        std::array<double, 8> values{};
        size_t count = 0;
        for (std::string_view word = take_word(rest); !word.empty(); word = take_word(rest)) {
            if (count == most) {
                throw input_error(fmt::format("{} has more than {} numbers", what, most));
            }
            if (!parse_number(word, values[count])) {
                throw input_error(fmt::format("expected a number, got '{}'", shown(word)));
            }
            if (!std::isfinite(values[count])) {
                throw input_error(fmt::format("'{}' is not a finite number", shown(word)));
            }
            ++count;
        }
        if (count < least) {
            throw input_error(fmt::format("{} needs {} numbers, got {}", what, least, count));
        }
        return {values, count};
    }

    void read_vertex(std::string_view rest) {
        const auto [p, count] = numbers(rest, 3, 8, "a vertex");
        vertices_.emplace_back(p[0], p[1], p[2]);
        if (count >= 6) {
            colours_.resize(vertices_.size() - 1, Vector3d::Ones());
            colours_.emplace_back(srgb_decoded(p[3]), srgb_decoded(p[4]), srgb_decoded(p[5]));
            notes_.add("vertex colours are decoded by the sRGB curve");
            if (count > 6) {
                notes_.add("numbers after the colour of a vertex are ignored",
                           fmt::format("line {}", line_));
            }
        } else if (count > 3 && p[3] != 1) {
            notes_.add("weights of vertices are ignored", fmt::format("line {}", line_));
        }
    }

    /// Parses an index and returns it from 0. A negative index counts from the last element.
    uint32_t index_of(std::string_view word, size_t count, const char *what) const {
        int64_t index = 0;
        const auto parsed = std::from_chars(word.data(), word.data() + word.size(), index);
        if (parsed.ec != std::errc() || parsed.ptr != word.data() + word.size() || index == 0) {
            throw input_error(fmt::format("'{}' is not a valid {} index", shown(word), what));
        }
        const int64_t from_zero = index > 0 ? index - 1 : static_cast<int64_t>(count) + index;
        if (from_zero < 0 || from_zero >= no_index) {
            throw out_of_range(index, count, what);
        }
        return static_cast<uint32_t>(from_zero);
    }

    static Error out_of_range(int64_t index, size_t count, const char *what) {
        return input_error(
            fmt::format("the face has {} index {}, but there are only {}", what, index, count));
    }

    /// Parses "v", "v/t", "v//n" or "v/t/n".
    Corner corner_of(std::string_view word) const {
        std::array<std::string_view, 3> part;
        for (size_t i = 0;; ++i) {
            const size_t end = word.find('/');
            part[i] = word.substr(0, end);
            if (end == std::string_view::npos) {
                break;
            }
            word.remove_prefix(end + 1);
            if (i == 2) {
                throw input_error("a corner has more than three indices");
            }
        }
        Corner corner;
        corner.vertex = index_of(part[0], vertices_.size(), "vertex");
        if (!part[1].empty()) {
            corner.uv = index_of(part[1], uvs_.size(), "texture coordinate");
        }
        if (!part[2].empty()) {
            corner.normal = index_of(part[2], normals_.size(), "normal");
        }
        return corner;
    }

    void read_face(std::string_view rest) {
        corners_.clear();
        bool has_uvs = true;  // at all corners
        bool has_normals = true;
        bool has_any_uv = false;
        bool has_any_normal = false;
        for (std::string_view word = take_word(rest); !word.empty(); word = take_word(rest)) {
            const Corner corner = corner_of(word);
            has_uvs = has_uvs && corner.uv != no_index;
            has_normals = has_normals && corner.normal != no_index;
            has_any_uv = has_any_uv || corner.uv != no_index;
            has_any_normal = has_any_normal || corner.normal != no_index;
            corners_.push_back(corner);
        }
        if ((has_any_uv && !has_uvs) || (has_any_normal && !has_normals)) {
            notes_.add("faces with texture coordinates or normals at some corners only lose them",
                       fmt::format("line {}", line_));
        }
        Group &group = group_of(has_any_uv && has_uvs, has_any_normal && has_normals);
        group.is_smoothed = group.is_smoothed || is_smoothed_;
        group.corners.insert(group.corners.end(), corners_.begin(), corners_.end());
        group.faces.push_back(
            {static_cast<uint32_t>(corners_.size()), static_cast<uint32_t>(line_)});
    }

    Group &group_of(bool has_uvs, bool has_normals) {
        if (!groups_.empty()) {
            const Group &last = groups_[last_group_];
            if (last.object == object_ && last.material == material_ && last.has_uvs == has_uvs &&
                last.has_normals == has_normals) {
                return groups_[last_group_];
            }
        }
        const auto [found, is_new] = group_index_.emplace(
            std::tuple(object_, material_, has_uvs, has_normals), groups_.size());
        if (is_new) {
            groups_.push_back({object_, material_, has_uvs, has_normals, false, {}, {}});
        }
        last_group_ = found->second;
        return groups_[last_group_];
    }

    MeshCore::Geometry build(const Group &group) {
        MeshCore::Geometry geometry;
        const std::string name = group.object.empty() ? name_ : group.object;
        std::vector<uint32_t> corners;
        size_t first = 0;
        for (size_t face = 0; face < group.faces.size(); ++face) {
            line_ = group.faces[face].line;
            corners.clear();
            for (uint32_t i = 0; i < group.faces[face].corners; ++i) {
                corners.push_back(static_cast<uint32_t>(geometry.vertices.size()));
                append_corner(group, group.corners[first + i], geometry);
            }
            first += group.faces[face].corners;
            add_face(corners.data(), corners.size(), face, name, geometry, notes_);
        }
        join_vertices(geometry);
        repair_normals(geometry, name, notes_);
        clamp_colours(geometry, name, notes_);
        if (group.is_smoothed && !group.has_normals) {
            notes_.add("smoothing groups are ignored; faces without normals are flat", name);
        }
        return geometry;
    }

    void append_corner(const Group &group, const Corner &corner,
                       MeshCore::Geometry &geometry) const {
        // Indices may refer to elements that follow the face, so they are checked at the end.
        geometry.vertices.push_back(at(vertices_, corner.vertex, "vertex"));
        if (!colours_.empty()) {
            geometry.colours.push_back(corner.vertex < colours_.size() ? colours_[corner.vertex]
                                                                       : Vector3d::Ones());
        }
        if (group.has_uvs) {
            geometry.uvs.push_back(at(uvs_, corner.uv, "texture coordinate"));
        }
        if (group.has_normals) {
            geometry.normals.push_back(at(normals_, corner.normal, "normal"));
        }
    }

    template <typename T>
    static const T &at(const std::vector<T> &all, uint32_t index, const char *what) {
        if (index >= all.size()) {
            throw out_of_range(static_cast<int64_t>(index) + 1, all.size(), what);
        }
        return all[index];
    }

    StatementReader reader_;
    std::string name_;
    ModelNotes &notes_;
    size_t line_ = 0;
    std::vector<Vector3d> vertices_;
    /// Colours of the first vertices. Those that follow have none, and are white.
    std::vector<Vector3d> colours_;
    std::vector<Vector3d> normals_;
    std::vector<Vector2d> uvs_;
    std::string object_;
    std::string material_;
    bool is_smoothed_ = false;
    std::vector<Corner> corners_;  ///< of the face that is read
    std::vector<Group> groups_;
    std::map<std::tuple<std::string, std::string, bool, bool>, size_t> group_index_;
    size_t last_group_ = 0;
    ObjFile file_;
};

}  // namespace

ObjFile read_obj(const std::filesystem::path &path, ModelNotes &notes, bool quiet) {
    const std::string text = read_file(path);
    const std::string name = path.filename().string();
    Progress progress("reading " + name, text.size(), "bytes", quiet);
    ObjReader reader(text, path.stem().string(), notes);
    ObjFile file;
    try {
        file = reader.read(progress);
    } catch (const Error &error) {
        throw Error(error.exit_code(),
                    fmt::format("{}:{}: {}", path.string(), reader.line(), error.what()));
    }
    progress.update(text.size());
    bool has_triangles = false;
    for (const ObjMesh &mesh : file.meshes) {
        has_triangles = has_triangles || !mesh.geometry.triangles.empty();
    }
    if (!has_triangles) {
        throw input_error(fmt::format("{}: the file has no faces", path.string()));
    }
    return file;
}

}  // namespace rtrays
