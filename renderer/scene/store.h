// SPDX-License-Identifier: MIT
// Stores: the serialized form of the scene graph, one per serializable type (thesis 3.2.4).
#pragma once

#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "renderer/scene/node.h"
#include "renderer/scene/stores.h"

namespace rtrays {

/// What one update did to one store, in objects.
struct StoreCounts {
    size_t allocated = 0;
    size_t freed = 0;
    size_t written = 0;
    size_t moved = 0;  ///< records that changed their index because others were freed
};

/// The part common to all stores: which objects there are and at which index ("slot") each has its
/// record.
///
/// An object is a node's core that the store holds. It is added when the core joins the graph, gets
/// a record when it is allocated, and loses it again when it is freed (hidden) or removed. Freed
/// records leave holes; `compact` closes them, so that readers of the arrays after an update never
/// meet one.
class Store {
  public:
    Store() = default;
    virtual ~Store() = default;
    Store(const Store &) = delete;
    Store &operator=(const Store &) = delete;

    virtual const char *type_name() const = 0;

    /// Whether a node with this core may have a record here.
    virtual bool holds(const Core &core) const = 0;

    /// Whether one of the node's cores may have a record here.
    virtual bool concerns(const Node &node) const = 0;

    /// Whether the object of a node that the store concerns is to have a record.
    virtual bool wants_record(const Node &node, const AttributeSet &attributes) const = 0;

    /// Registers the object of `node`, once for each of its cores that the store holds; no record
    /// is allocated.
    void add_object(const Node &node);

    /// Takes back one `add_object`; the last one frees the record if there is one.
    void remove_object(const Node &node);

    /// Appends a record for the object, unless it has one of the right size.
    void allocate_object(const Node &node);

    /// Writes the object's record, `attributes` applied. Throws `Error` (bad input) naming the node
    /// when it cannot be represented.
    void write_object(const Node &node, const AttributeSet &attributes);

    /// Gives up the object's record; the object stays registered.
    void free_object(const Node &node);

    /// Index of the object's record, `no_index` when it has none.
    uint32_t slot(const Node &node) const;

    /// Moves the records behind freed ones down, in order. Returns the new index of every old one,
    /// empty when nothing moved. Costs as much as the store is large, but only after something was
    /// freed.
    std::vector<uint32_t> compact();

    /// What was done between the last two calls of `finish_update`.
    const StoreCounts &counts() const { return finished_counts_; }
    void finish_update();

  protected:
    /// What tells objects apart: the node, or whatever nodes share.
    virtual const void *identity(const Node &node) const { return &node; }

    /// Whether the record of an allocated object still has the right size.
    virtual bool fits(uint32_t, const Node &) const { return true; }

    /// Whether the record is known to hold what `write` would write.
    virtual bool is_current(uint32_t, const Node &) const { return false; }

    virtual void append(const Node &node) = 0;
    virtual void write(uint32_t slot, const Node &node, const AttributeSet &attributes) = 0;

    /// Keeps only the records at these ascending slots.
    virtual void keep(const std::vector<uint32_t> &slots) = 0;

    uint32_t slot_of(const void *object) const;

  private:
    struct Object {
        uint32_t slot = no_index;
        size_t uses = 0;  ///< by nodes and their cores
    };

    void release(Object &object);

    std::unordered_map<const void *, Object> objects_;
    std::vector<Object *> owners_;  ///< of each slot, nullptr for a hole
    bool has_holes_ = false;
    StoreCounts counts_;
    StoreCounts finished_counts_;
};

/// Keeps the elements at these ascending indices: `Store::keep` for one array with an element per
/// record.
template <typename T>
void keep_elements(std::vector<T> &elements, const std::vector<uint32_t> &indices) {
    for (size_t i = 0; i < indices.size(); ++i) {
        elements[i] = elements[indices[i]];
    }
    elements.resize(indices.size());
}

/// Applies the result of `Store::compact` to indices into that store.
void remap(std::vector<uint32_t> &indices, const std::vector<uint32_t> &new_index);

}  // namespace rtrays
