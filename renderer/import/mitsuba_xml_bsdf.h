// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "renderer/import/mitsuba_xml_object.h"
#include "renderer/import/texture_file.h"
#include "renderer/scene/cores/material.h"
#include "renderer/scene/scene.h"

namespace rtrays::mitsuba {

/// How the texture coordinates of a geometry relate to Mitsuba's of the same one. An image has v =
/// 0 at its top there and at its bottom here.
enum class UvConvention {
    none,     ///< they have nothing in common
    same,     ///< (u, v)
    flipped,  ///< (u, 1 - v)
};

/// Names that are legal in our scenes and not taken: without dots, numbered where need be.
class NameList {
  public:
    std::string unique(const std::string &wanted);

  private:
    std::set<std::string> taken_;
};

/// Makes materials of BSDFs, each once.
class MaterialReader {
  public:
    /// Shares what has an id with the graph of `scene`, for `--set scene.materials.ID.PROPERTY`.
    MaterialReader(const Document &document, Scene &scene) : document_(document), scene_(scene) {}

    /// The material of a "bsdf" element on a geometry with such coordinates; `default_name` if it
    /// has no id. Throws `LocatedError` when it cannot be mapped.
    std::shared_ptr<MaterialCore> read(const Element &bsdf, UvConvention uv,
                                       const std::string &default_name);

    /// What a shape without a BSDF has: grey, and black if it emits.
    std::shared_ptr<MaterialCore> standard(bool emits);

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

    Draft read_bsdf(const Element &bsdf, UvConvention uv);
    void read_diffuse(Object &object, Draft &draft);
    void read_dielectric(Object &object, Draft &draft);
    void read_conductor(Object &object, Draft &draft);
    void read_plastic(Object &object, Draft &draft);
    void read_twosided(Object &object, Draft &draft);

    void read_colour(Object &object, const char *property, const char *parameter, double initial,
                     Draft &draft);
    void read_roughness(Object &object, Draft &draft);
    std::shared_ptr<Texture> texture(const Element &element, Draft &draft);

    const Document &document_;
    Scene &scene_;
    TextureFiles files_;
    NameList material_names_;
    NameList texture_names_;
    std::map<size_t, std::vector<Material>> materials_;  ///< by element
    std::map<std::pair<size_t, UvConvention>, std::shared_ptr<Texture>> textures_;
    std::shared_ptr<MaterialCore> standard_[2];
};

}  // namespace rtrays::mitsuba
