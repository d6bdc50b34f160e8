// SPDX-License-Identifier: MIT
// The kinds of measurement, by the names that "measures" gives them. Speeds compare processor time,
// or wall time where the device is a GPU (contest.h).
#pragma once

#include "experiments/hierarchy/contest.h"
#include "experiments/hierarchy/measurement.h"

namespace rtrays {

/// Building by every builder and layout, and by Embree's low, medium and high quality (thesis
/// table 4.1).
///
/// A turn builds from buffers that are on the device to a hierarchy that can be traced; Embree's
/// from a scene that holds the buffers (rtcCommitScene, not ROBUST); on as many threads as a CPU
/// device has compute units, beside a GPU on all of the host. Rows hold milliseconds, SAH cost (K_T
/// = K_I = 1) also over that of a full sweep on the host, the work of a diffuse ray, bytes, and
/// device milliseconds by stage of one build. The summary holds the exponents of time over
/// triangles.
MeasurementPlan plan_bvh_build(const MeasurementSettings &settings, DeviceContext &device);

/// Rays per second by kind of ray and layout, beside Embree (ROBUST, the instruction set that is
/// fastest on these rays) called ray by ray and by sixteens.
MeasurementPlan plan_ray_rates(const MeasurementSettings &settings, DeviceContext &device);

/// Hits of fuzzed rays against Embree's (ROBUST), differences judged in double precision, and rays
/// that find a way out of closed shapes; by layout.
MeasurementPlan plan_traversal(const MeasurementSettings &settings, DeviceContext &device);

/// An animated mesh frame by frame: milliseconds of building anew by every builder and of fitting
/// the tree of the first frame, and what diffuse rays take in both.
MeasurementPlan plan_bvh_animation(const MeasurementSettings &settings, DeviceContext &device);

/// Frames of path tracing, and the rays in them by kind (thesis tables 4.2 and 4.3, figure 4.21).
///
/// A turn renders one sample per pixel three times: explicit paths of one scattering event, whose
/// rays are those from the camera and to lights; of two, what it takes more to find nearest hits
/// being that of the rays after a bounce; and a whole frame by MIS with roulette from the first
/// bounce. Rows hold milliseconds on the device of each kind, numbers of rays, milliseconds of a
/// frame, on the wall, of all processors and of every stage; building the hierarchy and compiling,
/// which the first enqueue of a kernel does, apart.
MeasurementPlan plan_frame_times(const MeasurementSettings &settings, DeviceContext &device);

/// Samples per second of paths of 1, 4 and 8 bounces on diffuse surfaces, roulette off, one
/// explicit connection at every hit (thesis figure 4.22): the wavefront, one kernel for whole
/// paths, the Embree reference and, where wanted and installed, Mitsuba 3 and Cycles, in turns.
/// Rows hold, by depth, rates on the wall, rays per sample, and how many times faster the wavefront
/// is.
MeasurementPlan plan_bounces(const MeasurementSettings &settings, DeviceContext &device);

/// Frames of path tracing (MIS, roulette), one sample per pixel, and builds of the hierarchy, with
/// one setting changed at a time, in turns with the defaults; speeds over those.
MeasurementPlan plan_ablations(const MeasurementSettings &settings, DeviceContext &device);

/// Stored references by every renderer that made some, and an image of ours, tested against each
/// other pair by pair; likewise renderings of probes, made now, with the mean of each.
MeasurementPlan plan_reference_agreement(const MeasurementSettings &settings,
                                         DeviceContext &device);
std::filesystem::path references_manifest();  ///< what it depends on

/// {"value", "low", "high"} times a factor.
Json scaled(const Interval &interval, double factor);

/// Calls contest.turn() `repetitions` times; throws `Error` (interrupted) in between when asked to
/// stop.
void run_turns(Contest &contest, int repetitions);

}  // namespace rtrays
