// SPDX-License-Identifier: MIT
// Expands a table row only where its feature is compiled in: a row names FEATURE_<name> (0 or 1) or 1.
#pragma once

#define ALWAYS 1

#define WHEN(feature, ...) WHEN_EXPANDED(feature, __VA_ARGS__)
#define WHEN_EXPANDED(feature, ...) WHEN_##feature(__VA_ARGS__)
#define WHEN_0(...)
#define WHEN_1(...) __VA_ARGS__
