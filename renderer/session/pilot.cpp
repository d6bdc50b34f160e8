// SPDX-License-Identifier: MIT
#include "renderer/session/pilot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <iterator>
#include <numeric>
#include <utility>

#include "renderer/compile/device_scene.h"
#include "renderer/compile/emission_guide.h"
#include "renderer/compile/scatter_guide.h"
#include "renderer/integrators/unseen_light.h"
#include "renderer/scene/scene.h"
#include "renderer/session/render_session.h"
#include "renderer/session/state.h"

namespace rtrays {

namespace {

using ByTrial = std::array<double, LIGHT_PATH_TRIALS>;

// Costs in units of the time of a ray in path tracing (results/chapter4, stages of the curves).
/// Start of a light path.
constexpr double start_cost = 1.1;
/// Factor of the cost of camera paths that are weighted against light paths.
constexpr double weighting_cost = 1.2;

/// Share of the greatest efficiency from which trials count as equal. Estimates of variances are no
/// more exact, and a sample with many light paths takes long.
constexpr double equal_efficiency = 0.95;

/// Light paths per pixel with whose weights the first guide is trained, before their number is
/// chosen.
constexpr double first_guide_paths = 0.25;

/// Returns the number of light paths per pixel in a trial.
double paths_per_pixel(size_t trial) {
    const auto index = static_cast<uint32_t>(trial);
    return trial_has_light_paths(index) ? std::exp2(trial_log_factor(index)) : 0.0;
}

/// Returns the trial with light paths that is nearest to a number of them per pixel.
size_t nearest_trial(double per_pixel, bool is_explicit) {
    size_t nearest = 1;
    for (size_t trial = 2; trial < LIGHT_PATH_NUMBERS; ++trial) {
        // The numbers are powers of 4, so that the middle of two is half of the greater.
        nearest = per_pixel > paths_per_pixel(trial) / 2 ? trial : nearest;
    }
    return nearest + (is_explicit ? 0 : LIGHT_PATH_NUMBERS);
}

/// Returns TRIAL_SAMPLES times the variance of the mean of that many samples of a pixel, mean over
/// the pixels. The samples of a pixel are neighbours in `paths`, and those at a distance of
/// `sequences` belong to one sequence of points. Only sequences are independent.
ByTrial camera_variance(const std::vector<PathTrials> &paths, size_t sequences) {
    ByTrial sums{};
    const auto count = static_cast<double>(sequences);
    for (size_t first = 0; first < paths.size(); first += TRIAL_SAMPLES) {
        for (size_t trial = 0; trial < sums.size(); ++trial) {
            std::array<double, TRIAL_SAMPLES> of_sequence{};
            double total = 0;
            for (size_t i = 0; i < TRIAL_SAMPLES; ++i) {
                const auto value = static_cast<double>(paths[first + i].value[trial]);
                of_sequence[i % sequences] += value;
                total += value;
            }
            for (size_t sequence = 0; sequence < sequences; ++sequence) {
                const double difference = of_sequence[sequence] - total / count;
                sums[trial] += difference * difference / (count - 1);
            }
        }
    }
    for (double &sum : sums) {
        sum *= count / static_cast<double>(paths.size());
    }
    return sums;
}

/// Returns the variance of the light paths of one sample of the image, mean over its pixels.
ByTrial light_variance(const std::vector<PathTrials> &paths) {
    ByTrial sums{};
    for (const PathTrials &path : paths) {
        for (size_t trial = 0; trial < sums.size(); ++trial) {
            const auto value = static_cast<double>(path.value[trial]);
            sums[trial] += value * value;
        }
    }
    for (size_t trial = 0; trial < sums.size(); ++trial) {
        sums[trial] *= paths_per_pixel(trial) / static_cast<double>(paths.size());
    }
    return sums;
}

/// Returns 1 / (variance x cost), and 0 where the variance is not finite.
double efficiency(const PilotTrial &trial) {
    return std::isfinite(trial.variance) ? 1 / (trial.variance * trial.cost) : 0.0;
}

/// Returns the greatest efficiency of trials with light paths, and of those without.
std::pair<double, double> greatest_efficiencies(const std::vector<PilotTrial> &trials) {
    std::pair<double, double> greatest{0, 0};
    for (const PilotTrial &trial : trials) {
        double &of_kind = trial.per_pixel > 0 ? greatest.first : greatest.second;
        of_kind = std::max(of_kind, efficiency(trial));
    }
    return greatest;
}

/// Returns whether some number of light paths is more efficient than path tracing at the cost of
/// their weights would be, beyond what counts as equal. Otherwise light paths only take time.
bool light_paths_help(const std::vector<PilotTrial> &trials) {
    const auto [with, without] = greatest_efficiencies(trials);
    return weighting_cost * with > without / equal_efficiency;
}

/// Returns the trial with the least cost of a sample among those that are as efficient as any.
const PilotTrial &cheapest_of_the_efficient(const std::vector<PilotTrial> &trials) {
    const auto [with, without] = greatest_efficiencies(trials);
    const double greatest = std::max(with, without);
    const PilotTrial *cheapest = nullptr;
    for (const PilotTrial &trial : trials) {
        if (efficiency(trial) >= equal_efficiency * greatest &&
            (cheapest == nullptr || trial.cost < cheapest->cost)) {
            cheapest = &trial;
        }
    }
    return *cheapest;
}

/// The light paths of a pilot that train the guides which its settings ask for.
class GuideTraining {
  public:
    GuideTraining(const CompiledScene &scene, const RenderSettings &settings)
        : scene_(scene),
          trains_emission_(trains_emission_guide(settings)),
          trains_scattering_(trains_scatter_guide(settings)) {}

