// SPDX-License-Identifier: MIT
#include "reference/output.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "reference/manifest.h"
#include "renderer/base/files.h"
#include "renderer/base/image.h"

namespace rtrays::reference {

namespace {

Json statistics(const Options &options, const Json &config, const ReferenceStats &stats, const Film &film) {
    const auto rays = static_cast<double>(stats.camera_rays + stats.bounce_rays + stats.shadow_rays);
    const double all_samples = static_cast<double>(film.count()) * static_cast<double>(film.pixels.size());
    // Restored samples have their time in `seconds` but no rays counted here; a camera ray is a path.
    const double share = static_cast<double>(stats.camera_rays) / all_samples;
    return {{"schema_version", 1},
            {"config", config},
            {"sample_range", {film.begin, film.end}},
            {"threads", options.settings.threads},
            {"triangles", stats.triangles},
            {"degenerate_triangles", stats.degenerate_triangles},
            {"seconds_bvh", stats.build_seconds},
            {"seconds_wall", stats.seconds},
            {"samples_per_second", all_samples / stats.seconds},
            {"rays",
             {{"camera", stats.camera_rays}, {"bounce", stats.bounce_rays}, {"shadow", stats.shadow_rays}}},
            {"rays_per_second", stats.camera_rays > 0 ? Json(rays / (stats.seconds * share)) : Json()}};
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

void write_results(const Options &options, const Json &config, const ReferenceRenderer &renderer,
                   const std::vector<std::string> &commits) {
    const Film &film = renderer.film();
    const std::string commit = fmt::format("{}", fmt::join(commits, ","));
    const std::string engine = config.at("engine");
    Image image = renderer.develop();
    image.attributes()["rtrays:commit"] = commit;
    image.attributes()["rtrays:seed"] = std::to_string(options.settings.seed);
    image.attributes()["rtrays:sampleRange"] = fmt::format("{}:{}", film.begin, film.end);
    image.attributes()["rtrays:sceneHash"] = config.at("scene_hash").get<std::string>();
    image.attributes()["rtrays:engine"] = engine;
    image.attributes()["rtrays:config"] = config.dump();
    write_exr(image, options.output);

    if (!options.manifest.empty()) {
        Json entry = describe_run(options, config, film.count());
        entry["commit"] = commit;
        entry["seconds"] = renderer.seconds();
        update_manifest(options.manifest, options.output, std::move(entry));
    }
    if (!options.stats.empty()) {
        write_file(options.stats, statistics(options, config, renderer.stats(), film).dump(2) + "\n");
    }
}

}  // namespace rtrays::reference
