// SPDX-License-Identifier: MIT
#include "experiments/harness/core/reproduce.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <list>
#include <nlohmann/json.hpp>
#include <thread>
#include <utility>

#include "experiments/harness/core/document.h"
#include "experiments/harness/core/report.h"
#include "experiments/harness/core/resumption.h"
#include "renderer/base/clock.h"
#include "renderer/base/process.h"
#include "renderer/base/progress.h"
#include "renderer/base/resources.h"

namespace rtrays {

namespace fs = std::filesystem;

namespace {

fs::path collection_file(const std::string &collection) {
    return fs::path(collection).extension() == ".json"
               ? fs::path(collection)
               : resource_folder() / "experiments" / (collection + ".json");
}

/// Returns the experiment files of a folder, sorted by name.
std::vector<fs::path> experiment_files(const fs::path &folder) {
    std::error_code error;
    std::vector<fs::path> files;
    for (const auto &entry : fs::directory_iterator(folder, error)) {
        if (entry.path().extension() == ".json") {
            files.push_back(entry.path());
        }
    }
    if (error || files.empty()) {
        throw input_error(fmt::format("{}: {}", folder.string(),
                                      error ? error.message() : "no experiments (*.json)"));
    }
    std::sort(files.begin(), files.end());
    return files;
}

bool contains(const Json &list, const std::string &name) {
    return std::find(list.begin(), list.end(), name) != list.end();
}

std::optional<std::time_t> parse_utc(const Json &time) {
    std::tm utc{};
    return time.is_string() && strptime(time.get<std::string>().c_str(), "%Y-%m-%dT%H:%M:%SZ", &utc)
               ? std::optional(timegm(&utc))
               : std::nullopt;
}

std::string minutes_text(double seconds) {
    return fmt::format("{:.0f} min", std::ceil(seconds / 60));
}

std::vector<std::string> compile_command(const RunOptions &options) {
    return {fs::read_symlink("/proc/self/exe"),
            "run",
            options.file,
            "--profile",
            options.profile,
            "--device",
            options.device,
            "--compile",
            "--quiet"};
}

/// Compiles the kernels of the steps, as many at once as there are cores.
void compile(const std::vector<Step> &steps, bool quiet) {
    std::list<std::pair<std::string, Process>> running;
    Progress progress("compilation of kernels", steps.size(), "experiments", quiet);
    progress.update(0);
    size_t started = 0, finished = 0;
    while (finished < steps.size() && !interrupted()) {
        if (started < steps.size() && running.size() < std::thread::hardware_concurrency()) {
            const Step &step = steps[started++];
            running.emplace_back(std::piecewise_construct, std::forward_as_tuple(step.name),
                                 std::forward_as_tuple(compile_command(step.options)));
            continue;
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
        for (auto process = running.begin(); process != running.end();) {
            const std::optional<int> code = process->second.ended();
            if (code && *code != 0) {
                throw Error(static_cast<ExitCode>(*code),
                            fmt::format("{}: cannot compile its kernels; see the message above",
                                        process->first));
            }
            process = code ? running.erase(process) : std::next(process);
            finished += code ? 1 : 0;
        }
        progress.update(finished);
    }
}

/// Returns the durations of earlier runs of the steps: of an earlier call with this output folder,
/// or of the repository's results.
TimeLeft time_left(const std::vector<Step> &steps, const std::string &collection) {
    const fs::path results = resource_folder() / "results" / collection;
    std::vector<std::optional<double>> recorded;
    bool comparable = true;
    for (const Step &step : steps) {
        const fs::path stored = results / step.name / document_name;
        std::optional<double> seconds = recorded_seconds(step.document(), step.options.profile);
        seconds = seconds ? seconds : recorded_seconds(stored, step.options.profile);
        comparable = comparable && seconds.has_value();
        recorded.push_back(seconds ? seconds : recorded_seconds(stored));
    }
    return {recorded, comparable};
}

/// Runs all steps and returns the names of those that failed a check.
std::vector<std::string> run_steps(const std::vector<Step> &steps, TimeLeft left,
                                   const std::vector<Kind> &kinds) {
    const SteadyClock::time_point start = SteadyClock::now();
    std::vector<std::string> failed;
    for (size_t i = 0; i < steps.size(); ++i) {
        const Step &step = steps[i];
        const std::optional<double> seconds = left.seconds();
        fmt::print("[{} of {}] {}: {} elapsed{}\n", i + 1, steps.size(), step.name,
                   minutes_text(seconds_since(start)),
                   seconds ? ", about " + minutes_text(*seconds) + " left" : "");
        std::fflush(stdout);
        const SteadyClock::time_point begin = SteadyClock::now();
        const auto written = fs::file_time_type::clock::now();
        const ExitCode code = run_experiment(step.options, kinds);
        if (code != ExitCode::ok && !step.may_fail) {
            failed.push_back(step.name);
        }
        const bool measured = fs::last_write_time(step.document()) >= written;
        left.finish(measured ? std::optional(seconds_since(begin)) : std::nullopt);
    }
    fmt::print("{} experiments in {}\n", steps.size(), minutes_text(seconds_since(start)));
    std::fflush(stdout);
    return failed;
}

}  // namespace

fs::path Step::document() const {
    return options.out / document_name;
}

std::optional<double> recorded_seconds(const fs::path &document, const std::string &profile) {
    if (!fs::exists(document)) {
        return std::nullopt;
    }
    const Json json = load_json(document);
    const Json context = json.value("context", Json::object());
    const Json experiment = json.value("experiment", Json::object());
    const auto start = parse_utc(context.value("started_at", Json())),
               end = parse_utc(context.value("finished_at", Json()));
    if (!start || !end || (!profile.empty() && experiment.value("profile", "") != profile)) {
        return std::nullopt;
    }
    return std::max(1.0, std::difftime(*end, *start));
}

TimeLeft::TimeLeft(std::vector<std::optional<double>> recorded, bool comparable)
    : comparable_(comparable) {
    double sum = 0;
    size_t known = 0;
    for (const std::optional<double> &seconds : recorded) {
        sum += seconds.value_or(0);
        known += seconds ? 1 : 0;
    }
    const double mean = known > 0 ? sum / static_cast<double>(known) : 1;
    for (const std::optional<double> &seconds : recorded) {
        recorded_.push_back(seconds.value_or(mean));
    }
}

void TimeLeft::finish(std::optional<double> seconds) {
    if (seconds) {
        measured_ += *seconds;
        measured_recorded_ += recorded_[finished_];
    }
    ++finished_;
}

std::optional<double> TimeLeft::seconds() const {
    if (measured_recorded_ == 0 && !comparable_) {
        return std::nullopt;
    }
    const double ratio = measured_recorded_ > 0 ? measured_ / measured_recorded_ : 1;
    double left = 0;
    for (size_t i = finished_; i < recorded_.size(); ++i) {
        left += ratio * recorded_[i];
    }
    return left;
}

std::vector<Step> collection_steps(const ReproduceOptions &options,
                                   const std::vector<Kind> &kinds) {
    const DescriptionFile collection =
        load_description(collection_file(options.collection), "collection.schema.json");
    const Json &profile = collection.profile(options.profile);
    const Json none = Json::array(), other = profile.value("profile_of", Json::object());
    const fs::path out =
        options.out.empty()
            ? fs::path(collection.json.at("name").get<std::string>() + "." + options.profile)
            : options.out;
    std::vector<Step> steps;
    for (const Json &folder : collection.json.at("folders")) {
        for (const fs::path &path : experiment_files(collection.resolve(folder))) {
            const auto [file, kind] = load_experiment(path, kinds);
            const std::string name = file.json.at("name");
            const std::string wanted = other.value(name, options.profile);
            if (!file.json.contains("profiles") || !file.json.at("profiles").contains(wanted) ||
                contains(profile.value("without", none), name)) {
                continue;
            }
            RunOptions run;
            run.file = path;
            run.profile = wanted;
            run.out = out / name;
            run.device = options.device;
            run.quiet = options.quiet;
            steps.push_back(
                {name, kind, run, contains(collection.json.value("may_fail", none), name)});
        }
    }
    return steps;
}

ExitCode reproduce(const ReproduceOptions &options, const std::vector<Kind> &kinds) {
    const std::vector<Step> steps = collection_steps(options, kinds);
    if (options.dry_run) {
        for (const Step &step : steps) {
            fmt::print("{} --profile {} --out {}\n", step.options.file.string(),
                       step.options.profile, step.options.out.string());
        }
        return ExitCode::ok;
    }
    std::vector<Step> to_compile;
    std::vector<fs::path> runs;
    for (const Step &step : steps) {
        if (step.kind->has(Option::compile) && !fs::exists(step.document())) {
            to_compile.push_back(step);
        }
        runs.push_back(step.options.out);
    }
    compile(to_compile, options.quiet);
    require_not_interrupted();
    const std::vector<std::string> failed =
        run_steps(steps, time_left(steps, fs::path(options.collection).stem()), kinds);
    const auto reported = static_cast<ExitCode>(make_report(runs));
    if (!failed.empty()) {
        fmt::print(stderr, "a check failed in: {}\n", fmt::join(failed, ", "));
    }
    return failed.empty() || reported != ExitCode::ok ? reported : ExitCode::regression;
}

}  // namespace rtrays
