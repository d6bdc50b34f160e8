// SPDX-License-Identifier: MIT
// The one shape of all experiments: a file with a kind is read, measured on a device, and written
// as a document.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "experiments/harness/core/description.h"
#include "renderer/base/error.h"
#include "renderer/base/json.h"
#include "renderer/device/context.h"

namespace rtrays {

/// Options of `rtrays-experiment run`.
struct RunOptions {
    std::filesystem::path file;
    std::string profile;           ///< empty: "quick", or the only one
    std::filesystem::path out;     ///< NAME.PROFILE in the working directory if empty
    std::string device;            ///< device name for `DeviceContext`
    std::string check;             ///< one check of a gate; all if empty
    std::filesystem::path save;    ///< folder of a gate's results; not saved if empty
    bool update_baseline = false;  ///< measure the baseline of a gate instead of checking
    bool compile = false;          ///< compile the kernels only
    bool dry_run = false;          ///< check the inputs and print the plan only
    bool quiet = false;
};

/// Options that not every kind has.
enum class Option { profile, out, compile, check, save, update_baseline };

/// Device and folders of one run.
struct Bench {
    DeviceContext &device;
    std::filesystem::path out;    ///< folder of the document
    std::filesystem::path parts;  ///< folder of finished parts, for an interrupted run
    bool quiet = false;
};

/// An experiment with its profile, read from its file. The inputs are loaded and checked.
class Experiment {
  public:
    virtual ~Experiment() = default;

    /// Returns the lines that `--dry-run` prints.
    virtual std::string plan() const = 0;

    /// Returns everything that the result depends on beside the program and the device.
    virtual std::string inputs() const { return {}; }

    /// Compiles all kernels (Option::compile).
    virtual void compile(DeviceContext & /*device*/) const {}

    /// Measures and returns the document without the parts that all kinds share. It has
    /// "experiment" (with name and profile), and "rows" or "curves". Finished parts are read from
    /// `bench.parts`, so that an interrupted run continues. Throws `Error` (interrupted) on SIGINT
    /// and SIGTERM.
    virtual Json measure(const Bench &bench) const = 0;

    /// Returns whether the files that belong to a stored document exist. If not, the experiment is
    /// measured again.
    virtual bool is_whole(const Json & /*document*/, const std::filesystem::path & /*out*/) const {
        return true;
    }

    /// Returns whether a row of the document passes its check, or nothing for rows without one.
    virtual std::optional<bool> passes(const Json & /*row*/) const { return std::nullopt; }
};

/// Returns the line that concludes checks: "9 of 13 checks failed" or "all 13 checks passed".
std::string verdict_line(size_t passed, size_t failed);

/// A kind of experiment, named by "kind" of its files.
struct Kind {
    const char *name;
    const char *schema;  ///< schema of its files: "curves.schema.json"
    std::vector<Option> options;
    Binaries binaries;
    std::unique_ptr<Experiment> (*make)(const DescriptionFile &, const RunOptions &);

    bool has(Option option) const;
};

/// Reads an experiment file and finds its kind. Throws `Error` (bad input) if the file is not
/// valid, and for an unknown kind, listing `kinds`.
std::pair<DescriptionFile, const Kind *> load_experiment(const std::filesystem::path &path,
                                                         const std::vector<Kind> &kinds);

/// Runs an experiment of any of the kinds, writes OUT/run.json, prints the path of this document,
/// and returns the exit code of its checks. Repeating the command continues an interrupted run and
/// keeps a finished one (`Resumption`). Throws `Error`: bad input, reference missing, run failed,
/// interrupted.
ExitCode run_experiment(const RunOptions &options, const std::vector<Kind> &kinds);

}  // namespace rtrays
