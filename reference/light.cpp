// SPDX-License-Identifier: MIT
#include "reference/light.h"

#include <fmt/format.h>

#include <numeric>
#include <utility>

#include "renderer/base/error.h"

namespace rtrays::reference {

namespace {

constexpr double uniform_share = 0.5;  ///< of the selection probability; the rest goes by power

std::vector<double> triangle_areas(const Geometry &geometry, const std::vector<uint32_t> &triangles) {
    std::vector<double> areas;
    areas.reserve(triangles.size());
    for (const uint32_t triangle : triangles) {
        areas.push_back(geometry.triangles()[triangle].area());
    }
    return areas;
}

}  // namespace

DiffuseAreaLight::DiffuseAreaLight(const Geometry &geometry, std::vector<uint32_t> triangles,
                                   const Spectrum &radiance)
    : triangles_(std::move(triangles)), radiance_(radiance) {
    const std::vector<double> areas = triangle_areas(geometry, triangles_);
    choose_ = AliasTable(areas);
    area_ = std::accumulate(areas.begin(), areas.end(), 0.0);
}

std::optional<LightSample> DiffuseAreaLight::sample(const Geometry &geometry, const Vec3 &from,
                                                    Rng &rng) const {
    const uint32_t triangle = triangles_[choose_.sample(rng)];
    const TriangleRecord &record = geometry.triangles()[triangle];
    SurfacePoint point;
    point.primitive = triangle;
    const Eigen::Vector2d barycentric = sample_triangle(rng);
    point.local = {barycentric.x(), barycentric.y(), 0.0};
    point.position = record.point(barycentric);

    const Vec3 to_light = point.position - from;
    const double distance_squared = to_light.squaredNorm();
    const double projected = -record.normal.dot(to_light);  // cosine at the light times distance
    if (!(projected > 0.0)) {
        return std::nullopt;
    }
    const double distance = std::sqrt(distance_squared);
    // pdf_w = pdf_a d^2 / cos (Veach 1997, eq. 8.10), in a form that keeps d^3 from under- or overflowing
    // before the rest does.
    const double pdf_w = distance_squared * (distance / projected) / area_;
    return LightSample{to_light / distance, geometry.spawn_point(point, -to_light), radiance_, pdf_w, false};
}

double DiffuseAreaLight::pdf_w(const Geometry &geometry, const Vec3 &from, const SurfacePoint &hit) const {
    const Vec3 to_light = hit.position - from;
    const double projected = -geometry.normal(hit).dot(to_light);
    if (!(projected > 0.0)) {
        return 0.0;
    }
    const double distance_squared = to_light.squaredNorm();
    return distance_squared * (std::sqrt(distance_squared) / projected) / area_;
}

Spectrum DiffuseAreaLight::emitted(const Geometry &geometry, const SurfacePoint &hit, const Vec3 &wo) const {
    return geometry.normal(hit).dot(wo) > 0.0 ? radiance_ : Spectrum::Zero();
}

LightSet::LightSet(const Geometry &geometry, const LightArrays &lights) {
    std::vector<std::vector<uint32_t>> triangles(lights.kind.size());
    for (uint32_t i = 0; i < geometry.triangles().size(); ++i) {
        const uint32_t light = geometry.triangles()[i].light;
        if (light != no_index) {
            triangles.at(light).push_back(i);
        }
    }
    std::vector<double> powers;
    for (size_t i = 0; i < lights.kind.size(); ++i) {
        const Spectrum radiance = lights.radiance[i].cast<double>();
        if (!(radiance >= 0.0).all() || !radiance.allFinite()) {
            throw input_error(
                fmt::format("light {} '{}': radiance must be finite and not negative", i, lights.name[i]));
        }
        if (lights.kind[i] != LightArrays::Kind::diffuse_area || lights.shape[i] != no_index) {
            throw input_error(
                fmt::format("light {} '{}': the reference does not know its kind", i, lights.name[i]));
        }
        if (triangles[i].empty()) {
            slot_.push_back(no_index);  // no area: it emits nothing
            continue;
        }
        slot_.push_back(static_cast<uint32_t>(lights_.size()));
        lights_.emplace_back(DiffuseAreaLight(geometry, std::move(triangles[i]), radiance));
        powers.push_back(std::visit([](const auto &light) { return light.power(); }, lights_.back()));
    }
    if (lights_.empty()) {
        return;
    }
    const double total = std::accumulate(powers.begin(), powers.end(), 0.0);
    std::vector<double> weights;
    for (const double power : powers) {
        const double uniform = 1.0 / static_cast<double>(powers.size());
        weights.push_back(total > 0.0 ? uniform_share * uniform + (1.0 - uniform_share) * power / total
                                      : uniform);
    }
    choose_ = AliasTable(weights);
}

std::optional<LightSample> LightSet::sample(const Geometry &geometry, const Vec3 &from, Rng &rng) const {
    const uint32_t chosen = choose_.sample(rng);
    auto sample =
        std::visit([&](const auto &light) { return light.sample(geometry, from, rng); }, lights_[chosen]);
    if (sample) {
        sample->pdf_w *= choose_.probability(chosen);
    }
    return sample;
}

double LightSet::pdf_w(const Geometry &geometry, uint32_t light, const Vec3 &from,
                       const SurfacePoint &hit) const {
    const uint32_t slot = slot_[light];
    return choose_.probability(slot) *
           std::visit([&](const auto &l) { return l.pdf_w(geometry, from, hit); }, lights_[slot]);
}

Spectrum LightSet::emitted(const Geometry &geometry, uint32_t light, const SurfacePoint &hit,
                           const Vec3 &wo) const {
    return std::visit([&](const auto &l) { return l.emitted(geometry, hit, wo); }, lights_[slot_[light]]);
}

}  // namespace rtrays::reference
