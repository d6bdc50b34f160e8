// SPDX-License-Identifier: MIT
// Tests cameras with the device code compiled for the host: rays, their density, and connections of
// scene points to the lens.
//
// Two chi-square tests share a family-wise level of 0.01, so each has the level 0.01 / 2
// (Bonferroni). A planted error shows that the sample count suffices to detect 2 %.
#define FEATURE_lens 1
#include "testing/other_features.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <array>
#include <limits>

#include "renderer/base/angles.h"
#include "renderer/compile/compile_scene.h"
#include "renderer/kernels/camera/perspective.h"
#include "renderer/kernels/sampling/random.h"
#include "renderer/testing/chi_square.h"
#include "renderer/testing/float_traps.h"
#include "renderer/testing/shapes_double.h"

namespace rtrays {
namespace {

using test::log_uniform;
using test::Random;
using test::to_double;
using test::to_float3;
using test::uniform;

constexpr double half_ulp = 0x1p-24;
constexpr uint32_t sample_count = 400000;
constexpr double level = 0.01 / 2;

uint4 words(uint32_t i, uint32_t block) {
    return random_words(7, STREAM_CAMERA, i, 0, block);
}

CameraArrays one_camera(CameraArrays::FovAxis axis, double aperture_radius, double focus_distance) {
    CameraArrays cameras;
    cameras.name = {"camera"};
    cameras.world_from_camera = {Eigen::Matrix4d::Identity()};
    cameras.fov = {pi / 2};
    cameras.fov_axis = {axis};
    cameras.aperture_radius = {aperture_radius};
    cameras.focus_distance = {focus_distance};
    return cameras;
}

TEST(Camera, RaysHitTheCornersOfTheFieldOfView) {
    using Axis = CameraArrays::FovAxis;
    // The film has 40 x 20 pixels. The tangent of half the field of view is 1 along the named axis.
    for (const auto &[axis, x, y] :
         {std::tuple(Axis::x, 1.0f, 0.5f), std::tuple(Axis::y, 2.0f, 1.0f),
          std::tuple(Axis::smaller, 2.0f, 1.0f), std::tuple(Axis::larger, 1.0f, 0.5f)}) {
        const CameraRecord camera = compile_camera(one_camera(axis, 0, 1), 0, 40, 20);
        const CameraRay corner = camera_ray(camera, 0, 0, 0.5f, 0.5f);  // top left
        EXPECT_NEAR(corner.direction.x / -corner.direction.z, -x, 1e-6f);
        EXPECT_NEAR(corner.direction.y / -corner.direction.z, y, 1e-6f);
        EXPECT_EQ(length(corner.origin), 0.0f);
        EXPECT_NEAR(camera_ray(camera, 20, 10, 0.5f, 0.5f).direction.z, -1.0f, 1e-6f);
        EXPECT_NEAR(camera.pixel_area, x * 2 / 40 * y * 2 / 20, 1e-6f);
    }
}

TEST(Camera, LensRaysOfAFilmPositionMeetInThePlaneOfFocus) {
    const CameraRecord camera =
        compile_camera(one_camera(CameraArrays::FovAxis::x, 0.25, 3), 0, 40, 20);
    const float x = 31.5f, y = 4.25f;
    const float3 through_centre = make_float3(x / 20 - 1, (10 - y) / 20, -1) * 3.0f;
    for (uint32_t i = 0; i < 1000; ++i) {
        const uint4 w = words(i, 8);
        const CameraRay ray = camera_ray(camera, x, y, uniform_float(w.x), uniform_float(w.y));
        EXPECT_EQ(ray.origin.z, 0.0f);
        EXPECT_LE(length(ray.origin), 0.25f * (1 + 1e-6f));
        const float3 met = ray.origin + ray.direction * (-3.0f / ray.direction.z);
        EXPECT_NEAR(length(met - through_centre), 0.0f, 2e-6f);
    }
}

double lens_p(double planted) {
    const CameraRecord camera =
        compile_camera(one_camera(CameraArrays::FovAxis::x, 0.25, 3), 0, 40, 20);
    constexpr int rings = 10, sectors = 16;
    std::vector<uint64_t> observed(rings * sectors);
    for (uint32_t i = 0; i < sample_count; ++i) {
        const uint4 w = words(i, 9);
        const float3 on = camera_ray(camera, 3, 4, uniform_float(w.x), uniform_float(w.y)).origin;
        const double r2 = static_cast<double>(on.x * on.x + on.y * on.y) / (0.25 * 0.25);
        const double phi =
            std::atan2(static_cast<double>(on.y), static_cast<double>(on.x)) / (2 * pi) + 0.5;
        const int ring = std::min(static_cast<int>(r2 * rings), rings - 1);
        ++observed[static_cast<size_t>(ring * sectors +
                                       std::min(static_cast<int>(phi * sectors), sectors - 1))];
    }
    std::vector<double> expected(observed.size(), double(sample_count) / (rings * sectors));
    for (size_t i = 0; i < expected.size() / 2; ++i) {
        expected[i] *= 1 + planted;
    }
    return chi_square_p(observed, expected);
}

TEST(Camera, LensPointsAreUniform) {
    EXPECT_GT(lens_p(0.0), level);
    EXPECT_LT(lens_p(0.02), level);
}

/// A camera at a random position with a random field of view, from a telephoto lens to nearly half
/// of all directions.
struct RandomCamera {
    CameraRecord record{};
    double largest_slope;  ///< tangent of the angle between the axis and the corner of the film
    double pixel;          ///< side of a pixel on the plane at unit distance
    double lens_slope;     ///< radius of the lens over the focus distance

