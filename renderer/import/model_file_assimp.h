// SPDX-License-Identifier: MIT
// Reading files by Assimp, fenced in. Assimp 5.2.5 dies of a segmentation fault or an abort on
// about one in a thousand damaged files (X, Collada, X3D, 3MF: one in five) and allocates what a
// header demands. So a child process reads the file first, under limits of time and memory: only
// what it survived is read here.
#pragma once

#include <filesystem>
#include <memory>

struct aiScene;

namespace rtrays {

/// Reads a model file as it is, without any post-processing. Throws `Error` (bad input) naming the
/// file and the reason.
std::shared_ptr<const aiScene> read_by_assimp(const std::filesystem::path &path, bool quiet);

/// Reads the materials of an MTL file, in its order: those of the result.
std::shared_ptr<const aiScene> read_mtl_by_assimp(const std::filesystem::path &path);

}  // namespace rtrays
