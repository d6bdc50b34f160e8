// SPDX-License-Identifier: MIT
// What both builders write last: leaf triangles in tree order, and the areas that a tree's SAH cost
// sums.
#pragma once

#include "renderer/kernels/bvh/range_bounds.h"
#include "renderer/shared/triangle.h"

/// Half the area of a child's box, with sides scaled by `scale`.
DEVICE float node_child_area(GLOBAL const BvhNode *node, uint side, float scale) {
    GLOBAL const float(*box)[3] = node->bounds[side];
    return half_area(box[1][0] - box[0][0], box[1][1] - box[0][1], box[1][2] - box[0][2], scale);
}

/// Triangle `id` of the input, with its corners.
DEVICE LeafTriangle leaf_triangle(GLOBAL const float *positions, GLOBAL const uint *indices,
                                  uint id) {
    LeafTriangle triangle;
    triangle.id = id;
    for (uint corner = 0; corner < 3; ++corner) {
        const uint vertex = indices[3 * id + corner];
        for (uint axis = 0; axis < 3; ++axis) {
            triangle.coordinate[axis][corner] = positions[3 * vertex + axis];
        }
    }
    triangle.padding[0] = triangle.padding[1] = 0;
    return triangle;
}
