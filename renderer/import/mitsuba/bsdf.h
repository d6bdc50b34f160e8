// SPDX-License-Identifier: MIT
// Conversion of Mitsuba BSDFs and textures to our materials and textures.
#pragma once

#include <map>
#include <memory>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "renderer/import/images/texture_file.h"
#include "renderer/import/mitsuba/object.h"
#include "renderer/scene/cores/material.h"
#include "renderer/scene/scene.h"

namespace rtrays::mitsuba {

/// Our texture coordinates of a geometry in terms of Mitsuba's coordinates (u, v). The top of an
/// image has v = 0 in Mitsuba and v = 1 in this renderer.
enum class UvConvention {
    none,     ///< unrelated, or without coordinates
    same,     ///< (u, v)
    flipped,  ///< (u, 1 - v)
};

/// Source of legal and unique object names. Dots are replaced, and repeated names are numbered.
class NameList {
  public:
    std::string unique(const std::string &wanted);

  private:
    std::set<std::string> taken_;
};

/// Converts BSDFs to materials, each of them once.
class MaterialReader {
  public:
    /// Registers materials and textures that have an id in the graph of `scene`, so that
    /// `--set scene.materials.ID.PROPERTY` finds them.
    MaterialReader(const Document &document, Scene &scene) : document_(document), scene_(scene) {}

    /// Returns the material of a "bsdf" element on a geometry whose texture coordinates follow
    /// `uv`. The material is named `default_name` if the element has no id. `emission` is the
    /// texture of the radiance of that geometry alone, or nullptr. Throws `LocatedError` that lists
    /// all errors of the BSDF.
    std::shared_ptr<MaterialCore> read(const Element &bsdf, UvConvention uv,
                                       const std::string &default_name,
                                       const std::shared_ptr<Texture> &emission = nullptr);

    /// Returns the material of a shape without a BSDF: black if the shape emits, otherwise grey.
    std::shared_ptr<MaterialCore> standard(bool emits);

    /// Returns a black material whose emission is a texture.
    std::shared_ptr<MaterialCore> emitting(const std::shared_ptr<Texture> &emission);

    /// Whether a texture is used as a colour or as a number.
    enum class TextureUse { colour, number };

    /// Returns the texture of a geometry whose texture coordinates follow `uv`.
    std::shared_ptr<Texture> texture(const Element &element, UvConvention uv,
                                     TextureUse use = TextureUse::colour);

    TextureFiles &files() { return files_; }

  private:
    struct Material {
        std::shared_ptr<MaterialCore> core;
        bool depends_on_uv;
        UvConvention uv;
    };
    struct Draft;
    using Read = void (MaterialReader::*)(Object &, Draft &);
    struct Type {
        const char *name;
        Read read;
    };
    static const std::vector<Type> &types();

    Draft read_bsdf(const Element &bsdf, UvConvention uv, ErrorList &errors);
    void read_diffuse(Object &object, Draft &draft);
    /// Reads what smooth, rough and thin glass have in common.
    void read_glass(Object &object, const char *type, Draft &draft);
    void read_dielectric(Object &object, Draft &draft);
    void read_thin_dielectric(Object &object, Draft &draft);
    void read_conductor(Object &object, Draft &draft);
    void read_plastic(Object &object, Draft &draft);
    void read_principled(Object &object, Draft &draft);
    /// Returns a number within [0, 1], or 1 with a texture as its factor.
    double read_factor(Object &object, const char *property, std::shared_ptr<Texture> &factor,
                       Draft &draft);
    /// Returns a texture whose luminance mixes BSDFs. Throws `LocatedError` if it exceeds 1.
    std::shared_ptr<Texture> mix_texture(const Element &element, Draft &draft);
    /// Returns a number within [0, 1]. A texture is replaced by its mean, with a notice.
    double read_share(Object &object, const char *property, double initial, Draft &draft);
    void read_twosided(Object &object, Draft &draft);
    void read_blend(Object &object, Draft &draft);
    void read_mask(Object &object, Draft &draft);
    void read_normal_map(Object &object, Draft &draft);
    void read_bump_map(Object &object, Draft &draft);
    /// Reads what normal and bump maps share. `parameter` is that of the texture.
    void read_map(Object &object, const std::vector<Element> &textures, const char *parameter,
                  Draft &draft);

    /// Returns the components of a nested BSDF, and adds what its draft depends on.
    static std::vector<MaterialComponent> nested_components(const Element &bsdf, const Draft &part,
                                                            Draft &draft);
    /// Makes a material of these components.
    static void set_composite(const std::vector<MaterialComponent> &components, bool two_sided,
                              Draft &draft);

    void read_colour(Object &object, const char *property, const char *parameter, double initial,
                     Draft &draft);
    void read_roughness(Object &object, Draft &draft);
    std::shared_ptr<Texture> texture(const Element &element, Draft &draft,
                                     TextureUse use = TextureUse::colour);
    std::shared_ptr<Texture> bitmap(Object &object, UvConvention uv);
    std::shared_ptr<Texture> checkerboard(Object &object, UvConvention uv, TextureUse use);
    std::shared_ptr<Texture> mesh_attribute(Object &object);

    const Document &document_;
    Scene &scene_;
    TextureFiles files_;
    NameList material_names_;
    NameList texture_names_;
    std::map<size_t, std::vector<Material>> materials_;  ///< by hash of the element
    std::map<std::tuple<size_t, UvConvention, TextureUse>, std::shared_ptr<Texture>> textures_;
    std::shared_ptr<MaterialCore> standard_[2];
    int nesting_ = 0;  ///< depth of the BSDF that is being read
};

}  // namespace rtrays::mitsuba
