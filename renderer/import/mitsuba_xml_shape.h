// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <map>
#include <memory>
#include <string>

#include "renderer/import/mitsuba_xml_bsdf.h"
#include "renderer/import/mitsuba_xml_object.h"
#include "renderer/scene/core.h"

namespace rtrays::mitsuba {

/// A shape without its BSDF and emitter.
struct Shape {
    std::shared_ptr<Core> geometry;
    Eigen::Matrix4d world_from_geometry;
    UvConvention uv = UvConvention::none;
    bool can_emit = true;
    bool is_flipped = false;  ///< seen from behind, which our geometry cannot be
};

/// Makes geometry of shapes; what several shapes have in common is shared.
class ShapeReader {
  public:
    /// Throws `LocatedError` when the shape cannot be mapped; BSDF and emitter are left in
    /// `object`.
    Shape read(Object &object);

  private:
    using Read = Shape (ShapeReader::*)(Object &);
    struct Type {
        const char *name;
        Read read;
    };
    static const std::vector<Type> &types();

    Shape read_rectangle(Object &object);
    Shape read_cube(Object &object);
    Shape read_sphere(Object &object);
    Shape read_disk(Object &object);
    Shape read_cylinder(Object &object);
    Shape read_file(Object &object);

    std::shared_ptr<Core> &shared(const std::string &key) { return shared_[key]; }

    std::map<std::string, std::shared_ptr<Core>> shared_;
};

}  // namespace rtrays::mitsuba
