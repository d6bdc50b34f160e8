// SPDX-License-Identifier: MIT
#include "reference/tests/test_scenes.h"

namespace rtrays::reference {

uint32_t TestScene::add_material(const Rgb &reflectance) {
    BxdfComponent lambert;
    lambert.weight = reflectance;
    return add_material(std::vector<BxdfComponent>{lambert});
}

uint32_t TestScene::add_material(const std::vector<BxdfComponent> &components, bool two_sided) {
    materials.name.push_back("material" + std::to_string(materials.name.size()));
    materials.first_component.push_back(static_cast<uint32_t>(materials.component.size()));
    materials.component_count.push_back(static_cast<uint32_t>(components.size()));
    materials.two_sided.push_back(two_sided ? 1 : 0);
    materials.component.insert(materials.component.end(), components.begin(), components.end());
    return static_cast<uint32_t>(materials.name.size() - 1);
}

void TestScene::add_mesh(const std::vector<Vec3> &positions, const std::vector<Triangle> &triangles,
                         uint32_t material, const Rgb &radiance) {
    const auto mesh = static_cast<uint32_t>(meshes.name.size());
    const auto first_vertex = static_cast<uint32_t>(meshes.position.size());
    meshes.name.push_back("mesh" + std::to_string(mesh));
    meshes.first_triangle.push_back(static_cast<uint32_t>(meshes.triangle.size()));
    meshes.triangle_count.push_back(static_cast<uint32_t>(triangles.size()));
    meshes.material.push_back(material);
    meshes.has_normals.push_back(0);
    meshes.has_uv.push_back(0);
    for (const Vec3 &position : positions) {
        meshes.position.push_back(position.cast<float>());
    }
    double area = 0.0;
    for (const Triangle &t : triangles) {
        meshes.triangle.push_back({first_vertex + t[0], first_vertex + t[1], first_vertex + t[2]});
        meshes.triangle_mesh.push_back(mesh);
        area += 0.5 *
                (positions[t[1]] - positions[t[0]]).cross(positions[t[2]] - positions[t[0]]).norm();
    }
    if (radiance.isZero()) {
        meshes.light.push_back(no_index);
        return;
    }
    const uint32_t light = add_light(LightArrays::Kind::diffuse_area, radiance);
    meshes.light.push_back(light);
    lights.mesh[light] = mesh;
    lights.area[light] = area;
}

uint32_t TestScene::add_light(LightArrays::Kind kind, const Rgb &radiance) {
    lights.name.push_back("light" + std::to_string(lights.name.size()));
    lights.kind.push_back(kind);
    lights.radiance.push_back(radiance);
    lights.mesh.push_back(no_index);
    lights.shape.push_back(no_index);
    lights.area.push_back(0.0);
    lights.world_from_light.push_back(Eigen::Matrix4d::Identity());
    lights.inner_angle.push_back(0.0);
    lights.outer_angle.push_back(0.0);
    lights.image.emplace_back();
    return static_cast<uint32_t>(lights.name.size() - 1);
}

uint32_t TestScene::add_shape(ShapeArrays::Kind kind, const Eigen::Matrix4d &world_from_object,
                              uint32_t material, const Rgb &radiance) {
    const auto shape = static_cast<uint32_t>(shapes.name.size());
    shapes.name.push_back("shape" + std::to_string(shape));
    shapes.kind.push_back(kind);
    shapes.world_from_object.push_back(world_from_object);
    shapes.material.push_back(material);
    shapes.light.push_back(no_index);
    shapes.flare.push_back(kind == ShapeArrays::Kind::hyperboloid ? 1.0 : 0.0);
    shapes.julia_constant.emplace_back(Eigen::Vector4d::Zero());
    shapes.julia_slice.push_back(0.0);
    shapes.julia_iterations.push_back(0);
    if (!radiance.isZero()) {
        shapes.light.back() = add_light(LightArrays::Kind::diffuse_area, radiance);
        lights.shape.back() = shape;
        const double r = world_from_object.col(0).norm();
        lights.area.back() = (kind == ShapeArrays::Kind::sphere ? 4.0 : 1.0) * pi * r * r;
    }
    return shape;
}

Eigen::Matrix4d placed(const Vec3 &position, double scale) {
    Eigen::Matrix4d transform = scale * Eigen::Matrix4d::Identity();
    transform.topRightCorner<3, 1>() = position;
    transform(3, 3) = 1.0;
    return transform;
}

void TestScene::set_normals(const std::vector<Vec3> &normals) {
    meshes.has_normals.back() = 1;
    meshes.normal.resize(meshes.position.size() - normals.size(), Eigen::Vector3f::Zero());
    for (const Vec3 &normal : normals) {
        meshes.normal.push_back(normal.cast<float>());
    }
}

void TestScene::set_uv(const std::vector<Eigen::Vector2d> &uv) {
    meshes.has_uv.back() = 1;
    meshes.uv.resize(meshes.position.size() - uv.size(), Eigen::Vector2f::Zero());
    for (const Eigen::Vector2d &coordinates : uv) {
        meshes.uv.push_back(coordinates.cast<float>());
    }
}

void TestScene::set_colours(const std::vector<Rgb> &colours) {
    meshes.has_colour.resize(meshes.name.size(), 0);
    meshes.has_colour.back() = 1;
    meshes.colour.resize(meshes.position.size() - colours.size(), Rgb::Ones());
    meshes.colour.insert(meshes.colour.end(), colours.begin(), colours.end());
}

void TestScene::add_quad(const std::array<Vec3, 4> &corners, uint32_t material,
                         const Rgb &radiance) {
    add_mesh({corners.begin(), corners.end()}, {{0, 1, 2}, {0, 2, 3}}, material, radiance);
}

void TestScene::add_box(const Vec3 &low, const Vec3 &high, bool inside, uint32_t material,
                        const Rgb &radiance) {
    std::vector<Vec3> corners;
    for (int i = 0; i < 8; ++i) {
        corners.emplace_back(i & 1 ? high.x() : low.x(), i & 2 ? high.y() : low.y(),
                             i & 4 ? high.z() : low.z());
    }
    // Faces are counter-clockwise from outside.
    std::vector<Triangle> triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6},
                                       {0, 1, 5}, {0, 5, 4}, {2, 6, 7}, {2, 7, 3},
                                       {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    if (inside) {
        for (Triangle &t : triangles) {
            std::swap(t[1], t[2]);
        }
    }
    add_mesh(corners, triangles, material, radiance);
}

void TestScene::set_camera(const Vec3 &position, const Vec3 &target, const Vec3 &up, double fov) {
    const Vec3 z = (position - target).normalized();
    const Vec3 x = up.cross(z).normalized();
    Eigen::Matrix4d world_from_camera = Eigen::Matrix4d::Identity();
    world_from_camera.topLeftCorner<3, 1>() = x;
    world_from_camera.block<3, 1>(0, 1) = z.cross(x);
    world_from_camera.block<3, 1>(0, 2) = z;
    world_from_camera.topRightCorner<3, 1>() = position;
    cameras = {{"camera"}, {world_from_camera}, {fov}, {CameraArrays::FovAxis::x}, {0}, {0}, {1}};
}

TestScene furnace_box(float albedo, const Rgb &emission, const Vec3 &centre, double size) {
    TestScene scene;
    const Vec3 half = Vec3::Constant(0.5 * size);
    scene.add_box(centre - half, centre + half, true, scene.add_material(Rgb::Constant(albedo)),
                  emission);
    scene.set_camera(centre + size * Vec3(0.1, -0.05, 0.2), centre - size * Vec3(0.3, 0.1, 0.5),
                     Vec3::UnitY(), 1.2);
    return scene;
}

TestScene cornell_like_box() {
    TestScene scene;
    const uint32_t white = scene.add_material({0.75f, 0.75f, 0.75f});
    const uint32_t red = scene.add_material({0.6f, 0.06f, 0.06f});
    const uint32_t green = scene.add_material({0.12f, 0.48f, 0.1f});
    scene.add_quad({Vec3(0, 0, 0), Vec3(0, 0, 5.6), Vec3(5.6, 0, 5.6), Vec3(5.6, 0, 0)}, white);
    scene.add_quad({Vec3(0, 5.5, 0), Vec3(5.6, 5.5, 0), Vec3(5.6, 5.5, 5.6), Vec3(0, 5.5, 5.6)},
                   white);
    scene.add_quad({Vec3(0, 0, 0), Vec3(5.6, 0, 0), Vec3(5.6, 5.5, 0), Vec3(0, 5.5, 0)}, white);
    scene.add_quad({Vec3(0, 0, 0), Vec3(0, 5.5, 0), Vec3(0, 5.5, 5.6), Vec3(0, 0, 5.6)}, red);
    scene.add_quad({Vec3(5.6, 0, 0), Vec3(5.6, 0, 5.6), Vec3(5.6, 5.5, 5.6), Vec3(5.6, 5.5, 0)},
                   green);
    scene.add_quad(
        {Vec3(2.1, 5.49, 2.3), Vec3(3.4, 5.49, 2.3), Vec3(3.4, 5.49, 3.3), Vec3(2.1, 5.49, 3.3)},
        white, {18.4f, 15.6f, 8.0f});
    scene.add_box({0.9, 0.0, 1.0}, {2.4, 3.3, 2.5}, false, white);
    scene.add_box({3.0, 0.0, 2.9}, {4.6, 1.65, 4.5}, false, white);
    scene.set_camera({2.78, 2.73, 13.6}, {2.78, 2.73, 0.0}, Vec3::UnitY(), 0.69);
    return scene;
}

ReferenceSettings small_settings(int size, uint64_t seed, Strategies strategies) {
    ReferenceSettings settings;
    settings.width = settings.height = size;
    settings.seed = seed;
    settings.strategies = strategies;
    return settings;
}

}  // namespace rtrays::reference
