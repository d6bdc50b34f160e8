// SPDX-License-Identifier: MIT
// The scene graph: its tree of nodes, its shared objects and the stores that it serializes into.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

#include "renderer/scene/node.h"
#include "renderer/scene/scene.h"
#include "renderer/scene/stores/camera_store.h"
#include "renderer/scene/stores/light_store.h"
#include "renderer/scene/stores/material_store.h"
#include "renderer/scene/stores/mesh_store.h"
#include "renderer/scene/stores/shape_store.h"

namespace rtrays {

/// The scene graph and its serialized form (thesis 3.2.2). Users edit nodes and cores. `update`
/// brings the stores up to date from a list of the edited nodes, so its cost does not depend on the
/// rest of the graph.
class SceneGraph {
  public:
    SceneGraph();
    ~SceneGraph();

    Node &root() { return *root_; }

    /// Returns the node of that name, or nullptr. Names are unique; nodes without a name are not
    /// found.
    Node *find(const std::string &name) const;

    /// Registers a core or a texture under an address such as "materials.white", for `set_property`
    /// and listings. Throws `Error` (bad input) if the address is taken.
    void share(const std::string &address, std::shared_ptr<PropertyHolder> holder);

    /// Moves all nodes and shared objects of another graph into this one. The nodes become children
    /// of `parent`, a node of this graph. The names of both begin with that of `parent` and a
    /// slash: "materials.white" becomes "materials.PARENT/white". Throws `Error` (bad input) if a
    /// name is taken; then the other graph is incomplete.
    void absorb(SceneGraph &other, Node &parent);

    /// Sets "NODE.PROPERTY" or "SECTION.NAME.PROPERTY" from text. A core shared by several nodes
    /// changes for all of them. Throws `Error` (bad input) naming the address and the alternatives.
    void set_property(const std::string &address, const std::string &text);

    /// Calls `visit(owner, property)` for every property: of shared objects, then of nodes in tree
    /// order without those of shared objects. `set_property` finds it at "OWNER.PROPERTY". Calls
    /// `visit_use(node, owner)` for every shared object of a node.
    void visit_properties(
        const std::function<void(const std::string &, const Property &)> &visit,
        const std::function<void(const std::string &, const std::string &)> &visit_use) const;

    /// Advances animated cores to `time` (seconds) and writes all dirty records. Throws `Error`
    /// (bad input) if an object cannot be represented. The object then stays dirty, and the arrays
    /// must not be read until an update has succeeded.
    void update(double time);

    /// The scene time of the last update, seconds.
    double time() const { return time_; }

    /// Numbers of objects that the last update changed, by store.
    const StoreCounts &camera_counts() const { return cameras_.counts(); }
    const StoreCounts &material_counts() const { return materials_.counts(); }
    const StoreCounts &mesh_counts() const { return meshes_.counts(); }
    const StoreCounts &shape_counts() const { return shapes_.counts(); }
    const StoreCounts &light_counts() const { return lights_.counts(); }

    /// Returns the revision of the arrays after the last update.
    SceneRevision revision() const;

    /// Number of nodes that the last update visited.
    size_t visited_nodes() const { return visited_nodes_; }

    /// The arrays that the graph serializes into. They are current after `update`.
    const SceneArrays &arrays() const { return arrays_; }

    /// Returns the bounding box of all bounded geometry, in the coordinates of the scene file.
    /// Walks the entire graph.
    Eigen::AlignedBox3d bounds() const;

    /// Makes `origin` the origin of the baked world. The next update rewrites everything.
    void set_origin(const Eigen::Vector3d &origin);
    const Eigen::Vector3d &origin() const { return meshes_.origin; }

  private:
    friend class Node;

    // Called by the nodes of this graph.
    void attach(Node &subtree);
    void detach(Node &subtree);
    void core_added(const Node &node, CoreRole role);
    void core_removed(const Node &node, CoreRole role);

    void accumulate(Node &node) const;
    std::vector<Node *> nodes_to_write();
    void allocate(Node &node);
    void compact();

    uint64_t id_;  ///< differs from that of any other graph of the process
    SceneArrays arrays_;
    CameraStore cameras_{arrays_.cameras};
    MaterialStore materials_{arrays_.materials, arrays_.textures};
    MeshStore meshes_;
    ShapeStore shapes_;
    LightStore lights_;
    std::array<Store *, 5> stores_;  ///< in the order in which they must be written

    std::unordered_map<std::string, Node *> names_;
    std::map<std::string, std::shared_ptr<PropertyHolder>> shared_;
    std::vector<Core *> animated_;  ///< one entry per node that holds the core
    std::vector<Node *> dirty_;
    double time_ = 0;
    size_t visited_nodes_ = 0;
    std::unique_ptr<Node> root_;
};

}  // namespace rtrays
