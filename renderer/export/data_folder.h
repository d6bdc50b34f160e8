// SPDX-License-Identifier: MIT
// Unique names, and the folder of meshes and images beside an exported scene.
#pragma once

#include <filesystem>
#include <set>
#include <string>

namespace rtrays {

/// Allocator of names that are unique within a file.
class Names {
  public:
    /// Returns `wanted`, or `wanted` with a number appended if that name is taken.
    std::string unique(const std::string &wanted);
    void reserve(const std::string &name) { taken_.insert(name); }

  private:
    std::set<std::string> taken_;
};

/// The folder NAME_data beside an exported scene NAME.EXTENSION, for meshes and images.
class DataFolder {
  public:
    explicit DataFolder(const std::filesystem::path &scene_file);

    /// Returns the path of a new file in the folder, named after an object. Throws `Error` (run
    /// failed) if the folder cannot be created.
    std::filesystem::path new_file(const std::string &name, const std::string &extension);

    /// Returns the path of a file as the scene file refers to it.
    std::string relative(const std::filesystem::path &file) const;

  private:
    std::filesystem::path folder_;
    Names names_;
};

}  // namespace rtrays
