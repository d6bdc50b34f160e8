// SPDX-License-Identifier: MIT
#include "renderer/scene/node.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "renderer/base/error.h"
#include "renderer/scene/graph.h"

namespace rtrays {

void Core::changed(Dirty outdated) {
    ++version_;
    for (Node *node : nodes_) {
        node->mark(outdated);
    }
}

Node::~Node() {
    for (size_t role = 0; role < core_role_count; ++role) {
        let_go(static_cast<CoreRole>(role));
    }
    // The default destruction of a long chain would recurse once per node.
    std::vector<std::unique_ptr<Node>> pending = std::move(children_);
    while (!pending.empty()) {
        const std::unique_ptr<Node> node = std::move(pending.back());
        pending.pop_back();
        std::move(node->children_.begin(), node->children_.end(), std::back_inserter(pending));
        node->children_.clear();
    }
}

Node &Node::add_child(std::unique_ptr<Node> child) {
    if (graph_ != nullptr) {
        graph_->attach(*child);
    }
    child->parent_ = this;
    children_.push_back(std::move(child));
    Node &added = *children_.back();
    added.mark(Dirty::subtree);
    return added;
}

void Node::add_prefix(const std::string &prefix) {
    if (graph_ != nullptr) {
        throw run_error("'" + name_ + "' is in a graph, which knows it by its name");
    }
    visit_subtree(*this, [&](Node &node) {
        if (!node.name_.empty()) {
            node.name_.insert(0, prefix);
        }
    });
}

std::unique_ptr<Node> Node::remove_child(Node &child) {
    const auto found = std::find_if(
        children_.begin(), children_.end(),
        [&](const std::unique_ptr<Node> &candidate) { return candidate.get() == &child; });
    if (found == children_.end()) {
        throw run_error("'" + child.name() + "' is not a child of '" + name_ + "'");
    }
    if (graph_ != nullptr) {
        graph_->detach(child);
    }
    std::unique_ptr<Node> removed = std::move(*found);
    children_.erase(found);
    removed->parent_ = nullptr;
    return removed;
}

std::vector<std::unique_ptr<Node>> Node::remove_children() {
    for (const std::unique_ptr<Node> &child : children_) {
        if (graph_ != nullptr) {
            graph_->detach(*child);
        }
        child->parent_ = nullptr;
    }
    return std::exchange(children_, {});
}

void Node::set_core(std::shared_ptr<Core> core) {
    const CoreRole role = core->role();
    remove_core(role);
    core->nodes_.push_back(this);
    held(role) = {core, core->nodes_.size() - 1};
    if (graph_ != nullptr) {
        graph_->core_added(*this, role);
    }
    mark(core->attribute() != nullptr ? Dirty::subtree : Dirty::object);
}

void Node::remove_core(CoreRole role) {
    if (core(role) == nullptr) {
        return;
    }
    mark(core(role)->attribute() != nullptr ? Dirty::subtree : Dirty::object);
    if (graph_ != nullptr) {
        graph_->core_removed(*this, role);
    }
    let_go(role);
}

void Node::let_go(CoreRole role) {
    const HeldCore own = std::exchange(held(role), {});
    if (own.core != nullptr) {
        // The last node moves to the vacant position.
        std::vector<Node *> &nodes = own.core->nodes_;
        nodes[own.position] = nodes.back();
        nodes[own.position]->held(role).position = own.position;
        nodes.pop_back();
    }
}

void Node::mark(Dirty dirty) {
    if (graph_ != nullptr && dirty_ == Dirty::nothing && dirty != Dirty::nothing) {
        graph_->dirty_.push_back(this);
    }
    dirty_ = std::max(dirty_, dirty);
}

}  // namespace rtrays
