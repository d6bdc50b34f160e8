// SPDX-License-Identifier: MIT
#include <utility>

#include "experiments/harness/core/rendering.h"
#include "experiments/harness/kinds/curve_source.h"

namespace rtrays {

namespace {

class SessionSource : public CurveSource {
  public:
    SessionSource(SharedScenes &scenes, RenderSettings settings)
        : settings_(std::move(settings)), session_(scenes.session(settings_)) {}

    void restart(uint32_t seed) override {
        session_.restart(seed);
        done_ = 0;
    }

    TimedImage render_to(uint64_t spp) override {
        render_whole(session_, done_, spp);
        done_ = spp;
        const RenderStats stats = session_.stats();
        return {session_.develop(), stats.device_seconds, stats.wall_seconds};
    }

    std::vector<Image> independent_images(uint32_t seed, uint64_t spp, uint64_t count) override {
        return render_batches(session_, seed, spp, count);
    }

    nlohmann::json description() const override {
        const RenderStats stats = session_.stats();
        return {{"algorithm", settings_.algorithm->name},
                {"strategies", name_in(path_strategies, settings_.strategies)},
                {"settings", image_settings(settings_)},
                {"compile_seconds", stats.compile_seconds},
                {"bvh_seconds", stats.bvh_seconds},
                {"render_report", session_.report()}};
    }

  private:
    RenderSettings settings_;
    RenderSession session_;
    uint64_t done_ = 0;
};

}  // namespace

std::unique_ptr<CurveSource> session_source(SharedScenes &scenes, const RenderSettings &settings) {
    return std::make_unique<SessionSource>(scenes, settings);
}

}  // namespace rtrays
