// SPDX-License-Identifier: MIT
// Scenes that are built in memory for tests of the reference.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "reference/math.h"
#include "reference/renderer.h"
#include "renderer/scene/stores.h"

namespace rtrays::reference {

/// Scene arrays with functions to fill them.
struct TestScene : SceneArrays {
    uint32_t add_material(const Rgb &reflectance);
    uint32_t add_material(const std::vector<BxdfComponent> &components, bool two_sided = true);

    /// Adds a light without geometry, with the identity as its transform. Returns its index.
    uint32_t add_light(LightArrays::Kind kind, const Rgb &radiance);

    /// Adds a mesh, which is a light unless `radiance` is zero.
    void add_mesh(const std::vector<Vec3> &positions, const std::vector<Triangle> &triangles,
                  uint32_t material, const Rgb &radiance = Rgb::Zero());

    /// Adds a shape and returns its index. A hyperboloid has a flare of 1.
    uint32_t add_shape(ShapeArrays::Kind kind, const Eigen::Matrix4d &world_from_object,
                       uint32_t material, const Rgb &radiance = Rgb::Zero());

    /// Sets the normals, texture coordinates or colours of the last mesh, one per vertex.
    void set_normals(const std::vector<Vec3> &normals);
    void set_uv(const std::vector<Eigen::Vector2d> &uv);
    void set_colours(const std::vector<Rgb> &colours);

    /// Adds a quad with corners counter-clockwise as seen from the front.
    void add_quad(const std::array<Vec3, 4> &corners, uint32_t material,
                  const Rgb &radiance = Rgb::Zero());

    /// Adds an axis-parallel box, whose front faces inwards if `inside`.
    void add_box(const Vec3 &low, const Vec3 &high, bool inside, uint32_t material,
                 const Rgb &radiance = Rgb::Zero());

    /// Sets a camera that looks from `position` to `target`; `fov` is horizontal, in radians.
    void set_camera(const Vec3 &position, const Vec3 &target, const Vec3 &up, double fov);

    ReferenceRenderer renderer(const ReferenceSettings &settings) const {
        return ReferenceRenderer(*this, settings);
    }
};

/// Returns a uniform scale followed by a translation.
Eigen::Matrix4d placed(const Vec3 &position, double scale);

/// Returns a closed box whose walls emit `emission` and reflect `albedo`. The radiance is emission
/// / (1 - albedo) everywhere inside, in every direction, since L = E + rho L. The box is centred at
/// `centre` and has the edge length `size`.
TestScene furnace_box(float albedo, const Rgb &emission, const Vec3 &centre = Vec3::Zero(),
                      double size = 2.0);

/// Returns a box like the Cornell box: coloured side walls, a small ceiling light, a tall block and
/// a low one.
TestScene cornell_like_box();

/// Returns settings of a small square image.
ReferenceSettings small_settings(int size, uint64_t seed, Strategies strategies = Strategies::mis);

}  // namespace rtrays::reference
