// SPDX-License-Identifier: MIT
#include "experiments/harness/core/experiment.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "experiments/harness/core/document.h"
#include "experiments/harness/core/host.h"
#include "experiments/harness/core/resumption.h"

namespace rtrays {

namespace fs = std::filesystem;

namespace {

struct NamedOption {
    Option option;
    const char *flag;
    bool (*is_given)(const RunOptions &);
};

constexpr std::array<NamedOption, 6> named_options{{
    {Option::profile, "--profile", [](const RunOptions &o) { return !o.profile.empty(); }},
    {Option::out, "--out", [](const RunOptions &o) { return !o.out.empty(); }},
    {Option::compile, "--compile", [](const RunOptions &o) { return o.compile; }},
    {Option::check, "--check", [](const RunOptions &o) { return !o.check.empty(); }},
    {Option::save, "--save", [](const RunOptions &o) { return !o.save.empty(); }},
    {Option::update_baseline, "--update-baseline",
     [](const RunOptions &o) { return o.update_baseline; }},
}};

/// Throws `Error` (bad input) if an option is given that the kind does not have.
void require_options(const Kind &kind, const RunOptions &options) {
    std::vector<std::string> has;
    for (const NamedOption &named : named_options) {
        if (kind.has(named.option)) {
            has.emplace_back(named.flag);
        }
    }
    has.insert(has.end(), {"--device", "--dry-run", "--quiet"});
    for (const NamedOption &named : named_options) {
        if (named.is_given(options) && !kind.has(named.option)) {
            throw input_error(fmt::format("{}: {} does not apply to kind '{}'; its options are: {}",
                                          options.file.string(), named.flag, kind.name,
                                          fmt::join(has, ", ")));
        }
    }
}

/// Throws `Error` (run failed) if a value is missing, so that no incomplete document is written.
void require_complete(const Json &document) {
    try {
        parse_document(document.dump(), document_name);
    } catch (const Error &error) {
        throw run_error(
            fmt::format("the document is incomplete and was not written: {}", error.what()));
    }
}

/// Returns {"passed", "failed"}, the numbers of rows with a check, or null if no row has one.
Json verdicts_of(const Experiment &experiment, const Json &document) {
    size_t passed = 0, failed = 0;
    for (const Json &row : document.value("rows", Json::array())) {
        const std::optional<bool> passes = experiment.passes(row);
        passed += passes == true ? 1 : 0;
        failed += passes == false ? 1 : 0;
    }
    return passed + failed == 0 ? Json() : Json{{"passed", passed}, {"failed", failed}};
}

/// Measures, or returns the stored document if it was made from equal inputs.
Json document_of(const Experiment &experiment, const Kind &kind, const RunOptions &options,
                 DeviceContext &device) {
    const RunContext context;
    if (!kind.has(Option::out)) {
        return experiment.measure({device, {}, {}, options.quiet});
    }
    const Resumption resumption(options.out, document_name, experiment.inputs(), device.info());
    Json document = resumption.finished([&](const Json &stored) {
        return stored.value("schema_version", 0) == document_version &&
               experiment.is_whole(stored, options.out);
    });
    if (document.is_null()) {
        document = experiment.measure({device, options.out, resumption.parts(), options.quiet});
        document["schema_version"] = document_version;
        document["kind"] = kind.name;
        document["context"] = context.finish(device.info());
        if (const Json verdicts = verdicts_of(experiment, document); !verdicts.is_null()) {
            document["verdicts"] = verdicts;
        }
        require_complete(document);
        resumption.finish(document);
    }
    return document;
}

/// Prints the number of failed checks. Returns `ExitCode::regression` if there are any.
ExitCode conclude(const Json &verdicts) {
    if (verdicts.is_null()) {
        return ExitCode::ok;
    }
    fmt::print("{}\n", verdict_line(verdicts.at("passed"), verdicts.at("failed")));
    return verdicts.at("failed") > 0 ? ExitCode::regression : ExitCode::ok;
}

}  // namespace

std::string verdict_line(size_t passed, size_t failed) {
    return failed == 0 ? fmt::format("all {} checks passed", passed)
                       : fmt::format("{} of {} checks failed", failed, passed + failed);
}

bool Kind::has(Option option) const {
    return std::find(options.begin(), options.end(), option) != options.end();
}

std::pair<DescriptionFile, const Kind *> load_experiment(const fs::path &path,
                                                         const std::vector<Kind> &kinds) {
    DescriptionFile file = read_description(path);
    std::vector<std::string> names;
    for (const Kind &kind : kinds) {
        names.emplace_back(kind.name);
        if (file.json.is_object() && file.json.value("kind", Json()) == kind.name) {
            require_schema(file, kind.schema);
            return {std::move(file), &kind};
        }
    }
    throw input_error(fmt::format("{}: {}; kinds are: {}", file.location("/kind"),
                                  file.json.is_object() && file.json.contains("kind")
                                      ? "unknown kind " + file.json.at("kind").dump()
                                      : "missing key 'kind' of an experiment",
                                  fmt::join(names, ", ")));
}

ExitCode run_experiment(const RunOptions &given, const std::vector<Kind> &kinds) {
    const auto [file, kind] = load_experiment(given.file, kinds);
    require_options(*kind, given);
    RunOptions options = given;
    if (kind->has(Option::profile) && options.profile.empty()) {
        options.profile = file.default_profile();
    }
    if (kind->has(Option::out) && options.out.empty()) {
        options.out = file.json.at("name").get<std::string>() + "." + options.profile;
    }
    const std::unique_ptr<Experiment> experiment = kind->make(file, options);
    if (options.dry_run) {
        fmt::print("{}", experiment->plan());
        return ExitCode::ok;
    }
    DeviceContext device(options.device, kind->binaries);
    if (options.compile) {
        experiment->compile(device);
        return ExitCode::ok;
    }
    const Json document = document_of(*experiment, *kind, options, device);
    const ExitCode exit_code = conclude(verdicts_of(*experiment, document));
    if (kind->has(Option::out)) {
        fmt::print("{}\n", (options.out / document_name).string());
    }
    return exit_code;
}

}  // namespace rtrays