    explicit RandomCamera(Random &random, int largest_size = 4096) {
        const auto size = [&] { return static_cast<int>(std::pow(largest_size, uniform(random))); };
        const int width = size(), height = size();
        const bool pinhole = uniform(random) < 0.3;
        const double focus = pinhole ? 1.0 : log_uniform(random, -2, 3);
        const double aperture = pinhole ? 0.0 : focus * log_uniform(random, -4, 0.5);
        using Axis = CameraArrays::FovAxis;
        constexpr std::array<Axis, 4> axes = {Axis::x, Axis::y, Axis::smaller, Axis::larger};
        CameraArrays cameras =
            one_camera(axes[static_cast<size_t>(uniform(random, 0, 4))], aperture, focus);
        cameras.fov[0] = 2 * std::atan(log_uniform(random, -2, 2));
        cameras.world_from_camera[0].topLeftCorner<3, 3>() = test::uniform_rotation(random);
        cameras.world_from_camera[0].topRightCorner<3, 1>() =
            log_uniform(random, -3, 2) * test::uniform_direction(random);
        record = compile_camera(cameras, 0, width, height);
        pixel = std::sqrt(static_cast<double>(record.pixel_area));
        largest_slope = 0.5 * pixel * std::hypot(width, height);
        lens_slope = aperture / focus;
    }
};

// From far away, float resolves neither the position of the lens nor the directions of rays. Points
// of the rays at the scene must nevertheless be those of exact arithmetic, and be connected to the
// film position that they came from.
TEST(Camera, ResolvesASceneThatIsFarAway) {
    Random random(77);
    const SceneExtent extent = {{0.3, -0.2, 0.1}, 1.5};
    for (int i = 0; i < 20'000; ++i) {
        const double distance = log_uniform(random, 3.5, 7);
        const Eigen::Vector3d back = test::uniform_direction(random);
        CameraArrays cameras =
            one_camera(CameraArrays::FovAxis::x, i % 2 == 0 ? 0.0 : 0.5, distance);
        cameras.fov[0] = 2 * std::atan(1.5 / distance);
        Eigen::Matrix4d &world = cameras.world_from_camera[0];
        world.block<3, 1>(0, 2) = back;
        world.block<3, 1>(0, 0) = back.unitOrthogonal();
        world.block<3, 1>(0, 1) = back.cross(back.unitOrthogonal());
        world.block<3, 1>(0, 3) = extent.centre + distance * back;
        CameraRecord camera = compile_camera(cameras, 0, 512, 512);
        set_camera_start(cameras, 0, extent, camera);
        ASSERT_GT(camera.start_distance, 0.99 * distance - 2);

        const auto x = static_cast<float>(uniform(random, 0, 512)),
                   y = static_cast<float>(uniform(random, 0, 512));
        const float u = uniform_float(words(static_cast<uint32_t>(i), 9).x), v = 0.25f;
        const CameraRay ray = camera_ray(camera, x, y, u, v);
        const double pixel = 2 * std::tan(0.5 * cameras.fov[0]) / 512;
        const Eigen::Vector3d on_lens = to_double(point_on_lens(camera, u, v)),
                              film = world.topLeftCorner<3, 3>() *
                                     Eigen::Vector3d(pixel * (static_cast<double>(x) - 256),
                                                     pixel * (256 - static_cast<double>(y)), -1),
                              origin = world.block<3, 1>(0, 3) + on_lens,
                              way = (film * distance - on_lens).normalized();
        const Eigen::Vector3d point = to_double(ray.origin) + 2 * to_double(ray.direction);
        const Eigen::Vector3d error = (point - origin) - way * way.dot(point - origin);
        EXPECT_LT(error.norm(), 5e-6) << distance;  // a thousandth of a pixel
        EXPECT_GT(to_double(ray.origin).norm() + 0.5, extent.radius) << "outside the scene";

        const CameraConnection connection = camera_connection(camera, to_float3(point), u, v);
        ASSERT_GT(connection.pdf_w, 0.0f) << distance << " " << x << " " << y;
        EXPECT_NEAR(connection.raster.x, x, 2e-3) << distance;
        EXPECT_NEAR(connection.raster.y, y, 2e-3) << distance;
    }
}

TEST(Camera, BeginsOnTheLensUnlessItIsFarAndNoPlaneIsNear) {
    CameraRecord camera{};
    camera.position[2] = 5000;
    EXPECT_GT(camera_start_distance(camera, {{0, 0, 0}, 1}), 4990.0f);
    EXPECT_LT(camera_start_distance(camera, {{0, 0, 0}, 1}), 4999.0f);
    EXPECT_EQ(camera_start_distance(camera, {{0, 0, 0}, 10}), 0.0f);
    EXPECT_EQ(camera_start_distance(camera, {{0, 0, 0}, 1, true, false}), 0.0f);
    // A point of the lens may be nearer than its centre.
    camera.aperture_radius = 100;
    EXPECT_LT(camera_start_distance(camera, {{0, 0, 0}, 1}), 4899.0f);
    EXPECT_GT(camera_start_distance(camera, {{0, 0, 0}, 1}), 4890.0f);
}

// Connecting a point of a camera ray to the lens must give the raster position of the ray. The
// tolerance covers rounding of float directions and points. Slopes have errors of about
// u (slope + 1). Near the edge of a wide field, where cancellation dominates the forward component
// of the ray, errors are u slope^2.
TEST(Camera, ConnectsPointsOfARayToItsOrigin) {
    Random random(31);
    double worst = 0;
    int lost = 0, left_out = 0;
    constexpr int count = 300'000;
    for (int i = 0; i < count; ++i) {
        const RandomCamera camera(random);
        const CameraRecord &record = camera.record;
        const double x = uniform(random, 0, record.width), y = uniform(random, 0, record.height);
        const float u = static_cast<float>(uniform(random, 0, 0.999)),
                    v = static_cast<float>(uniform(random, 0, 0.999));
        const CameraRay ray =
            camera_ray(record, static_cast<float>(x), static_cast<float>(y), u, v);
        const double distance = log_uniform(random, -2, 4);
        const float3 point = to_float3(to_double(ray.origin) + distance * to_double(ray.direction));
        const CameraConnection connection = camera_connection(record, point, u, v);
        const Eigen::Vector3d forward = to_double(camera_forward(record));
        const double cosine = to_double(ray.direction).normalized().dot(forward);
        const double rounding =
            2 * half_ulp * to_double(point).cwiseAbs().maxCoeff() / (distance * cosine);
        if (!(rounding < 1e-3)) {
            ++left_out;  // rounding has destroyed the position of the point
            continue;
        }
        ASSERT_EQ(length(connection.lens_point - ray.origin), 0.0f);
        const double slope = camera.largest_slope + camera.lens_slope;
        const double error =
            8 * half_ulp * (1 + slope) * (1 + camera.largest_slope) + rounding * (1 + slope);
        const double pixels =
            error / camera.pixel + 2 * half_ulp * std::max(record.width, record.height);
        if (connection.pdf_w == 0.0f) {
            // Rounding may move a point at the edge of the film outside.
            const double edge = std::min({x, y, record.width - x, record.height - y});
            ASSERT_LT(edge, pixels);
            ++lost;
            continue;
        }
        const double off = std::max(std::abs(static_cast<double>(connection.raster.x) - x),
                                    std::abs(static_cast<double>(connection.raster.y) - y));
        ASSERT_LT(off, pixels) << i;
        worst = std::max(worst, pixels < 0.01 ? off : 0.0);
        // dw = cos^3 dA, so relative errors of the cosine are tripled.
        const auto pdf_w = static_cast<double>(connection.pdf_w);
        ASSERT_NEAR(static_cast<double>(camera_pdf_w(record, ray.direction)) / pdf_w, 1.0,
                    6 * error + 1e-6);
        ASSERT_NEAR(pdf_w * camera.pixel * camera.pixel * cosine * cosine * cosine, 1.0,
                    6 * error + 1e-6);
    }
    EXPECT_LT(worst, 5e-3);  // in pixels, for points whose tolerance is below 0.01
    EXPECT_LT(lost, count / 100);
    EXPECT_LT(left_out, count / 20);
}

// Compares the density with the solid angle of a small square of the film, which does not depend on
// the formula.
TEST(Camera, DensityIsThatOfTheRaysItMakes) {
    Random random(32);
    for (int i = 0; i < 20'000; ++i) {
        const RandomCamera camera(random, 64);
        const CameraRecord &record = camera.record;
        const auto x = static_cast<float>(uniform(random, 0.25, record.width - 0.25));
        const auto y = static_cast<float>(uniform(random, 0.25, record.height - 0.25));
        if (camera.pixel > 0.2 * (1 + camera.lens_slope) || camera.pixel < 1e-4 ||
            camera.largest_slope > 10) {
            continue;  // differences are too coarse or dominated by rounding
        }
        const float u = static_cast<float>(uniform(random, 0, 0.999)),
                    v = static_cast<float>(uniform(random, 0, 0.999));
        const auto direction = [&](float dx, float dy) {
            return to_double(camera_ray(record, x + dx, y + dy, u, v).direction).normalized();
        };
        constexpr float h = 0.25f;
        const Eigen::Vector3d along_x = direction(h, 0) - direction(-h, 0),
                              along_y = direction(0, h) - direction(0, -h);
        const double solid_angle = along_x.cross(along_y).norm() / (4.0 * 0.25 * 0.25);
        const CameraRay ray = camera_ray(record, x, y, u, v);
        const auto pdf_w = static_cast<double>(camera_pdf_w(record, ray.direction));
        const double tolerance = 8 * half_ulp / camera.pixel * (1 + camera.lens_slope) *
                                     (1 + camera.lens_slope) * (1 + camera.largest_slope) *
                                     (1 + camera.largest_slope) +
                                 camera.pixel * camera.pixel;
        if (tolerance < 0.01) {
            ASSERT_NEAR(pdf_w * solid_angle, 1.0, tolerance) << i;
        }
    }
}

/// Returns the integral of the density over the directions from a point of the lens that
/// `camera_connection` finds on the film. Uses midpoints of cosine and azimuth about the axis.
double total_density(const CameraRecord &camera, float u, float v, double largest_slope) {
    constexpr int rings = 1500, sectors = 1500;
    const double least_cosine = 1 / std::sqrt(1 + largest_slope * largest_slope);
    const Eigen::Vector3d z = to_double(camera_forward(camera));
    const Frame frame = frame_from_z(to_float3(z));
    const Eigen::Vector3d lens_point = to_double(camera_ray(camera, 0, 0, u, v).origin);
    double sum = 0;
    for (int i = 0; i < rings; ++i) {
        const double cosine = 1 - (1 - least_cosine) * (i + 0.5) / rings,
                     sine = std::sqrt(1 - cosine * cosine);
        for (int j = 0; j < sectors; ++j) {
            const double phi = 2 * pi * (j + 0.5) / sectors;
            const Eigen::Vector3d d = sine * std::cos(phi) * to_double(frame.x) +
                                      sine * std::sin(phi) * to_double(frame.y) + cosine * z;
            sum += static_cast<double>(
                camera_connection(camera, to_float3(lens_point + 7 * d), u, v).pdf_w);
        }
    }
    return sum * 2 * pi * (1 - least_cosine) / (double(rings) * sectors);
}

// A sample per pixel gives a total density equal to the number of pixels.
TEST(Camera, DensityIntegratesToTheNumberOfPixels) {
    using Axis = CameraArrays::FovAxis;
    const CameraRecord pinhole = compile_camera(one_camera(Axis::x, 0, 1), 0, 40, 20);
    EXPECT_NEAR(total_density(pinhole, 0.3f, 0.4f, std::hypot(1.0, 0.5)), 800, 800 * 2e-3);
    const CameraRecord tall = compile_camera(one_camera(Axis::x, 0, 1), 0, 10, 30);
    EXPECT_NEAR(total_density(tall, 0.3f, 0.4f, std::hypot(1.0, 3.0)), 300, 300 * 2e-3);
    const CameraRecord lens = compile_camera(one_camera(Axis::y, 0.6, 3), 0, 40, 20);
    EXPECT_NEAR(total_density(lens, 0.9f, 0.15f, std::hypot(2.0, 1.0) + 0.2), 800, 800 * 2e-3);
}

TEST(Camera, ConnectsPointsInFocusToOnePositionFromAllOfTheLens) {
    const double aperture = 0.25, focus = 3;
    const CameraRecord camera =
        compile_camera(one_camera(CameraArrays::FovAxis::x, aperture, focus), 0, 40, 20);
    const double pixel = 2.0 / 40;
    for (const double depth : {3.0, 1.5, 12.0}) {
        const Eigen::Vector3d point(0.2 * depth, -0.1 * depth, -depth);
        // A point out of focus covers a disc on the film. Its radius is that of the lens, projected
        // to the plane in focus.
        const double blur = aperture * std::abs(1 / focus - 1 / depth) / pixel;
        double largest = 0;
        for (uint32_t i = 0; i < 1000; ++i) {
            const uint4 w = words(i, 8);
            const CameraConnection connection =
                camera_connection(camera, to_float3(point), uniform_float(w.x), uniform_float(w.y));
            ASSERT_GT(connection.pdf_w, 0.0f);
            const double off =
                std::hypot(static_cast<double>(connection.raster.x) - (20 + 0.2 / pixel),
                           static_cast<double>(connection.raster.y) - (10 + 0.1 / pixel));
            ASSERT_LT(off, blur + 1e-4);
            largest = std::max(largest, off);
        }
        EXPECT_GE(largest, 0.99 * blur);
    }
}

TEST(Camera, SeesNothingBehindBesideOrInTheLens) {
    const float inf = std::numeric_limits<float>::infinity(),
                nan = std::numeric_limits<float>::quiet_NaN();
    const test::InvalidAllowed points_that_are_none;
    for (const double aperture : {0.0, 0.25}) {
        const CameraRecord camera =
            compile_camera(one_camera(CameraArrays::FovAxis::x, aperture, 3), 0, 40, 20);
        for (const float3 point :
             {make_float3(0, 0, 1), make_float3(0, 0, 0), make_float3(1, 0, 0),
              make_float3(5, 0, -1), make_float3(0, 5, -1), make_float3(1, 1, -1e-42f),
              make_float3(1e30f, 0, -1e-30f), make_float3(inf, 0, -1), make_float3(inf, 0, -inf),
              make_float3(nan, 0, -1), make_float3(0, 0, nan), make_float3(0, 0, inf),
              make_float3(0, 0, -inf)}) {
            EXPECT_EQ(camera_connection(camera, point, 0.5f, 0.25f).pdf_w, 0.0f)
                << point.x << ' ' << point.y << ' ' << point.z;
        }
        const CameraConnection far =
            camera_connection(camera, make_float3(0, 0, -1e37f), 0.5f, 0.25f);
        EXPECT_NEAR(far.pdf_w, 1 / camera.pixel_area,
                    0.02 / static_cast<double>(camera.pixel_area));
        EXPECT_TRUE(std::isfinite(far.raster.x) && std::isfinite(far.raster.y));
    }
    // The left and upper edges belong to the film, but the right and lower edges do not.
    const CameraRecord camera =
        compile_camera(one_camera(CameraArrays::FovAxis::x, 0, 1), 0, 40, 20);
    EXPECT_GT(camera_connection(camera, make_float3(-1, 0, -1), 0, 0).pdf_w, 0.0f);
    EXPECT_GT(camera_connection(camera, make_float3(0, 0.5f, -1), 0, 0).pdf_w, 0.0f);
    EXPECT_EQ(camera_connection(camera, make_float3(1, 0, -1), 0, 0).pdf_w, 0.0f);
    EXPECT_EQ(camera_connection(camera, make_float3(0, -0.5f, -1), 0, 0).pdf_w, 0.0f);
}

/// Result of connecting points on a tilted plane of radiance 1, which fills the view, to the
/// camera. The film has 8 x 6 pixels with an expected value of 1. `mean` is their mean, and `worst`
/// is the largest deviation in standard errors.
struct Film {
    double mean, worst;
};
Film splat_plane(double aperture, double planted) {
    const CameraRecord camera =
        compile_camera(one_camera(CameraArrays::FovAxis::x, aperture, 2), 0, 8, 6);
    constexpr size_t pixels = 48;
    constexpr uint32_t count = 8'000'000;
    const double side = 26;  // covers the view of the film
    const Eigen::Vector3d normal = Eigen::Vector3d(0.2, -0.3, 1).normalized();
    const Eigen::Vector3d x = normal.unitOrthogonal(), y = normal.cross(x);
    std::array<double, pixels> sum{}, squares{};
    for (uint32_t i = 0; i < count; ++i) {
        const uint4 w = words(i, 10);
        const Eigen::Vector3d p = Eigen::Vector3d(0, 0, -5) +
                                  side * ((static_cast<double>(uniform_float(w.x)) - 0.5) * x +
                                          (static_cast<double>(uniform_float(w.y)) - 0.5) * y);
        const CameraConnection connection =
            camera_connection(camera, to_float3(p), uniform_float(w.z), uniform_float(w.w));
        if (connection.pdf_w > 0.0f) {
            const Eigen::Vector3d way = to_double(connection.lens_point) - p;
            const double value = side * side * static_cast<double>(connection.pdf_w) *
                                 normal.dot(way) / std::pow(way.norm(), 3);
            const auto pixel = static_cast<size_t>(connection.raster.y) * 8 +
                               static_cast<size_t>(connection.raster.x);
            sum.at(pixel) += value * (pixel % 8 < 4 ? 1.0 : 1.0 + planted);
            squares.at(pixel) += value * value;
        }
    }
    Film film{0, 0};
    for (size_t i = 0; i < pixels; ++i) {
        const double mean = sum.at(i) / count,
                     error = std::sqrt((squares.at(i) / count - mean * mean) / count);
        film.mean += mean / pixels;
        film.worst = std::max(film.worst, std::abs(mean - 1) / error);
    }
    return film;
}

// Tests the importance, not only the geometry: light paths must add the mean radiance of each pixel
// to the film. 96 tests share a family-wise level of 0.01, so each may be 3.9 standard errors off.
TEST(Camera, ConnectionsAddUpToTheRadianceOfEachPixel) {
    for (const double aperture : {0.0, 0.3}) {
        const Film film = splat_plane(aperture, 0);
        EXPECT_LT(film.worst, 3.9);
        EXPECT_NEAR(film.mean, 1, 2e-3);
        EXPECT_GT(splat_plane(aperture, 0.02).worst, 3.9);
    }
}

}  // namespace
}  // namespace rtrays
