// SPDX-License-Identifier: MIT
#include "experiments/harness/core/references.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <vector>

#include "reference/manifest.h"
#include "renderer/base/error.h"
#include "renderer/base/json.h"
#include "renderer/base/shell.h"

namespace rtrays {

namespace fs = std::filesystem;

namespace {

constexpr std::array<const char *, 2> halves{"a", "b"};

std::string file_name(const ReferenceRequest &request, size_t half) {
    return fmt::format("{}.{}.{}.exr", request.scene_name, request.engine, halves[half]);
}

/// Whether the reference is one of those that `make references` renders.
bool is_of_repository(const ReferenceRequest &request) {
    return request.folder.parent_path().filename() == "results";
}

/// Returns the error of missing halves, with the commands that render them. Both halves must have
/// the same size and samples, so a missing one copies those of the other.
Error missing(const ReferenceRequest &request, const Json &listed, const std::string &what) {
    const fs::path manifest = request.folder / "manifest.json";
    // Smaller films are averaged from larger ones: references of the repository have the scene's
    // size, and those of one's own that of the experiment.
    std::string size = is_of_repository(request)
                           ? ""
                           : fmt::format(" --size {}x{}", request.width, request.height);
    uint64_t spp = 16384;
    std::vector<size_t> wanted;
    for (size_t half = 0; half < halves.size(); ++half) {
        const std::string name = file_name(request, half);
        if (!fs::exists(request.folder / name) || !listed.contains(name)) {
            wanted.push_back(half);
        } else {
            const Json &other = listed.at(name);
            size = fmt::format(" --size {}x{}", other.at("width").get<int>(),
                               other.at("height").get<int>());
            other.at("spp").get_to(spp);
        }
    }
    std::string commands = fmt::format("  mkdir -p {}\n", in_shell(request.folder));
    for (const size_t half : wanted) {
        commands +=
            fmt::format("  {} {} -o {} --engine {} --spp {}{} --seed {} --manifest {}\n",
                        in_shell(sibling_program("rtrays-reference")), in_shell(request.scene_path),
                        in_shell(request.folder / file_name(request, half)), request.engine, spp,
                        size, half + 1, in_shell(manifest));
    }
    return {ExitCode::reference_missing,
            fmt::format("{}; render it with:\n{}{}", what, commands,
                        is_of_repository(request)
                            ? "or render all references with: make references"
                            : "fewer samples are enough for larger errors: the reference's own "
                              "error should be a third of the smallest measured one")};
}

/// The manifest's entry of one half, checked against the request and the file.
Json checked_entry(const ReferenceRequest &request, const Json &manifest, size_t half) {
    const std::string name = file_name(request, half);
    const fs::path path = request.folder / name;
    if (!fs::exists(path)) {
        throw missing(request, manifest.at("references"),
                      fmt::format("the reference {} does not exist", path.string()));
    }
    if (!manifest.at("references").contains(name)) {
        throw missing(request, manifest.at("references"),
                      fmt::format("{}: no entry in the manifest", path.string()));
    }
    const Json &entry = manifest.at("references").at(name);
    if (entry.at("scene_hash") != request.scene_hash) {
        throw missing(request, Json::object(),
                      fmt::format("{} was rendered from another version of the scene (hash {}, the "
                                  "scene now has {})",
                                  path.string(), entry.at("scene_hash").get<std::string>(),
                                  request.scene_hash));
    }
    if (entry.at("sha256") != reference::sha256_of(path)) {
        throw input_error(fmt::format(
            "{}: the SHA-256 differs from the manifest, so the file was changed or damaged; "
            "restore it or render it again (make references)",
            path.string()));
    }
    return entry;
}

/// Returns the number of stored pixels per requested pixel along each side.
int reduction(const Image &stored, const ReferenceRequest &request) {
    const int factor = stored.width() / request.width;
    if (factor < 1 || stored.width() != factor * request.width ||
        stored.height() != factor * request.height) {
        throw input_error(fmt::format(
            "the reference of {} is {}x{}, which is not a multiple of the film size {}x{}; choose "
            "a size that divides it, or render the reference with --size",
            request.scene_name, stored.width(), stored.height(), request.width, request.height));
    }
    return factor;
}

}  // namespace

StoredReference load_reference(const ReferenceRequest &request) {
    const fs::path manifest_path = request.folder / "manifest.json";
    if (!fs::exists(manifest_path)) {
        throw missing(request, Json::object(),
                      fmt::format("{} does not exist", manifest_path.string()));
    }
    const Json manifest = reference::load_manifest(manifest_path);
    const Json entry_a = checked_entry(request, manifest, 0),
               entry_b = checked_entry(request, manifest, 1);
    if (entry_a.at("seed") == entry_b.at("seed")) {
        throw input_error(
            fmt::format("{}: both halves of {} have the seed {}, so they are not independent; "
                        "render one again with another --seed",
                        manifest_path.string(), request.scene_name, entry_a.at("seed").dump()));
    }
    if (entry_a.at("spp") != entry_b.at("spp")) {
        throw input_error(
            fmt::format("{}: the halves of {} have {} and {} spp, so their difference does not "
                        "give their noise; extend the shorter one (make references)",
                        manifest_path.string(), request.scene_name, entry_a.at("spp").dump(),
                        entry_b.at("spp").dump()));
    }

    const Image a = read_exr(request.folder / file_name(request, 0));
    const Image b = read_exr(request.folder / file_name(request, 1));
    const int factor = reduction(a, request);
    StoredReference result;
    result.halves = {downsample(a, factor), downsample(b, factor)};
    result.reference = combine_halves(result.halves[0], result.halves[1]);
    const double noise = result.reference.noise_mse;
    const double values = 3.0 * request.width * request.height;
    result.description = {
        {"engine", entry_a.at("engine_version")},
        {"files", {file_name(request, 0), file_name(request, 1)}},
        {"spp", entry_a.at("spp").get<uint64_t>() + entry_b.at("spp").get<uint64_t>()},
        {"reduced_by", factor},
        {"scene_hash", request.scene_hash},
        {"noise_floor",
         {{"mse", noise}, {"rmse", std::sqrt(noise)}, {"l2", std::sqrt(noise * values)}}}};
    return result;
}

StoredReference load_reference(const MeasuredScene &wanted, const Scene &scene) {
    return load_reference({wanted.reference_folder, scene.name(), scene.hash(),
                           wanted.reference_engine, wanted.width, wanted.height,
                           wanted.scene.string()});
}

}  // namespace rtrays
