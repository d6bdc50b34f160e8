// SPDX-License-Identifier: MIT
// Base of test suites that run for every combination of build method and layout of a hierarchy.
#pragma once

#include <gtest/gtest.h>

#include "renderer/testing/bvh_tree.h"

namespace rtrays::test {

/// Base class of a suite of TEST_P, which EACH_TREE instantiates.
using TreeTest = testing::TestWithParam<TreeKind>;
#define EACH_TREE(suite)                                                        \
    INSTANTIATE_TEST_SUITE_P(Trees, suite, testing::ValuesIn(all_tree_kinds()), \
                             [](const auto &test) { return test.param.name(); })

}  // namespace rtrays::test
