// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <set>
#include <string>

namespace rtrays {

/// Names that no other object of the file has.
class Names {
  public:
    std::string unique(const std::string &wanted);
    void reserve(const std::string &name) { taken_.insert(name); }

  private:
    std::set<std::string> taken_;
};

/// The folder NAME_data beside an exported scene NAME.EXTENSION, for meshes and images.
class DataFolder {
  public:
    explicit DataFolder(const std::filesystem::path &scene_file);

    /// A file of it that is not taken, named after an object. Throws `Error` (run failed) when the
    /// folder cannot be made.
    std::filesystem::path new_file(const std::string &name, const std::string &extension);

    /// As the scene refers to it.
    std::string relative(const std::filesystem::path &file) const;

  private:
    std::filesystem::path folder_;
    Names names_;
};

}  // namespace rtrays
