// SPDX-License-Identifier: MIT
// When the last paths of a batch are few, and how many events each of them then advances in one
// launch: the product is the streams' capacity, so that no launch adds more often to a pixel than a
// round of full streams.
#pragma once

#define FINISH_EVENTS 64u
#define FEW_PATHS(capacity) ((capacity) / FINISH_EVENTS)
