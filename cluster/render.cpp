// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <optional>

#include "cluster/agreement.h"
#include "cluster/commands.h"
#include "cluster/crew.h"
#include "renderer/base/commit.h"
#include "renderer/base/files.h"
#include "renderer/base/notice.h"
#include "renderer/command.h"

namespace rtrays::cluster {

namespace {

/// The session of one rank.
class Renderer {
  public:
    Renderer(const World &world, Devices devices) : world_(world), devices_(devices) {}

    /// Loads and compiles the scene; on rank 0, loads the film of --resume, too.
    Preparation prepare(int argc, char **argv) {
        if (const auto ended =
                parse_render("rtrays-mpi render", description, argc, argv, options_)) {
            return {ended, "", {}};
        }
        if (world_.is_root()) {
            require_consistent(options_);
        } else if (options_.print_scene || !options_.exported.empty()) {
            return {ExitCode::ok, "", {}};
        }
        options_.quiet = options_.quiet || !world_.is_root();
        scene_ = load_scene(options_);
        if (!scene_) {
            return {ExitCode::ok, "", {}};
        }
        requested_samples(options_);
        if (has_convergence_control(options_.settings)) {
            throw input_error(
                "convergence control needs all samples in order; render with rtrays-render");
        }
        open_device();
        session_.emplace(make_session(*scene_, options_, *device_));
        notice_unseen_light(*scene_, options_.settings);
        if (options_.dry_run) {
            fmt::print("{}\n", session_->report().dump(2));
            return {ExitCode::ok, "", {}};
        }
        missing_ = world_.is_root() ? resume(*session_, options_) : SampleRanges();
        header_ = session_->film();
        header_.words = {};
        return {{}, "", identity()};
    }

    ExitCode run() {
        const Work work{
            [this](SampleRange range) { return session_->render(range.begin, range.end); },
            [this] { return to_sums(session_->film()); }};
        const std::optional<Outcome> outcome = render_together(
            world_, work, world_.is_root() ? std::optional(make_plan()) : std::nullopt);
        const Json job = describe_job(world_, outcome);
        return outcome ? finish(*outcome, job) : ExitCode::ok;
    }

  private:
    static constexpr const char *description =
        "Renders a scene on the OpenCL devices of all ranks of an MPI job: the i-th rank of a node "
        "takes the i-th device that --device selects. The image has the bits of rtrays-render.";

    void open_device() {
        const std::vector<std::string> devices = matching_devices(options_.device);
        device_.emplace(devices[world_.local_rank() % devices.size()]);
        if (world_.local_size() > devices.size()) {
            notice(fmt::format("{} ranks of this node share {} device(s)", world_.local_size(),
                               devices.size()));
        }
    }

    std::vector<std::pair<std::string, std::string>> identity() const {
        std::vector<std::pair<std::string, std::string>> identity = {
            {"program", program_hash()},
            {"scene", fmt::format("{} ({})", scene_->name(), scene_->hash())},
            {"seed", std::to_string(header_.seed)},
            {"size", fmt::format("{} x {}", header_.width, header_.height)}};
        identity.insert(identity.end(), header_.config.begin(), header_.config.end());
        if (devices_ == Devices::equal) {
            identity.emplace_back("device", device_name());
        }
        return identity;
    }

    std::string device_name() const {
        return fmt::format("{} (driver {})", device_->info().name, device_->info().driver);
    }

    Plan make_plan() {
        Plan plan;
        plan.missing = missing_;
        plan.wanted = requested_samples(options_).count();
        plan.pixels = static_cast<uint64_t>(header_.width) * static_cast<uint64_t>(header_.height);
        plan.seconds = options_.seconds;
        plan.preview_interval = options_.preview;
        plan.preview = [this](const FilmSums &sums) {
            write_preview(*session_, film_of(sums), options_);
        };
        if (!options_.state.empty()) {
            plan.checkpoint_interval = options_.checkpoint_interval;
            plan.save = [this](const FilmSums &sums) { save_state(film_of(sums), options_); };
        }
        plan.quiet = options_.quiet;
        return plan;
    }

    static FilmSums to_sums(const FilmState &film) {
        return {film.words,
                {film.device_seconds, film.wall_seconds, static_cast<double>(film.non_finite),
                 static_cast<double>(film.out_of_range)},
                film.ranges};
    }

    FilmState film_of(const FilmSums &sums) const {
        FilmState film = header_;
        film.words = sums.words;
        film.device_seconds = sums.numbers.at(0);
        film.wall_seconds = sums.numbers.at(1);
        film.non_finite = static_cast<uint64_t>(sums.numbers.at(2));
        film.out_of_range = static_cast<uint64_t>(sums.numbers.at(3));
        film.ranges = sums.ranges;
        carry_words(film);
        return film;
    }

    ExitCode finish(const Outcome &outcome, const Json &job) const {
        Json report = session_->report();
        report["job"] = job;
        const FilmState film = film_of(outcome.film);
        const bool complete =
            options_.seconds ? !outcome.interrupted
                             : missing_ranges(film.ranges, requested_samples(options_)).empty();
        if (complete) {
            write_results(*session_, film, options_);
        }
        if (!options_.stats.empty()) {
            write_file(options_.stats, report.dump(2) + "\n");
        }
        if (!complete) {
            print_interruption(options_);
            return ExitCode::interrupted;
        }
        if (!options_.quiet) {
            uint64_t samples = 0;
            for (const RankRecord &rank : outcome.ranks) {
                samples += rank.samples;
            }
            print_summary(
                options_,
                samples * static_cast<uint64_t>(film.width) * static_cast<uint64_t>(film.height),
                outcome.seconds);
        }
        return ExitCode::ok;
    }

    const World &world_;
    Devices devices_;
    Options options_;
    std::optional<Scene> scene_;
    std::optional<DeviceContext> device_;
    std::optional<RenderSession> session_;
    SampleRanges missing_;
    FilmState header_;  ///< of this rank's film, without words
};

}  // namespace

ExitCode render(const World &world, Devices devices, int argc, char **argv) {
    Renderer renderer(world, devices);
    const Preparation preparation =
        prepare_in_turn(world, [&] { return renderer.prepare(argc, argv); });
    const std::optional<ExitCode> ended = agree(world, preparation);
    return ended ? *ended : renderer.run();
}

}  // namespace rtrays::cluster
