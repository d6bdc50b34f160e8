// SPDX-License-Identifier: MIT
#include "reference/sampling.h"

#include <cmath>

#include "renderer/base/error.h"

namespace rtrays::reference {

AliasTable::AliasTable(const std::vector<double> &weights) {
    double total = 0.0;
    for (const double weight : weights) {
        if (!(weight >= 0.0) || !std::isfinite(weight)) {
            throw run_error("alias table: a weight is negative or not finite");
        }
        total += weight;
    }
    if (!(total > 0.0) || !std::isfinite(total)) {
        throw run_error("alias table: the weights must have a positive, finite sum");
    }

    const auto count = static_cast<double>(weights.size());
    slots_.resize(weights.size());
    std::vector<uint32_t> small, large;
    for (uint32_t i = 0; i < weights.size(); ++i) {
        const double probability = weights[i] / total;
        slots_[i] = {probability, probability * count, i};
        (slots_[i].keep < 1.0 ? small : large).push_back(i);
    }
    // Each small slot is filled up to 1 by one large slot, which may thereby become small.
    while (!small.empty() && !large.empty()) {
        const uint32_t s = small.back();
        const uint32_t l = large.back();
        small.pop_back();
        slots_[s].alias = l;
        slots_[l].keep -= 1.0 - slots_[s].keep;
        if (slots_[l].keep < 1.0) {
            large.pop_back();
            small.push_back(l);
        }
    }
    // Rounding may leave slots over, but these are full up to a few ulps. A slot of weight 0 has
    // always found a partner before.
    for (const auto &rest : {small, large}) {
        for (const uint32_t i : rest) {
            slots_[i].keep = 1.0;
        }
    }
}

}  // namespace rtrays::reference
