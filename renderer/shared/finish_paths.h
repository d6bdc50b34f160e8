// SPDX-License-Identifier: MIT
// Constants of stage finish_paths, which takes over when only a few paths of a batch are left.
//
// FEW_PATHS is the number of paths from which it runs, FINISH_EVENTS the number of events by which
// it advances each of them per launch. Their product is at most the capacity of the streams. A
// launch thus adds to a pixel no more often than a round of full streams does.
#pragma once

#define FINISH_EVENTS 64u
#define FEW_PATHS(capacity) ((capacity) / FINISH_EVENTS)
