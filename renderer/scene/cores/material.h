// SPDX-License-Identifier: MIT
// Material cores: types of materials and their expansion to atomic BxDFs.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "renderer/scene/cores/parameter_core.h"
#include "renderer/scene/cores/texture.h"
#include "renderer/scene/stores.h"

namespace rtrays {

class MaterialCore;

/// The material of the geometry below a node: that of the nearest node that has one.
struct MaterialAttribute : AttributeOf<MaterialAttribute> {
    const MaterialCore *material = nullptr;

    void combine(const MaterialAttribute &own) { material = own.material; }
};

/// One atomic BxDF of a material, before textures have indices.
struct MaterialComponent {
    BxdfComponent bxdf;
    std::string parameter;                       ///< name of the colour that became the weight
    std::shared_ptr<Texture> texture = nullptr;  ///< texture of that colour
    std::shared_ptr<Texture> roughness_texture = nullptr;
    std::shared_ptr<Texture> mix_texture = nullptr;
};

/// A type of material. The number of components depends only on the type.
struct MaterialType : CoreType {
    std::function<std::vector<MaterialComponent>(const ParameterSet &)> expand;
};

/// Returns all types except "composite" (see composite.h).
const std::vector<MaterialType> &material_types();

/// The scattering and emission of a surface: a sum of atomic BxDFs (thesis 3.3.6). All types share
/// the parameters of `common_material_parameters`.
class MaterialCore : public ParameterCore {
  public:
    /// Throws `Error` (bad input) like `ParameterCore`, and for an unknown type, listing the types.
    MaterialCore(std::string name, const std::string &type, const ParameterValues &values,
                 const ParameterTextures &textures = {});
    MaterialCore(std::string name, std::shared_ptr<const MaterialType> type,
                 const ParameterValues &values, const ParameterTextures &textures = {});
    ~MaterialCore() override;

    CoreRole role() const override { return CoreRole::material; }
    const NodeAttribute *attribute() const override { return &attribute_; }

    std::vector<MaterialComponent> components() const;
    bool two_sided() const { return parameters().get<bool>("two_sided"); }
    const Eigen::Vector3d &emission() const { return parameters().vector3("emission"); }
    bool emits() const { return emission().maxCoeff() > 0; }
    /// Returns the texture that multiplies the emission, or nullptr.
    std::shared_ptr<Texture> emission_texture() const {
        return emits() ? parameters().texture("emission") : nullptr;
    }
    /// Returns the opacity without the index of its texture, which is `opacity_texture`.
    MaterialOpacity opacity() const;
    std::shared_ptr<Texture> opacity_texture() const { return parameters().texture("opacity"); }
    /// Returns the map of normals or heights without the index of its texture, which is
    /// `normal_map_texture`.
    NormalMap normal_map() const;
    std::shared_ptr<Texture> normal_map_texture() const;
    bool is_opaque() const { return opacity_texture() == nullptr && opacity().is_opaque(); }

    /// Called by the textures of the material when they change.
    void texture_changed() { changed(Dirty::object); }

  protected:
    Dirty outdated_by(const std::string &parameter) const override;

  private:
    MaterialAttribute attribute_;
};

/// Returns the parameters that every material has.
const ParameterTable &common_material_parameters();

/// Throws `Error` (bad input) for a texture of the roughness of a smooth component, one that scales
/// it beyond 1, one that scales a mixture beyond 1, and like `check_energy`.
void check_components(const std::vector<MaterialComponent> &components);

/// Throws `Error` (bad input) if the opacity of a material exceeds 1 at a texel, or if it has both
/// a map of normals and one of heights.
void check_common_parameters(const ParameterSet &parameters);

}  // namespace rtrays
