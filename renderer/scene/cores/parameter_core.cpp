// SPDX-License-Identifier: MIT
#include "renderer/scene/cores/parameter_core.h"

#include <utility>

namespace rtrays {

ParameterCore::ParameterCore(std::string name, std::shared_ptr<const CoreType> type,
                             const ParameterValues &values, const ParameterTextures &textures)
    : Core(std::move(name)),
      type_(std::move(type)),
      parameters_(type_->name, type_->parameters, values, textures) {
    if (type_->check) {
        type_->check(parameters_);
    }
}

void ParameterCore::set(const std::string &name, const PropertyValue &value) {
    ParameterSet next = parameters_;
    next.set(name, value);
    if (type_->check) {
        type_->check(next);
    }
    parameters_ = std::move(next);
    changed(outdated_by(name));
}

std::vector<Property> ParameterCore::properties() {
    return parameters_.properties(
        [this](const std::string &name, const PropertyValue &value) { set(name, value); });
}

}  // namespace rtrays
