// SPDX-License-Identifier: MIT
#include "renderer/device/profiler.h"

#include <fmt/format.h>

#include "renderer/base/error.h"

namespace rtrays {

namespace {

cl_ulong event_time(cl_event event, cl_profiling_info which) {
    cl_ulong nanoseconds = 0;
    check_cl(clGetEventProfilingInfo(event, which, sizeof nanoseconds, &nanoseconds, nullptr),
             "reading an event's time");
    return nanoseconds;
}

}  // namespace

void Profiler::collect() {
    for (const auto &[stage, event] : pending_) {
        cl_int status = CL_COMPLETE;
        check_cl(clGetEventInfo(event.get(), CL_EVENT_COMMAND_EXECUTION_STATUS, sizeof status,
                                &status, nullptr),
                 "reading an event's status");
        if (status < 0) {
            throw run_error(
                fmt::format("a kernel failed on the device: {}", cl_status_name(status)));
        }
        const cl_ulong begin = event_time(event.get(), CL_PROFILING_COMMAND_START);
        const cl_ulong end = event_time(event.get(), CL_PROFILING_COMMAND_END);
        stage->seconds += 1e-9 * static_cast<double>(end - begin);
        stage->launches += 1;
    }
    pending_.clear();
}

std::map<std::string, Profiler::Stage> Profiler::take() {
    collect();
    return std::exchange(stages_, {});
}

double total_seconds(const std::map<std::string, Profiler::Stage> &stages) {
    double seconds = 0;
    for (const auto &[name, stage] : stages) {
        seconds += stage.seconds;
    }
    return seconds;
}

}  // namespace rtrays
