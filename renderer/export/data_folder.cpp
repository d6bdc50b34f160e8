// SPDX-License-Identifier: MIT
#include "renderer/export/data_folder.h"

#include <fmt/format.h>

#include "renderer/base/error.h"

namespace rtrays {

std::string Names::unique(const std::string &wanted) {
    std::string name = wanted.empty() ? "unnamed" : wanted;
    for (int i = 2; !taken_.insert(name).second; ++i) {
        name = fmt::format("{}_{}", wanted, i);
    }
    return name;
}

DataFolder::DataFolder(const std::filesystem::path &scene_file)
    : folder_(scene_file.parent_path() / (scene_file.stem().string() + "_data")) {}

std::filesystem::path DataFolder::new_file(const std::string &name, const std::string &extension) {
    std::string stem = name;
    for (char &c : stem) {
        const bool is_plain =
            (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-';
        c = is_plain ? c : '_';
    }
    std::error_code error;
    std::filesystem::create_directories(folder_, error);
    if (error) {
        throw run_error(
            fmt::format("{}: cannot be created: {}", folder_.string(), error.message()));
    }
    return folder_ / (names_.unique(stem) + extension);
}

std::string DataFolder::relative(const std::filesystem::path &file) const {
    return (folder_.filename() / file.filename()).generic_string();
}

}  // namespace rtrays
