// SPDX-License-Identifier: MIT
// Nodes of the scene tree.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "renderer/scene/attribute.h"
#include "renderer/scene/core.h"

namespace rtrays {

class SceneGraph;

/// A node of the scene tree: a name, children and cores, nothing else (thesis 3.2.3). A node is
/// owned by its parent, so it appears in the graph only once. Content that appears more than once
/// is a shared core.
class Node {
  public:
    explicit Node(std::string name) : name_(std::move(name)) {}
    ~Node();
    Node(const Node &) = delete;
    Node &operator=(const Node &) = delete;

    const std::string &name() const { return name_; }
    Node *parent() const { return parent_; }
    const std::vector<std::unique_ptr<Node>> &children() const { return children_; }

    /// Appends a child with its subtree. Throws `Error` if one of the names is taken in this graph.
    Node &add_child(std::unique_ptr<Node> child);

    /// Puts text before the names of this node and of all below it, except of nodes without a name.
    /// The node must be in no graph.
    void add_prefix(const std::string &prefix);

    /// Removes all children, as `remove_child` does, and returns them in their order.
    std::vector<std::unique_ptr<Node>> remove_children();

    /// Removes a child from the graph, frees its records in the stores and returns it to the
    /// caller.
    std::unique_ptr<Node> remove_child(Node &child);

    /// Returns the core of one role, or nullptr.
    Core *core(CoreRole role) const { return held(role).core.get(); }

    /// Returns the core of one role if it is a `T`, or nullptr.
    template <typename T>
    T *core_of(CoreRole role) const {
        return dynamic_cast<T *>(core(role));
    }

    /// Gives the node a core, which replaces the core of the same role if there is one.
    void set_core(std::shared_ptr<Core> core);
    void remove_core(CoreRole role);

    /// Attributes accumulated from the root to this node, including its own, at the last update.
    const AttributeSet &attributes() const { return attributes_; }

    /// Adds the node to its graph's list of dirty nodes, in constant time.
    void mark(Dirty dirty);

  private:
    friend class SceneGraph;

    struct HeldCore {
        std::shared_ptr<Core> core;
        /// Index of this node in core->nodes_, so that the core is released in constant time.
        size_t position = 0;
    };

    HeldCore &held(CoreRole role) { return cores_[static_cast<size_t>(role)]; }
    const HeldCore &held(CoreRole role) const { return cores_[static_cast<size_t>(role)]; }
    void let_go(CoreRole role);

    std::string name_;
    SceneGraph *graph_ = nullptr;
    Node *parent_ = nullptr;
    std::vector<std::unique_ptr<Node>> children_;
    std::array<HeldCore, core_role_count> cores_;
    AttributeSet attributes_;
    Dirty dirty_ = Dirty::nothing;
};

/// Calls `visit(node)` for `root` and all nodes below it, parents first, children in order. The
/// call stack does not limit the depth.
template <typename Visit>
void visit_subtree(Node &root, const Visit &visit) {
    std::vector<Node *> pending{&root};
    while (!pending.empty()) {
        Node &node = *pending.back();
        pending.pop_back();
        visit(node);
        for (size_t i = node.children().size(); i > 0; --i) {
            pending.push_back(node.children()[i - 1].get());
        }
    }
}

}  // namespace rtrays
