// SPDX-License-Identifier: MIT
#include "renderer/import/models/geometry.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "renderer/base/error.h"
#include "renderer/import/models/triangulate.h"

namespace rtrays {

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Geometry = MeshCore::Geometry;

/// Returns whether the vector can be normalised.
bool has_direction(const Vector3d &v) {
    return v.allFinite() && v.stableNorm() > 0;
}

/// Returns the normalised vector, or zero if the vector cannot be normalised.
Vector3d direction(const Vector3d &v) {
    return has_direction(v) ? Vector3d(v.stableNormalized()) : Vector3d::Zero();
}

Vector3d face_normal(const Geometry &geometry, const Triangle &t) {
    const Vector3d &origin = geometry.vertices[t[0]];
    // Edges are normalised first, because the product of two long or short ones may exceed the
    // range of double.
    return direction(direction(geometry.vertices[t[1]] - origin)
                         .cross(direction(geometry.vertices[t[2]] - origin)));
}

/// All attributes of a vertex. Without padding, so that bytes can be compared.
struct VertexKey {
    double values[11] = {};

    bool operator==(const VertexKey &other) const {
        return std::memcmp(values, other.values, sizeof values) == 0;
    }
};

VertexKey key_of(const Geometry &geometry, size_t i) {
    VertexKey key;
    // Adding zero makes -0 and 0 one value.
    Eigen::Map<Vector3d>(key.values) = (geometry.vertices[i].array() + 0.0).matrix();
    if (!geometry.normals.empty()) {
        Eigen::Map<Vector3d>(key.values + 3) = (geometry.normals[i].array() + 0.0).matrix();
    }
    if (!geometry.uvs.empty()) {
        Eigen::Map<Vector2d>(key.values + 6) = (geometry.uvs[i].array() + 0.0).matrix();
    }
    if (!geometry.colours.empty()) {
        Eigen::Map<Vector3d>(key.values + 8) = (geometry.colours[i].array() + 0.0).matrix();
    }
    return key;
}

uint64_t hash_of(const VertexKey &key) {
    uint64_t hash = 0x9e3779b97f4a7c15u;
    for (const double value : key.values) {
        uint64_t bits;
        std::memcpy(&bits, &value, sizeof bits);
        hash = (hash ^ bits) * 0xff51afd7ed558ccdu;
        hash ^= hash >> 32;
    }
    return hash;
}

void append_vertex(const Geometry &from, size_t i, Geometry &to) {
    to.vertices.push_back(from.vertices[i]);
    if (!from.normals.empty()) {
        to.normals.push_back(from.normals[i]);
    }
    if (!from.uvs.empty()) {
        to.uvs.push_back(from.uvs[i]);
    }
    if (!from.colours.empty()) {
        to.colours.push_back(from.colours[i]);
    }
}

/// Gives every triangle three vertices of its own that have its normal.
void make_faceted(Geometry &geometry) {
    Geometry faceted;
    for (const Triangle &t : geometry.triangles) {
        const auto first = static_cast<uint32_t>(faceted.vertices.size());
        const Vector3d normal = face_normal(geometry, t);
        for (const uint32_t corner : t) {
            append_vertex(geometry, corner, faceted);
            // A triangle of zero area is never hit, so its normal may be arbitrary.
            faceted.normals.push_back(normal.isZero() ? Vector3d::UnitZ() : normal);
        }
        faceted.triangles.push_back({first, first + 1, first + 2});
    }
    geometry = std::move(faceted);
}

template <typename T>
void append(std::vector<T> &to, const std::vector<T> &from) {
    to.insert(to.end(), from.begin(), from.end());
}

}  // namespace

