// SPDX-License-Identifier: MIT
#include "renderer/bvh/bvh.h"

#include <algorithm>

namespace rtrays {

const char *to_string(BvhMethod method) {
    return std::find_if(std::begin(bvh_methods), std::end(bvh_methods),
                        [&](const NamedBvhMethod &named) { return named.method == method; })
        ->name;
}

const char *to_string(BvhLayout layout) {
    return std::find_if(std::begin(bvh_layouts), std::end(bvh_layouts),
                        [&](const NamedBvhLayout &named) { return named.layout == layout; })
        ->name;
}

}  // namespace rtrays
