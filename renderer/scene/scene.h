// SPDX-License-Identifier: MIT
// A scene: the scene graph, its arrays, the film size and the active camera.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "renderer/scene/stores.h"

namespace rtrays {

class SceneGraph;

/// Identifies the contents of a scene's arrays by part. A number that two revisions of one scene
/// share means that this part has not changed between them. Equal numbers of different scenes mean
/// nothing.
struct SceneRevision {
    uint64_t scene = 0;      ///< the scene itself; 0 for none
    uint64_t materials = 0;  ///< materials and textures
    uint64_t geometry = 0;   ///< positions and vertex indices of meshes
    uint64_t surfaces = 0;   ///< normals, texture coordinates and materials of meshes
    uint64_t shapes = 0;
    uint64_t lights = 0;
};

/// A window of a picture, in pixels from its top left corner.
struct FilmCrop {
    int x = 0, y = 0, width = 0, height = 0;
};

/// A loaded scene: the graph and the arrays it serializes into.
class Scene {
  public:
    /// Makes an empty scene. Its graph must be filled and `update` called before the arrays are
    /// read.
    Scene();
    ~Scene();
    Scene(Scene &&) noexcept;
    Scene &operator=(Scene &&) noexcept;

    const std::string &name() const { return name_; }
    void set_name(const std::string &name) { name_ = name; }

    int film_width() const { return film_width_; }
    int film_height() const { return film_height_; }
    /// Sets the size of the full picture, without a crop. Throws `Error` (bad input) if it is out
    /// of range.
    void set_film_size(int width, int height);

    /// Returns the window of the picture to render, if not all of it.
    const std::optional<FilmCrop> &crop() const { return crop_; }
    /// Throws `Error` (bad input) if the window is not in the picture.
    void set_crop(const FilmCrop &crop);

    SceneGraph &graph() { return *graph_; }
    const SceneGraph &graph() const { return *graph_; }

    /// Sets a property from text. The address is "NODE.PROPERTY" or "materials.NAME.PROPERTY",
    /// which is the address in `--set scene.ADDRESS=VALUE`. Takes effect with the next `update`.
    void set_property(const std::string &address, const std::string &text);

    /// Returns the text of `--print-scene`: the numbers of objects, then every property with its
    /// value, type and meaning, and the shared objects of every node.
    std::string describe() const;
    /// Returns the same as a JSON document.
    std::string describe_json() const;

    /// Updates the arrays to scene time `time` (seconds); only dirty records are rewritten. Throws
    /// `Error` (bad input) naming what is wrong with the scene.
    void update(double time);

    const SceneArrays &arrays() const;

    /// Returns the revision of the arrays. The camera is not part of it.
    SceneRevision revision() const;

    const CameraArrays &cameras() const { return arrays().cameras; }
    const MeshArrays &meshes() const { return arrays().meshes; }
    const MaterialArrays &materials() const { return arrays().materials; }
    const LightArrays &lights() const { return arrays().lights; }

    /// Returns the index in `cameras()` of the camera to render from.
    int active_camera() const;

    /// Selects the camera by node name. Throws `Error` (bad input) listing the cameras if there is
    /// no camera of that name.
    void set_active_camera(const std::string &node_name);

    /// Moves the origin of the baked world to the centre of all geometry and updates the arrays, if
    /// the geometry is so far from the origin of the scene file that rounding to float would lose
    /// relevant digits. Must be called once, after the first update.
    void recentre();

    /// Returns the origin of the baked world in the coordinates of the scene file (see stores.h).
    Eigen::Vector3d origin() const;

    /// Returns the `content_hash` of everything that determines the image: arrays and camera, but
    /// not names or the film size.
    std::string hash() const;

  private:
    std::unique_ptr<SceneGraph> graph_;
    std::string name_;
    std::string camera_node_;  ///< empty for the first camera
    int film_width_ = 256;
    int film_height_ = 256;
    std::optional<FilmCrop> crop_;
};

}  // namespace rtrays
