// SPDX-License-Identifier: MIT
#include "reference/renderer.h"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/blocked_range2d.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <chrono>
#include <mutex>
#include <optional>
#include <utility>

#include "reference/bsdf.h"
#include "reference/camera.h"
#include "reference/film.h"
#include "reference/first_hit_classifier.h"
#include "reference/geometry.h"
#include "reference/integrator.h"
#include "reference/light.h"
#include "renderer/base/error.h"
#include "renderer/base/progress.h"

namespace rtrays {

using namespace reference;

namespace {

constexpr uint64_t tile_size = 16;
/// A batch takes a fraction of a second, so that an interrupt takes effect soon.
constexpr uint64_t paths_per_batch = 1 << 19;

/// Checks that the material of every surface exists, and its light if it has one.
void check_indices(const SceneArrays &scene) {
    const auto check = [&](const char *what, const std::string &name, uint32_t material,
                           uint32_t light) {
        if (material >= scene.materials.name.size()) {
            throw input_error(fmt::format("{} '{}' has no material", what, name));
        }
        if (light != no_index && light >= scene.lights.kind.size()) {
            throw input_error(
                fmt::format("{} '{}': light {} is out of range; the scene has {} light(s)", what,
                            name, light, scene.lights.kind.size()));
        }
    };
    for (size_t i = 0; i < scene.meshes.name.size(); ++i) {
        check("mesh", scene.meshes.name[i], scene.meshes.material[i], scene.meshes.light[i]);
    }
    for (size_t i = 0; i < scene.shapes.name.size(); ++i) {
        check("shape", scene.shapes.name[i], scene.shapes.material[i], scene.shapes.light[i]);
    }
}

/// Counts the paths whose radiance the film refuses, and records the first in the order of pixels
/// and samples.
class Faults {
  public:
    void note(uint64_t pixel, uint64_t sample) {
        const std::lock_guard<std::mutex> lock(mutex_);
        const auto fault = std::make_pair(pixel, sample);
        first_ = first_ ? std::min(*first_, fault) : fault;
        ++count_;
    }
    const std::optional<std::pair<uint64_t, uint64_t>> &first() const { return first_; }
    uint64_t count() const { return count_; }

  private:
    std::mutex mutex_;
    std::optional<std::pair<uint64_t, uint64_t>> first_;
    uint64_t count_ = 0;
};

}  // namespace

struct ReferenceRenderer::State {
    State(const SceneArrays &scene, const ReferenceSettings &wanted)
        : settings(wanted),
          full_width(wanted.full_width > 0 ? wanted.full_width : wanted.width),
          camera(scene.cameras, wanted.camera, full_width,
                 wanted.full_width > 0 ? wanted.full_height : wanted.height),
          geometry(scene.meshes, scene.shapes, make_opacities(scene.materials, scene.textures)),
          bsdfs(make_bsdfs(scene.materials, scene.textures)),
          tilts(make_normal_tilts(scene.materials, scene.textures)),
          lights(geometry, scene.lights, emission_textures(scene.materials, scene.textures)),
          integrator(world(), wanted.strategies, wanted.max_depth, wanted.joinable_only,
                     wanted.roulette),
          film(wanted.width, wanted.height),
          threads(wanted.threads > 0 ? wanted.threads : tbb::info::default_concurrency()),
          arena(threads) {}

    World<Bsdf, LightSet> world() const {
        return {geometry, bsdfs, lights, tilts.empty() ? nullptr : &tilts};
    }
    void render_tile(const tbb::blocked_range2d<uint64_t> &tile, uint64_t begin, uint64_t end);
    void render_batch(uint64_t begin, uint64_t end);

