// SPDX-License-Identifier: MIT
#include "reference/geometry.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <limits>

#include "renderer/base/error.h"

namespace rtrays::reference {

namespace {

// Half ulps of the largest coordinate between a ray origin and its plane. A float origin is off by one
// half ulp per axis and Embree's plane distance by a few more (v0 - origin, three products, two sums).
constexpr double offset_half_ulps = 16.0;
constexpr double margin_over_offset = 4.0;

void require(bool condition, RTCDevice device, const char *what) {
    if (!condition || rtcGetDeviceError(device) != RTC_ERROR_NONE) {
        throw run_error(fmt::format("embree: {} failed", what));
    }
}

/// Fills the record; returns false when the area is zero (or below what double can tell from zero).
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
    const double longest = std::max({record.edge1.norm(), record.edge2.norm(), (v[2] - v[1]).norm()});
    if (!(doubled_area > 1e-14 * longest * longest)) {
        return false;
    }
    record.normal = cross / doubled_area;

    const double half_ulp = 0.5 * static_cast<double>(std::numeric_limits<float>::epsilon());
    const double magnitude = std::max(
        {v[0].cwiseAbs().maxCoeff(), v[1].cwiseAbs().maxCoeff(), v[2].cwiseAbs().maxCoeff(), longest});
    record.offset = offset_half_ulps * half_ulp * magnitude;
    const double smallest_height = doubled_area / longest;
    record.margin = std::min(margin_over_offset * record.offset / smallest_height, 0.25);
    const uint32_t mesh = meshes.triangle_mesh[index];
    record.has_normals = meshes.has_normals[mesh] != 0;
    record.has_uv = meshes.has_uv[mesh] != 0;
    record.material = meshes.material[mesh];
    record.light = meshes.light[mesh];
    return true;
}

/// Barycentrics of the point where the ray's line meets the triangle's plane (Moeller & Trumbore 1997),
/// moved onto the triangle: a float hit next to an edge, or at a grazing angle, may lie outside in double.
/// `fallback` is used when the line is parallel to the plane.
Eigen::Vector2d intersect_plane(const Ray &ray, const TriangleRecord &triangle,
                                const Eigen::Vector2d &fallback) {
    const Vec3 p = ray.direction.cross(triangle.edge2);
    const double determinant = triangle.edge1.dot(p);
    const Vec3 to_origin = ray.origin - triangle.vertex;
    const Vec3 q = to_origin.cross(triangle.edge1);
    double u = to_origin.dot(p) / determinant;
    double v = ray.direction.dot(q) / determinant;
    if (!std::isfinite(u) || !std::isfinite(v)) {
        u = fallback.x();
        v = fallback.y();
    }
    u = std::min(std::max(u, 0.0), 1.0);
    return {u, std::min(std::max(v, 0.0), 1.0 - u)};
}

}  // namespace

Geometry::Geometry(const MeshArrays &meshes) {
    const auto start = std::chrono::steady_clock::now();
    device_.reset(rtcNewDevice(nullptr));
    if (!device_) {
        throw run_error("embree: no device could be created");
    }
    const auto version = rtcGetDeviceProperty(device_.get(), RTC_DEVICE_PROPERTY_VERSION);
    stats_.engine = fmt::format("embree {}.{}.{}", version / 10000, version / 100 % 100, version % 100);

    const size_t count = meshes.triangle.size();
    triangles_.reserve(count);
    std::vector<Triangle> indices;
    indices.reserve(count);
    for (uint32_t i = 0; i < count; ++i) {
        TriangleRecord record;
        if (make_record(meshes, i, record)) {
            triangles_.push_back(record);
            indices.push_back(meshes.triangle[i]);
        }
    }
    stats_.triangles = triangles_.size();
    stats_.degenerate_triangles = count - triangles_.size();

    const auto any = [](const std::vector<uint8_t> &flags) {
        return std::find(flags.begin(), flags.end(), 1) != flags.end();
    };
    if (any(meshes.has_normals) || any(meshes.has_uv)) {
        vertices_ = indices;
        normals_ = meshes.normal;
        uvs_ = meshes.uv;
    }

    scene_.reset(rtcNewScene(device_.get()));
    require(scene_ != nullptr, device_.get(), "rtcNewScene");
    rtcSetSceneFlags(scene_.get(), RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(scene_.get(), RTC_BUILD_QUALITY_HIGH);
    if (!triangles_.empty()) {
        const RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
        auto *vertices = static_cast<float *>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0,
                                                                      RTC_FORMAT_FLOAT3, 3 * sizeof(float),
                                                                      meshes.position.size()));
        auto *faces = static_cast<uint32_t *>(rtcSetNewGeometryBuffer(
            geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(uint32_t), indices.size()));
        require(vertices != nullptr && faces != nullptr, device_.get(), "rtcSetNewGeometryBuffer");
        for (size_t i = 0; i < meshes.position.size(); ++i) {
            std::copy_n(meshes.position[i].data(), 3, vertices + 3 * i);
        }
        for (size_t i = 0; i < indices.size(); ++i) {
            std::copy_n(indices[i].data(), 3, faces + 3 * i);
        }
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene_.get(), geometry);
        rtcReleaseGeometry(geometry);
    }
    rtcCommitScene(scene_.get());
    require(true, device_.get(), "rtcCommitScene");
    stats_.build_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

