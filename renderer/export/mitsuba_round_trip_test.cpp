// SPDX-License-Identifier: MIT
// Tests that scenes exported for Mitsuba and imported again render to the same image bits.
#include <gtest/gtest.h>

#include <filesystem>

#include "renderer/device/context.h"
#include "renderer/export/mitsuba_xml.h"
#include "renderer/import/load_scene.h"
#include "renderer/session/render_session.h"
#include "renderer/testing/mitsuba_scenes.h"

namespace rtrays {
namespace {

Image render(const Scene &scene) {
    DeviceContext device;
    RenderSettings settings;
    settings.width = settings.height = 32;
    RenderSession session(scene, settings, device);
    session.render(0, 4);
    return session.develop();
}

class MitsubaRoundTrip : public WithImages, public testing::WithParamInterface<const char *> {};

TEST_P(MitsubaRoundTrip, KeepsTheImageBits) {
    const Scene scene = load_scene(std::string(RTRAYS_SCENES) + "/" + GetParam() + ".json");
    const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "out.xml";
    export_mitsuba_xml(scene, file);
    const Notices silent;
    const Image before = render(scene), after = render(load_scene(file.string()));
    double sum = 0;
    for (const std::string &name : rgb_names()) {
        EXPECT_EQ(before.channel(name), after.channel(name));
        for (const float value : before.channel(name)) {
            sum += static_cast<double>(value);
        }
    }
    EXPECT_GT(sum, 0);
}

INSTANTIATE_TEST_SUITE_P(Scenes, MitsubaRoundTrip,
                         testing::Values("cornell_box/scene", "features/combined_lights",
                                         "features/rough_glass_ggx", "features/texture_sphere",
                                         "features/thin_lens"),
                         [](const auto &tested) {
                             const std::string path = tested.param;
                             return path.substr(0, path.find('/')) + "_" +
                                    path.substr(path.find('/') + 1);
                         });

}  // namespace
}  // namespace rtrays
