// SPDX-License-Identifier: MIT
#include "experiments/harness/core/resumption.h"

#include <fmt/format.h>

#include <utility>

#include "renderer/base/commit.h"
#include "renderer/base/error.h"
#include "renderer/base/files.h"
#include "renderer/base/progress.h"

namespace rtrays {

namespace fs = std::filesystem;

Resumption::Resumption(fs::path out, std::string name, const std::string &inputs,
                       const DeviceInfo &device)
    : out_(std::move(out)),
      result_(out_ / name),
      key_(content_hash(program_hash() + inputs + device.name + device.driver)) {
    parts_ = out_ / ".partial" / key_;
    std::error_code error;
    fs::create_directories(parts_, error);
    if (error) {
        throw input_error(fmt::format("cannot create {}: {}", parts_.string(), error.message()));
    }
    require_writable(result_);
}

Json Resumption::finished(const std::function<bool(const Json &)> &is_whole) const {
    if (!fs::exists(result_)) {
        return {};
    }
    Json result = load_json(result_);
    if (!result.is_object() || result.value("made_from", "") != key_ ||
        (is_whole && !is_whole(result))) {
        return {};
    }
    fs::remove_all(out_ / ".partial");
    fmt::print(
        stderr,
        "{}: finished already with the same code and the same inputs; delete it to measure again\n",
        result_.string());
    return result;
}

void Resumption::finish(Json result) const {
    result["made_from"] = key_;
    write_file(result_, result.dump(1) + "\n");
    fs::remove_all(out_ / ".partial");
}

void require_not_interrupted() {
    if (interrupted()) {
        throw Error(ExitCode::interrupted, "interrupted; repeat the command to continue");
    }
}

Json finished_part(const fs::path &file, const std::function<Json()> &measure) {
    if (fs::exists(file)) {
        return load_json(file);
    }
    Json part = measure();
    write_file(file, part.dump(1) + "\n");
    return part;
}

}  // namespace rtrays
