// SPDX-License-Identifier: MIT
#include "renderer/base/resources.h"

namespace rtrays {

namespace fs = std::filesystem;

const fs::path &resource_folder() {
    static const fs::path folder = [] {
        std::error_code unknown;  // without /proc, the source folder is the answer
        const fs::path program = fs::read_symlink("/proc/self/exe", unknown);
        const fs::path installed = program.parent_path().parent_path() / "share/rtrays";
        return fs::is_directory(installed, unknown) ? installed : fs::path(RTRAYS_SOURCE);
    }();
    return folder;
}

}  // namespace rtrays
