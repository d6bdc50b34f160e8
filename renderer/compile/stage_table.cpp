// SPDX-License-Identifier: MIT
#include "renderer/compile/stage_table.h"

#include <algorithm>

namespace rtrays {

bool StageDescription::reads(StageInput input) const {
    return std::find(inputs.begin(), inputs.end(), input) != inputs.end();
}

const StageDescription &stage_description(Stage stage) {
    using In = StageInput;
    static const std::vector<StageDescription> table = {
#define RTRAYS_STAGE(name, program, file, items, ...) \
    {#name, StageProgram::program, file, StageItems::items, {__VA_ARGS__}},
        RTRAYS_STAGES(RTRAYS_STAGE)
#undef RTRAYS_STAGE
    };
    return table[static_cast<size_t>(stage)];
}

const char *to_string(Stage stage) {
    return stage_description(stage).name;
}

}  // namespace rtrays
