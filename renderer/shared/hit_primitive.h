// SPDX-License-Identifier: MIT
// The primitive that a ray hits: the index of a triangle, or that of a shape with SHAPE_BIT.
#pragma once

/// Marks an index as that of a shape, not of a triangle.
#define SHAPE_BIT 0x80000000u

/// The ray hits nothing. SHAPE_BIT is set in this value as well.
#define NO_HIT 0xffffffffu
