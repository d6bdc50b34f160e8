// SPDX-License-Identifier: MIT
// Cores hold the content of a scene: cameras, lights, geometry, transforms, materials. Nodes only
// place them (thesis 3.2.2, where they are called "kernels"; here a kernel is an OpenCL function).
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

/// Role of a core at its node, which has at most one core of each role. (The thesis gives a node
/// one core and several attributes. With roles a lamp is one node with a transform, a mesh, a
/// material and a light.)
enum class CoreRole { transform, visibility, material, geometry, light, camera };
constexpr size_t core_role_count = 6;

/// The records that a change of a core makes outdated.
enum class Dirty : uint8_t {
    nothing,  ///< all records are current
    object,   ///< the records of the node itself
    subtree,  ///< the attributes and records of the node and of everything below it
};

/// Base of all cores. Any number of nodes may share a core, which lives as long as one of them.
class Core : public PropertyHolder {
  public:
    using PropertyHolder::PropertyHolder;

    const std::vector<Node *> &nodes() const { return nodes_; }

    virtual CoreRole role() const = 0;

    /// Returns the attribute that the core contributes to its nodes, or nullptr.
    virtual const NodeAttribute *attribute() const { return nullptr; }

    /// Returns whether `update` must be called whenever the time changes.
    virtual bool is_animated() const { return false; }

    /// Advances the core to scene time `time` (seconds), through its setters.
    virtual void update(double) {}

    /// Counter that grows with every change. A record written at the same version is current.
    uint64_t version() const { return version_; }

  protected:
    /// Marks the nodes that hold the core as dirty. Every setter must end with this call.
    void changed(Dirty outdated);

  private:
    friend class Node;

    std::vector<Node *> nodes_;
    uint64_t version_ = 1;
};

}  // namespace rtrays
