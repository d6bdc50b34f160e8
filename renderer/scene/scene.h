// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>

#include "renderer/scene/stores.h"

namespace rtrays {

class SceneGraph;

/// A loaded scene: the graph and the arrays it serializes into.
class Scene {
  public:
    /// An empty scene; its graph is to be filled and `update` called before the arrays are read.
    Scene();
    ~Scene();
    Scene(Scene &&) noexcept;
    Scene &operator=(Scene &&) noexcept;

    const std::string &name() const { return name_; }
    void set_name(const std::string &name) { name_ = name; }

    int film_width() const { return film_width_; }
    int film_height() const { return film_height_; }
    void set_film_size(int width, int height);

    SceneGraph &graph() { return *graph_; }
    const SceneGraph &graph() const { return *graph_; }

    /// Sets a property from text: "NODE.PROPERTY" or "materials.NAME.PROPERTY" (the ROOT.PATH of
    /// `--set scene.` without the root). Takes effect with the next `update`.
    void set_property(const std::string &address, const std::string &text);

    /// The text of `--print-scene`: what the scene consists of and every property with its value.
    std::string describe() const;

    /// Brings the arrays to scene time `time` (seconds), rewriting only what is dirty. Throws
    /// `Error` (bad input) naming what is wrong with the scene.
    void update(double time);

    const SceneArrays &arrays() const;
    const CameraArrays &cameras() const { return arrays().cameras; }
    const MeshArrays &meshes() const { return arrays().meshes; }
    const MaterialArrays &materials() const { return arrays().materials; }
    const LightArrays &lights() const { return arrays().lights; }

    /// Index of the camera to render from, into `cameras()`.
    int active_camera() const;

    /// Chooses it by node name; throws `Error` (bad input) listing the cameras when there is none
    /// such.
    void set_active_camera(const std::string &node_name);

    /// Makes the middle of all geometry the origin of the baked world, where it is so far from the
    /// origin of the scene file that rounding to float would cost anything that matters, and
    /// updates. To be called once, after the first update.
    void recentre();

    /// Where the origin of the baked world is in the coordinates of the scene file (see stores.h).
    Eigen::Vector3d origin() const;

    /// `content_hash` of everything that decides the image: arrays and camera. Names and the film
    /// size are left out.
    std::string hash() const;

  private:
    std::unique_ptr<SceneGraph> graph_;
    std::string name_;
    std::string camera_node_;  ///< empty: the first
    int film_width_ = 256;
    int film_height_ = 256;
};

/// Loads a scene (our JSON, or a model file: see model_file.h) and updates it to time 0, with
/// progress on stderr unless `quiet`. Throws `Error` (bad input) naming file, line and remedy.
Scene load_scene(const std::string &path, bool quiet = true);

}  // namespace rtrays
