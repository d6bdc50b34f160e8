// SPDX-License-Identifier: MIT
// Times rays of one kind through one mesh in interleaved repetitions: every layout on the device,
// and Embree.
#pragma once

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "experiments/harness/core/contest.h"
#include "experiments/harness/models/meshes.h"
#include "experiments/harness/models/tracers.h"
#include "renderer/base/json.h"

namespace rtrays {

/// A mesh with all hierarchies of the device, and Embree's hierarchy for every instruction set.
class TracedMesh {
  public:
    TracedMesh(DeviceContext &device, const std::string &mesh);

    struct Named {
        std::string name;
        DeviceTracer tracer;
    };
    DeviceContext &device() const { return *device_; }
    const MeasuredMesh &mesh() const { return mesh_; }
    const std::vector<Named> &ours() const { return ours_; }
    const std::vector<std::unique_ptr<EmbreeTracer>> &embree() const { return embree_; }

  private:
    DeviceContext *device_;
    MeasuredMesh mesh_;
    std::vector<Named> ours_;
    std::vector<std::unique_ptr<EmbreeTracer>> embree_;
};

/// Contest of all tracers with one kind of ray.
class RayContest {
  public:
    /// Traces once with each tracer, which compiles its kernels, and chooses Embree's instruction
    /// sets. Throws `Error` (run failed) if the numbers of hits differ by more than 1e-4 of the
    /// rays. `mesh` must outlive the contest.
    RayContest(const TracedMesh &mesh, const RayKind &kind, size_t rays);

    Contest &contest() { return contest_; }
    /// Contestant that speeds are relative to: rtcIntersect1 or rtcOccluded1.
    const std::string &baseline() const { return baseline_; }
    double millions_of_rays() const { return 1e-6 * static_cast<double>(rays_.size()); }

    /// Returns the row of the result (kinds.h) after at least 6 turns.
    Json row() const;

  private:
    void require_equal_hits(const std::string &name, size_t hits, size_t expected) const;

    const TracedMesh *mesh_;
    RayKind kind_;
    std::vector<RayRecord> rays_;
    std::unique_ptr<DeviceRays> on_device_;
    Contest contest_;
    std::string baseline_;
    std::vector<Json> facts_;  ///< values of each contestant except times
};

}  // namespace rtrays
