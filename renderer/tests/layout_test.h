// SPDX-License-Identifier: MIT
// Tests of what every layout of a hierarchy must do.
#pragma once

#include <gtest/gtest.h>

#include "renderer/tests/bvh_tree.h"

namespace rtrays::test {

/// Base of a suite of TEST_P, which EACH_LAYOUT instantiates.
using LayoutTest = testing::TestWithParam<NamedBvhLayout>;
#define EACH_LAYOUT(suite)                                                   \
    INSTANTIATE_TEST_SUITE_P(Layouts, suite, testing::ValuesIn(bvh_layouts), \
                             [](const auto &test) { return std::string(test.param.name); })

}  // namespace rtrays::test