    bool is_needed() const { return trains_emission_ || trains_scattering_; }

    void add(const TrialPaths &light) {
        if (trains_emission_) {
            paths_.insert(paths_.end(), light.paths.begin(), light.paths.end());
        }
        std::copy_if(light.hits.begin(), light.hits.end(), std::back_inserter(hits_),
                     [](const TrainingHit &hit) { return hit.power != 0; });
    }

    /// Sets the guides of RenderSettings or Pilot, that of emission with the weights of a trial.
    template <typename Guided>
    void set_guides(Guided &guided, size_t trial) const {
        if (trains_emission_) {
            guided.emission_guide = std::make_shared<const EmissionGuide>(
                make_guide(scene_, emission_moments(scene_, paths_, trial)));
        }
        if (trains_scattering_) {
            guided.scatter_guide = std::make_shared<const ScatterGuide>(make_scatter_guide(hits_));
        }
    }

  private:
    const CompiledScene &scene_;
    bool trains_emission_, trains_scattering_;
    std::vector<PathTrials> paths_;
    std::vector<TrainingHit> hits_;
};

/// Traces the first `count` paths of one pass and adds rays and times to those of `pilot`.
TrialPaths trace(RenderSession &session, PassKind pass, size_t count, Pilot &pilot) {
    const RenderStats before = session.stats();
    TrialPaths found = session.trace_trials(pass, count);
    pilot.rays += static_cast<uint64_t>(found.nearest_rays + found.shadow_rays);
    pilot.seconds += session.stats().device_seconds - before.device_seconds;
    pilot.wall_seconds += session.stats().wall_seconds - before.wall_seconds;
    return found;
}

/// Returns the trials to choose from. Those that miss some light are left out: path tracing does
/// not see some caustics, and implicit paths alone do not hit some lights. So are those that lack a
/// strategy whose layer is asked for.
std::vector<size_t> candidates(const Scene &scene, const RenderSettings &settings) {
    const bool needs_light_paths =
        !unseen_light(algorithms::path_tracing, scene.arrays(), settings.max_depth).empty();
    const bool may_be_explicit = settings.strategies != PathStrategies::implicit_only;
    const bool needs_explicit = may_be_explicit && (settings.separate_strategies ||
                                                    !lights_not_hit(scene.arrays()).empty());
    std::vector<size_t> trials;
    for (uint32_t trial = 0; trial < LIGHT_PATH_TRIALS; ++trial) {
        if ((trial_has_light_paths(trial) || !needs_light_paths) &&
            (trial_is_explicit(trial) ? may_be_explicit : !needs_explicit)) {
            trials.push_back(trial);
        }
    }
    return trials;
}

/// Fills the trials and chooses among them.
void choose_light_paths(Pilot &pilot, const TrialPaths &camera, const TrialPaths &light,
                        const Scene &scene, const RenderSettings &settings) {
    const ByTrial of_camera = camera_variance(
        camera.paths, settings.sampler == Sampler::sobol ? SOBOL_SEQUENCES : TRIAL_SAMPLES);
    const ByTrial of_light = light_variance(light.paths);
    const auto camera_count = static_cast<double>(camera.paths.size()),
               light_count = static_cast<double>(light.paths.size());
    pilot.trials.clear();
    for (const size_t trial : candidates(scene, settings)) {
        const bool is_explicit = trial_is_explicit(static_cast<uint32_t>(trial));
        const double per_pixel = paths_per_pixel(trial);
        const double camera_rays = camera.nearest_rays + (is_explicit ? camera.shadow_rays : 0);
        pilot.trials.push_back(
            {per_pixel, is_explicit, of_camera[trial] + of_light[trial],
             camera_rays / camera_count * (per_pixel > 0 ? weighting_cost : 1.0) +
                 per_pixel *
                     ((light.nearest_rays + light.shadow_rays) / light_count + start_cost)});
    }
    const PilotTrial best = cheapest_of_the_efficient(pilot.trials);
    pilot.is_explicit = best.is_explicit;
    pilot.light_paths = static_cast<uint32_t>(
        std::lround(best.per_pixel * static_cast<double>(settings.width) * settings.height));
}

}  // namespace

TrialPaths RenderSession::trace_trials(PassKind kind, size_t count) {
    State &s = *state_;
    const auto pass = std::find_if(s.passes.begin(), s.passes.end(),
                                   [&](const CompiledPass &p) { return p.kind == kind; });
    s.counters.clear();
    const auto start = SteadyClock::now();
    TrialPaths found;
    found.paths.resize(count);
    s.run_pass(*pass, 0, 0, static_cast<uint32_t>(count));
    const std::vector<int64_t> words = pass->film.read();
    std::memcpy(found.paths.data(), words.data(), count * sizeof(PathTrials));
    if (kind == PassKind::light && s.integrator.training_paths > 0) {
        found.hits.resize(count * TRAINING_HITS);
        std::memcpy(
            found.hits.data(),
            words.data() + s.integrator.training_paths * sizeof(PathTrials) / sizeof(words[0]),
            found.hits.size() * sizeof(TrainingHit));
    }
    s.wall_seconds += seconds_since(start);
    const StreamCounters counters = s.counters.read().front();
    found.nearest_rays = static_cast<double>(counters.nearest_rays);
    found.shadow_rays = static_cast<double>(counters.shadow_rays);
    return found;
}

bool trains_emission_guide(const RenderSettings &settings) {
    return settings.guided_emission == GuidedEmission::trained &&
           settings.emission_guide == nullptr;
}

bool trains_scatter_guide(const RenderSettings &settings) {
    return settings.guided_scattering == GuidedScattering::trained &&
           settings.scatter_guide == nullptr;
}

bool needs_pilot(const RenderSettings &settings) {
    return settings.light_paths == LIGHT_PATHS_AUTO || trains_emission_guide(settings) ||
           trains_scatter_guide(settings);
}

RenderSettings pilot_settings(const RenderSettings &settings) {
    RenderSettings pilot = settings;
    pilot.seed = ~settings.seed;
    pilot.light_paths = LIGHT_PATHS_LIKE_PIXELS;
    pilot.light_path_trials = true;
    pilot.only_pass.reset();
    if (settings.light_paths != LIGHT_PATHS_AUTO) {
        pilot.only_pass = PassKind::light;
    }
    if (trains_emission_guide(settings)) {
        pilot.guided_emission = GuidedEmission::flat;
    }
    pilot.stores_training_hits = trains_scatter_guide(settings);
    pilot.guided_scattering = GuidedScattering::off;
    pilot.variance = pilot.separate_strategies = false;
    pilot.count_rays = RayCounts::in_all;
    pilot.convergence_error = 0;
    return pilot;
}

std::vector<uint32_t> pilot_pixels(uint32_t width, uint32_t height) {
    const uint64_t pixels = uint64_t{width} * height;
    const uint64_t most = std::clamp<uint64_t>(pixels / TRIAL_SAMPLES, 32 * 32, 128 * 128);
    const uint64_t step = (pixels + most - 1) / most;
    auto shift = static_cast<uint64_t>(std::lround(static_cast<double>(step) * 0.6180339887));
    while (std::gcd(shift, step) != 1) {
        ++shift;
    }
    std::vector<uint32_t> lattice;
    for (uint64_t y = 0; y < height; ++y) {
        for (uint64_t x = shift * y % step; x < width; x += step) {
            lattice.push_back(static_cast<uint32_t>(y * width + x));
        }
    }
    return lattice;
}

Pilot run_pilot(const std::shared_ptr<DeviceScene> &shared, const Scene &scene,
                RenderSettings settings) {
    const CompiledScene &compiled = shared->compiled();
    const bool chooses = settings.light_paths == LIGHT_PATHS_AUTO;
    if (trains_emission_guide(settings) && !is_trainable(compiled)) {
        if (!chooses) {
            require_trainable(compiled);
        }
        settings.guided_emission = GuidedEmission::off;
    }
    Pilot pilot;
    pilot.light_paths = chooses ? 0 : light_paths_per_sample(settings);
    pilot.is_explicit = settings.strategies != PathStrategies::implicit_only;
    if (compiled.lighting.light_count == 0) {
        return pilot;
    }
    const double pixels = static_cast<double>(settings.width) * settings.height;
    const size_t camera_paths = TRIAL_SAMPLES * pilot_pixels(static_cast<uint32_t>(settings.width),
                                                             static_cast<uint32_t>(settings.height))
                                                    .size();
    RenderSettings own = pilot_settings(settings);
    GuideTraining training(compiled, settings);
    const auto weights = [&] {
        const double light_paths =
            pilot.light_paths > 0 ? pilot.light_paths : first_guide_paths * pixels;
        return nearest_trial(light_paths / pixels, pilot.is_explicit);
    };
    std::vector<size_t> sets{camera_paths};
    if (training.is_needed()) {
        RenderSettings flat = own;
        flat.only_pass = PassKind::light;
        RenderSession session(shared, scene, flat);
        training.add(trace(session, PassKind::light, camera_paths / 4, pilot));
        if (trains_emission_guide(settings)) {
            own.guided_emission = GuidedEmission::off;
        }
        sets.insert(sets.begin(), camera_paths / 2);
    }
    for (const size_t light_paths : sets) {
        if (training.is_needed()) {
            training.set_guides(own, weights());
            own.seed += 1u << 30;  // other paths
        }
        RenderSession session(shared, scene, own);
        const TrialPaths light = trace(session, PassKind::light, light_paths, pilot);
        training.add(light);
        if (chooses) {
            choose_light_paths(pilot, trace(session, PassKind::camera, camera_paths, pilot), light,
                               scene, settings);
            if (!light_paths_help(pilot.trials)) {
                break;
            }
        }
    }
    if (pilot.light_paths > 0) {
        training.set_guides(pilot, weights());
    }
    return pilot;
}

}  // namespace rtrays
