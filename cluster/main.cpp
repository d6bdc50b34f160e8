// SPDX-License-Identifier: MIT
// rtrays-mpi: renders one image or one reference on all ranks of an MPI job.
#include <fmt/format.h>

#include <cstdio>
#include <optional>
#include <string>

#include "cluster/agreement.h"
#include "cluster/commands.h"
#include "renderer/base/commit.h"
#include "renderer/base/notice.h"

namespace rtrays::cluster {

namespace {

constexpr const char *usage =
    "Usage: mpirun -n RANKS rtrays-mpi [--mixed-devices] COMMAND ...\n\n"
    "Commands:\n"
    "  render       renders a scene; takes the options of rtrays-render\n"
    "  reference    renders a reference; takes the options of rtrays-reference\n\n"
    "The image has the same bits for any number of ranks. Rank 0 hands out ranges of samples, and\n"
    "writes the results. It saves the film of --state every five minutes (--checkpoint-interval)\n"
    "and on SIGTERM, SIGINT and SIGUSR1; --resume continues it.\n\n"
    "Options:\n"
    "  --mixed-devices    allow ranks whose devices differ, and thus the bits of their samples\n"
    "  --version          print the version\n"
    "  -h,--help          print this text; COMMAND --help lists the options of a command\n";

/// What the words before the arguments of a command say.
struct Request {
    std::string command;  ///< empty: nothing is left to do
    Devices devices = Devices::equal;
    int words = 1;  ///< before the command
};

/// Parses the words up to the command. Throws `Error` (bad usage) without a command.
Request parse_request(int argc, char **argv) {
    Request request;
    for (; request.words < argc; ++request.words) {
        const std::string word = argv[request.words];
        if (word == "render" || word == "reference") {
            request.command = word;
            return request;
        }
        if (word == "--version") {
            fmt::print("{}\n", program_version("rtrays-mpi"));
            return request;
        }
        if (word == "--help" || word == "-h") {
            fmt::print("{}", usage);
            return request;
        }
        if (word != "--mixed-devices") {
            throw input_error(fmt::format(
                "unknown command '{}'; expected render or reference (see --help)", word));
        }
        request.devices = Devices::mixed;
    }
    throw input_error("expected a command: render or reference (see --help)");
}

ExitCode run(const World &world, int argc, char **argv) {
    Request request;
    try {
        request = parse_request(argc, argv);
    } catch (const Error &error) {
        return agree(world, {error.exit_code(), error.what(), {}}).value_or(error.exit_code());
    }
    if (request.command.empty()) {
        return ExitCode::ok;
    }
    argc -= request.words;
    argv += request.words;
    return request.command == "render" ? render(world, request.devices, argc, argv)
                                       : render_reference(world, request.devices, argc, argv);
}

/// Runs the program as one rank. An error of one rank ends all.
ExitCode run_rank(const World &world, int argc, char **argv) {
    std::optional<NoticeReceiver> silence;
    if (!world.is_root()) {  // only rank 0 prints
        silence.emplace([](const std::string &) {});
        std::freopen("/dev/null", "w", stdout);
    }
    try {
        return run(world, argc, argv);
    } catch (const std::exception &error) {
        const auto *own = dynamic_cast<const Error *>(&error);
        const ExitCode code = own != nullptr ? own->exit_code() : ExitCode::run_failed;
        if (world.size() == 1) {
            throw;
        }
        fmt::print(stderr, "rtrays-mpi: rank {} ({}): {}\n", world.rank(), world.host(),
                   error.what());
        world.abort(static_cast<int>(code));
    }
}

ExitCode start(int argc, char **argv) {
    const World world(&argc, &argv);
    return run_rank(world, argc, argv);
}

}  // namespace

}  // namespace rtrays::cluster

int main(int argc, char **argv) {
    return rtrays::run_main("rtrays-mpi", [&] { return rtrays::cluster::start(argc, argv); });
}