size_t add_face(const uint32_t *corners, size_t count, size_t face, const std::string &mesh,
                Geometry &geometry, ModelNotes &notes) {
    for (size_t i = 0; i < count; ++i) {
        if (corners[i] >= geometry.vertices.size()) {
            throw input_error(fmt::format(
                "mesh '{}': face {} has vertex index {}, but there are only {} vertices", mesh,
                face, corners[i], geometry.vertices.size()));
        }
    }
    if (count < 3) {
        notes.add("points and lines are ignored", fmt::format("face {} of {}", face, mesh));
        return 0;
    }
    if (count == 3) {
        geometry.triangles.push_back({corners[0], corners[1], corners[2]});
        return 1;
    }
    std::vector<Triangle> parts;
    try {
        parts = triangulate(geometry.vertices, {corners, corners + count});
    } catch (const Error &) {
        notes.add("polygons that cross themselves are split into fans of triangles",
                  fmt::format("face {} of {}", face, mesh));
        for (size_t i = 1; i + 1 < count; ++i) {
            parts.push_back({corners[0], corners[i], corners[i + 1]});
        }
    }
    append(geometry.triangles, parts);
    return parts.size();
}

void join_vertices(Geometry &geometry) {
    // A hash table with open addressing, at most half full. A node-based map takes ten times as
    // long for millions of vertices.
    size_t slots = 16;
    while (slots < 2 * geometry.vertices.size()) {
        slots *= 2;
    }
    std::vector<uint32_t> table(slots, no_index);
    std::vector<uint32_t> joined(geometry.vertices.size(), no_index);
    std::vector<VertexKey> keys;  // keys of the vertices kept
    Geometry kept;
    for (Triangle &t : geometry.triangles) {
        for (uint32_t &corner : t) {
            if (joined[corner] == no_index) {
                const VertexKey key = key_of(geometry, corner);
                size_t slot = hash_of(key) & (slots - 1);
                while (table[slot] != no_index && !(keys[table[slot]] == key)) {
                    slot = (slot + 1) & (slots - 1);
                }
                if (table[slot] == no_index) {
                    table[slot] = static_cast<uint32_t>(keys.size());
                    keys.push_back(key);
                    append_vertex(geometry, corner, kept);
                }
                joined[corner] = table[slot];
            }
            corner = joined[corner];
        }
    }
    kept.triangles = std::move(geometry.triangles);
    geometry = std::move(kept);
}

void make_smooth_normals(Geometry &geometry) {
    geometry.normals.assign(geometry.vertices.size(), Vector3d::Zero());
    for (const Triangle &t : geometry.triangles) {
        const Vector3d normal = face_normal(geometry, t);
        for (size_t i = 0; i < 3; ++i) {
            const Vector3d &corner = geometry.vertices[t[i]];
            const Vector3d a = direction(geometry.vertices[t[(i + 1) % 3]] - corner);
            const Vector3d b = direction(geometry.vertices[t[(i + 2) % 3]] - corner);
            geometry.normals[t[i]] += std::atan2(a.cross(b).norm(), a.dot(b)) * normal;
        }
    }
    for (Vector3d &normal : geometry.normals) {
        // The normal is arbitrary if the triangles have zero area or their normals cancel.
        normal = has_direction(normal) ? direction(normal) : Vector3d::UnitZ();
    }
}

void repair_normals(Geometry &geometry, const std::string &mesh, ModelNotes &notes) {
    std::vector<size_t> broken;
    for (size_t i = 0; i < geometry.normals.size(); ++i) {
        if (!has_direction(geometry.normals[i])) {
            broken.push_back(i);
        }
    }
    if (broken.empty()) {
        return;
    }
    std::vector<Vector3d> normals = geometry.normals;
    make_smooth_normals(geometry);
    for (const size_t i : broken) {
        notes.add("normals that are zero or not finite are replaced by normals of the triangles",
                  fmt::format("vertex {} of {}", i, mesh));
        normals[i] = geometry.normals[i];
    }
    geometry.normals = std::move(normals);
}

void clamp_colours(Geometry &geometry, const std::string &mesh, ModelNotes &notes) {
    bool has_clamped = false;
    for (Vector3d &colour : geometry.colours) {
        const Vector3d clamped = colour.cwiseMax(0.0).cwiseMin(1.0);
        if (colour.allFinite() && clamped != colour) {
            colour = clamped;
            has_clamped = true;
        }
    }
    if (has_clamped) {
        notes.add("vertex colours are clamped to [0, 1]", mesh);
    }
}

