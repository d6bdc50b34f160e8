// SPDX-License-Identifier: MIT
#include "renderer/device/kernel.h"

#include <cxxabi.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdlib>
#include <map>
#include <memory>

namespace rtrays {

namespace {

std::string argument_type(cl_kernel kernel, cl_uint index) {
    char name[256] = "";
    if (clGetKernelArgInfo(kernel, index, CL_KERNEL_ARG_TYPE_NAME, sizeof name - 1, name,
                           nullptr) != CL_SUCCESS) {
        return {};  // programs loaded from a binary may lack this information
    }
    return name;
}

}  // namespace

std::string KernelArgument::type_name(const std::type_info &type) {
    static const std::map<std::string, std::string> fundamental = {{"unsigned int", "uint"},
                                                                   {"unsigned long", "ulong"}};
    const std::unique_ptr<char, decltype(&std::free)> demangled(
        abi::__cxa_demangle(type.name(), nullptr, nullptr, nullptr), &std::free);
    const std::string name = demangled.get();
    const auto found = fundamental.find(name);
    return found == fundamental.end() ? name : found->second;
}

Kernel::Kernel(const Program &program, const std::string &name, uint32_t group_size)
    : device_(&program.device()), name_(name), group_size_(group_size) {
    cl_int status = CL_SUCCESS;
    kernel_ = ClKernel(clCreateKernel(program.get(), name.c_str(), &status));
    check_cl(status,
             fmt::format("creating kernel '{}' of {}", name, fmt::join(program.paths(), ", ")));
    cl_uint count = 0;
    check_cl(clGetKernelInfo(kernel_.get(), CL_KERNEL_NUM_ARGS, sizeof count, &count, nullptr),
             "querying kernel " + name);
    for (cl_uint i = 0; i < count; ++i) {
        types_.push_back(argument_type(kernel_.get(), i));
    }
}

void Kernel::bind(const std::vector<KernelArgument> &arguments) {
    require_argument_count(arguments.size());
    for (uint32_t i = 0; i < arguments.size(); ++i) {
        bind(i, arguments[i]);
    }
}

void Kernel::require_argument_count(size_t count) const {
    if (count != types_.size()) {
        throw run_error(
            fmt::format("kernel '{}': expected {} arguments, got {}", name_, types_.size(), count));
    }
}

void Kernel::bind(uint32_t index, const KernelArgument &argument) {
    if (index >= types_.size()) {
        throw run_error(fmt::format("kernel '{}': expected an argument index below {}, got {}",
                                    name_, types_.size(), index));
    }
    if (!types_[index].empty() && types_[index] != argument.type()) {
        throw run_error(fmt::format("argument {} of kernel '{}': expected '{}', got '{}'", index,
                                    name_, types_[index], argument.type()));
    }
    check_cl(clSetKernelArg(kernel_.get(), index, argument.bytes().size(), argument.bytes().data()),
             fmt::format("binding argument {} of kernel '{}'", index, name_));
}

void Kernel::enqueue(uint64_t items) {
    if (items == 0) {
        return;
    }
    const size_t local = group_size_;
    const size_t global = (items + local - 1) / local * local;
    cl_event event = nullptr;
    check_cl(clEnqueueNDRangeKernel(device_->queue(), kernel_.get(), 1, nullptr, &global, &local, 0,
                                    nullptr, &event),
             fmt::format("launching kernel '{}' with {} work-items", name_, global));
    device_->profiler().add(name_, ClEvent(event));
    ++device_->traffic().launches;
}

}  // namespace rtrays
