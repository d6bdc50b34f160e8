// SPDX-License-Identifier: MIT
#include "reference/embree_shapes.h"

#include <limits>

#include "reference/geometry.h"

namespace rtrays::reference {

namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

/// Computes the bounding box of a shape in float. The padding makes the box large enough for the
/// float ray that replaces the double ray near it.
void shape_bounds(const RTCBoundsFunctionArguments *args) {
    const Shape &shape = static_cast<const Shape *>(args->geometryUserPtr)[args->primID];
    if (!shape.is_bounded()) {
        *args->bounds_o = {infinity,  infinity,  infinity,  0.0f,
                           -infinity, -infinity, -infinity, 0.0f};
        return;  // Embree skips primitives without valid bounds
    }
    const Eigen::AlignedBox3d &box = shape.bounds();
    const double pad = 16.0 * static_cast<double>(std::numeric_limits<float>::epsilon()) *
                       (box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs())).maxCoeff();
    const Eigen::Vector3f low = (box.min().array() - pad).cast<float>();
    const Eigen::Vector3f high = (box.max().array() + pad).cast<float>();
    *args->bounds_o = {low.x(), low.y(), low.z(), 0.0f, high.x(), high.y(), high.z(), 0.0f};
}

void intersect_shape(const RTCIntersectFunctionNArguments *args) {
    auto &query = *static_cast<SceneQuery *>(args->context);
    auto &result =
        *reinterpret_cast<RTCRayHit *>(args->rayhit);  // N is 1, because only rtcIntersect1 is used
    double t = 0.0;
    Vec3 object;
    if (args->valid[0] != 0 &&
        query.meets_shape(args->primID, static_cast<double>(result.ray.tfar), t, object)) {
        query.object = object;
        result.ray.tfar = static_cast<float>(t);
        result.hit.geomID = shapes_id;
        result.hit.primID = args->primID;
    }
}

void occlude_shape(const RTCOccludedFunctionNArguments *args) {
    const auto &query = *static_cast<const SceneQuery *>(args->context);
    auto &ray = *reinterpret_cast<RTCRay *>(args->ray);
    double t = 0.0;
    Vec3 object;
    if (args->valid[0] != 0 &&
        query.meets_shape(args->primID, static_cast<double>(ray.tfar), t, object)) {
        ray.tfar = -infinity;
    }
}

/// Rejects the hit of a triangle that lets the ray pass.
void filter_triangle(const RTCFilterFunctionNArguments *args) {
    const auto &query = *static_cast<const SceneQuery *>(args->context);
    const auto &hit = *reinterpret_cast<const RTCHit *>(args->hit);
    if (args->valid[0] == 0) {
        return;
    }
    const SurfacePoint point = query.geometry->triangle_point(
        *query.ray, hit.primID, {static_cast<double>(hit.u), static_cast<double>(hit.v)});
    if (!query.geometry->stops(point, query.key, 0)) {
        args->valid[0] = 0;
    }
}

}  // namespace

bool SceneQuery::meets_shape(uint32_t index, double t_max, double &t, Vec3 &at) const {
    const Shape &shape = geometry->shapes()[index];
    if (geometry->is_opaque()) {
        return shape.intersect(*ray, t_max, t, at);
    }
    Ray onwards = *ray;
    double passed = 0.0;
    for (uint32_t hit = 0; shape.intersect(onwards, t_max - passed, t, at); ++hit) {
        t += passed;
        const auto first = static_cast<uint32_t>(geometry->triangles().size());
        if (geometry->stops({shape.to_world(at), at, first + index}, key, hit)) {
            return true;
        }
        passed = t;
        onwards.origin = shape.spawn_point(at, ray->direction);
    }
    return false;
}

void attach_opacity(RTCGeometry triangles) {
    rtcSetGeometryIntersectFilterFunction(triangles, filter_triangle);
    rtcSetGeometryOccludedFilterFunction(triangles, filter_triangle);
}

void attach_shapes(RTCDevice device, RTCScene scene, std::vector<Shape> &shapes) {
    const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(shapes.size()));
    rtcSetGeometryUserData(geometry, shapes.data());
    rtcSetGeometryBoundsFunction(geometry, shape_bounds, nullptr);
    rtcSetGeometryIntersectFunction(geometry, intersect_shape);
    rtcSetGeometryOccludedFunction(geometry, occlude_shape);
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(scene, geometry, shapes_id);
    rtcReleaseGeometry(geometry);
}

}  // namespace rtrays::reference
