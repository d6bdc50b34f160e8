// SPDX-License-Identifier: MIT
// Conversion of Mitsuba emitters and sensors to our lights and cameras.
#pragma once

#include <Eigen/Core>
#include <memory>

#include "renderer/import/images/texture_file.h"
#include "renderer/import/mitsuba/object.h"
#include "renderer/scene/cores/camera.h"
#include "renderer/scene/cores/light.h"
#include "renderer/scene/scene.h"

namespace rtrays::mitsuba {

/// A light and its transform.
struct PlacedLight {
    std::shared_ptr<LightCore> light;
    Eigen::Matrix4d world_from_light;
};

/// Throws `LocatedError` unless the emitter of a shape is an area light.
void check_area_light(const Object &emitter);

/// Converts the emitter of a shape. Throws `LocatedError` unless it is a supported area light.
std::shared_ptr<LightCore> read_area_light(Object &emitter);

/// Converts an emitter that belongs to no shape. Throws `LocatedError` if it is unsupported.
PlacedLight read_light(Object &emitter, TextureFiles &files);

/// A camera, its transform and its film size in pixels.
struct PlacedCamera {
    std::shared_ptr<CameraCore> camera;
    Eigen::Matrix4d world_from_camera;
    int width;
    int height;
    std::optional<FilmCrop> crop;
    /// Settings of film, sampler and clipping planes that this renderer replaces by its own.
    std::vector<std::string> replaced;
};

/// Converts a sensor and its film. Throws `LocatedError` if they are unsupported.
PlacedCamera read_camera(Object &sensor, const Document &document);

}  // namespace rtrays::mitsuba
