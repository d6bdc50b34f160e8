// SPDX-License-Identifier: MIT
// Isolated reading of files through Assimp.
// Assimp 5.2.5 crashes on about one in a thousand damaged files (on one in five for X, Collada, X3D
// and 3MF). It also allocates any amount of memory that a header requests. A child process
// therefore reads each file first, under limits of time and memory. This process reads the file
// only if the child succeeds.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

struct aiScene;

namespace rtrays {

/// Reads a model file without any post-processing. `content` replaces the content of the file,
/// unless it is empty. Throws `Error` (bad input) naming the file and the reason.
std::shared_ptr<const aiScene> read_by_assimp(const std::filesystem::path &path,
                                              const std::string &content, bool quiet);

}  // namespace rtrays
