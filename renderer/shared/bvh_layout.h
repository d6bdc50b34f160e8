// SPDX-License-Identifier: MIT
// The memory layouts of a bounding volume hierarchy. A program is compiled for one of them,
// BVH_LAYOUT.
#pragma once

#include "renderer/shared/bvh_node.h"
#include "renderer/shared/stackless_node.h"
#include "renderer/shared/triangle.h"
#include "renderer/shared/wide_node.h"

#define BVH_LAYOUT_BVH2 0
#define BVH_LAYOUT_STACKLESS 1
#define BVH_LAYOUT_WIDE8 2

#ifndef BVH_LAYOUT
#define BVH_LAYOUT BVH_LAYOUT_BVH2
#endif

// The node and triangle records of the layout, and the function that traverses it.
#if BVH_LAYOUT == BVH_LAYOUT_WIDE8
#define BVH_NODE WideNode
#define BVH_TRIANGLES TriangleBlock
#define TRAVERSE_BVH traverse_wide
#elif BVH_LAYOUT == BVH_LAYOUT_STACKLESS
#define BVH_NODE StacklessNode
#define BVH_TRIANGLES LeafTriangle
#define TRAVERSE_BVH traverse_stackless
#else
#define BVH_NODE BvhNode
#define BVH_TRIANGLES LeafTriangle
#define TRAVERSE_BVH traverse_bvh2
#endif
