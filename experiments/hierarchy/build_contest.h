// SPDX-License-Identifier: MIT
// Building hierarchies over one mesh in turns: by every builder and layout on the device, and by
// Embree.
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

/// One builder for each variant, with its kernels: for any number of meshes.
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

class BuildContest {
  public:
    /// Builds once by each, which compiles, and traces `rays` diffuse rays. `builders` must outlive
    /// the contest.
    BuildContest(Builders &builders, const std::string &mesh, size_t rays);

    Contest &contest() { return contest_; }
    double triangles() const { return static_cast<double>(mesh_.mesh.triangles.size()); }

    /// What is known after at least 6 turns (kinds.h), but for the cost of a full sweep.
    Json row() const;

    /// SAH cost of a full sweep on the host: n log n, about a minute for 1e7 triangles.
    double full_sweep_cost() const;

    /// What speeds are relative to.
    static constexpr const char *baseline = "Embree medium";

  private:
    MeasuredMesh mesh_;
    std::unique_ptr<DeviceMesh> on_device_;
    Contest contest_;
    std::vector<Json> facts_;  ///< of each contestant, all but times
};

}  // namespace rtrays
