// SPDX-License-Identifier: MIT
// Conversion of sensors to cameras. Parameters and defaults are those of Mitsuba 3.9,
// src/sensors/{perspective,thinlens,orthographic}.cpp and src/render/sensor.cpp.
#include <fmt/format.h>

#include <cmath>

#include "renderer/base/angles.h"
#include "renderer/import/mitsuba/light.h"
#include "renderer/scene/cores/transform.h"
#include "renderer/scene/stores/pose.h"

namespace rtrays::mitsuba {

namespace {

int pixels(Object &film, const char *name, int initial) {
    const double value = film.number(name, initial);
    if (value != std::floor(value) || value < 1 || value > (1 << 16)) {
        throw film.property(name).error(
            fmt::format("expected an integer from 1 to 65536, got {}", value));
    }
    return static_cast<int>(value);
}

/// Reads the crop of a film, unless it is the full film.
void read_crop(Object &film, PlacedCamera &placed) {
    const auto integer = [&](const char *name, int initial) {
        const double value = film.number(name, initial);
        if (value != std::floor(value) || value < 0 || value > (1 << 16)) {
            throw film.property(name).error(
                fmt::format("expected an integer from 0 to 65536, got {}", value));
        }
        return static_cast<int>(value);
    };
    const FilmCrop crop{integer("crop_offset_x", 0), integer("crop_offset_y", 0),
                        integer("crop_width", placed.width), integer("crop_height", placed.height)};
    if (crop.x != 0 || crop.y != 0 || crop.width != placed.width || crop.height != placed.height) {
        placed.crop = crop;
    }
}

void read_film(Object &sensor, const Document &document, PlacedCamera &placed) {
    placed.width = 768;
    placed.height = 576;
    const std::vector<Element> films = sensor.objects("film");
    if (films.size() > 1) {
        throw films[1].error("second film of this sensor; give one");
    }
    std::string filter = "gaussian";
    if (!films.empty()) {
        Object film(films[0], document);
        const bool has_old_type = films[0].is_old() && film.type() == "ldrfilm";
        if (film.type() != "hdrfilm" && !has_old_type) {
            throw films[0].error("unsupported film type; supported types are: hdrfilm");
        }
        if (has_old_type) {
            placed.replaced.push_back("film 'ldrfilm' (its tone mapping by --exposure)");
            for (const char *name : {"gamma", "exposure", "tonemap_method", "key", "burn"}) {
                film.ignore(name);
            }
        }
        placed.width = pixels(film, "width", placed.width);
        placed.height = pixels(film, "height", placed.height);
        read_crop(film, placed);
        // Settings of output files, and settings of filters wider than ours.
        for (const char *name :
             {"file_format", "pixel_format", "component_format", "banner", "attach_log",
              "compensate", "sample_border", "high_quality_edges"}) {
            film.ignore(name);
        }
        for (const Element &element : film.objects("rfilter")) {
            filter = element.raw_attribute("type");
        }
        film.finish();
    }
    if (filter != "box") {
        placed.replaced.push_back(
            fmt::format("rfilter '{}' (by a box filter of one pixel)", filter));
    }
}

/// Sets `fov` and `fov_axis` of a camera.
void read_angle(Object &sensor, int width, int height, ParameterValues &values) {
    const std::vector<std::string> axes = {"x", "y", "diagonal", "smaller", "larger"};
    std::string axis = axes[sensor.choice("fov_axis", axes, 0)];
    const std::optional<double> given = sensor.number("fov");
    const std::string focal_length = sensor.text("focal_length", "50mm");
    double fov = given.value_or(0);
    if (given.has_value() && sensor.has("focal_length")) {
        throw sensor.element().error("has both fov and focal_length");
    }
    if (!given.has_value()) {
        // The focal length is in millimetres, for the diagonal of a film of 36 by 24 mm.
        const std::string number = focal_length.substr(0, focal_length.find("mm"));
        const Element &place =
            sensor.has("focal_length") ? sensor.property("focal_length") : sensor.element();
        const std::vector<double> length = parse_numbers(place, number);
        if (length.size() != 1 || !(length[0] > 0)) {
            throw place.error(
                fmt::format("expected a positive length in millimetres, got '{}'", focal_length));
        }
        fov = 2 * std::atan(std::hypot(36.0, 24.0) / (2 * length[0])) / degree;
        axis = "diagonal";
    }
    if (axis == "diagonal") {
        if (!(fov > 0 && fov < 180)) {
            throw sensor.property("fov").error(fmt::format("{} is not within (0, 180)", fov));
        }
        fov = 2 * std::atan(std::tan(0.5 * fov * degree) * width / std::hypot(width, height)) /
              degree;
        axis = "x";
    }
    values["fov"] = fov;
    values["fov_axis"] = axis;
}

void read_pose(Object &sensor, PlacedCamera &placed) {
    const Eigen::Matrix4d to_world = nearest_similarity(sensor.transform(), "a camera");
    const Pose pose = pose_of(to_world * scaling({-1, 1, -1}), "a camera");
    // Mitsuba's own tolerance. It rejects any other scale.
    if (std::abs(pose.scale - 1) > 1e-3) {
        throw sensor.property("to_world")
            .error(fmt::format("scales by {:.6g}, but a camera cannot be scaled; remove the scale",
                               pose.scale));
    }
    placed.world_from_camera = pose.rigid;
}

/// Reads the pose of an orthographic camera and sets its size. The view of Mitsuba's is 2 wide,
/// times the scale of x and y. Its scale of z moves the clipping planes only.
void read_orthographic_pose(Object &sensor, PlacedCamera &placed, ParameterValues &values) {
    Eigen::Matrix4d to_world = sensor.transform();
    const Eigen::Vector3d x = to_world.col(0).head<3>(), y = to_world.col(1).head<3>();
    if (!(std::abs(x.stableNorm() / y.stableNorm() - 1) < 1e-3)) {
        throw sensor.property("to_world")
            .error("scales x and y differently, but pixels are square; use one scale for both");
    }
    to_world.col(2).head<3>() *= x.stableNorm() / to_world.col(2).head<3>().stableNorm();
    const Pose pose =
        pose_of(nearest_similarity(to_world, "a camera") * scaling({-1, 1, -1}), "a camera");
    placed.world_from_camera = pose.rigid;
    values["size"] = 2 * pose.scale;
    values["size_axis"] = std::string("x");
}

void read_clipping(Object &sensor, PlacedCamera &placed) {
    const double near_clip = sensor.number("near_clip", 0.01);
    const double far_clip = sensor.number("far_clip", 10000);
    placed.replaced.push_back(
        fmt::format("near_clip {} and far_clip {} (by no clipping)", near_clip, far_clip));
}

void read_sampler(Object &sensor, const Document &document, PlacedCamera &placed) {
    for (const Element &element : sensor.objects("sampler")) {
        Object sampler(element, document);
        placed.replaced.push_back(fmt::format("sampler '{}' of {} samples per pixel (by --spp)",
                                              element.raw_attribute("type"),
                                              sampler.number("sample_count", 4)));
    }
}

}  // namespace

PlacedCamera read_camera(Object &sensor, const Document &document) {
    const bool has_lens = sensor.type() == "thinlens";
    const bool is_parallel = sensor.type() == "orthographic";
    if (!has_lens && !is_parallel && sensor.type() != "perspective") {
        throw sensor.element().error(
            "unsupported sensor type; supported types are: perspective, thinlens, orthographic");
    }
    return sensor.element().located([&] {
        PlacedCamera placed;
        read_film(sensor, document, placed);
        ParameterValues values;
        if (!is_parallel) {
            read_angle(sensor, placed.width, placed.height, values);
        }
        if (has_lens) {
            const std::optional<double> radius = sensor.number("aperture_radius");
            if (!radius.has_value()) {
                throw sensor.element().error("needs an aperture_radius");
            }
            values["aperture_radius"] = *radius;
            values["focus_distance"] =
                sensor.number("focus_distance", sensor.number("far_clip", 10000));
        } else {
            sensor.ignore("focus_distance");  // unused without a lens
        }
        for (const char *name : {"principal_point_offset_x", "principal_point_offset_y"}) {
            if (sensor.number(name, 0) != 0) {
                throw sensor.property(name).error(
                    "off-centre principal points are unsupported; set this property to 0");
            }
        }
        sensor.ignore("shutter_open");  // nothing moves
        sensor.ignore("shutter_close");
        if (is_parallel) {
            read_orthographic_pose(sensor, placed, values);
        } else {
            read_pose(sensor, placed);
        }
        read_clipping(sensor, placed);
        read_sampler(sensor, document, placed);
        sensor.finish();
        placed.camera = std::make_shared<CameraCore>(sensor.id(),
                                                     is_parallel ? "orthographic"
                                                     : has_lens  ? "thin_lens"
                                                                 : "pinhole",
                                                     values);
        return placed;
    });
}

}  // namespace rtrays::mitsuba
