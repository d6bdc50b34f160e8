// SPDX-License-Identifier: MIT
// Attributes: what accumulates from the root of the scene graph to its leaves (thesis 3.2.3).
#pragma once

#include <memory>
#include <vector>

namespace rtrays {

/// One accumulating quantity ("attribute" in the thesis). The three operations are the thesis'; how
/// two values combine is up to the type: transforms multiply, visibility is a logical AND, a
/// material replaces the inherited one.
class NodeAttribute {
  public:
    virtual ~NodeAttribute() = default;

    /// What a root without any value of this type starts from.
    virtual std::unique_ptr<NodeAttribute> default_value() const = 0;

    virtual std::unique_ptr<NodeAttribute> clone() const = 0;

    /// Makes this (inherited) value the one below a node that contributes `own`, of the same type.
    virtual void merge(const NodeAttribute &own) = 0;
};

/// Implements all but the combination for a type with a default constructor. `Derived` has
/// `void combine(const Derived &own)`.
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

/// The accumulated attributes of one node, at most one of each type. Values that a node does not
/// change are shared with its parent, so a set costs a pointer per attribute.
class AttributeSet {
  public:
    /// Accumulates what a node contributes. Never touches values shared with other nodes.
    void merge(const NodeAttribute &own);

    /// The value of one type: the accumulated one, or the default.
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
