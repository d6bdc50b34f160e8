// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <memory>

#include "renderer/import/mitsuba_xml_object.h"
#include "renderer/import/texture_file.h"
#include "renderer/scene/cores/camera.h"
#include "renderer/scene/cores/light.h"

namespace rtrays::mitsuba {

struct PlacedLight {
    std::shared_ptr<LightCore> light;
    Eigen::Matrix4d world_from_light;
};

/// The emitter of a shape. Throws `LocatedError` unless it is an area light that maps.
std::shared_ptr<LightCore> read_area_light(Object &emitter);

/// An emitter by itself. Throws `LocatedError` when it cannot be mapped.
PlacedLight read_light(Object &emitter, TextureFiles &files);

struct PlacedCamera {
    std::shared_ptr<CameraCore> camera;
    Eigen::Matrix4d world_from_camera;
    int width;
    int height;
    std::vector<std::string>
        replaced;  ///< what its film, sampler and clipping planes say that we do otherwise
};

/// A sensor with its film. Throws `LocatedError` when it cannot be mapped.
PlacedCamera read_camera(Object &sensor, const Document &document);

}  // namespace rtrays::mitsuba
