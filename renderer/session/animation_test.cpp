// SPDX-License-Identifier: MIT
// Tests sessions of animated scenes: the film at every time, with a hierarchy that is rebuilt or
// refitted.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "renderer/import/load_scene.h"
#include "renderer/testing/session_films.h"

namespace rtrays {
namespace {

using test::device;

RenderSettings small(const std::vector<std::string> &assignments) {
    RenderSettings settings;
    settings.width = settings.height = 32;
    for (const std::string &assignment : assignments) {
        apply_setting(settings, assignment);
    }
    return settings;
}

std::vector<int64_t> render(RenderSession &session) {
    return test::film_words(session, 2);
}

/// Counts the words in which two films differ. Paths that hit two triangles at the same distance
/// cause a few differences.
size_t count_different(const std::vector<int64_t> &a, const std::vector<int64_t> &b) {
    EXPECT_EQ(a.size(), b.size());
    size_t different = 0;
    for (size_t i = 0; i < a.size(); ++i) {
        different += a[i] != b[i] ? 1 : 0;
    }
    return different;
}

Scene cloth(double time) {
    Scene scene = load_scene(RTRAYS_SCENES "/cloth/scene.json");
    scene.update(time);
    return scene;
}

TEST(Animation, EveryTimeHasItsOwnFilm) {
    const double times[] = {0.5, 2.0, 0.0};
    for (const char *layout : {"bvh2", "bvh2_stackless", "wide8"}) {
        const std::string of_layout = std::string("device.bvh_layout=") + layout;
        std::vector<std::vector<int64_t>> fresh;
        for (const double time : times) {
            RenderSession session(cloth(time), small({of_layout}), device());
            fresh.push_back(render(session));
        }
        EXPECT_GT(count_different(fresh[0], fresh[1]), fresh[0].size() / 10)
            << "the cloth must have moved";
        for (const bool refits : {false, true}) {
            RenderSession session(cloth(0),
                                  small({of_layout, refits ? "device.bvh_update=refit"
                                                           : "device.bvh_update=rebuild"}),
                                  device());
            for (size_t i = 0; i < fresh.size(); ++i) {
                session.update(cloth(times[i]));
                EXPECT_EQ(session.report().at("bvh").at("refitted"), refits);
                EXPECT_LE(count_different(render(session), fresh[i]), fresh[i].size() / 100)
                    << layout << ' ' << times[i];
            }
        }
    }
}

TEST(Animation, AnotherSceneBeginsAnew) {
    const Scene box = load_scene(RTRAYS_SCENES "/cornell_box/scene.json");
    for (const char *update : {"device.bvh_update=rebuild", "device.bvh_update=refit"}) {
        RenderSession session(cloth(0), small({update}), device());
        session.update(box);
        EXPECT_FALSE(session.report().at("bvh").at("refitted"));
        RenderSession fresh(box, small({}), device());
        EXPECT_EQ(render(session), render(fresh));
    }
}

}  // namespace
}  // namespace rtrays
