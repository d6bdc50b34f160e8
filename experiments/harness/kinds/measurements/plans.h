// SPDX-License-Identifier: MIT
// The kinds of measurement, named as in "measures". Speeds compare processor time, or wall time if
// the device is a GPU (contest.h).
#pragma once

#include "experiments/harness/core/contest.h"
#include "experiments/harness/kinds/measurements/measurement.h"

namespace rtrays {

/// Measures hierarchy builds by every builder and layout, and by Embree with low, medium and high
/// quality (thesis, table 4.1).
///
/// A turn builds a traceable hierarchy from buffers that are on the device. Embree builds from a
/// scene that has the buffers (rtcCommitScene, not ROBUST). Embree uses as many threads as a CPU
/// device has compute units, or all host threads if the device is a GPU. Rows have milliseconds,
/// the SAH cost (K_T = K_I = 1) and that of a full sweep on the host. They also have the traversal
/// work of a diffuse ray, bytes, and device milliseconds of one build by stage. The summary has the
/// exponents of time over triangle count.
MeasurementPlan plan_bvh_build(const MeasurementSettings &settings, DeviceContext &device);

/// Measures rays per second by kind of ray and layout, and those of Embree (ROBUST). Embree is
/// called for single rays and for packets of sixteen, with the instruction set that is fastest on
/// these rays.
MeasurementPlan plan_ray_rates(const MeasurementSettings &settings, DeviceContext &device);

/// Checks, for each layout, the hits of fuzzed rays against Embree (ROBUST); differences are judged
/// in double precision. Also counts the rays that escape from closed shapes.
MeasurementPlan plan_traversal(const MeasurementSettings &settings, DeviceContext &device);

/// Returns whether all layouts of a row of `plan_traversal` keep their limits.
std::optional<bool> traversal_passes(const Json &row);

/// Measures an animated mesh frame by frame: milliseconds of rebuilding with every builder and of
/// refitting the tree of the first frame, and the cost of diffuse rays in both trees.
MeasurementPlan plan_bvh_animation(const MeasurementSettings &settings, DeviceContext &device);

/// Measures frames of path tracing and their rays by kind (thesis, tables 4.2 and 4.3, figure
/// 4.21).
///
/// A turn renders one sample per pixel three times. The first render has explicit paths with one
/// scattering event, whose rays are camera and shadow rays. The second has two scattering events;
/// its additional time for nearest hits is that of the secondary rays. The third is a full frame by
/// MIS with roulette from the first bounce. Rows have, for each kind of ray, device milliseconds
/// and ray counts. For a frame they have wall time, processor time and the time of every stage.
/// Hierarchy builds and kernel compilation (by the first enqueue) are measured separately.
MeasurementPlan plan_frame_times(const MeasurementSettings &settings, DeviceContext &device);

/// Measures samples per second of paths with 1, 4 and 8 bounces on diffuse surfaces, without
/// roulette and with one explicit connection at every hit (thesis, figure 4.22). Contestants are
/// the wavefront, one kernel for full paths, the Embree reference and, if requested and installed,
/// Mitsuba 3 and Cycles. Rows have, by depth, wall-time rates, rays per sample, and the speed of
/// the wavefront relative to the others.
MeasurementPlan plan_bounces(const MeasurementSettings &settings, DeviceContext &device);

/// Measures error and time of images of the scenes `references`, by path tracing and truncated BDPT
/// and, if requested and installed, by Mitsuba 3 and Cycles. Rows have, by contestant, the MSE
/// against the stored Embree reference, less its noise, and both durations of every turn; those of
/// the renderer include its pilots.
MeasurementPlan plan_renderers(const MeasurementSettings &settings, DeviceContext &device);

/// Measures frames of path tracing (MIS, roulette, one sample per pixel) and hierarchy builds with
/// one setting changed at a time, interleaved with the defaults, to which speeds are relative.
MeasurementPlan plan_ablations(const MeasurementSettings &settings, DeviceContext &device);

/// Tests the stored references of all renderers and an image of RTRays pair by pair. Also renders
/// probe scenes with all renderers, tests the images pair by pair and reports their means.
MeasurementPlan plan_reference_agreement(const MeasurementSettings &settings,
                                         DeviceContext &device);

/// Path of the manifest that `plan_reference_agreement` depends on.
std::filesystem::path references_manifest();

/// Returns {"value", "low", "high"} multiplied by a factor.
Json scaled(const Interval &interval, double factor);

/// Calls contest.turn() `repetitions` times. Throws `Error` (interrupted) between turns if a signal
/// stops it.
void run_turns(Contest &contest, int repetitions);

}  // namespace rtrays
