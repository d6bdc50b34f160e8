// SPDX-License-Identifier: MIT
// Functions with which both builders finish a tree: leaf triangles in tree order, and the areas of
// which the SAH cost consists.
#pragma once

#include "renderer/kernels/bvh/range_bounds.h"
#include "renderer/shared/triangle.h"

/// Returns half the area of a child's box, with sides scaled by `scale`.
DEVICE float node_child_area(GLOBAL const BvhNode *node, uint side, float scale) {
    GLOBAL const float(*box)[3] = node->bounds[side];
    return half_area(box[1][0] - box[0][0], box[1][1] - box[0][1], box[1][2] - box[0][2], scale);
}

/// Returns triangle `id` of the input with its vertices.
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
