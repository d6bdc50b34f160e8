// SPDX-License-Identifier: MIT
#include "reference/embree_shapes.h"

#include <limits>

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
    auto &query = *static_cast<ShapeQuery *>(args->context);
    auto &result =
        *reinterpret_cast<RTCRayHit *>(args->rayhit);  // N is 1, because only rtcIntersect1 is used
    const Shape &shape = static_cast<const Shape *>(args->geometryUserPtr)[args->primID];
    double t = 0.0;
    Vec3 object;
    if (args->valid[0] != 0 &&
        shape.intersect(*query.ray, static_cast<double>(result.ray.tfar), t, object)) {
        query.object = object;
        result.ray.tfar = static_cast<float>(t);
        result.hit.geomID = shapes_id;
        result.hit.primID = args->primID;
    }
}

void occlude_shape(const RTCOccludedFunctionNArguments *args) {
    const auto &query = *static_cast<const ShapeQuery *>(args->context);
    auto &ray = *reinterpret_cast<RTCRay *>(args->ray);
    const Shape &shape = static_cast<const Shape *>(args->geometryUserPtr)[args->primID];
    double t = 0.0;
    Vec3 object;
    if (args->valid[0] != 0 &&
        shape.intersect(*query.ray, static_cast<double>(ray.tfar), t, object)) {
        ray.tfar = -infinity;
    }
}

}  // namespace

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
