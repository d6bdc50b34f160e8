// SPDX-License-Identifier: MIT
#include "renderer/scene/store.h"

#include <utility>

namespace rtrays {

void Store::add_object(const Node &node) {
    ++objects_[identity(node)].uses;
}

void Store::remove_object(const Node &node) {
    const auto found = objects_.find(identity(node));
    if (found != objects_.end() && --found->second.uses == 0) {
        release(found->second);
        objects_.erase(found);
    }
}

void Store::allocate_object(const Node &node) {
    Object &object = objects_.at(identity(node));
    if (object.slot != no_index && !fits(object.slot, node)) {
        release(object);
    }
    if (object.slot == no_index) {
        append(node);
        object.slot = static_cast<uint32_t>(owners_.size());
        owners_.push_back(&object);  // elements of an unordered_map do not move
        ++counts_.allocated;
    }
}

void Store::write_object(const Node &node, const AttributeSet &attributes) {
    const uint32_t at = slot(node);
    if (!is_current(at, node)) {
        write(at, node, attributes);
        ++counts_.written;
    }
}

void Store::finish_update() {
    changed_ |= counts_.allocated + counts_.freed + counts_.written > 0;
    version_ += std::exchange(changed_, false) ? 1 : 0;
    finished_counts_ = std::exchange(counts_, {});
}

void Store::free_object(const Node &node) {
    release(objects_.at(identity(node)));
}

uint32_t Store::slot(const Node &node) const {
    return slot_of(identity(node));
}

uint32_t Store::slot_of(const void *object) const {
    const auto found = objects_.find(object);
    return found == objects_.end() ? no_index : found->second.slot;
}

void Store::release(Object &object) {
    if (object.slot != no_index) {
        owners_[object.slot] = nullptr;
        object.slot = no_index;
        has_holes_ = true;
        ++counts_.freed;
    }
}

std::vector<uint32_t> Store::compact() {
    if (!has_holes_) {
        return {};
    }
    std::vector<uint32_t> kept;
    std::vector<uint32_t> new_index(owners_.size(), no_index);
    for (uint32_t old = 0; old < owners_.size(); ++old) {
        if (owners_[old] != nullptr) {
            const auto index = static_cast<uint32_t>(kept.size());
            counts_.moved += index != old ? 1 : 0;
            new_index[old] = index;
            owners_[old]->slot = index;
            kept.push_back(old);
        }
    }
    keep(kept);
    keep_elements(owners_, kept);
    has_holes_ = false;
    return new_index;
}

void remap(std::vector<uint32_t> &indices, const std::vector<uint32_t> &new_index) {
    for (uint32_t &index : indices) {
        // A record that is about to be rewritten may still have an index beyond the end.
        index = index < new_index.size() ? new_index[index] : no_index;
    }
}

}  // namespace rtrays
