// SPDX-License-Identifier: MIT
#include "experiments/harness/kinds/ladder.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <set>

#include "renderer/base/files.h"

namespace rtrays {

namespace fs = std::filesystem;

namespace {

fs::path partial_file(const LadderTask &task, uint32_t seed, const std::string &extension) {
    return task.partial / fmt::format("{}.seed{}.{}", task.id, seed, extension);
}

constexpr uint32_t first_seed = 1;

fs::path early_file(const LadderTask &task, uint64_t spp) {
    return partial_file(task, first_seed, fmt::format("{}spp.exr", spp));
}

fs::path batch_file(const LadderTask &task, uint32_t seed, uint64_t batch) {
    return partial_file(task, seed, fmt::format("batch{}.exr", batch));
}

/// Renders the ladder of one seed and writes its last image, its batches and early images.
Repetition render_ladder(const LadderTask &task, CurveSource &source, uint32_t seed) {
    source.restart(seed);
    Repetition repetition;
    repetition.seed = seed;
    const uint64_t batch_spp = task.spp.back() / batches_per_seed;
    std::set<uint64_t> stops(task.spp.begin(), task.spp.end());
    for (uint64_t batch = 1; task.has_batches && batch <= batches_per_seed; ++batch) {
        stops.insert(batch * batch_spp);
    }
    const auto is_in = [](const std::vector<uint64_t> &counts, uint64_t spp) {
        return std::find(counts.begin(), counts.end(), spp) != counts.end();
    };
    uint64_t done = 0, batches = 0;
    Image before;
    for (const uint64_t spp : stops) {
        const TimedImage rendered = source.render_to(spp);
        const Image &image = rendered.image;
        if (is_in(task.spp, spp)) {
            repetition.points.push_back({spp, rendered.seconds_device, rendered.seconds_wall,
                                         compute_metrics(image, task.reference),
                                         divide_mse(image, task.reference, task.first_hits)});
        }
        if (seed == first_seed && is_in(task.early_images, spp)) {
            write_exr(image, early_file(task, spp));
        }
        if (task.has_batches && spp == (batches + 1) * batch_spp) {
            write_exr(last_batch(before, image, batches + 1), batch_file(task, seed, batches));
            before = image;
            ++batches;
        }
        task.advance(spp - done);
        done = spp;
        if (spp == task.spp.back()) {
            write_exr(image, partial_file(task, seed, "exr"));
        }
    }
    return repetition;
}

}  // namespace

LadderResult render_ladders(const LadderTask &task) {
    LadderResult result;
    std::unique_ptr<CurveSource> source;  // a resumed run may need none
    for (uint32_t seed = first_seed; seed < first_seed + task.seeds; ++seed) {
        const fs::path numbers = partial_file(task, seed, "json");
        // The measurements are written last, so the images exist if the measurements do.
        if (fs::exists(numbers)) {
            const Json stored = load_json(numbers);
            result.repetitions.push_back(parse_repetition(stored.at("repetition")));
            result.description = stored.at("description");
            task.advance(task.spp.back());
        } else {
            if (!source) {
                source = task.make_source();
            }
            result.repetitions.push_back(render_ladder(task, *source, seed));
            result.description = source->description();
            write_file(numbers, Json{{"repetition", to_json(result.repetitions.back())},
                                     {"description", result.description}}
                                    .dump());
        }
        result.images.push_back(read_exr(partial_file(task, seed, "exr")));
        for (uint64_t batch = 0; task.has_batches && batch < batches_per_seed; ++batch) {
            result.batches.push_back(read_exr(batch_file(task, seed, batch)));
        }
    }
    if (!task.has_batches) {
        result.batches = result.images;
    }
    for (const uint64_t spp : task.early_images) {
        result.early_images.push_back(read_exr(early_file(task, spp)));
    }
    return result;
}

std::vector<Image> render_fresh_batches(const LadderTask &task) {
    const uint64_t count = (task.has_batches ? batches_per_seed : 1) * task.seeds;
    return task.make_source()->independent_images(first_seed + task.seeds,
                                                  2 * task.spp.back() * task.seeds, count);
}

}  // namespace rtrays
