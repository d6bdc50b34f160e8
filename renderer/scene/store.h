// SPDX-License-Identifier: MIT
// Stores: the serialized form of the scene graph, one store per serializable type (thesis 3.2.4).
#pragma once

#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "renderer/scene/node.h"
#include "renderer/scene/stores.h"

namespace rtrays {

/// Numbers of objects that one update changed in a store.
struct StoreCounts {
    size_t allocated = 0;
    size_t freed = 0;
    size_t written = 0;
    size_t moved = 0;  ///< records whose index changed because others were freed
};

/// The common part of all stores: the registered objects and the index ("slot") of the record of
/// each.
///
/// An object is a core of a node, of a type that the store holds. It is added when the core enters
/// the graph. It gets a record when it is allocated, and loses the record when it is freed (hidden)
/// or removed. Freed records leave holes. `compact` closes them, so that readers of the arrays
/// after an update never see one.
class Store {
  public:
    Store() = default;
    virtual ~Store() = default;
    Store(const Store &) = delete;
    Store &operator=(const Store &) = delete;

    virtual const char *type_name() const = 0;

    /// Returns whether a node with this core may have a record here.
    virtual bool holds(const Core &core) const = 0;

    /// Returns whether one of the node's cores may have a record here.
    virtual bool concerns(const Node &node) const = 0;

    /// Returns whether the object of a node that the store concerns must have a record.
    virtual bool wants_record(const Node &node, const AttributeSet &attributes) const = 0;

    /// Registers the object of `node`, once for each of its cores that the store holds. Does not
    /// allocate a record.
    void add_object(const Node &node);

    /// Undoes one `add_object`. The last one frees the record if there is one.
    void remove_object(const Node &node);

    /// Appends a record for the object, unless it already has one of the right size.
    void allocate_object(const Node &node);

    /// Writes the record of the object with `attributes` applied. Throws `Error` (bad input) naming
    /// the node if the object cannot be represented.
    void write_object(const Node &node, const AttributeSet &attributes);

    /// Frees the record of the object; the object stays registered.
    void free_object(const Node &node);

    /// Returns the index of the object's record, or `no_index` if it has none.
    uint32_t slot(const Node &node) const;

    /// Moves records down, in order, to close the holes of freed records. Returns the new index of
    /// every old record, or an empty vector if nothing was freed. The cost is linear in the size of
    /// the store, but only after records were freed.
    std::vector<uint32_t> compact();

    /// Numbers of changes between the last two calls of `finish_update`.
    const StoreCounts &counts() const { return finished_counts_; }

    /// Number of updates that wrote, added or removed records.
    uint64_t version() const { return version_; }

    /// Makes the current update one that changed records, for changes that other stores cause.
    void mark_changed() { changed_ = true; }

    void finish_update();

  protected:
    /// Returns the identity of the object: the node, or the object that nodes share.
    virtual const void *identity(const Node &node) const { return &node; }

    /// Returns whether the record of an allocated object still has the right size.
    virtual bool fits(uint32_t, const Node &) const { return true; }

    /// Returns whether the record is known to equal the one that `write` would write.
    virtual bool is_current(uint32_t, const Node &) const { return false; }

    virtual void append(const Node &node) = 0;
    virtual void write(uint32_t slot, const Node &node, const AttributeSet &attributes) = 0;

    /// Keeps only the records at these ascending slots.
    virtual void keep(const std::vector<uint32_t> &slots) = 0;

    uint32_t slot_of(const void *object) const;

  private:
    struct Object {
        uint32_t slot = no_index;
        size_t uses = 0;  ///< number of nodes and cores that use it
    };

    void release(Object &object);

    std::unordered_map<const void *, Object> objects_;
    std::vector<Object *> owners_;  ///< owner of each slot, nullptr for a hole
    bool has_holes_ = false;
    StoreCounts counts_;
    StoreCounts finished_counts_;
    uint64_t version_ = 0;
    bool changed_ = false;
};

/// Keeps the elements at these ascending indices. Implements `Store::keep` for one array with an
/// element per record.
template <typename T>
void keep_elements(std::vector<T> &elements, const std::vector<uint32_t> &indices) {
    for (size_t i = 0; i < indices.size(); ++i) {
        elements[i] = elements[indices[i]];
    }
    elements.resize(indices.size());
}

/// Updates indices into a store by the result of `Store::compact`.
void remap(std::vector<uint32_t> &indices, const std::vector<uint32_t> &new_index);

}  // namespace rtrays
