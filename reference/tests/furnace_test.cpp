// SPDX-License-Identifier: MIT
// Closed furnaces, whose radiance is L = E / (1 - rho).
//
// To prove that the furnaces notice errors, the production integrator also runs with BSDFs and
// lights that are wrong on purpose.
#include <gtest/gtest.h>

#include <boost/math/special_functions/gamma.hpp>

#include "reference/bsdf.h"
#include "reference/film.h"
#include "reference/integrator.h"
#include "reference/light.h"
#include "reference/tests/statistics.h"
#include "reference/tests/test_scenes.h"

namespace rtrays::reference {
namespace {

constexpr int size = 16;
constexpr uint64_t spp = 2048;
constexpr double z_999 = 3.2905;  // two-sided 99.9 %
const Rgb emission(1.0f, 0.5f, 0.25f);

/// Returns the deviation of the image's red mean from the closed form, in standard errors of the
/// mean.
double furnace_z(const Image &image, double albedo) {
    const BlockMean mean = image_mean(image, "R");
    const double expected = static_cast<double>(emission[0]) / (1.0 - albedo);
    return (mean.mean - expected) / std::sqrt(mean.variance);
}

class Furnace : public testing::TestWithParam<std::tuple<float, Strategies>> {};

TEST_P(Furnace, radiance_is_emission_over_one_minus_albedo) {
    const auto [albedo, strategies] = GetParam();
    // Uses the albedo as rounded to float.
    const double absorbed = 1.0 - static_cast<double>(albedo);
    auto renderer = furnace_box(albedo, emission).renderer(small_settings(size, 21, strategies));
    // The mean length of a path is 1 / absorbed. The spread of path values relative to the mean is
    // the same at any albedo.
    renderer.render(0, static_cast<uint64_t>(std::ceil(spp * std::min(1.0, 10.0 * absorbed))) + 48);
    const Image image = renderer.develop();
    EXPECT_LT(std::abs(furnace_z(image, static_cast<double>(albedo))), z_999);
    // The bound must be meaningful: one standard error is below 1 % of the value.
    EXPECT_LT(std::sqrt(image_mean(image, "R").variance), 0.01 / absorbed);
}

INSTANTIATE_TEST_SUITE_P(albedos, Furnace,
                         testing::Combine(testing::Values(0.5f, 0.9f, 0.99f, 0.999f),
                                          testing::Values(Strategies::implicit_only,
                                                          Strategies::mis)));

TEST(Furnace, survives_an_albedo_of_a_millionth_less_than_one) {
    // The implicit estimate is E times the number of vertices, which is geometrically distributed
    // with mean 1e6. The sum over k paths, divided by its mean, is Gamma(k, 1 / k) to within 1e-6.
    constexpr unsigned paths = 16;
    const float albedo = 1.0f - 1e-6f;
    auto renderer =
        furnace_box(albedo, emission).renderer(small_settings(1, 24, Strategies::implicit_only));
    renderer.render(0, paths);
    const double expected = 1.0 / (1.0 - static_cast<double>(albedo));
    const double ratio = image_mean(renderer.develop(), "R").mean / expected;
    const double below = boost::math::gamma_p(static_cast<double>(paths), paths * ratio);
    EXPECT_GT(below, 0.0005);
    EXPECT_LT(below, 0.9995);
}

TEST(Furnace, a_depth_limit_cuts_the_series_after_as_many_terms) {
    for (const uint32_t depth : {1u, 2u, 3u}) {
        ReferenceSettings settings = small_settings(size, 22);
        settings.max_depth = depth;
        auto renderer = furnace_box(0.5f, emission).renderer(settings);
        renderer.render(0, spp);
        const BlockMean mean = image_mean(renderer.develop(), "R");
        const double expected = (1.0 - std::pow(0.5, depth + 1.0)) / 0.5;
        EXPECT_LT(std::abs(mean.mean - expected), z_999 * std::sqrt(mean.variance))
            << "depth " << depth;
    }
}

// Planted errors follow.

/// The density of the sampled direction is 2 % too large.
struct WrongDensity : Lambert {
    using Lambert::Lambert;
    std::optional<BsdfSample> sample(const Vec3 &wo, const TexturePoint &at, Rng &rng) const {
        auto result = Lambert::sample(wo, at, rng);
        if (result) {
            result->weight /= 1.02;
        }
        return result;
    }
};

/// The cosine is missing from the explicit estimate.
struct MissingCosine : Lambert {
    using Lambert::Lambert;
    Spectrum evaluate(const Vec3 &wi, const Vec3 &wo, const TexturePoint &at) const {
        return Lambert::evaluate(wi, wo, at) / std::abs(wi.z());
    }
};

/// The MIS weights of the implicit estimate ignore the density of the light, so direct light counts
/// twice.
struct ForgottenMis : LightSet {
    using LightSet::LightSet;
    double pdf_w(const Geometry &, uint32_t, const Vec3 &, const SurfacePoint &) const {
        return 0.0;
    }
};

template <class BsdfModel, class Lights>
double planted_z(Strategies strategies) {
    const double albedo = 0.5;
    const TestScene scene = furnace_box(0.5f, emission);
    const Geometry geometry(scene.meshes, scene.shapes);
    const Lights lights(geometry, scene.lights);
    const std::vector<BsdfModel> bsdfs{BsdfModel(Spectrum::Constant(albedo))};
    const PathIntegrator<BsdfModel, Lights> integrator({geometry, bsdfs, lights}, strategies, 0);
    const Camera camera(scene.cameras, 0, size, size);
    Film film(size, size);
    RayCounts counts;
    for (uint64_t pixel = 0; pixel < film.pixels.size(); ++pixel) {
        for (uint64_t sample = 0; sample < spp; ++sample) {
            Rng rng(23, pixel, sample);
            const double x = static_cast<double>(pixel % size) + rng.uniform();
            const double y = static_cast<double>(pixel / size) + rng.uniform();
            film.pixels[pixel].add(integrator.radiance(camera.ray(x, y), rng, counts));
        }
    }
    film.add({0, spp});
    return furnace_z(film.develop(), albedo);
}

TEST(Furnace, notices_planted_errors) {
    // No planted error.
    EXPECT_LT(std::abs((planted_z<Lambert, LightSet>(Strategies::mis))), z_999);
    EXPECT_GT(std::abs((planted_z<WrongDensity, LightSet>(Strategies::implicit_only))), 2 * z_999);
    EXPECT_GT(std::abs((planted_z<WrongDensity, LightSet>(Strategies::mis))), 2 * z_999);
    EXPECT_GT(std::abs((planted_z<MissingCosine, LightSet>(Strategies::mis))), 2 * z_999);
    EXPECT_GT(std::abs((planted_z<Lambert, ForgottenMis>(Strategies::mis))), 2 * z_999);
}

}  // namespace
}  // namespace rtrays::reference
