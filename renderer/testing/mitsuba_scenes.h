// SPDX-License-Identifier: MIT
// Helpers that parse small Mitsuba scenes in tests.
#pragma once

#include <string>
#include <vector>

#include "renderer/base/notice.h"
#include "renderer/import/mitsuba/mitsuba_xml.h"
#include "renderer/testing/scene_builder.h"

namespace rtrays {

/// Returns a valid scene that contains the elements of `body`, which begins in line 3.
inline std::string mitsuba_scene(const std::string &body) {
    return R"(<scene version="3.0.0">
<sensor type="perspective" id="eye"><float name="fov" value="60"/><film type="hdrfilm"><integer name="width" value="8"/><integer name="height" value="4"/></film></sensor>
)" + body + "\n</scene>";
}

/// Collects notices, instead of printing them, during its lifetime.
class Notices {
  public:
    const std::vector<std::string> &texts() const { return texts_; }

  private:
    std::vector<std::string> texts_;
    NoticeReceiver receiver_{[this](const std::string &text) { texts_.push_back(text); }};
};

inline Scene parse_mitsuba(const std::string &text) {
    const Notices silent;
    return parse_mitsuba_xml(text, "in.xml", "in", testing::TempDir());
}

inline Scene parse_elements(const std::string &body) {
    return parse_mitsuba(mitsuba_scene(body));
}

}  // namespace rtrays
