// SPDX-License-Identifier: MIT
// Tests of the pipeline on the device: kernels, buffers and launches of a scene, and the
// independence of the image's bits from all of them.
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "renderer/base/angles.h"
#include "renderer/bvh/bvh.h"
#include "renderer/device/context.h"
#include "renderer/device/source.h"
#include "renderer/import/load_scene.h"
#include "renderer/integrators/algorithm.h"
#include "renderer/session/render_session.h"
#include "renderer/shared/film_layout.h"
#include "renderer/testing/errors.h"
#include "renderer/testing/temporary_folder.h"

namespace rtrays {
namespace {

DeviceContext &device() {
    static DeviceContext context;
    return context;
}

Scene cornell_box() {
    return load_scene(RTRAYS_SCENES "/cornell_box/scene.json");
}

RenderSettings small(const std::vector<std::string> &assignments = {}) {
    RenderSettings settings;
    settings.width = settings.height = 32;
    settings.stream_capacity = 512;
    for (const std::string &assignment : assignments) {
        apply_setting(settings, assignment);
    }
    return settings;
}

std::vector<int64_t> render_words(const RenderSettings &settings, uint64_t split = 4) {
    RenderSession session(cornell_box(), settings, device());
    session.render(0, split);
    session.render(split, 4);
    const FilmState film = session.film();
    require_valid(film);
    return film.words;
}

std::vector<std::string> names(const nlohmann::json &list, const char *key) {
    std::vector<std::string> result;
    for (const auto &item : list) {
        result.push_back(item.at(key));
    }
    return result;
}

bool contains(const std::vector<std::string> &list, const std::string &name) {
    return std::find(list.begin(), list.end(), name) != list.end();
}

struct Mean {
    double value = 0;
    double standard_error = 0;
};

/// Returns the mean over a square of pixels, and its standard error from the variance layer.
Mean mean_of(const Image &image, const std::string &channel, int begin, int end) {
    Mean mean;
    const double n = (end - begin) * (end - begin);
    for (int y = begin; y < end; ++y) {
        for (int x = begin; x < end; ++x) {
            const auto i = static_cast<size_t>(y * image.width() + x);
            mean.value += static_cast<double>(image.channel(channel)[i]) / n;
            mean.standard_error +=
                static_cast<double>(image.channel("variance." + channel)[i]) / (n * n);
        }
    }
    mean.standard_error = std::sqrt(mean.standard_error);
    return mean;
}

class Algorithms : public testing::TestWithParam<std::string> {};

TEST_P(Algorithms, GiveTheSameBitsHoweverTheWorkIsCut) {
    const auto with = [&](const std::vector<std::string> &assignments) {
        RenderSettings settings = small(assignments);
        settings.algorithm = &algorithm_named(GetParam());
        return settings;
    };
    const std::vector<int64_t> words = render_words(with({}));
    EXPECT_NE(std::count(words.begin(), words.end(), 0), static_cast<long>(words.size()));
    EXPECT_EQ(render_words(with({})), words) << "a second run";
    EXPECT_EQ(render_words(with({}), 1), words) << "a batch split";
    // These settings are tested together, because most of them recompile every stage. Any change of
    // the image would show.
    EXPECT_EQ(render_words(with({"device.group_size=16", "device.stream_capacity=3000",
                                 "device.stream_chunk=7", "device.path_layout=arrays"}),
                           1),
              words)
        << "another group size, stream capacity, chunk of work and layout";
    EXPECT_EQ(render_words(with({"device.features=all"})), words) << "all features compiled in";
    if (!algorithm_named(GetParam()).is_random) {
        return;  // these algorithms use no random numbers
    }
    const std::vector<int64_t> sobol = render_words(with({"integrator.sampler=sobol"}));
    EXPECT_NE(sobol, words);
    EXPECT_EQ(render_words(with({"integrator.sampler=sobol", "device.features=all"}), 1), sobol);
}

// With Sobol points, a CPU draws the words of sixteen paths together where a work-item has as many.
TEST(Pipeline, DrawsTheSameWordsInBatchesAndOneByOne) {
    for (const std::string sampler : {"sobol", "regular"}) {
        const auto with_chunk = [&](const std::string &chunk) {
            RenderSettings settings =
                small({"integrator.sampler=" + sampler, "device.stream_chunk=" + chunk});
            settings.algorithm =
                &algorithm_named(sampler == "sobol" ? "truncated_bdpt" : "whitted");
            return render_words(settings);
        };
        const std::vector<int64_t> words = with_chunk("1");
        EXPECT_EQ(with_chunk("16"), words) << sampler;
        EXPECT_EQ(with_chunk("20"), words) << sampler;
    }
}

/// Without scattering, some algorithms see the lamp in both passes and must weight only these two
/// contributions.
TEST_P(Algorithms, GiveTheImageOfEverythingCompiledInWhereNothingScatters) {
    const Scene lamp = load_scene(RTRAYS_SCENES "/extreme/bright_lamp.json");
    RenderSettings settings = small();
    settings.algorithm = &algorithm_named(GetParam());
    const auto render = [&](CompiledFeatures features) {
        settings.features = features;
        RenderSession session(lamp, settings, device());
        session.render(0, 4);
        return develop_film(session.film());
    };
    const Image image = render(CompiledFeatures::scene), other = render(CompiledFeatures::all);
    for (const char *channel : {"R", "G", "B", "variance.R"}) {
        EXPECT_EQ(image.channel(channel), other.channel(channel)) << channel;
    }
}

INSTANTIATE_TEST_SUITE_P(All, Algorithms, testing::ValuesIn(algorithm_names()),
                         [](const auto &algorithm) { return algorithm.param; });

TEST(Pipeline, HierarchiesDifferInTiesAlone) {
    const std::vector<int64_t> words = render_words(small({}));
    for (const Named<BvhMethod> &method : bvh_methods) {
        for (const Named<BvhLayout> &layout : bvh_layouts) {
            const std::vector<int64_t> other =
                render_words(small({std::string("device.bvh_builder=") + method.name,
                                    std::string("device.bvh_layout=") + layout.name}));
            size_t different = 0;
            for (size_t i = 0; i < words.size(); ++i) {
                different += other[i] != words[i] ? 1 : 0;
            }
            EXPECT_LE(different, words.size() / 100) << method.name << ' ' << layout.name;
        }
    }
}

TEST(Pipeline, EverythingCompiledInChangesNoBit) {
    for (const char *strategies : {"integrator.strategies=implicit",
                                   "integrator.strategies=explicit", "integrator.strategies=mis"}) {
        const std::vector<int64_t> words = render_words(small({strategies}));
        EXPECT_EQ(render_words(small({strategies, "device.features=all"})), words) << strategies;
    }
    for (const char *termination :
         {"integrator.termination=fixed", "integrator.termination=adaptive"}) {
        const std::vector<int64_t> words =
            render_words(small({termination, "integrator.max_depth=3"}));
        EXPECT_EQ(
            render_words(small({termination, "integrator.max_depth=3", "device.features=all"})),
            words)
            << termination;
    }
}

TEST(Pipeline, MergesPassesThatWereRenderedApart) {
    RenderSettings settings = small();
    settings.algorithm = &algorithms::truncated_bdpt;
    const auto render = [&](std::optional<PassKind> pass) {
        settings.only_pass = pass;
        RenderSession session(cornell_box(), settings, device());
        session.render(0, 4);
        return session.film();
    };
    const FilmState whole = render({}), camera = render(PassKind::camera);
    FilmState merged = render(PassKind::light);
    expect_input_error("films differ in passes", [&] {
        FilmState film = merged;
        merge_film(film, whole);
    });
    merge_film(merged, camera);
    EXPECT_EQ(merged.words, whole.words);
    EXPECT_EQ(merged.passes, whole.passes);
    EXPECT_EQ(merged.light_paths, whole.light_paths);
    const Image image = develop_film(merged);
    for (size_t i = 0; i < image.pixel_count(); ++i) {
        ASSERT_NEAR(image.channel("camera.G")[i] + image.channel("light.G")[i],
                    image.channel("G")[i], 1e-6 * (1 + image.channel("G")[i]));
    }
    settings.algorithm = &algorithms::bdpt;
    expect_input_error("share their light paths", [&] { render(PassKind::light); });
    settings.only_pass.reset();
    settings.light_paths = 7;
    expect_input_error("one light path per camera path", [&] { render({}); });
    settings.light_paths = LIGHT_PATHS_LIKE_PIXELS;
    settings.algorithm = &algorithms::light_tracing;
    expect_input_error("light_tracing has no pass 'camera'", [&] { render(PassKind::camera); });
}

TEST(Pipeline, KeepsWhatARoundMaySplatWithinTheRoomOfAWord) {
    RenderSettings settings = small({"device.stream_capacity=1048576"});
    settings.algorithm = &algorithms::light_tracing;
    const RenderSession session(cornell_box(), settings, device());
    EXPECT_LE(2 * session.report()["stream"]["capacity"].get<uint64_t>(), FILM_ADDITIONS_AT_ONCE);
}

TEST(Pipeline, CountsFewerLightPathsInTheWeights) {
    // A quarter of the light paths changes the distribution of work, but not the expected image.
    const auto mean = [&](const char *light_paths) {
        RenderSettings settings = small({light_paths, "integrator.seen_emitters=camera"});
        settings.algorithm = &algorithms::truncated_bdpt;
        RenderSession session(cornell_box(), settings, device());
        session.render(0, 256);
        const Image image = session.develop();
        double light = 0;
        for (const float value : image.channel("light.G")) {
            light += static_cast<double>(value) / static_cast<double>(image.pixel_count());
        }
        return std::pair(mean_of(image, "G", 0, 32), light);
    };
    const auto [all, light_of_all] = mean("integrator.light_paths=1024");
    const auto [few, light_of_few] = mean("integrator.light_paths=64");
    EXPECT_LT(std::abs(all.value - few.value),
              4 * std::hypot(all.standard_error, few.standard_error));
    EXPECT_LT(all.standard_error, 0.01 * all.value) << "statistical power";
    EXPECT_LT(light_of_few, 0.7 * light_of_all);
}

// With 16 vertices, all strategies find all but the longest paths. With 1 vertex, connections find
// only paths of two scattering events. Nothing may be lost or counted twice on either side of the
// limit. Five differences from path tracing share a family-wise level of 0.01 (two-sided, Student's
// t with 31 degrees of freedom, Bonferroni), so each may be 3.4 standard errors off. The standard
// errors come from the spread of 32 batches.
TEST(Pipeline, ConnectsToAsManyVerticesAsSet) {
    const auto mean = [&](const std::string &algorithm, uint32_t seed,
                          const std::vector<std::string> &assignments,
                          const SourceOverlays &overlays = {}) {
        RenderSettings settings = small(assignments);
        settings.algorithm = &algorithm_named(algorithm);
        settings.seed = seed;
        settings.source_overlays = overlays;
        RenderSession session(cornell_box(), settings, device());
        std::vector<double> batches;
        for (uint64_t batch = 0; batch < 32; ++batch) {
            session.restart(seed);
            session.render(16 * batch, 16 * (batch + 1));
            batches.push_back(mean_of(session.develop(), "G", 0, 32).value);
        }
        Mean result;
        for (const double value : batches) {
            result.value += value / 32;
        }
        for (const double value : batches) {
            result.standard_error += std::pow(value - result.value, 2) / (32 * 31);
        }
        result.standard_error = std::sqrt(result.standard_error);
        return result;
    };
    const Mean expected = mean("path_tracing", 1, {});
    EXPECT_LT(expected.standard_error, 0.005 * expected.value) << "statistical power";
    const auto errors_off = [&](const Mean &found) {
        return std::abs(found.value - expected.value) /
               std::hypot(found.standard_error, expected.standard_error);
    };
    uint32_t seed = 2;
    for (const char *vertices : {"16", "8", "2", "1", "0"}) {
        EXPECT_LT(
            errors_off(mean("bdpt", seed++, {std::string("integrator.bdpt_vertices=") + vertices})),
            3.4)
            << vertices;
    }
    // Planted errors must be detected: a missing cosine in the connections, and a strategy that is
    // missing in all weights.
    const auto planted = [&](const char *file, const std::string &search, const char *replacement) {
        std::string text = device_source(file);
        const size_t at = text.find(search);
        EXPECT_NE(at, std::string::npos) << search;
        return errors_off(
            mean("bdpt", seed++, {}, {{file, text.replace(at, search.size(), replacement)}}));
    };
    EXPECT_GT(planted("kernels/path/vertex_connection.h", "weight * cos_there", "weight"), 6);
    EXPECT_GT(
        planted("kernels/mis/bidirectional.h", "return log_norm(log_a, log_reverse + log_s, beta);",
                "(void)log_a; (void)beta; return log_reverse + log_s;"),
        6);
}

TEST(Pipeline, KeepsLightVerticesInProportionToTheirNumber) {
    const auto report = [&](const char *algorithm, const char *assignment) {
        RenderSettings settings = small({assignment});
        settings.algorithm = &algorithm_named(algorithm);
        return RenderSession(cornell_box(), settings, device()).report();
    };
    const nlohmann::json truncated = report("truncated_bdpt", "integrator.max_depth=40");
    EXPECT_EQ(truncated["bytes_per_path"],
              report("truncated_bdpt", "integrator.max_depth=4")["bytes_per_path"]);
    const nlohmann::json four = report("bdpt", "integrator.bdpt_vertices=4");
    const int vertex = four["light_vertex_bytes_per_path"].get<int>() / 4;
    EXPECT_EQ(vertex, 44) << "hit, direction, throughput, two logarithms";
    const nlohmann::json sixteen = report("bdpt", "integrator.bdpt_vertices=16");
    EXPECT_EQ(sixteen["bytes_per_path"].get<int>() - four["bytes_per_path"].get<int>(),
              12 * vertex);
    uint64_t bytes = 0;
    for (const auto &buffer : sixteen["buffers"]) {
        const std::string name = buffer.at("name");
        bytes += name == "path_states" || name == "queues" || name == "light_vertices"
                     ? buffer.at("bytes").get<uint64_t>()
                     : 0;
    }
    EXPECT_EQ(bytes, sixteen["bytes_per_path"].get<uint64_t>() * 512);
}

TEST(Pipeline, ResumesAndMergesToTheSameBits) {
    RenderSession session(cornell_box(), small(), device());
    session.render(0, 4);
    const FilmState whole = session.film();
    session.restart(1);
    session.render(0, 1);
    const FilmState first = session.film();
    session.restart(1);
    session.render(1, 4);
    FilmState second = session.film();

    session.restart(1);
    session.restore(first);
    session.render(1, 4);
    EXPECT_EQ(session.film().words, whole.words) << "resumed";
    EXPECT_EQ(session.film().samples(), 4u);

    merge_film(second, first);
    EXPECT_EQ(second.words, whole.words) << "merged";

    expect_input_error("samples 3:5 overlap 0:4", [&] { session.render(3, 5); });
    RenderSession other(cornell_box(), small({"integrator.beta=1"}), device());
    expect_input_error(
        "the film was rendered with integrator.beta = 2, and this render has 1; resume with the "
        "integrator.beta of the film",
        [&] { other.restore(first); });
}

TEST(Pipeline, RestartsWithAnotherDepthToTheSameBits) {
    RenderSession session(cornell_box(), small({"integrator.max_depth=5"}), device());
    session.render(0, 2);
    session.restart(3, 2);
    session.render(0, 2);
    RenderSession fresh(cornell_box(), small({"integrator.max_depth=2"}), device());
    fresh.restart(3);
    fresh.render(0, 2);
    EXPECT_EQ(session.film().words, fresh.film().words);
    EXPECT_EQ(session.film().config, fresh.film().config);
    expect_input_error("max_depth=2 cannot become 0", [&] { session.restart(1, 0); });
    RenderSession unlimited(cornell_box(), small(), device());
    EXPECT_THROW(unlimited.restart(1, 2), Error);
    RenderSettings casting = small();
    casting.algorithm = &algorithm_named("ray_casting");
    RenderSession fixed(cornell_box(), casting, device());
    EXPECT_THROW(fixed.restart(1, 2), Error);
}

// Closed forms: every pixel of a furnace is E / (1 - rho). Explicit paths alone are not tested here
// but in experiments/harness/estimators_test.cpp. All walls emit, and cos cos / d^2 has no finite
// variance where two walls meet. The 13 means and the 3 means of the emitter below share a
// family-wise level of 0.01, so each may be 3.5 standard errors off (two-sided, Bonferroni). The
// standard errors are small enough to detect an error of 2 %.
constexpr double bound = 3.5;

TEST(ClosedForm, FurnaceGivesEmissionOverOneMinusAlbedo) {
    for (const auto &[file, albedo] : {std::pair("/analytic/furnace_050.json", 0.5f),
                                       std::pair("/analytic/furnace_090.json", 0.9f)}) {
        for (const char *strategies : {"implicit", "mis"}) {
            RenderSettings settings = small({std::string("integrator.strategies=") + strategies});
            RenderSession session(load_scene(RTRAYS_SCENES + std::string(file)), settings,
                                  device());
            session.render(0, 512);
            const Image image = session.develop();
            const double expected = 1.0 / (1.0 - static_cast<double>(albedo));
            for (const auto &[channel, emission] :
                 {std::pair("R", 1.0), std::pair("G", 0.5), std::pair("B", 0.25)}) {
                const Mean mean = mean_of(image, channel, 0, 32);
                EXPECT_LT(std::abs(mean.value - emission * expected), bound * mean.standard_error)
                    << file << " " << strategies << " " << channel;
                EXPECT_LT(mean.standard_error, 0.02 / (2 * bound) * emission * expected)
                    << "statistical power";
            }
        }
    }
}

// With 8 light paths per pixel the weights of both strategies matter.
TEST(ClosedForm, FurnaceOfImplicitAndLightPaths) {
    RenderSettings settings =
        small({"integrator.strategies=implicit", "integrator.light_paths=8192"});
    settings.algorithm = &algorithms::truncated_bdpt;
    RenderSession session(load_scene(RTRAYS_SCENES "/analytic/furnace_050.json"), settings,
                          device());
    session.render(0, 32);
    const Mean mean = mean_of(session.develop(), "R", 0, 32);
    EXPECT_LT(std::abs(mean.value - 2), bound * mean.standard_error);
    EXPECT_LT(mean.standard_error, 0.02 / (2 * bound) * 2) << "statistical power";
}

TEST(ClosedForm, IrradianceBelowASquareEmitter) {
    RenderSettings settings;
    settings.width = settings.height = 33;
    settings.max_depth = 1;
    settings.stream_capacity = 512;
    RenderSession session(load_scene(RTRAYS_SCENES "/analytic/emitter_direct.json"), settings,
                          device());
    session.render(0, 16384);
    const Image image = session.develop();
    const double a = 1.0, h = 2.0, r = std::sqrt(a * a + h * h);  // half side, height
    // Irradiance per unit radiance at the foot of the centre.
    const double irradiance = 4.0 * a / r * std::atan(a / r);
    for (const auto &[channel, factor] :
         {std::pair("R", 0.8 * 1), std::pair("G", 0.5 * 2), std::pair("B", 0.2 * 4)}) {
        const Mean mean = mean_of(image, channel, 16, 17);
        EXPECT_NEAR(mean.value, factor * irradiance / pi, bound * mean.standard_error);
        EXPECT_LT(mean.standard_error, 0.02 / (2 * bound) * mean.value) << "statistical power";
    }
}

TEST(Features, AreNamedAndClosed) {
    // Each pass starts paths either at the camera or at the lights.
    const FeatureMask from_light =
        FeatureMask::all().with(Feature::from_camera, false).with(Feature::convergence, false);
    EXPECT_TRUE(FeatureMask::all().closed() == from_light);
    const FeatureMask from_camera = FeatureMask::all()
                                        .with(Feature::from_light, false)
                                        .with(Feature::emission_density, false)
                                        .with(Feature::shadow_origin, false);
    EXPECT_TRUE(from_camera.closed() == from_camera);
    EXPECT_TRUE(FeatureMask().closed() == FeatureMask().with(Feature::from_camera));
    const FeatureMask dark = FeatureMask::all().with(Feature::lights, false).closed();
    EXPECT_FALSE(dark.has(Feature::explicit_light));
    EXPECT_FALSE(dark.has(Feature::many_lights));
    EXPECT_EQ(dark.defines().at("FEATURE_lights"), "0");
    EXPECT_TRUE(contains(dark.names(), "scattering"));
    for (const Feature feature :
         {Feature::light_strategy, Feature::from_light, Feature::point_lights}) {
        EXPECT_FALSE(dark.has(feature));
    }
    // Light paths start at lights that camera paths cannot hit, even if camera paths do not connect
    // to them.
    const FeatureMask forward = FeatureMask::all().with(Feature::explicit_light, false).closed();
    EXPECT_TRUE(forward.has(Feature::point_lights));
    EXPECT_TRUE(forward.has(Feature::many_lights));
    EXPECT_FALSE(forward.with(Feature::from_light, false).closed().has(Feature::point_lights));
    // Without scattering, no vertices are connected, but both passes still see the emitters and
    // weight them.
    const FeatureMask bare = FeatureMask::all().with(Feature::scattering, false).closed();
    EXPECT_FALSE(bare.has(Feature::vertex_connections));
    EXPECT_TRUE(bare.has(Feature::light_emitters));
    EXPECT_TRUE(bare.has(Feature::from_light));
}

TEST(Features, LeaveOutCodeFieldsBuffersAndLaunchesThatTheSceneDoesNotNeed) {
    RenderSession mis(cornell_box(), small(), device());
    RenderSession implicit(cornell_box(), small({"integrator.strategies=implicit"}), device());
    mis.render(0, 1);
    implicit.render(0, 1);
    const nlohmann::json full = mis.report(), lean = implicit.report();
    EXPECT_TRUE(contains(names(full["stages"], "name"), "sample_light"));
    EXPECT_FALSE(contains(names(lean["stages"], "name"), "sample_light"));
    EXPECT_FALSE(contains(names(lean["stages"], "name"), "intersect_any"));
    for (const nlohmann::json &program : lean["programs"]) {
        EXPECT_FALSE(contains(program["files"], "kernels/sample_light.cl"));
    }
    EXPECT_FALSE(contains(names(lean["passes"][0]["path_state"], "field"), "shadow_vector"));
    EXPECT_LT(lean["bytes_per_path"], full["bytes_per_path"]);
    EXPECT_LE(full["bytes_per_path"], 128);

    // Without reflection and light, only rays and the film remain.
    Scene dark = cornell_box();
    for (const std::string material : {"white", "red", "green", "lamp"}) {
        dark.set_property("materials." + material + ".reflectance", "[0, 0, 0]");
    }
    dark.update(0);
    RenderSession emission(dark, small(), device());
    emission.render(0, 4);
    const nlohmann::json bare = emission.report();
    EXPECT_FALSE(contains(names(bare["buffers"], "name"), "materials"));
    EXPECT_FALSE(contains(names(bare["passes"][0]["path_state"], "field"), "throughput"));
    EXPECT_EQ(bare["rays"]["shadow"], 0);
    EXPECT_EQ(bare["rays"]["nearest"], 32 * 32 * 4);
}

}  // namespace
}  // namespace rtrays
