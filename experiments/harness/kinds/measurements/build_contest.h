// SPDX-License-Identifier: MIT
// Times the building of hierarchies over one mesh in interleaved repetitions: every builder and
// layout on the device, and Embree.
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

/// A builder with compiled kernels for each variant. It is reused for all meshes.
class Builders {
  public:
    explicit Builders(DeviceContext &device);

    struct Named {
        std::string name;
        BvhBuilder builder;
    };
    std::vector<Named> &all() { return all_; }
    DeviceContext &device() { return *device_; }

  private:
    DeviceContext *device_;
    std::vector<Named> all_;
};

/// Contest of all builders over one mesh.
class BuildContest {
  public:
    /// Builds once with each builder, which compiles its kernels, and traces `rays` diffuse rays.
    /// `builders` must outlive the contest.
    BuildContest(Builders &builders, const std::string &mesh, size_t rays);

    Contest &contest() { return contest_; }
    double triangles() const { return static_cast<double>(mesh_.mesh.triangles.size()); }

    /// Returns the row of the result (kinds.h) after at least 6 turns, without "full_sweep_sah".
    Json row() const;

    /// Computes the SAH cost of a full-sweep build on the host. It takes O(n log n) time, about a
    /// minute for 1e7 triangles.
    double full_sweep_cost() const;

    /// Contestant that speeds are relative to.
    static constexpr const char *baseline = "Embree medium";

  private:
    MeasuredMesh mesh_;
    std::unique_ptr<DeviceMesh> on_device_;
    Contest contest_;
    std::vector<Json> facts_;  ///< values of each contestant except times
};

}  // namespace rtrays
