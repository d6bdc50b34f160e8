// SPDX-License-Identifier: MIT
#include "experiments/ladder.h"

#include <fmt/format.h>

#include <memory>

#include "renderer/base/files.h"
#include "renderer/base/progress.h"

namespace rtrays {

namespace fs = std::filesystem;

namespace {

fs::path partial_file(const LadderTask &task, uint32_t seed, const char *extension) {
    return task.partial / fmt::format("{}.seed{}.{}", CurveDescription{task.settings}.id(), seed, extension);
}

/// The session is made when the first seed needs it: a resumed run may need none.
class LazySession {
  public:
    explicit LazySession(const LadderTask &task) : task_(task) {}

    RenderSession &get() {
        if (!session_) {
            session_ = std::make_unique<RenderSession>(task_.scene, task_.settings, task_.device);
        }
        return *session_;
    }

  private:
    const LadderTask &task_;
    std::unique_ptr<RenderSession> session_;
};

Repetition render_ladder(const LadderTask &task, RenderSession &session, uint32_t seed) {
    session.restart(seed);
    Repetition repetition;
    repetition.seed = seed;
    uint64_t done = 0;
    for (uint64_t spp : task.spp) {
        render_whole(session, done, spp);
        const RenderStats stats = session.stats();
        repetition.points.push_back({spp, stats.device_seconds, stats.wall_seconds,
                                     compute_metrics(session.develop(), task.reference)});
        task.advance(spp - done);
        done = spp;
    }
    return repetition;
}

}  // namespace

LadderResult render_ladders(const LadderTask &task) {
    LadderResult result;
    LazySession session(task);
    for (uint32_t seed = 1; seed <= static_cast<uint32_t>(task.seeds); ++seed) {
        const fs::path numbers = partial_file(task, seed, "json"), picture = partial_file(task, seed, "exr");
        // The numbers are written last: where they are, the picture is.
        if (fs::exists(numbers)) {
            const Json stored = load_json(numbers);
            result.repetitions.push_back(parse_repetition(stored.at("repetition")));
            result.cost = stored.at("cost");
            result.images.push_back(read_exr(picture));
            task.advance(task.spp.back());
            continue;
        }
        result.repetitions.push_back(render_ladder(task, session.get(), seed));
        const RenderStats stats = session.get().stats();
        result.cost = {{"compile_seconds", stats.compile_seconds},
                       {"bvh_seconds", stats.bvh_seconds},
                       {"render_report", session.get().report()}};
        result.images.push_back(session.get().develop());
        write_exr(result.images.back(), picture);
        write_file(numbers,
                   Json{{"repetition", to_json(result.repetitions.back())}, {"cost", result.cost}}.dump());
    }
    return result;
}

}  // namespace rtrays
