// SPDX-License-Identifier: MIT
#include "renderer/scene/attribute.h"

#include <algorithm>
#include <typeinfo>
#include <utility>

namespace rtrays {

void AttributeSet::merge(const NodeAttribute &own) {
    const auto inherited = std::find_if(values_.begin(), values_.end(), [&](const auto &value) {
        const NodeAttribute &candidate = *value;
        return typeid(candidate) == typeid(own);
    });
    std::unique_ptr<NodeAttribute> merged =
        inherited == values_.end() ? own.default_value() : (*inherited)->clone();
    merged->merge(own);
    if (inherited == values_.end()) {
        values_.push_back(std::move(merged));
    } else {
        *inherited = std::move(merged);
    }
}

}  // namespace rtrays
