// SPDX-License-Identifier: MIT
#include "renderer/device/source.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <set>
#include <sstream>
#include <string_view>
#include <utility>
#include <vector>

#include "embedded/device_sources.h"
#include "embedded/random123_sources.h"
#include "renderer/base/error.h"

namespace rtrays {

namespace {

std::optional<std::string> find_source(const std::string &path, const SourceOverlays &overlays) {
    const auto overlay = overlays.find(path);
    if (overlay != overlays.end()) {
        return overlay->second;
    }
    for (const EmbeddedFiles &files : {embedded::device_sources(), embedded::random123_sources()}) {
        const std::string_view text = files.find(path);
        if (text.data() != nullptr) {
            return std::string(text);
        }
    }
    return std::nullopt;
}

std::string required_source(const std::string &path, const SourceOverlays &overlays) {
    std::optional<std::string> text = find_source(path, overlays);
    if (!text) {
        throw run_error(fmt::format("device source '{}' does not exist", path));
    }
    return *std::move(text);
}

/// Returns the path of an `#include "..."` line, or an empty string for any other line.
std::string included_path(const std::string &line) {
    const size_t hash = line.find_first_not_of(" \t");
    if (hash == std::string::npos || line[hash] != '#') {
        return {};
    }
    const size_t word = line.find_first_not_of(" \t", hash + 1);
    if (word == std::string::npos || line.compare(word, 7, "include") != 0) {
        return {};
    }
    const size_t open = line.find('"', word);
    const size_t close = open == std::string::npos ? open : line.find('"', open + 1);
    return close == std::string::npos ? std::string() : line.substr(open + 1, close - open - 1);
}

class Expander {
  public:
    explicit Expander(const SourceOverlays &overlays) : overlays_(overlays) {}

    std::string run(const std::vector<std::string> &paths) {
        for (const std::string &path : paths) {
            expand(path, required_source(path, overlays_));
        }
        return output_;
    }

  private:
    void expand(const std::string &path, const std::string &text) {
        if (std::find(stack_.begin(), stack_.end(), path) != stack_.end()) {
            return;  // an include cycle, which an include guard would end as well
        }
        if (text.find("#pragma once") != std::string::npos && !once_.insert(path).second) {
            return;
        }
        stack_.push_back(path);
        output_ += fmt::format("#line 1 \"{}\"\n", path);
        std::istringstream stream(text);
        std::string line;
        for (unsigned number = 1; std::getline(stream, line); ++number) {
            const std::string wanted = included_path(line);
            if (!wanted.empty()) {
                include(path, number, wanted);
                output_ += fmt::format("#line {} \"{}\"\n", number + 1, path);
            } else if (line.find("#pragma once") != std::string::npos) {
                output_ += "\n";
            } else {
                output_ += line + "\n";
            }
        }
        stack_.pop_back();
    }

    void include(const std::string &from, unsigned line, const std::string &wanted) {
        const std::filesystem::path relative = std::filesystem::path(from).parent_path() / wanted;
        std::string rooted = wanted;
        // Host code includes device code by its full path.
        const std::string own_root = "renderer/";
        if (rooted.compare(0, own_root.size(), own_root) == 0) {
            rooted = rooted.substr(own_root.size());
        }
        for (const std::string &candidate : {relative.lexically_normal().string(), rooted}) {
            const std::optional<std::string> text = find_source(candidate, overlays_);
            if (text) {
                expand(candidate, *text);
                return;
            }
        }
        // The line may be in a branch that is not compiled; only the compiler knows.
        output_ += fmt::format("#error {}:{}: include \"{}\" does not exist\n", from, line, wanted);
    }

    const SourceOverlays &overlays_;
    std::set<std::string> once_;
    std::vector<std::string> stack_;
    std::string output_;
};

}  // namespace

std::string device_source(const std::string &path) {
    return required_source(path, {});
}

std::string source_place(const std::string &expanded, size_t line) {
    std::istringstream stream(expanded);
    std::string file = "defines", text;
    size_t number = 1;  // number of the next line in its file
    for (size_t i = 1; i < line && std::getline(stream, text); ++i) {
        number += 1;
        if (text.compare(0, 6, "#line ") == 0) {
            const size_t open = text.find('"');
            number = std::stoul(text.substr(6));
            file = text.substr(open + 1, text.rfind('"') - open - 1);
        }
    }
    return fmt::format("{}:{}", file, number);
}

std::string expand_source(const std::vector<std::string> &paths, const SourceOverlays &overlays) {
    return Expander(overlays).run(paths);
}

}  // namespace rtrays