size_t count_opposed(const MeshCore &mesh) {
    if (mesh.normals().empty()) {
        return 0;
    }
    const auto is_opposed = [&](const Triangle &t) {
        const Vector3d &origin = mesh.vertices()[t[0]];
        const Vector3d front =
            (mesh.vertices()[t[1]] - origin).cross(mesh.vertices()[t[2]] - origin);
        return front.dot(mesh.normals()[t[0]] + mesh.normals()[t[1]] + mesh.normals()[t[2]]) < 0;
    };
    return static_cast<size_t>(
        std::count_if(mesh.triangles().begin(), mesh.triangles().end(), is_opposed));
}

void note_opposed(const MeshCore &mesh, ModelNotes &notes) {
    if (const size_t opposed = count_opposed(mesh); opposed > 0) {
        notes.add(
            "normals oppose the winding, which decides what the front is",
            fmt::format("{} of {} triangles of {}", opposed, mesh.triangles().size(), mesh.name()));
    }
}

void append_geometry(Geometry &geometry, Geometry part, const Eigen::Matrix4d &transform) {
    const Eigen::Matrix3d linear = transform.topLeftCorner<3, 3>();
    // The inverse transpose is the cofactor matrix divided by the determinant. Only the sign of the
    // determinant matters, because normals are normalised.
    Eigen::Matrix3d cofactors;
    for (int i = 0; i < 3; ++i) {
        cofactors.col(i) = linear.col((i + 1) % 3).cross(linear.col((i + 2) % 3));
    }
    const bool mirrors = linear.determinant() < 0;
    for (Vector3d &vertex : part.vertices) {
        vertex = linear * vertex + transform.topRightCorner<3, 1>();
    }
    for (Vector3d &normal : part.normals) {
        normal = direction((mirrors ? -1.0 : 1.0) * (cofactors * normal));
    }
    if (mirrors) {
        for (Triangle &t : part.triangles) {
            std::swap(t[1], t[2]);
        }
    }
    if (geometry.vertices.empty()) {
        geometry = std::move(part);
        return;
    }
    if (geometry.normals.empty() != part.normals.empty()) {
        make_faceted(geometry.normals.empty() ? geometry : part);
    }
    if (geometry.uvs.empty() != part.uvs.empty()) {
        Geometry &lacking = geometry.uvs.empty() ? geometry : part;
        lacking.uvs.assign(lacking.vertices.size(), Vector2d::Zero());
    }
    if (geometry.colours.empty() != part.colours.empty()) {
        Geometry &lacking = geometry.colours.empty() ? geometry : part;
        lacking.colours.assign(lacking.vertices.size(), Vector3d::Ones());
    }
    const size_t first = geometry.vertices.size();
    if (first + part.vertices.size() >= no_index) {
        throw input_error("the file has more than 2^32 vertices");
    }
    append(geometry.vertices, part.vertices);
    append(geometry.normals, part.normals);
    append(geometry.uvs, part.uvs);
    append(geometry.colours, part.colours);
    for (const Triangle &t : part.triangles) {
        const auto offset = static_cast<uint32_t>(first);
        geometry.triangles.push_back({offset + t[0], offset + t[1], offset + t[2]});
    }
}

std::map<int64_t, Geometry> split_geometry(const Geometry &geometry,
                                           const std::vector<int64_t> &groups) {
    std::map<int64_t, std::vector<size_t>> members;
    for (size_t i = 0; i < groups.size(); ++i) {
        members[groups[i]].push_back(i);
    }
    std::map<int64_t, Geometry> parts;
    std::vector<uint32_t> moved(geometry.vertices.size());
    // Index of the group for which `moved` is valid.
    std::vector<int64_t> moved_by(geometry.vertices.size(), -1);
    int64_t place = 0;
    for (const auto &[group, triangles] : members) {
        Geometry &part = parts[group];
        for (const size_t i : triangles) {
            Triangle t = geometry.triangles[i];
            for (uint32_t &corner : t) {
                if (moved_by[corner] != place) {
                    moved_by[corner] = place;
                    moved[corner] = static_cast<uint32_t>(part.vertices.size());
                    append_vertex(geometry, corner, part);
                }
                corner = moved[corner];
            }
            part.triangles.push_back(t);
        }
        ++place;
    }
    return parts;
}

}  // namespace rtrays
