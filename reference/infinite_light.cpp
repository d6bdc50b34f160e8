// SPDX-License-Identifier: MIT
#include "reference/infinite_light.h"

#include <algorithm>
#include <numeric>

#include "reference/texture.h"
#include "renderer/base/error.h"

namespace rtrays::reference {

namespace {

/// Samples x in [0, 1] with a density proportional to a + (b - a) x, where a + b > 0 (PBRT 4th ed.,
/// A.5.1). This form stays exact if a and b are equal or one is 0.
double sample_linear(double a, double b, Rng &rng) {
    const double u = rng.uniform();
    return u * (a + b) / (a + std::sqrt((1.0 - u) * a * a + u * b * b));
}

}  // namespace

std::optional<LightSample> DomeLight::sample(const Geometry &, const Vec3 &, Rng &rng) const {
    const double z = 1.0 - 2.0 * rng.uniform();
    const double phi = 2.0 * pi * rng.uniform();
    const double sine = std::sqrt((1.0 - z) * (1.0 + z));
    const Vec3 wi(sine * std::cos(phi), sine * std::sin(phi), z);
    return LightSample{wi, Vec3::Zero(), radiance_, 0.25 * inv_pi, false, true};
}

EnvironmentLight::EnvironmentLight(std::shared_ptr<const TextureImage> image,
                                   const Eigen::Matrix3d &rotation, const Spectrum &factor,
                                   double scene_radius, const std::string &what)
    : image_(std::move(image)), rotation_(rotation), factor_(factor), scene_radius_(scene_radius) {
    require_valid(image_.get(), what);
    std::vector<double> weights;
    for (int row = 0; row <= image_->height; ++row) {
        // Integral over v of the sine of the row's latitudes.
        const double band = (std::cos(pi * top(row)) - std::cos(pi * top(row + 1))) / pi;
        for (int column = 0; column < image_->width; ++column) {
            const auto c = corners({column, row, 0.0, 0.0});
            weights.push_back(0.25 * (c[0] + c[1] + c[2] + c[3]) * band / image_->width);
        }
    }
    const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
    mean_radiance_ = 0.5 * pi * total;  // the integral of the sine over v is 2 / pi
    if (total > 0.0) {
        choose_ = AliasTable(weights);
    }
}

double EnvironmentLight::top(int row) const {
    return std::clamp((row - 0.5) / image_->height, 0.0, 1.0);
}

Spectrum EnvironmentLight::corner(int column, int row) const {
    return factor_ * texel(*image_, column == image_->width ? 0 : column,
                           std::clamp(row, 0, image_->height - 1));
}

std::array<double, 4> EnvironmentLight::corners(const Cell &cell) const {
    return {corner(cell.column, cell.row - 1).mean(), corner(cell.column + 1, cell.row - 1).mean(),
            corner(cell.column, cell.row).mean(), corner(cell.column + 1, cell.row).mean()};
}

EnvironmentLight::Cell EnvironmentLight::cell_of(double u, double v) const {
    const double x = u * image_->width - 0.5;
    const double left = std::floor(x);
    const int column = static_cast<int>(left) + (left < 0.0 ? image_->width : 0);
    const int row =
        std::clamp(static_cast<int>(std::floor(v * image_->height + 0.5)), 0, image_->height);
    // At the poles both rows are equal, so the half height of the cell does not matter.
    const double down = (v - top(row)) / (top(row + 1) - top(row));
    return {std::min(column, image_->width - 1), row, x - left, std::clamp(down, 0.0, 1.0)};
}

Spectrum EnvironmentLight::interpolate(const Cell &cell) const {
    const double r = cell.right, d = cell.down;
    return (1.0 - d) * ((1.0 - r) * corner(cell.column, cell.row - 1) +
                        r * corner(cell.column + 1, cell.row - 1)) +
           d * ((1.0 - r) * corner(cell.column, cell.row) + r * corner(cell.column + 1, cell.row));
}

Eigen::Vector2d EnvironmentLight::to_image(const Vec3 &d) const {
    const double u = std::atan2(d.x(), -d.z()) / (2.0 * pi);
    // Equals acos(d.y) for a unit vector, without its loss of digits at the poles.
    return {u < 0.0 ? u + 1.0 : u, std::atan2(std::hypot(d.x(), d.z()), d.y()) / pi};
}

Spectrum EnvironmentLight::radiance(const Vec3 &direction) const {
    const Eigen::Vector2d uv = to_image(rotation_.transpose() * direction);
    return interpolate(cell_of(uv.x(), uv.y()));
}

double EnvironmentLight::pdf_w(const Vec3 &direction) const {
    if (is_black()) {
        return 0.0;
    }
    const Vec3 d = rotation_.transpose() * direction;
    const Eigen::Vector2d uv = to_image(d);
    const Cell cell = cell_of(uv.x(), uv.y());
    const auto c = corners(cell);
    const double sum = c[0] + c[1] + c[2] + c[3];
    if (!(sum > 0.0)) {
        return 0.0;
    }
    const double r = cell.right, down = cell.down;
    const double value =
        (1.0 - down) * ((1.0 - r) * c[0] + r * c[1]) + down * ((1.0 - r) * c[2] + r * c[3]);
    const auto index = static_cast<size_t>(cell.row) * static_cast<size_t>(image_->width) +
                       static_cast<size_t>(cell.column);
    const double cell_area = (top(cell.row + 1) - top(cell.row)) / image_->width;
    const double pdf_uv = choose_.probability(index) * 4.0 * value / sum / cell_area;
    // dw = 2 pi^2 sin(theta) du dv. The density is infinite at the poles. There light sampling has
    // the full MIS weight and probability zero.
    return pdf_uv / (2.0 * square(pi) * std::hypot(d.x(), d.z()));
}

std::optional<LightSample> EnvironmentLight::sample(const Geometry &, const Vec3 &,
                                                    Rng &rng) const {
    if (is_black()) {
        return std::nullopt;
    }
    const auto index = static_cast<int>(choose_.sample(rng));
    Cell cell{index % image_->width, index / image_->width, 0.0, 0.0};
    const auto c = corners(cell);
    cell.down = sample_linear(c[0] + c[1], c[2] + c[3], rng);
    cell.right = sample_linear((1.0 - cell.down) * c[0] + cell.down * c[2],
                               (1.0 - cell.down) * c[1] + cell.down * c[3], rng);
    const double phi = 2.0 * pi * (cell.column + 0.5 + cell.right) / image_->width;
    const double theta = pi * (top(cell.row) + cell.down * (top(cell.row + 1) - top(cell.row)));
    const Vec3 d(std::sin(theta) * std::sin(phi), std::cos(theta),
                 -std::sin(theta) * std::cos(phi));
    const Vec3 wi = rotation_ * d;
    const double pdf = pdf_w(wi);
    if (!(pdf > 0.0 && std::isfinite(pdf))) {
        return std::nullopt;  // at a pole or on the rim of a black region, with probability zero
    }
    return LightSample{wi, Vec3::Zero(), radiance(wi), pdf, false, true};
}

}  // namespace rtrays::reference
