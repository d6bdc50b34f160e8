// SPDX-License-Identifier: MIT
// Constants of stage run_tail, which takes over when only the last few paths of a batch are left,
// its tail.
#pragma once

/// Number of events by which a launch advances each path.
#define TAIL_EVENTS 64u

/// Largest number of paths that are a tail. Times TAIL_EVENTS it is at most the capacity of the
/// stream. A launch thus adds to a pixel no more often than a round of a full stream does.
#define TAIL_PATHS(capacity) ((capacity) / TAIL_EVENTS)
