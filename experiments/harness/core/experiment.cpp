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

constexpr std::array<NamedOption, 5> named_options{{
    {Option::profile, "--profile", [](const RunOptions &o) { return !o.profile.empty(); }},
    {Option::out, "--out", [](const RunOptions &o) { return !o.out.empty(); }},
    {Option::compile, "--compile", [](const RunOptions &o) { return o.compile; }},
    {Option::check, "--check", [](const RunOptions &o) { return !o.check.empty(); }},
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
void require_complete(const Json &document, const Kind &kind) {
    if (*kind.result_schema == '\0') {
        return;
    }
    try {
        parse_document(document.dump(), kind.result, kind.result_schema);
    } catch (const Error &error) {
        throw run_error(
            fmt::format("the document is incomplete and was not written: {}", error.what()));
    }
}

/// Measures, or returns the stored document if it was made from equal inputs.
Json document_of(const Experiment &experiment, const Kind &kind, const RunOptions &options,
                 DeviceContext &device) {
    const RunContext context;
    if (!kind.has(Option::out)) {
        return experiment.measure({device, {}, {}, options.quiet});
    }
    const Resumption resumption(options.out, kind.result, experiment.inputs(), device.info());
    Json document = resumption.finished(
        [&](const Json &stored) { return experiment.is_whole(stored, options.out); });
    if (document.is_null()) {
        document = experiment.measure({device, options.out, resumption.parts(), options.quiet});
        document["kind"] = kind.name;
        document["context"] = context.finish(device.info());
        require_complete(document, kind);
        resumption.finish(document);
    }
    return document;
}

}  // namespace

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
        options.profile = "quick";
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
    const ExitCode exit_code =
        experiment->conclude(document_of(*experiment, *kind, options, device));
    if (kind->has(Option::out)) {
        fmt::print("{}\n", (options.out / kind->result).string());
    }
    return exit_code;
}

}  // namespace rtrays
