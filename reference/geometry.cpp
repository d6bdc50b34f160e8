// SPDX-License-Identifier: MIT
#include "reference/geometry.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <utility>

#include "reference/embree_shapes.h"
#include "renderer/base/error.h"

namespace rtrays::reference {

namespace {

constexpr unsigned triangles_id = 0;
constexpr float infinity = std::numeric_limits<float>::infinity();

void require(bool condition, RTCDevice device, const char *what) {
    if (!condition || rtcGetDeviceError(device) != RTC_ERROR_NONE) {
        throw run_error(fmt::format("embree: {} failed", what));
    }
}

void fill(RTCRay &query, const Ray &ray, float t_max) {
    query.org_x = static_cast<float>(ray.origin.x());
    query.org_y = static_cast<float>(ray.origin.y());
    query.org_z = static_cast<float>(ray.origin.z());
    query.tnear = 0.0f;
    query.dir_x = static_cast<float>(ray.direction.x());
    query.dir_y = static_cast<float>(ray.direction.y());
    query.dir_z = static_cast<float>(ray.direction.z());
    query.time = 0.0f;
    query.tfar = t_max;
    query.mask = 0xffffffffu;
    query.id = 0;
    query.flags = 0;
}

}  // namespace

Geometry::Geometry(const MeshArrays &meshes, const ShapeArrays &shapes,
                   std::vector<Opacity> opacities)
    : opacities_(std::move(opacities)) {
    const auto start = std::chrono::steady_clock::now();
    device_.reset(rtcNewDevice(nullptr));
    if (!device_) {
        throw run_error("embree: cannot create a device");
    }
    const auto version = rtcGetDeviceProperty(device_.get(), RTC_DEVICE_PROPERTY_VERSION);
    stats_.engine =
        fmt::format("embree {}.{}.{}", version / 10000, version / 100 % 100, version % 100);

    const size_t count = meshes.triangle.size();
    triangles_.reserve(count);
    std::vector<Triangle> indices;
    indices.reserve(count);
    for (uint32_t i = 0; i < count; ++i) {
        TriangleRecord record;
        if (make_record(meshes, i, record)) {
            triangles_.push_back(record);
            indices.push_back(meshes.triangle[i]);
            for (const Vec3 &corner : {record.vertex, Vec3(record.vertex + record.edge1),
                                       Vec3(record.vertex + record.edge2)}) {
                bounds_.extend(corner);
            }
        }
    }
    first_shape_ = static_cast<uint32_t>(triangles_.size());
    stats_.triangles = triangles_.size();
    stats_.degenerate_triangles = count - triangles_.size();
    const auto any = [](const std::vector<uint8_t> &flags) {
        return std::find(flags.begin(), flags.end(), 1) != flags.end();
    };
    if (any(meshes.has_normals) || any(meshes.has_uv) || any(meshes.has_colour)) {
        vertices_ = indices;
        normals_ = meshes.normal;
        uvs_ = meshes.uv;
        colours_ = meshes.colour;
    }
    for (uint32_t i = 0; i < shapes.kind.size(); ++i) {
        shapes_.emplace_back(shapes, i);
        if (shapes_.back().is_bounded()) {
            bounds_.extend(shapes_.back().bounds());
        } else {
            unbounded_.push_back(i);
        }
    }
    stats_.shapes = shapes_.size();

    scene_.reset(rtcNewScene(device_.get()));
    require(scene_ != nullptr, device_.get(), "rtcNewScene");
    rtcSetSceneFlags(scene_.get(), RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(scene_.get(), RTC_BUILD_QUALITY_HIGH);
    if (!triangles_.empty()) {
        attach_triangles(meshes, indices);
    }
    if (shapes_.size() > unbounded_.size()) {
        attach_shapes(device_.get(), scene_.get(), shapes_);
        require(true, device_.get(), "user geometry");
    }
    rtcCommitScene(scene_.get());
    require(true, device_.get(), "rtcCommitScene");
    stats_.build_seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void Geometry::attach_triangles(const MeshArrays &meshes, const std::vector<Triangle> &indices) {
    const RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
    auto *vertices = static_cast<float *>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                3 * sizeof(float), meshes.position.size()));
    auto *faces = static_cast<uint32_t *>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                3 * sizeof(uint32_t), indices.size()));
    require(vertices != nullptr && faces != nullptr, device_.get(), "rtcSetNewGeometryBuffer");
    for (size_t i = 0; i < meshes.position.size(); ++i) {
        std::copy_n(meshes.position[i].data(), 3, vertices + 3 * i);
    }
    for (size_t i = 0; i < indices.size(); ++i) {
        std::copy_n(indices[i].data(), 3, faces + 3 * i);
    }
    if (!is_opaque()) {
        attach_opacity(geometry);
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(scene_.get(), geometry, triangles_id);
    rtcReleaseGeometry(geometry);
}

