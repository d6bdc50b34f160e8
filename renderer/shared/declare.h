// SPDX-License-Identifier: MIT
// Conditional expansion of table rows, for tables whose rows depend on features.
//
// WHEN(feature)(row) expands to `row` if `feature` is 1 and to nothing if it is 0. `feature` is
// FEATURE_<name> (0 or 1) or ALWAYS. UNLESS(feature)(row) is the opposite. The row is a single
// macro argument, whatever commas it expands to, because OpenCL C has no variadic macros (OpenCL
// C 1.2, section 6.9.e).
#pragma once

#define ALWAYS 1

#define WHEN(feature) WHEN_EXPANDED(feature)
#define WHEN_EXPANDED(feature) WHEN_##feature
#define WHEN_0(row)
#define WHEN_1(row) row

#define UNLESS(feature) UNLESS_EXPANDED(feature)
#define UNLESS_EXPANDED(feature) UNLESS_##feature
#define UNLESS_0(row) row
#define UNLESS_1(row)
