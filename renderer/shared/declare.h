// SPDX-License-Identifier: MIT
// Expands a table row only where its feature is compiled in: WHEN(feature)(row), where the feature
// is FEATURE_<name> (0 or 1) or 1. The row is one argument, whatever commas it expands to: OpenCL C
// has no macros of many (1.2, 6.9.e).
#pragma once

#define ALWAYS 1

#define WHEN(feature) WHEN_EXPANDED(feature)
#define WHEN_EXPANDED(feature) WHEN_##feature
#define WHEN_0(row)
#define WHEN_1(row) row
