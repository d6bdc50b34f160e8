// SPDX-License-Identifier: MIT
#include "experiments/harness/models/buildings.h"

#include <algorithm>
#include <cmath>

#include "experiments/harness/models/meshes.h"

namespace rtrays {

namespace {

using Eigen::Vector3f;

constexpr float width = 12, height = 8, length = 36;  // size of a hall
constexpr float gallery_width = 3, gallery_height = 4;
constexpr uint32_t column_pairs = 11;

/// A parallelogram that is divided into cells.
struct Sheet {
    Vector3f corner, u, v;
};

float area(const Sheet &sheet) {
    return sheet.u.cross(sheet.v).norm();
}

/// Adds a sheet of cells of about the size `cell`. Its vertices are displaced along the normal by
/// up to `relief`.
void add_sheet(test::Mesh &mesh, const Sheet &sheet, float cell, float relief,
               test::Random &random) {
    const auto columns = std::max(1u, static_cast<uint32_t>(sheet.u.norm() / cell));
    const auto rows = std::max(1u, static_cast<uint32_t>(sheet.v.norm() / cell));
    const Vector3f normal = sheet.u.cross(sheet.v).normalized();
    const auto first = static_cast<uint32_t>(mesh.positions.size());
    for (uint32_t row = 0; row <= rows; ++row) {
        for (uint32_t column = 0; column <= columns; ++column) {
            mesh.positions.push_back(
                sheet.corner +
                sheet.u * (static_cast<float>(column) / static_cast<float>(columns)) +
                sheet.v * (static_cast<float>(row) / static_cast<float>(rows)) +
                normal * test::uniform(random, 0, relief));
        }
    }
    for (uint32_t row = 0; row < rows; ++row) {
        for (uint32_t column = 0; column < columns; ++column) {
            const uint32_t a = first + row * (columns + 1) + column, b = a + 1, c = a + columns + 1;
            mesh.triangles.push_back({a, b, c});
            mesh.triangles.push_back({b, c + 1, c});
        }
    }
}

/// Adds an open fluted cylinder along y with 2 * rings * segments triangles.
void add_column(test::Mesh &mesh, float x, float z, uint32_t rings, uint32_t segments) {
    const auto first = static_cast<uint32_t>(mesh.positions.size());
    for (uint32_t ring = 0; ring <= rings; ++ring) {
        for (uint32_t segment = 0; segment < segments; ++segment) {
            const float phi = 2 * static_cast<float>(M_PI) * static_cast<float>(segment) /
                              static_cast<float>(segments);
            const float radius = 0.3f + 0.03f * std::cos(12 * phi);
            mesh.positions.emplace_back(
                x + radius * std::cos(phi),
                height * static_cast<float>(ring) / static_cast<float>(rings),
                z + radius * std::sin(phi));
        }
    }
    for (uint32_t ring = 0; ring < rings; ++ring) {
        for (uint32_t segment = 0; segment < segments; ++segment) {
            const uint32_t a = first + ring * segments + segment;
            const uint32_t b = first + ring * segments + (segment + 1) % segments;
            mesh.triangles.push_back({a, a + segments, b});
            mesh.triangles.push_back({b, a + segments, b + segments});
        }
    }
}

/// Builds a hall or court. Walls have about 15 % of the triangles, columns 35 %, vases the rest.
test::Mesh interior(uint32_t count, bool has_ceiling) {
    test::Random random(count);
    test::Mesh mesh{"interior", {}, {}};
    const Vector3f x(width, 0, 0), y(0, height, 0), z(0, 0, length), side(gallery_width, 0, 0);
    std::vector<Sheet> sheets = {{{0, 0, 0}, x, z},
                                 {{0, 0, 0}, y, z},
                                 {{width, 0, 0}, y, z},
                                 {{0, 0, 0}, x, y},
                                 {{0, 0, length}, x, y},
                                 {{0, gallery_height, 0}, side, z},
                                 {{width - gallery_width, gallery_height, 0}, side, z}};
    if (has_ceiling) {
        sheets.push_back({y, x, z});
    }
    float all = 0;
    for (const Sheet &sheet : sheets) {
        all += area(sheet);
    }
    const auto total = static_cast<float>(count);
    const float cell = std::sqrt(all / (0.5f * 0.15f * total));
    for (const Sheet &sheet : sheets) {
        add_sheet(mesh, sheet, cell, 0.02f, random);
    }
    const auto segments =
        std::max(4u, static_cast<uint32_t>(std::sqrt(0.35f * total / (16 * column_pairs))));
    for (uint32_t pair = 0; pair < column_pairs; ++pair) {
        for (const float column_x : {gallery_width, width - gallery_width}) {
            add_column(mesh, column_x, 3.0f * static_cast<float>(pair + 1), 4 * segments, segments);
        }
    }
    const float vases = std::clamp(total / 5000, 20.0f, 1000.0f);
    const auto rings = std::max(4u, static_cast<uint32_t>(std::sqrt(0.5f * total / (4 * vases))));
    while (mesh.triangles.size() < count) {
        const float radius = test::uniform(random, 0.1f, 0.5f);
        const float across = test::uniform(random, 0.6f, gallery_width - 0.6f);
        const bool upstairs = random() % 3 == 0, right = random() % 2 == 0;
        const Vector3f centre(right ? width - across : across,
                              (upstairs ? gallery_height : 0) + radius,
                              test::uniform(random, 4, length - 1));
        append(mesh, test::sphere(rings, 2 * rings, radius, 0.05f, centre, random()));
    }
    mesh.triangles.resize(count);
    return mesh;
}

/// Adds a house on a square with side length `side`, with `bays` boxes on its four fronts.
void add_house(test::Mesh &mesh, const Vector3f &corner, float side, float house_height,
               uint32_t bays) {
    mesh.add_box(corner, corner + Vector3f(side, house_height, side));
    const uint32_t per_front = bays / 4 + 1;
    const auto columns = std::max(
        1u, static_cast<uint32_t>(std::sqrt(static_cast<float>(per_front) * side / house_height)));
    const uint32_t rows = per_front / columns + 1;
    const Vector3f cell(side / static_cast<float>(columns), house_height / static_cast<float>(rows),
                        0.4f);
    for (uint32_t bay = 0; bay < bays; ++bay) {
        const uint32_t front = bay % 4, place = bay / 4;
        const float along = (static_cast<float>(place % columns) + 0.2f) * cell.x();
        const float up = (static_cast<float>(place / columns) + 0.3f) * cell.y();
        const float low = front < 2 ? -cell.z() : side, high = front < 2 ? 0 : side + cell.z();
        const bool faces_x = front % 2 == 0;
        const Vector3f from = faces_x ? Vector3f(low, up, along) : Vector3f(along, up, low);
        const Vector3f size = faces_x ? Vector3f(high - low, 0.5f * cell.y(), 0.6f * cell.x())
                                      : Vector3f(0.6f * cell.x(), 0.5f * cell.y(), high - low);
        mesh.add_box(corner + from, corner + from + size);
    }
}

}  // namespace

test::Mesh hall(uint32_t count) {
    return interior(count, true);
}

test::Mesh court(uint32_t count) {
    return interior(count, false);
}

test::Mesh city(uint32_t count) {
    constexpr float pitch = 30, side = 20;
    test::Random random(count);
    test::Mesh mesh{"city", {}, {}};
    const auto lots =
        std::max(2u, static_cast<uint32_t>(std::sqrt(static_cast<float>(count) / 1200)));
    const float extent = pitch * static_cast<float>(lots);
    add_sheet(mesh, {{0, 0, 0}, {0, 0, extent}, {extent, 0, 0}}, pitch, 0.0f, random);
    const auto boxes =
        static_cast<uint32_t>(count - std::min<size_t>(count, mesh.triangles.size())) / 12;
    for (uint32_t lot = 0; lot < lots * lots; ++lot) {
        const Vector3f corner(pitch * static_cast<float>(lot % lots) + 5, 0,
                              pitch * static_cast<float>(lot / lots) + 5);
        add_house(mesh, corner, side, test::uniform(random, 10, 60), boxes / (lots * lots));
    }
    while (mesh.triangles.size() < count) {  // boxes in the streets
        const Vector3f at(pitch * static_cast<float>(random() % lots) + test::uniform(random, 0, 3),
                          0, test::uniform(random, 0, extent));
        mesh.add_box(at, at + Vector3f(1.5f, 1.2f, 1.5f));
    }
    mesh.triangles.resize(count);
    return mesh;
}

}  // namespace rtrays
