// SPDX-License-Identifier: MIT
// Attributes: values that accumulate from the root of the scene graph to its leaves (thesis 3.2.3).
#pragma once

#include <memory>
#include <vector>

namespace rtrays {

/// An accumulating quantity ("attribute" in the thesis, which defines the three operations). The
/// type decides how two values combine: transforms multiply, visibility is a logical AND, a
/// material replaces the inherited one.
class NodeAttribute {
  public:
    virtual ~NodeAttribute() = default;

    /// Returns the value that accumulation starts with at the root.
    virtual std::unique_ptr<NodeAttribute> default_value() const = 0;

    virtual std::unique_ptr<NodeAttribute> clone() const = 0;

    /// Merges into this inherited value the value `own` that a node contributes, which has the same
    /// type. The result is the value below that node.
    virtual void merge(const NodeAttribute &own) = 0;
};

/// Implementation of the operations for a type with a default constructor. `Derived` must have
/// `void combine(const Derived &own)`, which merges a value into an inherited one.
template <typename Derived>
class AttributeOf : public NodeAttribute {
  public:
    std::unique_ptr<NodeAttribute> default_value() const final {
        return std::make_unique<Derived>();
    }
    std::unique_ptr<NodeAttribute> clone() const final { return std::make_unique<Derived>(self()); }
    void merge(const NodeAttribute &own) final {
        static_cast<Derived &>(*this).combine(static_cast<const Derived &>(own));
    }

  private:
    const Derived &self() const { return static_cast<const Derived &>(*this); }
};

/// The accumulated attributes of a node, at most one of each type. Values that a node does not
/// change are shared with its parent, so a set costs one pointer per attribute.
class AttributeSet {
  public:
    /// Merges a value that a node contributes. Never modifies values shared with other nodes.
    void merge(const NodeAttribute &own);

    /// Returns the accumulated value of one type, or the default.
    template <typename T>
    const T &get() const {
        for (const auto &value : values_) {
            if (const T *found = dynamic_cast<const T *>(value.get())) {
                return *found;
            }
        }
        static const T default_value;
        return default_value;
    }

  private:
    std::vector<std::shared_ptr<const NodeAttribute>> values_;
};

}  // namespace rtrays
