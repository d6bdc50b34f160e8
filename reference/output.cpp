// SPDX-License-Identifier: MIT
#include "reference/output.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <utility>

#include "reference/manifest.h"
#include "renderer/base/error.h"
#include "renderer/base/files.h"
#include "renderer/base/image.h"

namespace rtrays::reference {

namespace {

Json statistics(const Result &result) {
    const auto pixels = static_cast<double>(result.image.pixel_count());
    const auto count = static_cast<double>(count_samples(result.ranges));
    Json statistics = {{"schema_version", 1},
                       {"config", result.config},
                       {"sample_range", {result.ranges.front().begin, result.ranges.back().end}},
                       {"seconds_wall", result.seconds},
                       {"samples_per_second", count * pixels / result.seconds}};
    statistics.update(result.counts);
    return statistics;
}

void require_listable(const Result &result) {
    if (result.ranges.size() != 1) {
        throw input_error(
            fmt::format("--manifest: the samples {} are not one range", describe(result.ranges)));
    }
    if (result.config.contains("crop")) {
        throw input_error("a crop of the film excludes --manifest");
    }
}

}  // namespace

Json describe_run(const Json &config, SampleRange samples) {
    return {{"scene", config.at("scene")},
            {"scene_hash", config.at("scene_hash")},
            {"width", config.at("width")},
            {"height", config.at("height")},
            {"seed", config.at("seed")},
            {"sample_range", {samples.begin, samples.end}},
            {"spp", samples.count()},
            {"strategies", config.at("strategies")},
            {"max_depth", config.at("max_depth")},
            {"engine_version", config.at("engine")}};
}

Json describe_counts(const ReferenceRenderer &renderer, int threads) {
    const ReferenceStats stats = renderer.stats();
    const auto rays =
        static_cast<double>(stats.camera_rays + stats.bounce_rays + stats.shadow_rays);
    // `seconds` includes the time of restored samples, but their rays are not counted. Each camera
    // ray is one path, so camera rays over all samples is the share of the rays counted here.
    const double all_samples =
        static_cast<double>(renderer.film().count() * renderer.film().pixels.size());
    const double share = static_cast<double>(stats.camera_rays) / all_samples;
    return {
        {"threads", threads},
        {"triangles", stats.triangles},
        {"degenerate_triangles", stats.degenerate_triangles},
        {"seconds_bvh", stats.build_seconds},
        {"rays",
         {{"camera", stats.camera_rays},
          {"bounce", stats.bounce_rays},
          {"shadow", stats.shadow_rays}}},
        {"rays_per_second", stats.camera_rays > 0 ? Json(rays / (stats.seconds * share)) : Json()}};
}

void write_results(const OutputFiles &files, Result result) {
    if (!files.manifest.empty()) {
        require_listable(result);
    }
    const std::string commit = fmt::format("{}", fmt::join(result.commits, ","));
    auto &attributes = result.image.attributes();
    attributes["rtrays:commit"] = commit;
    attributes["rtrays:seed"] = std::to_string(result.config.at("seed").get<uint64_t>());
    attributes["rtrays:sampleRange"] = describe(result.ranges);
    attributes["rtrays:sceneHash"] = result.config.at("scene_hash").get<std::string>();
    attributes["rtrays:engine"] = result.config.at("engine").get<std::string>();
    attributes["rtrays:config"] = result.config.dump();
    write_exr(result.image, files.image);

    if (!files.manifest.empty()) {
        Json entry = describe_run(result.config, result.ranges.front());
        entry["commit"] = commit;
        entry["seconds"] = result.seconds;
        update_manifest(files.manifest, files.image, std::move(entry));
    }
    if (!files.stats.empty()) {
        write_file(files.stats, statistics(result).dump(2) + "\n");
    }
}

}  // namespace rtrays::reference
