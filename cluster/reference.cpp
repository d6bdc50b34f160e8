// SPDX-License-Identifier: MIT
#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <optional>
#include <string>

#include "cluster/agreement.h"
#include "cluster/commands.h"
#include "cluster/crew.h"
#include "reference/command.h"
#include "reference/renderer.h"
#include "renderer/base/commit.h"

namespace rtrays::cluster {

namespace {

/// Returns the name of the processor that Linux reports, or "unknown".
std::string processor_name() {
    std::ifstream file("/proc/cpuinfo");
    for (std::string line; std::getline(file, line);) {
        if (line.rfind("model name", 0) == 0) {
            return line.substr(std::min(line.find(':') + 2, line.size()));
        }
    }
    return "unknown";
}

/// Returns the number of threads of a rank that shares its node with others: its part of the
/// processors, or 0 (all that it may use) if MPI or the batch system has bound it to some of them.
int threads_per_rank(const World &world) {
    const long processors = sysconf(_SC_NPROCESSORS_ONLN);
    cpu_set_t usable;
    if (sched_getaffinity(0, sizeof usable, &usable) != 0 || CPU_COUNT(&usable) < processors) {
        return 0;
    }
    return std::max(1, static_cast<int>(processors) / static_cast<int>(world.local_size()));
}

/// The reference renderer of one rank.
class Reference {
  public:
    Reference(const World &world, Devices devices) : world_(world), devices_(devices) {}

    /// Loads the scene; on rank 0, loads the film to continue, too.
    Preparation prepare(int argc, char **argv) {
        reference::Options defaults;
        defaults.checkpoint_interval = 300;
        const auto parsed = reference::parse_options(argc, argv, defaults);
        if (!parsed) {
            return {ExitCode::ok, "", {}};
        }
        options_ = *parsed;
        if (options_.engine != "embree") {
            throw input_error("--engine " + options_.engine + ": ranks render by embree alone");
        }
        if (world_.is_root()) {
            reference::require_outputs(options_);
        }
        const Scene scene = reference::load_scene(options_);
        if (options_.settings.threads == 0) {
            options_.settings.threads = threads_per_rank(world_);
        }
        renderer_.emplace(scene.arrays(), options_.settings);
        checkpoint_.config = reference::make_config(scene.name(), scene.hash(), options_.settings,
                                                    renderer_->stats().engine);
        if (world_.is_root()) {
            if (reference::is_done(options_, checkpoint_.config)) {
                return {ExitCode::ok, "", {}};
            }
            checkpoint_ = reference::begin_or_resume(options_, steps(), checkpoint_.config);
            renderer_->restore(checkpoint_.film, checkpoint_.seconds);
        }
        return {{}, "", identity()};
    }

    ExitCode run() {
        const Work work{
            [this](SampleRange range) { return renderer_->render(range.begin, range.end); },
            [this] { return to_sums(renderer_->film(), renderer_->seconds()); }};
        const std::optional<Outcome> outcome = render_together(
            world_, work, world_.is_root() ? std::optional(make_plan()) : std::nullopt);
        const Json job = describe_job(world_, outcome);
        return outcome ? finish(*outcome, job) : ExitCode::ok;
    }

  private:
    reference::Steps steps() const { return {{options_.begin, options_.end}, 1}; }

    std::vector<std::pair<std::string, std::string>> identity() const {
        std::vector<std::pair<std::string, std::string>> identity = {{"program", program_hash()}};
        for (const auto &entry : checkpoint_.config.items()) {
            identity.emplace_back(entry.key(), entry.value().dump());
        }
        if (devices_ == Devices::equal) {
            identity.emplace_back("processor", processor_name());
        }
        return identity;
    }

    Plan make_plan() {
        Plan plan;
        plan.missing = missing_ranges(checkpoint_.film.ranges, steps().range);
        plan.wanted = steps().range.count();
        plan.pixels = checkpoint_.film.pixels.size();
        plan.checkpoint_interval = options_.checkpoint_interval;
        plan.save = [this](const FilmSums &sums) {
            take(sums);
            reference::save_checkpoint(checkpoint_, options_.state);
        };
        plan.quiet = options_.quiet;
        return plan;
    }

    static FilmSums to_sums(const reference::Film &film, double seconds) {
        FilmSums sums;
        sums.words.resize(film.pixels.size() * reference::PixelSums::word_count);
        std::memcpy(sums.words.data(), film.pixels.data(), sums.words.size() * sizeof(int64_t));
        sums.numbers = {seconds};
        sums.ranges = film.ranges;
        return sums;
    }

    /// Replaces the film of the checkpoint.
    void take(const FilmSums &sums) {
        reference::Film &film = checkpoint_.film;
        std::memcpy(static_cast<void *>(film.pixels.data()), sums.words.data(),
                    sums.words.size() * sizeof(int64_t));
        for (reference::PixelSums &pixel : film.pixels) {
            pixel.carry();
        }
        film.ranges = sums.ranges;
        checkpoint_.seconds = sums.numbers.at(0);
    }

    ExitCode finish(const Outcome &outcome, const Json &job) {
        take(outcome.film);
        if (!checkpoint_.finished()) {
            reference::report_interruption(options_, checkpoint_.film.count());
            return ExitCode::interrupted;
        }
        reference::write_results(options_, steps(), checkpoint_,
                                 checkpoint_.film.develop(checkpoint_.seconds),
                                 {{"threads", options_.settings.threads}, {"job", job}});
        return ExitCode::ok;
    }

    const World &world_;
    Devices devices_;
    reference::Options options_;
    std::optional<ReferenceRenderer> renderer_;
    reference::Checkpoint checkpoint_{Json(), reference::Film(0, 0), {0, 0}, 0, {}};
};

}  // namespace

ExitCode render_reference(const World &world, Devices devices, int argc, char **argv) {
    Reference renderer(world, devices);
    const Preparation preparation =
        prepare_in_turn(world, [&] { return renderer.prepare(argc, argv); });
    const std::optional<ExitCode> ended = agree(world, preparation);
    return ended ? *ended : renderer.run();
}

}  // namespace rtrays::cluster
