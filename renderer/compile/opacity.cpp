// SPDX-License-Identifier: MIT
// Compiles the opacities of materials for the opacity test of rays (kernels/traversal/opacity.h).
#include <algorithm>
#include <map>

#include "renderer/compile/compile_scene.h"
#include "renderer/scene/cores/texture.h"

namespace rtrays {

namespace {

/// Returns channel values of a texel, decoded.
Eigen::Vector3d texel(const TextureImage &image, size_t index) {
    Eigen::Vector3d values;
    for (Eigen::Index c = 0; c < 3; ++c) {
        values[c] = decoded_channel(image, 3 * index + static_cast<size_t>(c));
    }
    return values;
}

/// Appends the texels of an image, and returns the index of the first.
uint32_t append_texels(const TextureImage &image, std::vector<float> &texels) {
    const size_t first = texels.size();
    const size_t count = static_cast<size_t>(image.width) * static_cast<size_t>(image.height);
    texels.reserve(first + count);
    for (size_t i = 0; i < count; ++i) {
        texels.push_back(static_cast<float>(luminance(texel(image, i))));
    }
    return static_cast<uint32_t>(first);
}

/// Compiles the opacities and returns the index of each material's record, or OPAQUE.
std::vector<uint32_t> compile_records(const SceneArrays &scene, CompiledScene &compiled) {
    std::vector<uint32_t> index_of_material;
    std::map<const TextureImage *, uint32_t> first_texel;
    for (const MaterialOpacity &opacity : scene.materials.opacity) {
        if (opacity.is_opaque()) {
            index_of_material.push_back(OPAQUE);
            continue;
        }
        OpacityRecord record{};
        record.opacity = static_cast<float>(opacity.value);
        record.cutoff = static_cast<float>(opacity.cutoff);
        if (opacity.texture != no_index) {
            const TextureImage *image = scene.textures.image[opacity.texture].get();
            const auto [found, is_new] = first_texel.try_emplace(image, 0);
            if (is_new) {
                found->second = append_texels(*image, compiled.opacity_texels);
            }
            record.texture = texture_record(scene.textures, opacity.texture);
            record.texture.first_word = found->second;
        }
        index_of_material.push_back(static_cast<uint32_t>(compiled.opacities.size()));
        compiled.opacities.push_back(record);
    }
    return index_of_material;
}

void mask_triangles(const MeshArrays &meshes, const std::vector<uint32_t> &opacity_of_material,
                    CompiledScene &compiled) {
    compiled.triangle_masks.assign(meshes.triangle.size(), OPAQUE);
    for (size_t i = 0; i < meshes.triangle.size(); ++i) {
        const uint32_t opacity = opacity_of_material[meshes.material[meshes.triangle_mesh[i]]];
        if (opacity == OPAQUE) {
            continue;
        }
        MaskedTriangle masked{};
        masked.opacity = opacity;
        for (size_t corner = 0; corner < 3 && !meshes.uv.empty(); ++corner) {
            std::copy_n(meshes.uv[meshes.triangle[i][corner]].data(), 2, masked.uv[corner]);
        }
        compiled.triangle_masks[i] = static_cast<uint32_t>(compiled.masked_triangles.size());
        compiled.masked_triangles.push_back(masked);
    }
}

}  // namespace

void compile_opacity(const SceneArrays &scene, bool every_array, CompiledScene &compiled) {
    const std::vector<uint32_t> opacity_of_material = compile_records(scene, compiled);
    if (every_array) {
        compiled.triangle_masks.assign(scene.meshes.triangle.size(), OPAQUE);
    }
    bool any_shape = false;
    if (!compiled.opacities.empty()) {
        mask_triangles(scene.meshes, opacity_of_material, compiled);
        for (ShapeRecord &shape : compiled.shapes) {
            shape.opacity = opacity_of_material[shape.material];
            any_shape = any_shape || shape.opacity != OPAQUE;
        }
    }
    compiled.opacity_features =
        FeatureMask()
            .with(Feature::opacity, any_shape || !compiled.masked_triangles.empty())
            .with(Feature::texture_mirror,
                  std::any_of(compiled.opacities.begin(), compiled.opacities.end(),
                              [](const OpacityRecord &record) {
                                  return (record.texture.flags & TEXTURE_MIRROR) != 0u;
                              }));
}

}  // namespace rtrays
