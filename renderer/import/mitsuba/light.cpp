// SPDX-License-Identifier: MIT
// Conversion of emitters to lights, with the parameters and defaults of Mitsuba 3.9
// (src/emitters/*.cpp).
#include "renderer/import/mitsuba/light.h"

#include <fmt/format.h>

#include <Eigen/Geometry>

#include "renderer/import/mitsuba/envmap.h"
#include "renderer/scene/cores/transform.h"
#include "renderer/scene/stores/pose.h"

namespace rtrays::mitsuba {

namespace {

using Eigen::Matrix4d;
using Eigen::Vector3d;

/// Returns the transform for our lights, which shine along -z. Mitsuba's emitters shine along +z.
Matrix4d turned_about_y(const Matrix4d &to_world) {
    return to_world * scaling({-1, 1, -1});
}

std::shared_ptr<LightCore> make_light(const Object &object, const char *type,
                                      const ParameterValues &values) {
    return std::make_shared<LightCore>(object.id(), type, values);
}

PlacedLight read_point(Object &object, TextureFiles &) {
    const std::optional<Vector3d> position = object.vector("position");
    if (position.has_value() && object.has("to_world")) {
        throw object.element().error("has both position and to_world; give one");
    }
    return {make_light(object, "point", {{"intensity", object.emission("intensity", 1)}}),
            position.has_value() ? translation(*position) : object.transform()};
}

PlacedLight read_spot(Object &object, TextureFiles &) {
    const double cutoff = object.number("cutoff_angle", 20);
    return {make_light(object, "spot",
                       {{"intensity", object.emission("intensity", 1)},
                        {"inner_degrees", object.number("beam_width", 0.75 * cutoff)},
                        {"outer_degrees", cutoff}}),
            turned_about_y(object.transform())};
}

PlacedLight read_directional(Object &object, TextureFiles &) {
    const std::optional<Vector3d> direction = object.vector("direction");
    if (direction.has_value() && object.has("to_world")) {
        throw object.element().error("has both direction and to_world; give one");
    }
    Matrix4d world = turned_about_y(object.transform());
    if (direction.has_value()) {
        if (!(direction->stableNorm() > 0)) {
            throw object.property("direction").error("expected a direction of positive length");
        }
        // The light shines along -z. Any rotation about z gives the same light.
        const Vector3d z = -direction->stableNormalized(), x = z.unitOrthogonal();
        world.topLeftCorner<3, 3>() << x, z.cross(x), z;
    }
    return {make_light(object, "directional", {{"irradiance", object.emission("irradiance", 1)}}),
            world};
}

PlacedLight read_constant(Object &object, TextureFiles &) {
    return {make_light(object, "dome", {{"radiance", object.emission("radiance", 1)}}),
            Matrix4d::Identity()};
}

PlacedLight read_envmap(Object &object, TextureFiles &files) {
    const std::optional<std::string> file = object.text("filename");
    if (!file.has_value()) {
        throw object.element().error("needs a filename");
    }
    const Vector3d scale = Vector3d::Constant(object.number("scale", 1));
    const Matrix4d to_world = nearest_similarity(object.transform(), "an environment");
    pose_of(to_world, "an environment");  // throws for a mirroring transform
    const auto image = std::make_shared<TextureImage>(
        from_mitsuba_envmap(*files.load(object.element().path(*file), TextureEncoding::linear)));
    return {std::make_shared<LightCore>(object.id(), image, ParameterValues{{"scale", scale}}),
            to_world};
}

struct Type {
    const char *name;
    PlacedLight (*read)(Object &, TextureFiles &);
};
constexpr Type types[] = {{"point", read_point},
                          {"spot", read_spot},
                          {"directional", read_directional},
                          {"constant", read_constant},
                          {"envmap", read_envmap}};

}  // namespace

void check_area_light(const Object &emitter) {
    if (emitter.type() != "area") {
        throw emitter.element().error(
            "unsupported emitter type on a shape; supported types are: area");
    }
}

std::shared_ptr<LightCore> read_area_light(Object &object) {
    check_area_light(object);
    object.ignore("sampling_weight");  // affects noise only
    return object.element().located([&] {
        const auto light =
            make_light(object, "diffuse_area", {{"radiance", object.emission("radiance", 1)}});
        object.finish();
        return light;
    });
}

PlacedLight read_light(Object &object, TextureFiles &files) {
    object.ignore("sampling_weight");  // affects noise only
    std::string names;
    for (const Type &type : types) {
        if (object.type() == type.name) {
            return object.element().located([&] {
                const PlacedLight light = type.read(object, files);
                object.finish();
                return light;
            });
        }
        names += (names.empty() ? "" : ", ") + std::string(type.name);
    }
    throw object.element().error(fmt::format(
        "unsupported emitter type; supported types are: {}, and area on a shape", names));
}

}  // namespace rtrays::mitsuba
