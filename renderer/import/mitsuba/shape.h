// SPDX-License-Identifier: MIT
// Conversion of Mitsuba shapes to our geometry.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>

#include "renderer/import/mitsuba/bsdf.h"
#include "renderer/import/mitsuba/object.h"
#include "renderer/scene/core.h"
#include "renderer/scene/cores/mesh.h"

namespace rtrays::mitsuba {

/// The geometry and transform of a shape, without its BSDF and emitter.
struct Shape {
    std::shared_ptr<Core> geometry;
    Eigen::Matrix4d world_from_geometry;
    UvConvention uv = UvConvention::none;
    bool can_emit = true;
    bool is_flipped = false;  ///< front and back are exchanged, which our geometry cannot express
};

/// Returns a shape as a mesh, which can emit, and whose front is on the flipped side if the shape
/// is flipped.
Shape tessellated(const Shape &shape);

/// Exchanges the vertices of each triangle whose front is not on the side of its stored normals.
/// Those normals decide the side in Mitsuba.
void turn_towards_normals(MeshCore::Geometry &geometry);

/// Converts shapes to geometry. Equal geometry of several shapes is shared.
class ShapeReader {
  public:
    /// Converts a shape. Leaves its BSDF and emitter in `object`. Throws `LocatedError` if the
    /// shape is unsupported.
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
    Shape read_serialized_mesh(Object &object);
    /// Returns the shape of a mesh from a file. `prefix` identifies the mesh within its file, and
    /// `load` returns it. `flip_v` exchanges the top and the bottom of textures.
    Shape mesh(Object &object, const std::filesystem::path &path, const std::string &prefix,
               bool flip_v, const std::function<MeshCore::Geometry(bool without_normals)> &load);

    std::shared_ptr<Core> &shared(const std::string &key) { return shared_[key]; }

    std::map<std::string, std::shared_ptr<Core>> shared_;
};

}  // namespace rtrays::mitsuba
