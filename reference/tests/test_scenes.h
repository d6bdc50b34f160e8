// SPDX-License-Identifier: MIT
// Scenes built in memory, for tests of the reference alone.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "reference/math.h"
#include "reference/renderer.h"
#include "renderer/scene/stores.h"

namespace rtrays::reference {

/// The arrays of a scene, filled by hand.
struct TestScene : SceneArrays {
    uint32_t add_material(const Rgb &reflectance);
    uint32_t add_material(const std::vector<BxdfComponent> &components, bool two_sided = true);

    /// A light of no geometry and the identity as its transform; returns its index.
    uint32_t add_light(LightArrays::Kind kind, const Rgb &radiance);

    /// `radiance` of zero: no light.
    void add_mesh(const std::vector<Vec3> &positions, const std::vector<Triangle> &triangles,
                  uint32_t material, const Rgb &radiance = Rgb::Zero());

    /// Returns the index of the shape; a hyperboloid has a flare of 1.
    uint32_t add_shape(ShapeArrays::Kind kind, const Eigen::Matrix4d &world_from_object,
                       uint32_t material, const Rgb &radiance = Rgb::Zero());

    /// Of the last mesh, one per vertex.
    void set_normals(const std::vector<Vec3> &normals);
    void set_uv(const std::vector<Eigen::Vector2d> &uv);

    /// Corners counter-clockwise seen from the front.
    void add_quad(const std::array<Vec3, 4> &corners, uint32_t material,
                  const Rgb &radiance = Rgb::Zero());

    /// Axis-parallel box; `inside` says on which side its front faces.
    void add_box(const Vec3 &low, const Vec3 &high, bool inside, uint32_t material,
                 const Rgb &radiance = Rgb::Zero());

    /// Camera looking from `position` to `target`; `fov` is horizontal, in radians.
    void set_camera(const Vec3 &position, const Vec3 &target, const Vec3 &up, double fov);

    ReferenceRenderer renderer(const ReferenceSettings &settings) const {
        return ReferenceRenderer(*this, settings);
    }
};

/// Uniform scale, then translation.
Eigen::Matrix4d placed(const Vec3 &position, double scale);

/// Closed box of walls that all emit `emission` and reflect `albedo`: the radiance is emission / (1
/// - albedo) everywhere inside, in every direction, since L = E + rho L. Centred at `centre`, edge
/// length `size`.
TestScene furnace_box(float albedo, const Rgb &emission, const Vec3 &centre = Vec3::Zero(),
                      double size = 2.0);

/// A box like the Cornell box: coloured side walls, a small ceiling light, a tall and a low block.
TestScene cornell_like_box();

/// Settings of a small square image.
ReferenceSettings small_settings(int size, uint64_t seed, Strategies strategies = Strategies::mis);

}  // namespace rtrays::reference
