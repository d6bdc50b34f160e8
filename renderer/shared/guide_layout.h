// SPDX-License-Identifier: MIT
// The layouts of the guides of paths: words, with tables of directions.
//
// A table divides the unit square of two random numbers (u, v) into GUIDE_ROWS rows by u and
// GUIDE_COLUMNS columns by v. It has the ends of the rows, then those of the columns of each row
// (kernels/sampling/select.h). A table over all directions, in world axes, has u = (1 - z) / 2, and
// v is the angle around the z axis.
//
// An emission guide says how light paths select their light and their direction. For every light
// there is first the end of its range of random words, then, for every light, the index of the
// first word of its table, or NO_GUIDE_TABLE. kernels/light/emission_guide.h says which direction a
// point of the square stands for.
//
// A scatter guide says from where light arrives at a place, on one side of a surface. A side is the
// coordinate axis nearest to the normal there, with its sign. The first GUIDE_SIDES words are the
// indices of the nodes with which the trees of the sides begin. A node has two words. The lower
// GUIDE_LINK_BITS of the first are an axis (0 to 2) or GUIDE_LEAF:
// - An inner node divides space where the coordinate of its axis is the second word, a float. The
//   other bits of the first word are the index of the first child. The second child, which has the
//   greater coordinates, follows it.
// - A leaf is a cell. The other bits of its first word are the index of its table over all
//   directions, or NO_GUIDE_TABLE.
#pragma once

#define GUIDE_ROWS 16u
#define GUIDE_COLUMNS 32u
#define GUIDE_ROW_BITS 4u     ///< log2 of GUIDE_ROWS
#define GUIDE_COLUMN_BITS 5u  ///< log2 of GUIDE_COLUMNS
#define GUIDE_BINS (GUIDE_ROWS * GUIDE_COLUMNS)
#define GUIDE_TABLE_WORDS (GUIDE_ROWS + GUIDE_BINS)

/// Index of the table of a light or a cell without one. No table begins there.
#define NO_GUIDE_TABLE 0u

#define GUIDE_SIDES 6u
#define GUIDE_LINK_BITS 2u
#define GUIDE_LEAF 3u
#define GUIDE_NODE_WORDS 2u
