// SPDX-License-Identifier: MIT
#include "renderer/export/export_scene.h"

#include <fmt/format.h>

#include "renderer/base/error.h"
#include "renderer/export/blender_scene.h"
#include "renderer/export/mitsuba_xml.h"

namespace rtrays {

namespace {

struct Format {
    const char *ending;
    const char *renderer;
    void (*write)(const Scene &, const std::filesystem::path &, const ExportSettings &);
};

constexpr Format formats[] = {{".xml", "Mitsuba 3", &export_mitsuba_xml},
                              {".blender.json", "Blender's Cycles", &export_blender_scene}};

const Format &format_of(const std::filesystem::path &path) {
    const std::string name = path.filename().string();
    std::string known;
    for (const Format &format : formats) {
        const std::string ending = format.ending;
        if (name.size() > ending.size() &&
            name.compare(name.size() - ending.size(), ending.size(), ending) == 0) {
            return format;
        }
        known +=
            fmt::format("{}{} ({})", known.empty() ? "" : " or ", format.ending, format.renderer);
    }
    throw input_error(
        fmt::format("{}: unknown format of an exported scene; the file name must end in {}",
                    path.string(), known));
}

}  // namespace

void export_scene(const Scene &scene, const std::filesystem::path &path,
                  const ExportSettings &settings) {
    format_of(path).write(scene, path, settings);
}

void require_export_name(const std::filesystem::path &path) {
    format_of(path);
}

}  // namespace rtrays
