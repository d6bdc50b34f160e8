// SPDX-License-Identifier: MIT
// Wrappers of OpenCL's C API: every status is checked, and handles own their objects.
#pragma once

#define CL_TARGET_OPENCL_VERSION 120
#include <CL/cl.h>

#include <string>
#include <utility>

namespace rtrays {

/// Throws `Error` (run failed) with the name of `status` unless it is CL_SUCCESS. `what` describes
/// the attempted operation.
void check_cl(cl_int status, const std::string &what);

/// Returns the name of a status, for instance "CL_OUT_OF_RESOURCES".
std::string cl_status_name(cl_int status);

/// Owns one reference to an OpenCL object.
template <typename T, cl_int (*release)(T)>
class ClHandle {
  public:
    ClHandle() = default;
    explicit ClHandle(T object) : object_(object) {}
    ClHandle(ClHandle &&other) noexcept : object_(std::exchange(other.object_, nullptr)) {}
    ClHandle &operator=(ClHandle &&other) noexcept {
        std::swap(object_, other.object_);
        return *this;
    }
    ~ClHandle() {
        if (object_ != nullptr) {
            release(object_);
        }
    }

    T get() const { return object_; }

  private:
    T object_ = nullptr;
};

using ClContext = ClHandle<cl_context, clReleaseContext>;
using ClQueue = ClHandle<cl_command_queue, clReleaseCommandQueue>;
using ClProgram = ClHandle<cl_program, clReleaseProgram>;
using ClKernel = ClHandle<cl_kernel, clReleaseKernel>;
using ClMemory = ClHandle<cl_mem, clReleaseMemObject>;
using ClEvent = ClHandle<cl_event, clReleaseEvent>;

}  // namespace rtrays
