// SPDX-License-Identifier: MIT
#include "reference/output.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "reference/manifest.h"
#include "renderer/base/files.h"
#include "renderer/base/image.h"

namespace rtrays::reference {

namespace {

Json statistics(const Options &options, const Json &config, const Result &result) {
    const auto pixels = static_cast<double>(result.image.pixel_count());
    const auto count = static_cast<double>(result.end - result.begin);
    Json statistics = {{"schema_version", 1},
                       {"config", config},
                       {"sample_range", {result.begin, result.end}},
                       {"threads", options.settings.threads},
                       {"seconds_wall", result.seconds},
                       {"samples_per_second", count * pixels / result.seconds}};
    statistics.update(result.counts);
    return statistics;
}

}  // namespace

Json describe_run(const Options &options, const Json &config, uint64_t spp) {
    return {{"scene", config.at("scene")},
            {"scene_hash", config.at("scene_hash")},
            {"width", options.settings.width},
            {"height", options.settings.height},
            {"seed", options.settings.seed},
            {"sample_range", {options.begin, options.begin + spp}},
            {"spp", spp},
            {"strategies", config.at("strategies")},
            {"max_depth", config.at("max_depth")},
            {"engine_version", config.at("engine")}};
}

Json describe_counts(const ReferenceRenderer &renderer) {
    const ReferenceStats stats = renderer.stats();
    const auto rays =
        static_cast<double>(stats.camera_rays + stats.bounce_rays + stats.shadow_rays);
    // `seconds` includes the time of restored samples, but their rays are not counted. Each camera
    // ray is one path, so camera rays over all samples is the share of the rays counted here.
    const double all_samples =
        static_cast<double>(renderer.film().count() * renderer.film().pixels.size());
    const double share = static_cast<double>(stats.camera_rays) / all_samples;
    return {
        {"triangles", stats.triangles},
        {"degenerate_triangles", stats.degenerate_triangles},
        {"seconds_bvh", stats.build_seconds},
        {"rays",
         {{"camera", stats.camera_rays},
          {"bounce", stats.bounce_rays},
          {"shadow", stats.shadow_rays}}},
        {"rays_per_second", stats.camera_rays > 0 ? Json(rays / (stats.seconds * share)) : Json()}};
}

void write_results(const Options &options, const Json &config, Result result,
                   const std::vector<std::string> &commits) {
    const std::string commit = fmt::format("{}", fmt::join(commits, ","));
    auto &attributes = result.image.attributes();
    attributes["rtrays:commit"] = commit;
    attributes["rtrays:seed"] = std::to_string(options.settings.seed);
    attributes["rtrays:sampleRange"] = fmt::format("{}:{}", result.begin, result.end);
    attributes["rtrays:sceneHash"] = config.at("scene_hash").get<std::string>();
    attributes["rtrays:engine"] = config.at("engine").get<std::string>();
    attributes["rtrays:config"] = config.dump();
    write_exr(result.image, options.output);

    if (!options.manifest.empty()) {
        Json entry = describe_run(options, config, result.end - result.begin);
        entry["commit"] = commit;
        entry["seconds"] = result.seconds;
        update_manifest(options.manifest, options.output, std::move(entry));
    }
    if (!options.stats.empty()) {
        write_file(options.stats, statistics(options, config, result).dump(2) + "\n");
    }
}

}  // namespace rtrays::reference
