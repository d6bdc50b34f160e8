// SPDX-License-Identifier: MIT
// Tests of what every hierarchy must do, whatever its layout and whoever built it.
#pragma once

#include <gtest/gtest.h>

#include "renderer/tests/bvh_tree.h"

namespace rtrays::test {

/// Base of a suite of TEST_P, which EACH_TREE instantiates.
using TreeTest = testing::TestWithParam<TreeKind>;
#define EACH_TREE(suite)                                                        \
    INSTANTIATE_TEST_SUITE_P(Trees, suite, testing::ValuesIn(all_tree_kinds()), \
                             [](const auto &test) { return test.param.name(); })

}  // namespace rtrays::test
