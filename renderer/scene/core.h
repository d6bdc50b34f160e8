// SPDX-License-Identifier: MIT
// Cores hold what a scene consists of: cameras, lights, geometry, transforms, materials. Nodes only
// place them (thesis 3.2.2; "kernel" there, renamed because a kernel is an OpenCL function here).
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "renderer/scene/attribute.h"
#include "renderer/scene/property_holder.h"

namespace rtrays {

class Node;

/// What a core is to its node, which has at most one core of each role. (The thesis gives a node
/// one core and several attributes; with roles a lamp is one node with a transform, a mesh, a
/// material and a light.)
enum class CoreRole { transform, visibility, material, geometry, light, camera };
constexpr size_t core_role_count = 6;

/// What a change of a core outdates.
enum class Dirty : uint8_t {
    nothing,  ///< all is written
    object,   ///< the records of the node itself
    subtree,  ///< the accumulated attributes and records of the node and everything below it
};

/// The base of all cores. A core may be shared by any number of nodes; it lives as long as one of
/// them.
class Core : public PropertyHolder {
  public:
    using PropertyHolder::PropertyHolder;

    const std::vector<Node *> &nodes() const { return nodes_; }

    virtual CoreRole role() const = 0;

    /// What the core contributes to the attributes of its nodes, if anything.
    virtual const NodeAttribute *attribute() const { return nullptr; }

    /// Whether `update` is to be called whenever the time changes.
    virtual bool is_animated() const { return false; }

    /// Brings the core to scene time `time` (seconds), through its setters.
    virtual void update(double) {}

    /// Grows with every change: a record written at the same version is up to date.
    uint64_t version() const { return version_; }

  protected:
    /// Every setter ends here: marks the nodes that hold the core.
    void changed(Dirty outdated);

  private:
    friend class Node;

    std::vector<Node *> nodes_;
    uint64_t version_ = 1;
};

}  // namespace rtrays
