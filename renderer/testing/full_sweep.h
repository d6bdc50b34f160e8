// SPDX-License-Identifier: MIT
// Full-sweep SAH build on the host, with whose cost hierarchies are compared. It evaluates every
// split of the sorted centroids on each axis. The centroids are sorted once, and partitions keep
// the order: I. Wald, V. Havran, "On building fast kd-trees for ray tracing, and on doing that in
// O(N log N)", 2006.
#pragma once

#include <algorithm>
#include <array>
#include <numeric>
#include <vector>

#include "renderer/shared/bvh_node.h"
#include "renderer/testing/bvh_meshes.h"

namespace rtrays::test {

/// Returns half the surface area of a box, 0 for an empty box.
template <typename Box>
double half_area(const Box &box) {
    if (box.isEmpty()) {
        return 0;
    }
    const Eigen::Vector3d d = box.max().template cast<double>() - box.min().template cast<double>();
    return d.x() * d.y() + d.y() * d.z() + d.z() * d.x();
}

/// Computes the cost of the tree without building nodes.
class FullSweep {
  public:
    explicit FullSweep(const Mesh &mesh)
        : boxes_(mesh.triangles.size()), goes_left_(boxes_.size()), areas_(boxes_.size()) {
        for (uint32_t i = 0; i < boxes_.size(); ++i) {
            for (uint32_t corner = 0; corner < 3; ++corner) {
                boxes_[i].extend(mesh.vertex(i, corner));
            }
        }
        for (int axis = 0; axis < 3; ++axis) {
            std::vector<uint32_t> &order = orders_[axis];
            order.resize(boxes_.size());
            std::iota(order.begin(), order.end(), 0u);
            const auto centre = [&](uint32_t i) {
                return boxes_[i].min()[axis] + boxes_[i].max()[axis];
            };
            std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
                return std::make_pair(centre(a), a) < std::make_pair(centre(b), b);
            });
        }
    }

    /// Returns the SAH cost with K_T = K_I = 1, relative to the root's area. Leaves hold up to
    /// BVH_LEAF_SIZE triangles, as in the device builder.
    double cost() { return cost_of(0, boxes_.size()) / half_area(bounds_of(0, boxes_.size())); }

  private:
    using Box = Eigen::AlignedBox3f;

    struct Split {
        double cost = INFINITY;
        int axis = 0;
        size_t begin_of_right = 0;
    };

    Box bounds_of(size_t begin, size_t end) const {
        Box all;
        for (size_t i = begin; i < end; ++i) {
            all.extend(boxes_[orders_[0][i]]);
        }
        return all;
    }

    Split best_split(size_t begin, size_t end) {
        Split best;
        for (int axis = 0; axis < 3; ++axis) {
            const std::vector<uint32_t> &order = orders_[axis];
            Box right, left;
            for (size_t i = end - 1; i > begin; --i) {
                right.extend(boxes_[order[i]]);
                areas_[i] = half_area(right);
            }
            for (size_t i = begin + 1; i < end; ++i) {
                left.extend(boxes_[order[i - 1]]);
                const double cost = half_area(left) * static_cast<double>(i - begin) +
                                    areas_[i] * static_cast<double>(end - i);
                if (cost < best.cost) {
                    best = {cost, axis, i};
                }
            }
        }
        return best;
    }

    /// Partitions the range on all axes. Triangles left of the split come first; the order within
    /// each side is unchanged.
    void partition(size_t begin, size_t end, const Split &split) {
        for (size_t i = begin; i < end; ++i) {
            goes_left_[orders_[split.axis][i]] = i < split.begin_of_right ? 1 : 0;
        }
        for (std::vector<uint32_t> &order : orders_) {
            waiting_.clear();
            size_t left = begin;
            for (size_t i = begin; i < end; ++i) {
                if (goes_left_[order[i]] != 0) {
                    order[left++] = order[i];
                } else {
                    waiting_.push_back(order[i]);
                }
            }
            std::copy(waiting_.begin(), waiting_.end(),
                      order.begin() + static_cast<std::ptrdiff_t>(left));
        }
    }

    double cost_of(size_t begin, size_t end) {
        const double area = half_area(bounds_of(begin, end));
        const size_t size = end - begin;
        if (size <= BVH_LEAF_SIZE) {
            return area * static_cast<double>(size);
        }
        const Split split = best_split(begin, end);
        partition(begin, end, split);
        return area + cost_of(begin, split.begin_of_right) + cost_of(split.begin_of_right, end);
    }

    std::vector<Box> boxes_;
    std::array<std::vector<uint32_t>, 3> orders_;  ///< triangles per axis, sorted in each range
    std::vector<uint8_t> goes_left_;
    std::vector<uint32_t> waiting_;
    std::vector<double> areas_;
};

inline double full_sweep_cost(const Mesh &mesh) {
    return FullSweep(mesh).cost();
}

}  // namespace rtrays::test
