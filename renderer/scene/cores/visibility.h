// SPDX-License-Identifier: MIT
// Visibility cores, which show or hide subtrees.
#pragma once

#include <utility>

#include "renderer/scene/core.h"

namespace rtrays {

/// Whether geometry and its lights are part of the scene: only if every node above is visible.
struct VisibilityAttribute : AttributeOf<VisibilityAttribute> {
    bool visible = true;

    void combine(const VisibilityAttribute &own) { visible = visible && own.visible; }
};

/// Shows or hides a node and everything below it. Cameras cannot be hidden.
class VisibilityCore : public Core {
  public:
    VisibilityCore(std::string name, bool visible) : Core(std::move(name)) {
        attribute_.visible = visible;
    }

    CoreRole role() const override { return CoreRole::visibility; }
    const char *type_name() const override { return "visibility"; }
    const NodeAttribute *attribute() const override { return &attribute_; }

    std::vector<Property> properties() override {
        return {make_property<bool>(
            "visible", "whether the node and everything below it is in the scene",
            [this] { return attribute_.visible; }, [this](bool value) { set_visible(value); })};
    }

    void set_visible(bool visible) {
        attribute_.visible = visible;
        changed(Dirty::subtree);
    }

  private:
    VisibilityAttribute attribute_;
};

}  // namespace rtrays