bool Geometry::intersect(const Ray &ray, Coherence coherence, SurfacePoint &hit) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = coherence == Coherence::coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT
                                                     : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    RTCRayHit query;
    query.ray.org_x = static_cast<float>(ray.origin.x());
    query.ray.org_y = static_cast<float>(ray.origin.y());
    query.ray.org_z = static_cast<float>(ray.origin.z());
    query.ray.tnear = 0.0f;
    query.ray.dir_x = static_cast<float>(ray.direction.x());
    query.ray.dir_y = static_cast<float>(ray.direction.y());
    query.ray.dir_z = static_cast<float>(ray.direction.z());
    query.ray.time = 0.0f;
    query.ray.tfar = std::numeric_limits<float>::infinity();
    query.ray.mask = 0xffffffffu;
    query.ray.id = 0;
    query.ray.flags = 0;
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene_.get(), &context, &query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) {
        return false;
    }
    hit.triangle = query.hit.primID;
    const TriangleRecord &triangle = triangles_[hit.triangle];
    hit.barycentric = intersect_plane(ray, triangle, {query.hit.u, query.hit.v});
    hit.position = triangle.point(hit.barycentric);
    return true;
}

bool Geometry::occluded(const Vec3 &from, const Vec3 &to) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    const Vec3 segment = to - from;
    RTCRay query;
    query.org_x = static_cast<float>(from.x());
    query.org_y = static_cast<float>(from.y());
    query.org_z = static_cast<float>(from.z());
    query.tnear = 0.0f;
    query.dir_x = static_cast<float>(segment.x());
    query.dir_y = static_cast<float>(segment.y());
    query.dir_z = static_cast<float>(segment.z());
    query.time = 0.0f;
    query.tfar = 1.0f;
    query.mask = 0xffffffffu;
    query.id = 0;
    query.flags = 0;
    rtcOccluded1(scene_.get(), &context, &query);
    return query.tfar < 0.0f;
}

Parametrization Geometry::parametrize(const SurfacePoint &point) const {
    const TriangleRecord &triangle = triangles_[point.triangle];
    Parametrization result{triangle.normal, triangle.edge1, Eigen::Vector2d::Zero()};
    if (!triangle.has_normals && !triangle.has_uv) {
        return result;
    }
    const auto &[a, b, c] = vertices_[point.triangle];
    const double u = point.barycentric.x(), v = point.barycentric.y();
    if (triangle.has_normals) {
        const Vec3 normal = (1.0 - u - v) * normals_[a].cast<double>() + u * normals_[b].cast<double>() +
                            v * normals_[c].cast<double>();
        const double length = normal.norm();
        // Opposite normals cancel; what is left of them below 1e-6 is rounding to float.
        if (length > 1e-6) {
            result.shading_normal = normal / length;
        }
    }
    if (triangle.has_uv) {
        const Eigen::Vector2d uv0 = uvs_[a].cast<double>();
        const Eigen::Vector2d along1 = uvs_[b].cast<double>() - uv0, along2 = uvs_[c].cast<double>() - uv0;
        result.uv = uv0 + u * along1 + v * along2;
        // edge = dp/du du + dp/dv dv for both edges, solved for dp/du.
        const double determinant = along1.x() * along2.y() - along2.x() * along1.y();
        if (std::abs(determinant) > 1e-12 * along1.norm() * along2.norm()) {
            result.tangent = (along2.y() * triangle.edge1 - along1.y() * triangle.edge2) / determinant;
        }
    }
    return result;
}

Vec3 Geometry::spawn_point(const SurfacePoint &point, const Vec3 &direction) const {
    const TriangleRecord &triangle = triangles_[point.triangle];
    const double side = std::copysign(triangle.offset, triangle.normal.dot(direction));
    const double smallest =
        std::min({point.barycentric.x(), point.barycentric.y(), 1.0 - point.barycentric.sum()});
    if (smallest >= triangle.margin) {
        return point.position + side * triangle.normal;
    }
    // Towards the centroid until the nearest edge is `margin` away.
    const double share = (triangle.margin - smallest) / (1.0 / 3.0 - smallest);
    const Eigen::Vector2d inner =
        point.barycentric + share * (Eigen::Vector2d::Constant(1.0 / 3.0) - point.barycentric);
    return triangle.point(inner) + side * triangle.normal;
}

}  // namespace rtrays::reference
