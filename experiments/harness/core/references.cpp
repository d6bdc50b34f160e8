// SPDX-License-Identifier: MIT
#include "experiments/harness/core/references.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "reference/manifest.h"
#include "renderer/base/error.h"
#include "renderer/base/json.h"

namespace rtrays {

namespace fs = std::filesystem;

namespace {

constexpr std::array<const char *, 2> halves{"a", "b"};

std::string file_name(const ReferenceRequest &request, size_t half) {
    return fmt::format("{}.{}.{}.exr", request.scene_name, request.engine, halves[half]);
}

Error missing(const ReferenceRequest &request, size_t half, const std::string &what) {
    const std::string manifest = (request.folder / "manifest.json").string();
    return {
        ExitCode::reference_missing,
        // The command renders the scene's own film size. Smaller films are averaged from it.
        fmt::format(
            "{}; render it with:\n  rtrays-reference {} -o {} --spp 16384 --seed {} --manifest {}\n"
            "or render all references with: make references",
            what, request.scene_path, (request.folder / file_name(request, half)).string(),
            half + 1, manifest)};
}

/// The manifest's entry of one half, checked against the request and the file.
Json checked_entry(const ReferenceRequest &request, const Json &manifest, size_t half) {
    const std::string name = file_name(request, half);
    const fs::path path = request.folder / name;
    if (!fs::exists(path)) {
        throw missing(request, half, fmt::format("the reference {} does not exist", path.string()));
    }
    if (!manifest.at("references").contains(name)) {
        throw missing(request, half, fmt::format("{}: no entry in the manifest", path.string()));
    }
    const Json &entry = manifest.at("references").at(name);
    if (entry.at("scene_hash") != request.scene_hash) {
        throw input_error(fmt::format(
            "{} was rendered from another version of the scene (hash {}, the scene now has {}); "
            "render it again (make references)",
            path.string(), entry.at("scene_hash").get<std::string>(), request.scene_hash));
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
        throw missing(request, 0, fmt::format("{} does not exist", manifest_path.string()));
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