Ray Geometry::from_nearby(const Ray &ray) const {
    if (bounds_.isEmpty() || !unbounded_.empty()) {
        return ray;
    }
    const double radius = 0.5 * bounds_.diagonal().norm();
    const double distance = (ray.origin - bounds_.center()).norm() - 2.0 * radius;
    if (!(distance > 1000.0 * radius)) {
        return ray;
    }
    return {ray.origin + distance / ray.direction.norm() * ray.direction, ray.direction};
}

SurfacePoint Geometry::triangle_point(const Ray &ray, uint32_t triangle,
                                      const Eigen::Vector2d &barycentric) const {
    const TriangleRecord &record = triangles_[triangle];
    const Eigen::Vector2d at = record.intersect_plane(ray, barycentric);
    return {record.point(at), {at.x(), at.y(), 0.0}, triangle};
}

bool Geometry::stops(const SurfacePoint &hit, uint64_t key, uint32_t earlier_hits) const {
    const Opacity &opacity = opacities_[material(hit)];
    return opacity.is_opaque() ||
           is_stopped(opacity.at(parametrize(hit).uv), key, hit.primitive, earlier_hits);
}

bool Geometry::intersect(const Ray &from_anywhere, Coherence coherence, SurfacePoint &hit,
                         uint64_t key) const {
    const Ray ray = from_nearby(from_anywhere);
    SceneQuery query(*this, ray, key, coherence == Coherence::coherent);
    RTCRayHit result;
    fill(result.ray, ray, infinity);
    result.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    result.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene_.get(), &query, &result);
    for (const uint32_t i : unbounded_) {
        double t = 0.0;
        Vec3 object;
        if (query.meets_shape(i, static_cast<double>(result.ray.tfar), t, object)) {
            query.object = object;
            result.ray.tfar = static_cast<float>(t);
            result.hit.geomID = shapes_id;
            result.hit.primID = i;
        }
    }
    if (result.hit.geomID == triangles_id) {
        hit = triangle_point(ray, result.hit.primID, {result.hit.u, result.hit.v});
        return true;
    }
    if (result.hit.geomID == shapes_id) {
        hit.primitive = first_shape_ + result.hit.primID;
        hit.local = query.object;
        hit.position = shapes_[result.hit.primID].to_world(query.object);
        return true;
    }
    return false;
}

bool Geometry::blocked(const Ray &ray, double t_max, uint64_t key) const {
    SceneQuery query(*this, ray, key, false);
    RTCRay result;
    fill(result, ray, static_cast<float>(t_max));
    rtcOccluded1(scene_.get(), &query, &result);
    if (result.tfar < 0.0f) {
        return true;
    }
    return std::any_of(unbounded_.begin(), unbounded_.end(), [&](uint32_t i) {
        double t = 0.0;
        Vec3 object;
        return query.meets_shape(i, t_max, t, object);
    });
}

bool Geometry::occluded(const Ray &ray, uint64_t key) const {
    return blocked(ray, std::numeric_limits<double>::infinity(), key);
}

Parametrization Geometry::parametrize(const SurfacePoint &point) const {
    if (!is_triangle(point)) {
        const Shape &surface = shape(point);
        return {surface.normal(point.local), surface.tangent(point.local), surface.uv(point.local)};
    }
    const TriangleRecord &record = triangle(point);
    Parametrization result{record.normal, record.edge1, Eigen::Vector2d::Zero()};
    if (!record.has_normals && !record.has_uv && !record.has_colour) {
        return result;
    }
    const auto &[a, b, c] = vertices_[point.primitive];
    const double u = point.local.x(), v = point.local.y();
    if (record.has_normals) {
        const Vec3 normal = (1.0 - u - v) * normals_[a].cast<double>() +
                            u * normals_[b].cast<double>() + v * normals_[c].cast<double>();
        const double length = normal.norm();
        // Opposite normals cancel. A length below 1e-6 is rounding error of the float normals.
        if (length > 1e-6) {
            result.shading_normal = normal / length;
        }
    }
    if (record.has_colour) {
        const auto colour_of = [this](uint32_t i) -> Spectrum {
            return colours_[i].cast<double>().array();
        };
        result.colour =
            ((1.0 - u - v) * colour_of(a) + u * colour_of(b) + v * colour_of(c)).max(0.0);
    }
    if (record.has_uv) {
        const Eigen::Vector2d uv0 = uvs_[a].cast<double>();
        const Eigen::Vector2d along1 = uvs_[b].cast<double>() - uv0,
                              along2 = uvs_[c].cast<double>() - uv0;
        result.uv = uv0 + u * along1 + v * along2;
        // Both edges satisfy edge = dp/du du + dp/dv dv, which is solved for dp/du.
        const double determinant = along1.x() * along2.y() - along2.x() * along1.y();
        if (std::abs(determinant) > 1e-12 * along1.norm() * along2.norm()) {
            result.tangent = (along2.y() * record.edge1 - along1.y() * record.edge2) / determinant;
            result.along_v = (along1.x() * record.edge2 - along2.x() * record.edge1) / determinant;
            result.derivatives = true;
        }
    }
    return result;
}

}  // namespace rtrays::reference
