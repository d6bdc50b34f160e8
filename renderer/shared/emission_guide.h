// SPDX-License-Identifier: MIT
// The layout of an emission guide: how light paths select their light and their direction.
//
// A guide consists of words. For every light there is first the end of its range of random words
// (kernels/sampling/select.h), then, for every light, the index of the first word of its table, or
// NO_GUIDE_TABLE. A table divides the unit square of two random numbers (u, v) into GUIDE_ROWS rows
// by u and GUIDE_COLUMNS columns by v. It has the ends of the rows, then those of the columns of
// each row. kernels/light/emission_guide.h says which direction a point of the square stands for.
#pragma once

#define GUIDE_ROWS 16u
#define GUIDE_COLUMNS 32u
#define GUIDE_ROW_BITS 4u     ///< log2 of GUIDE_ROWS
#define GUIDE_COLUMN_BITS 5u  ///< log2 of GUIDE_COLUMNS
#define GUIDE_BINS (GUIDE_ROWS * GUIDE_COLUMNS)
#define GUIDE_TABLE_WORDS (GUIDE_ROWS + GUIDE_BINS)

/// Index of the table of a light without one. No table begins there, since the ends of the lights
/// do.
#define NO_GUIDE_TABLE 0u
