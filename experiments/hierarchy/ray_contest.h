// SPDX-License-Identifier: MIT
// Rays of one kind through one mesh in turns: by every layout on the device, and by Embree.
#pragma once

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "experiments/hierarchy/contest.h"
#include "experiments/hierarchy/meshes.h"
#include "experiments/hierarchy/tracers.h"
#include "renderer/base/json.h"

namespace rtrays {

/// A mesh in every hierarchy of the device's, and in Embree's by every instruction set.
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

class RayContest {
  public:
    /// Traces once by each, which compiles, and chooses Embree's instruction sets. Throws `Error`
    /// (run failed) when the numbers of rays that hit something differ by more than 1e-4 of all.
    /// `mesh` must outlive the contest.
    RayContest(const TracedMesh &mesh, const RayKind &kind, size_t rays);

    Contest &contest() { return contest_; }
    const std::string &baseline() const {
        return baseline_;
    }  ///< what speeds are relative to: rtcIntersect1, rtcOccluded1
    double millions_of_rays() const { return 1e-6 * static_cast<double>(rays_.size()); }

    /// What is known after at least 6 turns (kinds.h).
    Json row() const;

  private:
    void require_equal_hits(const std::string &name, size_t hits, size_t expected) const;

    const TracedMesh *mesh_;
    RayKind kind_;
    std::vector<RayRecord> rays_;
    std::unique_ptr<DeviceRays> on_device_;
    Contest contest_;
    std::string baseline_;
    std::vector<Json> facts_;  ///< of each contestant, all but times
};

}  // namespace rtrays
