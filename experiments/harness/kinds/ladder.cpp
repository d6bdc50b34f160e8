// SPDX-License-Identifier: MIT
#include "experiments/harness/kinds/ladder.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <set>

#include "renderer/base/files.h"
#include "renderer/base/progress.h"

namespace rtrays {

namespace fs = std::filesystem;

namespace {

fs::path partial_file(const LadderTask &task, uint32_t seed, const std::string &extension) {
    return task.partial /
           fmt::format("{}.seed{}.{}", CurveDescription{task.settings}.id(), seed, extension);
}

constexpr uint32_t first_seed = 1;

fs::path early_file(const LadderTask &task, uint64_t spp) {
    return partial_file(task, first_seed, fmt::format("{}spp.exr", spp));
}

/// Creates the session when the first seed needs it. A resumed run may need none.
class LazySession {
  public:
    explicit LazySession(const LadderTask &task) : task_(task) {}

    RenderSession &get() {
        if (!session_) {
            session_ = std::make_unique<RenderSession>(task_.scenes.session(task_.settings));
        }
        return *session_;
    }

  private:
    const LadderTask &task_;
    std::unique_ptr<RenderSession> session_;
};

fs::path batch_file(const LadderTask &task, uint32_t seed, uint64_t batch) {
    return partial_file(task, seed, fmt::format("batch{}.exr", batch));
}

/// Renders the ladder of one seed and writes its batches and early images.
Repetition render_ladder(const LadderTask &task, RenderSession &session, uint32_t seed) {
    session.restart(seed);
    Repetition repetition;
    repetition.seed = seed;
    const uint64_t batch_spp = task.spp.back() / batches_per_seed;
    std::set<uint64_t> stops(task.spp.begin(), task.spp.end());
    for (uint64_t batch = 1; batch <= batches_per_seed; ++batch) {
        stops.insert(batch * batch_spp);
    }
    const auto is_in = [](const std::vector<uint64_t> &counts, uint64_t spp) {
        return std::find(counts.begin(), counts.end(), spp) != counts.end();
    };
    uint64_t done = 0, batches = 0;
    Image before;
    for (const uint64_t spp : stops) {
        render_whole(session, done, spp);
        const RenderStats stats = session.stats();
        const Image image = session.develop();
        if (is_in(task.spp, spp)) {
            repetition.points.push_back({spp, stats.device_seconds, stats.wall_seconds,
                                         compute_metrics(image, task.reference),
                                         divide_mse(image, task.reference, task.first_hits)});
        }
        if (seed == first_seed && is_in(task.early_images, spp)) {
            write_exr(image, early_file(task, spp));
        }
        if (spp == (batches + 1) * batch_spp) {
            write_exr(last_batch(before, image, batches + 1), batch_file(task, seed, batches));
            before = image;
            ++batches;
        }
        task.advance(spp - done);
        done = spp;
    }
    return repetition;
}

}  // namespace

LadderResult render_ladders(const LadderTask &task) {
    LadderResult result;
    LazySession session(task);
    for (uint32_t seed = first_seed; seed < first_seed + task.seeds; ++seed) {
        const fs::path numbers = partial_file(task, seed, "json"),
                       picture = partial_file(task, seed, "exr");
        // The measurements are written last, so the images exist if the measurements do.
        if (fs::exists(numbers)) {
            const Json stored = load_json(numbers);
            result.repetitions.push_back(parse_repetition(stored.at("repetition")));
            result.cost = stored.at("cost");
            result.images.push_back(read_exr(picture));
            task.advance(task.spp.back());
        } else {
            result.repetitions.push_back(render_ladder(task, session.get(), seed));
            const RenderStats stats = session.get().stats();
            result.cost = {{"compile_seconds", stats.compile_seconds},
                           {"bvh_seconds", stats.bvh_seconds},
                           {"render_report", session.get().report()}};
            result.images.push_back(session.get().develop());
            write_exr(result.images.back(), picture);
            write_file(numbers, Json{{"repetition", to_json(result.repetitions.back())},
                                     {"cost", result.cost}}
                                    .dump());
        }
        for (uint64_t batch = 0; batch < batches_per_seed; ++batch) {
            result.batches.push_back(read_exr(batch_file(task, seed, batch)));
        }
    }
    if (task.settings.sampler == Sampler::sobol) {
        result.batches = result.images;
    }
    for (const uint64_t spp : task.early_images) {
        result.early_images.push_back(read_exr(early_file(task, spp)));
    }
    return result;
}

std::vector<Image> render_fresh_batches(const LadderTask &task) {
    RenderSession session = task.scenes.session(task.settings);
    return render_batches(session, first_seed + task.seeds, 2 * task.spp.back() * task.seeds,
                          batches_per_seed * task.seeds);
}

}  // namespace rtrays
