// SPDX-License-Identifier: MIT
#include "renderer/device/opencl.h"

#include <fmt/format.h>

#include "renderer/base/error.h"

namespace rtrays {

std::string cl_status_name(cl_int status) {
    switch (status) {
#define RTRAYS_STATUS(name) \
    case name:              \
        return #name;
        RTRAYS_STATUS(CL_SUCCESS)
        RTRAYS_STATUS(CL_DEVICE_NOT_FOUND)
        RTRAYS_STATUS(CL_DEVICE_NOT_AVAILABLE)
        RTRAYS_STATUS(CL_COMPILER_NOT_AVAILABLE)
        RTRAYS_STATUS(CL_MEM_OBJECT_ALLOCATION_FAILURE)
        RTRAYS_STATUS(CL_OUT_OF_RESOURCES)
        RTRAYS_STATUS(CL_OUT_OF_HOST_MEMORY)
        RTRAYS_STATUS(CL_PROFILING_INFO_NOT_AVAILABLE)
        RTRAYS_STATUS(CL_BUILD_PROGRAM_FAILURE)
        RTRAYS_STATUS(CL_INVALID_VALUE)
        RTRAYS_STATUS(CL_INVALID_DEVICE)
        RTRAYS_STATUS(CL_INVALID_BINARY)
        RTRAYS_STATUS(CL_INVALID_BUILD_OPTIONS)
        RTRAYS_STATUS(CL_INVALID_PROGRAM_EXECUTABLE)
        RTRAYS_STATUS(CL_INVALID_KERNEL_NAME)
        RTRAYS_STATUS(CL_INVALID_ARG_INDEX)
        RTRAYS_STATUS(CL_INVALID_ARG_VALUE)
        RTRAYS_STATUS(CL_INVALID_ARG_SIZE)
        RTRAYS_STATUS(CL_INVALID_KERNEL_ARGS)
        RTRAYS_STATUS(CL_INVALID_WORK_GROUP_SIZE)
        RTRAYS_STATUS(CL_INVALID_BUFFER_SIZE)
        RTRAYS_STATUS(CL_INVALID_OPERATION)
#undef RTRAYS_STATUS
        default:
            return fmt::format("OpenCL status {}", status);
    }
}

void check_cl(cl_int status, const std::string &what) {
    if (status != CL_SUCCESS) {
        throw run_error(fmt::format("{}: {}", what, cl_status_name(status)));
    }
}

}  // namespace rtrays
