// SPDX-License-Identifier: MIT
#include "reference/triangle.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "renderer/base/error.h"

namespace rtrays::reference {

namespace {

// Distance of a ray origin from its plane, in half ulps of the largest coordinate. A float origin
// is off by one half ulp per axis. Embree's plane distance is off by a few more (v0 - origin, three
// products, two sums).
constexpr double offset_half_ulps = 16.0;
constexpr double margin_over_offset = 4.0;

}  // namespace

bool make_record(const MeshArrays &meshes, uint32_t index, TriangleRecord &record) {
    std::array<Vec3, 3> v;
    for (size_t k = 0; k < 3; ++k) {
        v[k] = meshes.position[meshes.triangle[index][k]].cast<double>();
        if (!v[k].allFinite()) {
            const uint32_t mesh = meshes.triangle_mesh[index];
            throw input_error(fmt::format("mesh '{}': triangle {} has a vertex that is not finite",
                                          meshes.name[mesh], index - meshes.first_triangle[mesh]));
        }
    }
    record.vertex = v[0];
    record.edge1 = v[1] - v[0];
    record.edge2 = v[2] - v[0];
    const Vec3 cross = record.edge1.cross(record.edge2);
    const double doubled_area = cross.norm();
    const double longest =
        std::max({record.edge1.norm(), record.edge2.norm(), (v[2] - v[1]).norm()});
    if (!(doubled_area > 1e-14 * longest * longest)) {
        return false;
    }
    record.normal = cross / doubled_area;

    const double half_ulp = 0.5 * static_cast<double>(std::numeric_limits<float>::epsilon());
    const double magnitude = std::max({v[0].cwiseAbs().maxCoeff(), v[1].cwiseAbs().maxCoeff(),
                                       v[2].cwiseAbs().maxCoeff(), longest});
    record.offset = offset_half_ulps * half_ulp * magnitude;
    const double smallest_height = doubled_area / longest;
    record.margin = std::min(margin_over_offset * record.offset / smallest_height, 0.25);
    const uint32_t mesh = meshes.triangle_mesh[index];
    record.has_normals = meshes.has_normals[mesh] != 0;
    record.has_uv = meshes.has_uv[mesh] != 0;
    record.has_colour = mesh < meshes.has_colour.size() && meshes.has_colour[mesh] != 0;
    record.material = meshes.material[mesh];
    record.light = meshes.light[mesh];
    return true;
}

}  // namespace rtrays::reference
