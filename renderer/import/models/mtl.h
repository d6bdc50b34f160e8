// SPDX-License-Identifier: MIT
// Our own reader of Wavefront MTL files. Assimp's reader ignores missing files, options of maps and
// colours of one number.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "renderer/import/models/surface.h"
#include "renderer/import/models/textures.h"

namespace rtrays {

/// An image that an MTL file names, or none if `file` is empty.
struct MtlMap {
    std::string file;
    TexturePlacement placement;
    double multiplier = 1;  ///< option -bm
};

/// A material of an MTL file. Its images are not loaded yet.
struct MtlMaterial {
    std::string name;
    std::filesystem::path folder;  ///< of the MTL file
    ModelSurface surface;
    MtlMap diffuse_map;
    MtlMap specular_map;
    MtlMap emission_map;
    MtlMap opacity_map;
    MtlMap normal_map;
    MtlMap bump_map;
};

/// Reads the materials of an MTL file in its order. Illumination models 4, 6, 7 and 9 are glass of
/// index Ni and transmittance Tf. Models 3 and 5 without a diffuse colour are metals of reflectance
/// Ks. Pr and Pm together are roughness and metalness. norm and map_Kn are maps of normals,
/// map_Bump and bump are maps of heights. Notes name everything else that is ignored. Throws
/// `Error` (bad input) naming the file, the line and the fault.
std::vector<MtlMaterial> read_mtl(const std::filesystem::path &path, ModelNotes &notes);

/// Converts a material and loads its images. They are looked for beside the MTL file, then in
/// `model_folder`. If `vertex_coloured`, the colours of vertices multiply the diffuse colour.
/// Throws `Error` (bad input) naming the material and the fault.
std::shared_ptr<MaterialCore> make_mtl_material(const MtlMaterial &material,
                                                const std::string &name,
                                                const std::filesystem::path &model_folder,
                                                bool vertex_coloured, ModelTextures &textures,
                                                ModelNotes &notes);

}  // namespace rtrays