    ReferenceSettings settings;
    int full_width;  ///< of the full picture
    Camera camera;
    Geometry geometry;
    std::vector<Bsdf> bsdfs;
    std::vector<NormalTilt> tilts;
    LightSet lights;
    PathIntegrator<Bsdf, LightSet> integrator;
    Film film;
    Faults faults;
    tbb::enumerable_thread_specific<RayCounts> counts;
    double seconds = 0.0;
    int threads;
    tbb::task_arena arena;
};

void ReferenceRenderer::State::render_tile(const tbb::blocked_range2d<uint64_t> &tile,
                                           uint64_t begin, uint64_t end) {
    RayCounts tile_counts;
    for (uint64_t y = tile.rows().begin(); y != tile.rows().end(); ++y) {
        for (uint64_t x = tile.cols().begin(); x != tile.cols().end(); ++x) {
            const uint64_t pixel = y * static_cast<uint64_t>(settings.width) + x;
            // A pixel has the random numbers that it has in the full picture.
            const uint64_t column = x + static_cast<uint64_t>(settings.crop_x);
            const uint64_t row = y + static_cast<uint64_t>(settings.crop_y);
            PixelSums::Adder sums(film.pixels[pixel]);
            for (uint64_t sample = begin; sample < end; ++sample) {
                Rng rng(settings.seed, row * static_cast<uint64_t>(full_width) + column, sample);
                const double film_x = static_cast<double>(column) + rng.uniform();
                const double film_y = static_cast<double>(row) + rng.uniform();
                const Spectrum radiance =
                    integrator.radiance(camera.ray(film_x, film_y, rng), rng, tile_counts);
                if (!sums.add(radiance)) {
                    faults.note(pixel, sample);
                }
            }
        }
    }
    counts.local() += tile_counts;
}

void ReferenceRenderer::State::render_batch(uint64_t begin, uint64_t end) {
    const auto start = std::chrono::steady_clock::now();
    // The arena alone gets at most as many threads as there are cores; tests request more.
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                    static_cast<size_t>(threads));
    const tbb::blocked_range2d<uint64_t> pixels(0, static_cast<uint64_t>(settings.height),
                                                tile_size, 0, static_cast<uint64_t>(settings.width),
                                                tile_size);
    arena.execute([&] {
        tbb::parallel_for(
            pixels, [&](const auto &tile) { render_tile(tile, begin, end); },
            tbb::simple_partitioner());
    });
    film.add({begin, end});
    seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (faults.first()) {
        const auto [pixel, sample] = *faults.first();
        const auto width = static_cast<uint64_t>(settings.width);
        throw run_error(fmt::format(
            "pixel {},{} sample {} (seed {}): the radiance is not finite or beyond the film's "
            "range of 2^136; {} such samples",
            pixel % width, pixel / width, sample, settings.seed, faults.count()));
    }
}

ReferenceRenderer::ReferenceRenderer(const SceneArrays &scene, const ReferenceSettings &settings) {
    check_indices(scene);
    if (!settings.roulette && settings.max_depth == 0) {
        throw input_error(
            "paths without Russian roulette need a maximum number of scattering events");
    }
    state_ = std::make_unique<State>(scene, settings);
}

ReferenceRenderer::~ReferenceRenderer() = default;

uint64_t ReferenceRenderer::render(uint64_t begin, uint64_t end) {
    SampleRanges all = state_->film.ranges;
    add_range(all, {begin, end});  // an overlap is an error before it costs time
    while (begin < end && !interrupted()) {
        const uint64_t batch_end = std::min(end, begin + batch_size());
        state_->render_batch(begin, batch_end);
        begin = batch_end;
    }
    return begin;
}

uint64_t ReferenceRenderer::batch_size() const {
    return std::clamp<uint64_t>(paths_per_batch / state_->film.pixels.size(), 1, 1024);
}

Image ReferenceRenderer::develop() const {
    return state_->film.develop(seconds());
}

std::vector<FirstHit> ReferenceRenderer::first_hits() const {
    const State &state = *state_;
    const FirstHitClassifier classifier(state.world(), state.camera);
    const auto width = static_cast<uint64_t>(state.settings.width);
    const auto height = static_cast<uint64_t>(state.settings.height);
    std::vector<FirstHit> classes(width * height);
    const auto classify_rows = [&](const tbb::blocked_range<uint64_t> &rows) {
        for (uint64_t y = rows.begin(); y != rows.end(); ++y) {
            for (uint64_t x = 0; x < width; ++x) {
                const uint64_t column = x + static_cast<uint64_t>(state.settings.crop_x);
                const uint64_t row = y + static_cast<uint64_t>(state.settings.crop_y);
                classes[y * width + x] = classifier.of_pixel(
                    column, row, row * static_cast<uint64_t>(state.full_width) + column);
            }
        }
    };
    state_->arena.execute(
        [&] { tbb::parallel_for(tbb::blocked_range<uint64_t>(0, height), classify_rows); });
    return classes;
}

double ReferenceRenderer::seconds() const {
    return state_->seconds;
}

uint64_t ReferenceRenderer::samples() const {
    return state_->film.count();
}

ReferenceStats ReferenceRenderer::stats() const {
    RayCounts total;
    for (const RayCounts &part : state_->counts) {
        total += part;
    }
    const GeometryStats &geometry = state_->geometry.stats();
    return {geometry.engine,        geometry.triangles, geometry.degenerate_triangles,
            geometry.build_seconds, seconds(),          total.camera,
            total.bounce,           total.shadow};
}

const Film &ReferenceRenderer::film() const {
    return state_->film;
}

void ReferenceRenderer::restore(Film film, double seconds) {
    if (film.width != state_->settings.width || film.height != state_->settings.height) {
        throw run_error("the size of the restored film differs from the settings");
    }
    state_->film = std::move(film);
    state_->seconds = seconds;
}

}  // namespace rtrays
