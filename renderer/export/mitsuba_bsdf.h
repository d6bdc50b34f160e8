// SPDX-License-Identifier: MIT
// Export of materials to Mitsuba BSDFs.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

#include "renderer/base/error.h"
#include "renderer/export/data_folder.h"
#include "renderer/export/mitsuba_writer.h"
#include "renderer/import/mitsuba/bsdf.h"
#include "renderer/scene/stores.h"

namespace rtrays::mitsuba {

struct PrincipledBsdf;

/// Writer of materials as BSDFs. Each material is written once, or once per convention of texture
/// coordinates if its BSDF depends on them.
class BsdfWriter {
  public:
    BsdfWriter(const SceneArrays &arrays, pugi::xml_node scene, Names &ids, DataFolder &folder)
        : arrays_(arrays), scene_(scene), ids_(ids), folder_(folder) {}

    /// Returns the id of the BSDF of a material, which is written on first use. Throws `Error` (bad
    /// input) naming the material and the feature that Mitsuba lacks.
    std::string id(uint32_t material, UvConvention uv);

    /// Returns whether the BSDF of a material shows the colours of vertices.
    bool has_vertex_colours(uint32_t material) const;

    /// Writes the radiance of an area light, of which the texture is that of the emission of its
    /// material. Throws `Error` (bad input) naming the material if Mitsuba lacks the coordinates.
    void write_radiance(pugi::xml_node emitter, const Rgb &radiance, uint32_t material,
                        UvConvention uv);

  private:
    struct Slot;
    using Write = void (BsdfWriter::*)(pugi::xml_node, const BxdfComponent *, UvConvention);
    struct Recipe {
        const char *components;
        const char *plugin;  ///< prefixed by "rough" if the first component is rough
        bool transmits;
        Write write;
    };
    static const std::vector<Recipe> &recipes();
    /// Returns the recipe of these components, or null.
    static const Recipe *recipe(const std::vector<BxdfComponent> &parts);
    /// Returns the error of components for which Mitsuba has no BSDF.
    static Error unknown(const std::vector<BxdfComponent> &parts);

    /// Writes the BSDF of a material without its opacity. An empty id means none.
    void write_sides(pugi::xml_node parent, std::string id, uint32_t material, UvConvention uv);
    /// Writes the BSDF of one side, black if there are no components.
    void write_parts(pugi::xml_node parent, const std::string &id,
                     const std::vector<BxdfComponent> &parts, UvConvention uv);

    /// Returns the BSDF that lets light pass. The BSDF of the surface becomes its child.
    pugi::xml_node write_mask(const MaterialOpacity &opacity, const std::string &id,
                              UvConvention uv);
    /// Returns the BSDF of a map of normals or heights. The BSDF of the surface becomes its child.
    pugi::xml_node write_map(pugi::xml_node parent, uint32_t material, const std::string &id,
                             UvConvention uv);
    /// Returns whether a texture consists of the colours of vertices and one factor.
    bool is_constant(uint32_t texture) const;
    /// Returns whether a triangle of the material has texture coordinates of negative area.
    bool has_mirrored_uv(uint32_t material) const;
    void write_diffuse(pugi::xml_node bsdf, const BxdfComponent *parts, UvConvention uv);
    void write_conductor(pugi::xml_node bsdf, const BxdfComponent *parts, UvConvention uv);
    void write_dielectric(pugi::xml_node bsdf, const BxdfComponent *parts, UvConvention uv);
    void write_thin_dielectric(pugi::xml_node bsdf, const BxdfComponent *parts, UvConvention uv);
    /// Throws `Error` (bad input) if a texture of a coat and its base has colours of vertices.
    void check_plastic(const BxdfComponent *parts) const;
    void write_coated(pugi::xml_node bsdf, const BxdfComponent *parts, UvConvention uv);
    void write_principled(pugi::xml_node bsdf, const PrincipledBsdf &principled, UvConvention uv);
    void write_plastic(pugi::xml_node bsdf, const BxdfComponent *parts, UvConvention uv);

    /// Writes the distribution and the roughness of a rough component.
    void write_roughness(pugi::xml_node bsdf, const BxdfComponent &part, UvConvention uv);
    /// Writes a colour, or a texture whose texels are multiplied by `weight`. `offset` is added to
    /// the texels then, equally in the first two channels.
    void write_weight(pugi::xml_node bsdf, const char *name, const Eigen::Vector3d &weight,
                      uint32_t texture, UvConvention uv,
                      const Eigen::Vector3d &offset = Eigen::Vector3d::Zero());
    /// Writes the colours of vertices. Throws `Error` (bad input) unless their factor is grey.
    void write_vertex_colours(pugi::xml_node bsdf, const char *name, const Eigen::Vector3d &weight,
                              uint32_t texture);
    std::string image_file(uint32_t texture, const Eigen::Vector3d &weight,
                           const Eigen::Vector3d &offset);

    const SceneArrays &arrays_;
    pugi::xml_node scene_;
    Names &ids_;
    DataFolder &folder_;
    std::map<std::pair<uint32_t, UvConvention>, std::string> written_;
    /// By image, weight, and offset of the first and the last channel.
    std::map<std::tuple<const TextureImage *, double, double, double, double, double>, std::string>
        images_;
};

}  // namespace rtrays::mitsuba
