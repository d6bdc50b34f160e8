// SPDX-License-Identifier: MIT
#include "renderer/base/commit.h"

#include "renderer/base/files.h"
#include "rtrays_commit.h"

namespace rtrays {

namespace {

// Volatile, so that the optimizer cannot split the text into instructions, where program_hash()
// would not find it.
const char *volatile const stamp = RTRAYS_COMMIT;

}  // namespace

std::string commit() {
    return stamp;
}

bool built_from_changed_sources() {
    return RTRAYS_DIRTY;
}

std::string version() {
    return RTRAYS_DIRTY ? commit() + "-dirty" : commit();
}

std::string program_version(const std::string &program) {
    return program + " " + RTRAYS_VERSION + " (" + version() + ")";
}

std::string program_hash() {
    std::string program = read_file("/proc/self/exe");
    const std::string text = commit();
    for (size_t at = program.find(text); at != std::string::npos; at = program.find(text, at)) {
        program.replace(at, text.size(), text.size(), '-');
    }
    return content_hash(program);
}

}  // namespace rtrays
