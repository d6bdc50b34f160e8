// SPDX-License-Identifier: MIT
#include "renderer/scene/graph.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <atomic>
#include <utility>

#include "renderer/base/error.h"
#include "renderer/base/suggestion.h"
#include "renderer/scene/cores/mesh.h"
#include "renderer/scene/cores/shape.h"
#include "renderer/scene/cores/transform.h"

namespace rtrays {

namespace {

/// Returns a number that no other graph of this process has.
uint64_t next_id() {
    static std::atomic<uint64_t> last{0};
    return ++last;
}

/// Returns some of the names, for messages: scenes have up to millions.
std::string some(std::vector<std::string> names) {
    constexpr size_t most = 20;
    std::sort(names.begin(), names.end());
    const size_t more = names.size() > most ? names.size() - most : 0;
    names.resize(names.size() - more);
    return fmt::format("{}{}", fmt::join(names, ", "),
                       more > 0 ? fmt::format(" and {} more", more) : "");
}

std::vector<Property> properties_of(const Node &node) {
    std::vector<Property> all;
    for (size_t role = 0; role < core_role_count; ++role) {
        if (Core *core = node.core(static_cast<CoreRole>(role))) {
            for (Property &property : core->properties()) {
                all.push_back(std::move(property));
            }
        }
    }
    return all;
}

}  // namespace

SceneGraph::SceneGraph()
    : id_(next_id()),
      meshes_(arrays_.meshes, materials_, lights_),
      shapes_(arrays_.shapes, materials_, lights_),
      lights_(arrays_.lights, meshes_, shapes_),
      stores_{&materials_, &cameras_, &meshes_, &shapes_, &lights_},
      root_(std::make_unique<Node>("")) {
    attach(*root_);
}

SceneGraph::~SceneGraph() {
    // Destroyed nodes release their cores; the graph need not be notified any more.
    visit_subtree(*root_, [](Node &node) { node.graph_ = nullptr; });
}

Node *SceneGraph::find(const std::string &name) const {
    const auto found = names_.find(name);
    return found == names_.end() ? nullptr : found->second;
}

void SceneGraph::attach(Node &subtree) {
    std::vector<Node *> added;
    visit_subtree(subtree, [&](Node &node) { added.push_back(&node); });
    for (size_t i = 0; i < added.size(); ++i) {
        const std::string &name = added[i]->name();
        if (!name.empty() && !names_.emplace(name, added[i]).second) {
            for (size_t j = 0; j < i; ++j) {
                names_.erase(added[j]->name());
            }
            throw input_error(
                fmt::format("two nodes have the name '{}'; rename one of them", name));
        }
    }
    for (Node *node : added) {
        node->graph_ = this;
        node->dirty_ = Dirty::nothing;
        for (size_t role = 0; role < core_role_count; ++role) {
            core_added(*node, static_cast<CoreRole>(role));
        }
    }
}

void SceneGraph::detach(Node &subtree) {
    visit_subtree(subtree, [&](Node &node) {
        for (size_t role = 0; role < core_role_count; ++role) {
            core_removed(node, static_cast<CoreRole>(role));
        }
        names_.erase(node.name());
        node.graph_ = nullptr;
        node.dirty_ = Dirty::nothing;
    });
    dirty_.erase(std::remove_if(dirty_.begin(), dirty_.end(),
                                [](const Node *node) { return node->dirty_ == Dirty::nothing; }),
                 dirty_.end());
}

void SceneGraph::core_added(const Node &node, CoreRole role) {
    Core *core = node.core(role);
    if (core == nullptr) {
        return;
    }
    for (Store *store : stores_) {
        if (store->holds(*core)) {
            store->add_object(node);
        }
    }
    if (core->is_animated()) {
        animated_.push_back(core);
        core->update(time_);
    }
}

void SceneGraph::core_removed(const Node &node, CoreRole role) {
    Core *core = node.core(role);
    if (core == nullptr) {
        return;
    }
    for (Store *store : stores_) {
        if (store->holds(*core)) {
            store->remove_object(node);
        }
    }
    if (core->is_animated()) {
        animated_.erase(std::find(animated_.begin(), animated_.end(), core));
    }
}

void SceneGraph::accumulate(Node &node) const {
    node.attributes_ = node.parent_ != nullptr ? node.parent_->attributes_ : AttributeSet();
    for (const Node::HeldCore &own : node.cores_) {
        if (own.core != nullptr && own.core->attribute() != nullptr) {
            node.attributes_.merge(*own.core->attribute());
        }
    }
}

std::vector<Node *> SceneGraph::nodes_to_write() {
    const auto covered = [](const Node &node) {
        const Node *above = node.parent();
        while (above != nullptr && above->dirty_ != Dirty::subtree) {
            above = above->parent();
        }
        return above != nullptr;
    };
    std::vector<Node *> nodes;
    for (Node *node : dirty_) {
        if (covered(*node)) {
            continue;  // the subtree of a node above includes this one
        }
        if (node->dirty_ == Dirty::subtree) {
            visit_subtree(*node, [&](Node &below) {
                accumulate(below);
                nodes.push_back(&below);
            });
        } else {
            nodes.push_back(node);
        }
    }
    return nodes;
}

void SceneGraph::allocate(Node &node) {
    for (Store *store : stores_) {
        if (!store->concerns(node)) {
            continue;
        }
        if (store->wants_record(node, node.attributes())) {
            store->allocate_object(node);
        } else {
            store->free_object(node);
        }
    }
}

void SceneGraph::compact() {
    cameras_.compact();
    if (const std::vector<uint32_t> moved = materials_.compact(); !moved.empty()) {
        remap(meshes_.arrays.material, moved);
        remap(shapes_.arrays.material, moved);
        meshes_.mark_surfaces();
        shapes_.mark_changed();
    }
    if (const std::vector<uint32_t> moved = meshes_.compact(); !moved.empty()) {
        remap(lights_.arrays.mesh, moved);
        lights_.mark_changed();
    }
    if (const std::vector<uint32_t> moved = shapes_.compact(); !moved.empty()) {
        remap(lights_.arrays.shape, moved);
        lights_.mark_changed();
    }
    if (const std::vector<uint32_t> moved = lights_.compact(); !moved.empty()) {
        remap(meshes_.arrays.light, moved);
        remap(shapes_.arrays.light, moved);
        shapes_.mark_changed();
    }
}

void SceneGraph::update(double time) {
    if (time != time_) {
        time_ = time;
        for (size_t i = 0; i < animated_.size(); ++i) {
            animated_[i]->update(time);
        }
    }
    const std::vector<Node *> nodes = nodes_to_write();
    visited_nodes_ = nodes.size();
    for (Node *node : nodes) {
        allocate(*node);
    }
    compact();
    for (Store *store : stores_) {
        for (const Node *node : nodes) {
            if (store->concerns(*node) && store->slot(*node) != no_index) {
                store->write_object(*node, node->attributes());
            }
        }
        store->finish_update();
    }
    meshes_.drop_unused();
    for (Node *node : dirty_) {
        node->dirty_ = Dirty::nothing;
    }
    dirty_.clear();
}

SceneRevision SceneGraph::revision() const {
    return {id_,
            materials_.version(),
            meshes_.geometry_version(),
            meshes_.surface_version(),
            shapes_.version(),
            lights_.version()};
}

Eigen::AlignedBox3d SceneGraph::bounds() const {
    Eigen::AlignedBox3d box;
    visit_subtree(*root_, [&](const Node &node) {
        const Eigen::Matrix4d &m = node.attributes().get<TransformAttribute>().world_from_object;
        if (const auto *mesh = node.core_of<MeshCore>(CoreRole::geometry)) {
            for (const Eigen::Vector3d &vertex : mesh->vertices()) {
                box.extend(m.topLeftCorner<3, 3>() * vertex + m.topRightCorner<3, 1>());
            }
        }
        if (const auto *shape = node.core_of<ShapeCore>(CoreRole::geometry);
            shape != nullptr && !shape->canonical_bounds().isEmpty()) {
            const Eigen::Matrix4d placed = m * shape->object_from_canonical();
            const Eigen::AlignedBox3d bounds = shape->canonical_bounds();
            for (int corner = 0; corner < 8; ++corner) {
                const auto at = bounds.corner(static_cast<Eigen::AlignedBox3d::CornerType>(corner));
                box.extend(placed.topLeftCorner<3, 3>() * at + placed.topRightCorner<3, 1>());
            }
        }
    });
    return box;
}

void SceneGraph::set_origin(const Eigen::Vector3d &origin) {
    cameras_.origin = origin;
    meshes_.origin = origin;
    shapes_.origin = origin;
    lights_.origin = origin;
    root_->mark(Dirty::subtree);
}

void SceneGraph::share(const std::string &address, std::shared_ptr<PropertyHolder> holder) {
    if (!shared_.emplace(address, std::move(holder)).second) {
        throw input_error(
            fmt::format("two shared objects have the name '{}'; rename one of them", address));
    }
}

void SceneGraph::absorb(SceneGraph &other, Node &parent) {
    const std::string prefix = parent.name() + "/";
    for (const auto &[address, holder] : other.shared_) {
        const size_t name = address.find('.') + 1;
        share(address.substr(0, name) + prefix + address.substr(name), holder);
    }
    other.shared_.clear();
    for (std::unique_ptr<Node> &child : other.root_->remove_children()) {
        child->add_prefix(prefix);
        parent.add_child(std::move(child));
    }
}

void SceneGraph::set_property(const std::string &address, const std::string &text) {
    const size_t dot = address.rfind('.');
    if (dot == std::string::npos) {
        throw input_error(
            fmt::format("'{}': expected NODE.PROPERTY or SECTION.NAME.PROPERTY", address));
    }
    const std::string owner = address.substr(0, dot);
    const std::string name = address.substr(dot + 1);

    std::vector<Property> properties;
    if (const auto shared = shared_.find(owner); shared != shared_.end()) {
        properties = shared->second->properties();
    } else if (const Node *node = find(owner)) {
        properties = properties_of(*node);
    } else {
        std::vector<std::string> names;
        for (const auto &named : names_) {
            names.push_back(named.first);
        }
        for (const auto &named : shared_) {
            names.push_back(named.first);
        }
        throw input_error(
            fmt::format("'{}': unknown node or shared object '{}'; {}the scene has: {}", address,
                        owner, suggestion(owner, names), some(names)));
    }
    std::vector<std::string> names;
    for (const Property &property : properties) {
        if (property.name == name) {
            try {
                property.set_text(text);
            } catch (const Error &error) {
                throw input_error(fmt::format("'{}': {}", address, error.what()));
            }
            return;
        }
        names.push_back(property.name);
    }
    throw input_error(fmt::format("'{}': '{}' has no property '{}'; {}properties are: {}", address,
                                  owner, name, suggestion(name, names), some(names)));
}

void SceneGraph::visit_properties(
    const std::function<void(const std::string &, const Property &)> &visit,
    const std::function<void(const std::string &, const std::string &)> &visit_use) const {
    std::unordered_map<const PropertyHolder *, std::string> addresses;
    for (const auto &[address, holder] : shared_) {
        addresses.emplace(holder.get(), address);
        for (const Property &property : holder->properties()) {
            visit(address, property);
        }
    }
    visit_subtree(*root_, [&](const Node &node) {
        for (size_t role = 0; role < core_role_count; ++role) {
            Core *core = node.core(static_cast<CoreRole>(role));
            if (core == nullptr) {
                continue;
            }
            if (const auto shared = addresses.find(core); shared != addresses.end()) {
                visit_use(node.name(), shared->second);
                continue;
            }
            for (const Property &property : core->properties()) {
                visit(node.name(), property);
            }
        }
    });
}

}  // namespace rtrays
