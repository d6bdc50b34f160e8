// SPDX-License-Identifier: MIT
// Errors of a build without Assimp for model files other than PLY and OBJ.
#include <fmt/format.h>

#include "renderer/base/error.h"
#include "renderer/import/models/scene.h"

namespace rtrays {

namespace {

[[noreturn]] void refuse(const std::filesystem::path &path) {
    throw input_error(fmt::format(
        "{}: model files other than PLY and OBJ are unsupported by this build; configure with "
        "-DRTRAYS_MODELS=ON (requires Assimp)",
        path.string()));
}

}  // namespace

/// Accepts every extension, because the list of formats is Assimp's. Reading reports the remedy.
bool assimp_reads(const std::string &) {
    return true;
}

MeshCore::Geometry read_model_geometry(const std::filesystem::path &path, ModelNotes &, bool) {
    refuse(path);
}

void read_model_scene(const std::filesystem::path &path, Scene &, ModelNames &, ModelNotes &,
                      bool) {
    refuse(path);
}

}  // namespace rtrays
