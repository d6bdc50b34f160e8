// SPDX-License-Identifier: MIT
// Classes of pixels in scenes whose pixels can be counted by hand.
//
// The camera is at the origin and sees exactly the square -1 <= x, y <= 1 of the plane z = -1. On a
// film of 12 x 12 pixels, a lamp of half side 1 at distance 3 covers the 4 x 4 pixels in the
// centre, also if it is seen in a mirror.
#include "reference/first_hit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

#include "reference/tests/test_materials.h"
#include "reference/tests/test_scenes.h"

namespace rtrays::reference {
namespace {

constexpr int size = 12;

/// Returns the number of pixels of each class.
std::array<int, 3> counts(TestScene &scene) {
    scene.set_camera(Vec3::Zero(), -Vec3::UnitZ(), Vec3::UnitY(), 0.5 * pi);
    std::array<int, 3> result{};
    for (const FirstHit hit : scene.renderer(small_settings(size, 1)).first_hits()) {
        ++result[static_cast<size_t>(hit)];
    }
    return result;
}

using Counts = std::array<int, 3>;  // light_behind_delta, delta, other

/// Adds a square that faces +z, or -z if `faces_down`, and covers low <= x <= high.
void add_square(TestScene &scene, double low, double high, double half_height, double z,
                uint32_t material, bool faces_down = false, const Rgb &radiance = Rgb::Zero()) {
    std::array<Vec3, 4> corners{Vec3(low, -half_height, z), Vec3(high, -half_height, z),
                                Vec3(high, half_height, z), Vec3(low, half_height, z)};
    if (faces_down) {
        std::reverse(corners.begin(), corners.end());
    }
    scene.add_quad(corners, material, radiance);
}

uint32_t black(TestScene &scene) {
    return scene.add_material(Rgb::Zero());
}

/// Adds a lamp behind the camera, which faces a mirror in front of it.
void add_lamp(TestScene &scene, double half_side, bool faces_down = true) {
    add_square(scene, -half_side, half_side, half_side, 1, black(scene), faces_down, Rgb::Ones());
}

TEST(FirstHit, a_mirror_shows_a_lamp_over_a_known_number_of_pixels) {
    TestScene scene;
    add_square(scene, -1, 0, 1, -1, scene.add_material({ideal_reflection()}));
    add_square(scene, 0, 1, 1, -1, scene.add_material(Rgb::Ones()));
    add_lamp(scene, 1);
    EXPECT_EQ(counts(scene), (Counts{8, 64, 72}));
}

TEST(FirstHit, a_lamp_in_a_part_of_a_pixel_decides_its_class) {
    TestScene scene;
    add_square(scene, -1, 1, 1, -1, scene.add_material({ideal_reflection()}));
    add_lamp(scene, 1.1);  // 0.2 pixels more on each side
    EXPECT_EQ(counts(scene), (Counts{36, 108, 0}));
}

TEST(FirstHit, a_lamp_that_faces_away_or_a_wall_is_no_light) {
    TestScene scene;
    add_square(scene, -1, 1, 1, -1, scene.add_material({ideal_reflection()}));
    add_lamp(scene, 1, false);
    EXPECT_EQ(counts(scene), (Counts{0, 144, 0}));
}

TEST(FirstHit, a_lamp_without_a_mirror_is_other) {
    TestScene scene;
    add_square(scene, -1, 1, 1, -1, black(scene), false, Rgb::Ones());
    EXPECT_EQ(counts(scene), (Counts{0, 0, 144}));
}

TEST(FirstHit, all_branches_of_a_beam_splitter_are_followed) {
    // The lamps are seen by reflection on the left and by transmission on the right.
    TestScene scene;
    BxdfComponent reflection = ideal_reflection(), transmission = ideal_refraction(1.0);
    reflection.weight = transmission.weight = Rgb::Constant(0.5f);
    add_square(scene, -1, 1, 1, -1, scene.add_material(std::vector{reflection, transmission}));
    add_square(scene, -1, 0, 1, 1, black(scene), true, Rgb::Ones());
    add_square(scene, 0, 1, 1, -3, black(scene), false, Rgb::Ones());
    EXPECT_EQ(counts(scene), (Counts{16, 128, 0}));
}

TEST(FirstHit, a_coat_on_a_diffuse_base_counts_as_a_mirror) {
    TestScene scene;
    add_square(scene, -1, 1, 1, -1,
               scene.add_material(std::vector{with_dielectric(ideal_reflection(), 1.5),
                                              with_dielectric(lambert(0.5), 1.5, true)}));
    add_lamp(scene, 1);
    EXPECT_EQ(counts(scene), (Counts{16, 128, 0}));
}

TEST(FirstHit, rough_surfaces_are_other) {
    TestScene scene;
    add_square(scene, -1, 1, 1, -1, scene.add_material({blinn(1000)}));
    add_lamp(scene, 1);
    EXPECT_EQ(counts(scene), (Counts{0, 0, 144}));
}

TEST(FirstHit, the_sky_in_a_mirror_is_a_light) {
    TestScene scene;
    add_square(scene, -1, 0, 1, -1, scene.add_material({ideal_reflection()}));
    scene.add_light(LightArrays::Kind::dome, Rgb::Ones());
    EXPECT_EQ(counts(scene), (Counts{72, 0, 72}));
}

TEST(FirstHit, surfaces_that_let_rays_pass_do_not_count) {
    TestScene scene;
    const uint32_t mirror = scene.add_material({ideal_reflection()});
    scene.materials.opacity.resize(mirror + 1);
    scene.materials.opacity[mirror].value = 0.0;
    add_square(scene, -1, 1, 1, -1, mirror);
    add_lamp(scene, 1);
    scene.materials.opacity.resize(scene.materials.name.size());
    EXPECT_EQ(counts(scene), (Counts{0, 0, 144}));
}

TEST(FirstHit, closed_glass_and_facing_mirrors_end) {
    TestScene scene;
    scene.add_shape(ShapeArrays::Kind::sphere, placed(Vec3(0, 0, -4), 1),
                    scene.add_material(smooth_glass(1.5)));
    const uint32_t mirror = scene.add_material({ideal_reflection()});
    add_square(scene, -9, 9, 9, -6, mirror);
    add_square(scene, -9, 9, 9, 1, mirror, true);
    EXPECT_EQ(counts(scene), (Counts{0, 144, 0}));
}

}  // namespace
}  // namespace rtrays::reference
