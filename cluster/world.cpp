// SPDX-License-Identifier: MIT
#include "cluster/world.h"

#define OMPI_SKIP_MPICXX 1  // the C interface alone
#define MPICH_SKIP_MPICXX 1
#include <fmt/format.h>
#include <mpi.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>
#include <limits>
#include <thread>

#include "renderer/base/error.h"

namespace rtrays::cluster {

namespace {

enum Tag { report_tag = 1, order_tag = 2 };

/// Throws `Error` (run failed) unless a call of MPI succeeded.
void check(int status, const char *what) {
    if (status != MPI_SUCCESS) {
        std::array<char, MPI_MAX_ERROR_STRING> text{};
        int length = 0;
        MPI_Error_string(status, text.data(), &length);
        throw run_error(fmt::format("MPI, {}: {}", what, text.data()));
    }
}

size_t rank_in(MPI_Comm communicator) {
    int rank = 0;
    check(MPI_Comm_rank(communicator, &rank), "rank");
    return static_cast<size_t>(rank);
}

size_t size_of(MPI_Comm communicator) {
    int size = 0;
    check(MPI_Comm_size(communicator, &size), "number of ranks");
    return static_cast<size_t>(size);
}

/// Waits for a request. MPI itself would wait with a busy processor, which other threads of this
/// node may need.
void wait(MPI_Request &request) {
    auto pause = std::chrono::microseconds(20);
    int done = 0;
    while (check(MPI_Test(&request, &done, MPI_STATUS_IGNORE), "waiting"), done == 0) {
        std::this_thread::sleep_for(pause);
        pause = std::min(2 * pause, std::chrono::microseconds(1000));
    }
}

int int_of(size_t size) {
    if (size > static_cast<size_t>(std::numeric_limits<int>::max())) {
        throw run_error(fmt::format("MPI: a message of {} elements is too long", size));
    }
    return static_cast<int>(size);
}

}  // namespace

/// The ranks of this node.
struct World::Node {
    MPI_Comm communicator = MPI_COMM_NULL;
};

World::World(int *argc, char ***argv) : node_(std::make_unique<Node>()) {
    int provided = 0;
    check(MPI_Init_thread(argc, argv, MPI_THREAD_FUNNELED, &provided), "start");
    if (provided < MPI_THREAD_FUNNELED) {
        throw run_error("MPI does not support threads in a process; install another one");
    }
    rank_ = rank_in(MPI_COMM_WORLD);
    size_ = size_of(MPI_COMM_WORLD);
    check(MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL,
                              &node_->communicator),
          "ranks of a node");
    local_rank_ = rank_in(node_->communicator);
    local_size_ = size_of(node_->communicator);
    constexpr size_t most_ranks = 1 << 15;  // words of reference/fixed_sum.h
    if (size_ > most_ranks) {
        throw run_error(fmt::format("{} ranks: sums are exact for at most {}", size_, most_ranks));
    }
}

World::~World() {
    MPI_Comm_free(&node_->communicator);
    MPI_Finalize();
}

std::string World::host() const {
    std::array<char, MPI_MAX_PROCESSOR_NAME + 1> name{};
    int length = 0;
    check(MPI_Get_processor_name(name.data(), &length), "name of the node");
    return name.data();
}

void World::abort(int code) const {
    MPI_Abort(MPI_COMM_WORLD, code);
    std::abort();
}

std::vector<std::string> World::gather(const std::string &text) const {
    const int length = int_of(text.size());
    std::vector<int> lengths(is_root() ? size_ : 0), offsets(lengths.size());
    check(MPI_Gather(&length, 1, MPI_INT, lengths.data(), 1, MPI_INT, 0, MPI_COMM_WORLD), "gather");
    size_t total = 0;
    for (size_t i = 0; i < lengths.size(); ++i) {
        offsets[i] = int_of(total);
        total += static_cast<size_t>(lengths[i]);
    }
    int_of(total);
    std::string all(total, '\0');
    check(MPI_Gatherv(text.data(), length, MPI_CHAR, all.data(), lengths.data(), offsets.data(),
                      MPI_CHAR, 0, MPI_COMM_WORLD),
          "gather");
    std::vector<std::string> texts;
    for (size_t i = 0; i < lengths.size(); ++i) {
        texts.push_back(
            all.substr(static_cast<size_t>(offsets[i]), static_cast<size_t>(lengths[i])));
    }
    return texts;
}

std::string World::broadcast(std::string text) const {
    uint64_t length = text.size();
    check(MPI_Bcast(&length, 1, MPI_UINT64_T, 0, MPI_COMM_WORLD), "broadcast");
    text.resize(length);
    check(MPI_Bcast(text.data(), int_of(length), MPI_CHAR, 0, MPI_COMM_WORLD), "broadcast");
    return text;
}

void World::wait_for_node() const {
    MPI_Request request = MPI_REQUEST_NULL;
    check(MPI_Ibarrier(node_->communicator, &request), "barrier");
    wait(request);
}

void World::sum(std::vector<int64_t> &words, size_t slab) const {
    for (size_t begin = 0; begin < words.size(); begin += slab) {
        const int count = int_of(std::min(slab, words.size() - begin));
        int64_t *const data = words.data() + begin;
        check(MPI_Reduce(is_root() ? MPI_IN_PLACE : data, is_root() ? data : nullptr, count,
                         MPI_INT64_T, MPI_SUM, 0, MPI_COMM_WORLD),
              "sum");
    }
}

void World::sum(std::vector<double> &numbers) const {
    check(
        MPI_Reduce(is_root() ? MPI_IN_PLACE : numbers.data(), is_root() ? numbers.data() : nullptr,
                   int_of(numbers.size()), MPI_DOUBLE, MPI_SUM, 0, MPI_COMM_WORLD),
        "sum");
}

void World::send(size_t rank, const Order &order) const {
    check(MPI_Send(&order, sizeof order, MPI_BYTE, int_of(rank), order_tag, MPI_COMM_WORLD),
          "order");
}

Order World::exchange(const Report &report) const {
    Order order;
    MPI_Request request = MPI_REQUEST_NULL;
    check(MPI_Irecv(&order, sizeof order, MPI_BYTE, 0, order_tag, MPI_COMM_WORLD, &request),
          "order");
    check(MPI_Send(&report, sizeof report, MPI_BYTE, 0, report_tag, MPI_COMM_WORLD), "report");
    wait(request);
    return order;
}

std::optional<World::Received> World::receive() const {
    int arrived = 0;
    MPI_Status status;
    check(MPI_Iprobe(MPI_ANY_SOURCE, report_tag, MPI_COMM_WORLD, &arrived, &status), "report");
    if (arrived == 0) {
        return std::nullopt;
    }
    Received received{static_cast<size_t>(status.MPI_SOURCE), {}};
    check(MPI_Recv(&received.report, sizeof received.report, MPI_BYTE, status.MPI_SOURCE,
                   report_tag, MPI_COMM_WORLD, MPI_STATUS_IGNORE),
          "report");
    return received;
}

}  // namespace rtrays::cluster
