// SPDX-License-Identifier: MIT
#include "reference/area_light.h"

#include <fmt/format.h>

#include <numeric>
#include <utility>

#include "renderer/base/error.h"

namespace rtrays::reference {

namespace {

std::vector<double> triangle_areas(const Geometry &geometry,
                                   const std::vector<uint32_t> &triangles) {
    std::vector<double> areas;
    areas.reserve(triangles.size());
    for (const uint32_t triangle : triangles) {
        areas.push_back(geometry.triangles()[triangle].area());
    }
    return areas;
}

/// Returns the scale factor of a similarity transform. Throws `Error` (bad input) for any other
/// transform.
double scale_of(const Shape &shape) {
    const Eigen::Matrix3d gram = shape.linear().transpose() * shape.linear();
    const double squared = gram.trace() / 3.0;
    if ((gram - squared * Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() > 1e-6 * squared) {
        throw input_error("an emitting sphere must not be scaled non-uniformly or sheared");
    }
    return std::sqrt(squared);
}

/// Returns 1 - cos of the half angle of the cone that a sphere subtends, given the squared distance
/// from its centre. The form avoids cancellation for small cones.
double cone_height(double radius, double distance_squared) {
    const double sine_squared = square(radius) / distance_squared;
    return sine_squared / (1.0 + std::sqrt(1.0 - sine_squared));
}

}  // namespace

double DiffuseEmitter::pdf_w(const Geometry &geometry, const Vec3 &from,
                             const SurfacePoint &hit) const {
    const Vec3 to_light = hit.position - from;
    const double projected =
        -geometry.normal(hit).dot(to_light);  // cosine at the light times the distance
    if (!(projected > 0.0)) {
        return 0.0;
    }
    // pdf_w = pdf_a d^2 / cos (Veach 1997, eq. 8.10). This order of operations keeps d^3 from
    // under- or overflowing unless the result does.
    const double distance_squared = to_light.squaredNorm();
    return distance_squared * (std::sqrt(distance_squared) / projected) / area_;
}

std::optional<LightSample> DiffuseEmitter::look(const Geometry &geometry, const Vec3 &from,
                                                const SurfacePoint &point,
                                                const Vec3 &normal) const {
    const Vec3 to_light = point.position - from;
    const double distance_squared = to_light.squaredNorm();
    const double projected = -normal.dot(to_light);
    if (!(projected > 0.0)) {
        return std::nullopt;
    }
    const double distance = std::sqrt(distance_squared);
    // The density is pdf_a d^2 / cos, as in `pdf_w`.
    const double pdf_w = distance_squared * (distance / projected) / area_;
    return LightSample{to_light / distance,
                       geometry.spawn_point(point, -to_light),
                       radiance_at(geometry, point),
                       pdf_w,
                       false,
                       false};
}

MeshLight::MeshLight(const Geometry &geometry, std::vector<uint32_t> triangles,
                     const Spectrum &radiance)
    : DiffuseEmitter(0.0, radiance), triangles_(std::move(triangles)) {
    const std::vector<double> areas = triangle_areas(geometry, triangles_);
    choose_ = AliasTable(areas);
    area_ = std::accumulate(areas.begin(), areas.end(), 0.0);
}

std::optional<LightSample> MeshLight::sample(const Geometry &geometry, const Vec3 &from,
                                             Rng &rng) const {
    SurfacePoint point;
    point.primitive = triangles_[choose_.sample(rng)];
    const TriangleRecord &record = geometry.triangle(point);
    const Eigen::Vector2d barycentric = sample_triangle(rng);
    point.local = {barycentric.x(), barycentric.y(), 0.0};
    point.position = record.point(barycentric);
    return look(geometry, from, point, record.normal);
}

DiscLight::DiscLight(const Geometry &geometry, uint32_t shape, const Spectrum &radiance)
    : DiffuseEmitter(pi * geometry.shapes()[shape]
                              .linear()
                              .col(0)
                              .cross(geometry.shapes()[shape].linear().col(1))
                              .norm(),
                     radiance),
      shape_(shape),
      normal_(geometry.shapes()[shape].normal(Vec3::Zero())) {}

std::optional<LightSample> DiscLight::sample(const Geometry &geometry, const Vec3 &from,
                                             Rng &rng) const {
    const double radius = std::sqrt(rng.uniform());
    const double phi = 2.0 * pi * rng.uniform();
    SurfacePoint point;
    point.local = {radius * std::cos(phi), radius * std::sin(phi), 0.0};
    point.position = geometry.shapes()[shape_].to_world(point.local);
    point.primitive = static_cast<uint32_t>(geometry.triangles().size()) + shape_;
    return look(geometry, from, point, normal_);
}

SphereLight::SphereLight(const Geometry &geometry, uint32_t shape, const Spectrum &radiance)
    : DiffuseEmitter(4.0 * pi * square(scale_of(geometry.shapes()[shape])), radiance),
      shape_(shape),
      centre_(geometry.shapes()[shape].centre()),
      radius_(scale_of(geometry.shapes()[shape])),
      offset_(geometry.shapes()[shape].offset()) {}

std::optional<LightSample> SphereLight::sample(const Geometry &geometry, const Vec3 &from,
                                               Rng &rng) const {
    const Vec3 to_centre = centre_ - from;
    const double distance_squared = to_centre.squaredNorm();
    if (!(distance_squared > square(radius_))) {
        return std::nullopt;  // the inside of the sphere is dark
    }
    const double distance = std::sqrt(distance_squared);
    const double height = cone_height(radius_, distance_squared);
    const double below = rng.uniform() * height;  // 1 - cos(theta)
    const double sine_squared = below * (2.0 - below);
    const double sine = std::sqrt(sine_squared);
    const double phi = 2.0 * pi * rng.uniform();
    const Frame frame(to_centre / distance);
    const Vec3 wi = frame.to_world({sine * std::cos(phi), sine * std::sin(phi), 1.0 - below});
    // Half the chord of the ray, which gives the nearer intersection. The argument of the root is
    // negative only through rounding, at the rim.
    const double reach =
        std::sqrt(std::max(square(radius_) - distance_squared * sine_squared, 0.0));
    const Vec3 point = from + (distance * (1.0 - below) - reach) * wi;
    const Vec3 target = centre_ + (radius_ + offset_) * (point - centre_).normalized();
    SurfacePoint on_sphere;
    on_sphere.position = point;
    on_sphere.local = geometry.shapes()[shape_].to_object(point).normalized();
    on_sphere.primitive = static_cast<uint32_t>(geometry.triangles().size()) + shape_;
    return LightSample{wi,    target, radiance_at(geometry, on_sphere), 1.0 / (2.0 * pi * height),
                       false, false};
}

double SphereLight::pdf_w(const Geometry &, const Vec3 &from, const SurfacePoint &) const {
    const double distance_squared = (centre_ - from).squaredNorm();
    return distance_squared > square(radius_)
               ? 1.0 / (2.0 * pi * cone_height(radius_, distance_squared))
               : 0.0;
}

}  // namespace rtrays::reference
