// SPDX-License-Identifier: MIT
// The ranks of an MPI job. Only the main thread of a process calls these functions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "renderer/base/sample_ranges.h"

namespace rtrays::cluster {

/// What rank 0 tells another rank to do.
struct Order {
    enum class Kind : uint64_t { render, sum, end };
    Kind kind;
    SampleRange range;
};

/// What a rank has done since its last order. The first report has no samples.
struct Report {
    SampleRange range = {0, 0};
    double seconds = 0;
    uint64_t interrupted = 0;  ///< whether a signal has asked the rank to end
};

/// The MPI job of this process, from construction to destruction.
class World {
  public:
    /// Starts MPI. Throws `Error` (run failed) if there are more ranks than exact sums allow.
    World(int *argc, char ***argv);
    ~World();
    World(const World &) = delete;
    World &operator=(const World &) = delete;

    size_t rank() const { return rank_; }
    size_t size() const { return size_; }
    bool is_root() const { return rank_ == 0; }
    size_t local_rank() const { return local_rank_; }  ///< among the ranks of this node
    size_t local_size() const { return local_size_; }  ///< ranks of this node
    /// Returns the name of this node.
    std::string host() const;

    /// Ends all ranks at once with an exit code.
    [[noreturn]] void abort(int code) const;

    /// Returns the texts of all ranks on rank 0, and nothing elsewhere. All ranks call it.
    std::vector<std::string> gather(const std::string &text) const;

    /// Returns the text of rank 0 on all ranks. All ranks call it.
    std::string broadcast(std::string text) const;

    /// Waits, without taking processor time, until all ranks of the node call it.
    void wait_for_node() const;

    /// Replaces the words on rank 0 by their sums over all ranks, in slabs of at most `slab` words.
    /// All ranks call it, with the same number of words.
    void sum(std::vector<int64_t> &words, size_t slab) const;
    /// Replaces numbers on rank 0 by their sums over all ranks. All ranks call it.
    void sum(std::vector<double> &numbers) const;

    /// Sends an order to another rank. Called by rank 0.
    void send(size_t rank, const Order &order) const;
    /// Sends a report to rank 0 and waits for the next order.
    Order exchange(const Report &report) const;

    struct Received {
        size_t rank;
        Report report;
    };
    /// Returns a report that has arrived, or nothing. Called by rank 0.
    std::optional<Received> receive() const;

  private:
    struct Node;
    std::unique_ptr<Node> node_;
    size_t rank_, size_, local_rank_, local_size_;
};

}  // namespace rtrays::cluster
