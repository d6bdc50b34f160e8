// SPDX-License-Identifier: MIT
#include "renderer/device/context.h"

#include <fmt/format.h>
#include <sys/mman.h>

#include <algorithm>
#include <cstdint>

#include "renderer/base/error.h"
#include "renderer/base/lower_case.h"
#include "renderer/device/pocl_cache.h"

namespace rtrays {

namespace {

std::string device_text(cl_device_id device, cl_device_info what) {
    size_t size = 0;
    check_cl(clGetDeviceInfo(device, what, 0, nullptr, &size), "querying a device");
    std::string text(size, '\0');
    check_cl(clGetDeviceInfo(device, what, size, text.data(), nullptr), "querying a device");
    text.resize(std::min(text.find('\0'), text.size()));
    return text;
}

template <typename T>
T device_value(cl_device_id device, cl_device_info what) {
    T value{};
    check_cl(clGetDeviceInfo(device, what, sizeof value, &value, nullptr), "querying a device");
    return value;
}

std::string platform_name(cl_platform_id platform) {
    char name[256] = "";
    check_cl(clGetPlatformInfo(platform, CL_PLATFORM_NAME, sizeof name - 1, name, nullptr),
             "querying a platform");
    return name;
}

DeviceInfo describe(cl_platform_id platform, cl_device_id device) {
    const std::string extensions = device_text(device, CL_DEVICE_EXTENSIONS);
    return {platform,
            device,
            device_text(device, CL_DEVICE_NAME),
            platform_name(platform),
            device_text(device, CL_DRIVER_VERSION),
            device_text(device, CL_DEVICE_OPENCL_C_VERSION),
            (device_value<cl_device_type>(device, CL_DEVICE_TYPE) & CL_DEVICE_TYPE_CPU) != 0,
            extensions.find("cl_khr_int64_base_atomics") != std::string::npos,
            (device_value<cl_device_fp_config>(device, CL_DEVICE_SINGLE_FP_CONFIG) &
             CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT) != 0,
            device_value<cl_uint>(device, CL_DEVICE_MAX_COMPUTE_UNITS),
            device_value<size_t>(device, CL_DEVICE_MAX_WORK_GROUP_SIZE),
            device_value<cl_ulong>(device, CL_DEVICE_MAX_MEM_ALLOC_SIZE),
            device_value<cl_ulong>(device, CL_DEVICE_GLOBAL_MEM_SIZE)};
}

/// A device with its index "PLATFORM:DEVICE".
struct IndexedDevice {
    std::string index;
    DeviceInfo info;
};

/// Returns the devices that `spec` selects, at least one.
std::vector<IndexedDevice> select_devices(const std::string &spec) {
    const std::vector<DeviceInfo> devices = list_devices();
    if (devices.empty()) {
        const std::string fault = pocl_cache_fault();
        const std::string opening =
            fault.empty() ? "no OpenCL device found; "
                          : fmt::format(
                                "no OpenCL device found; if PoCL is installed, it has none because "
                                "its cache cannot be written ({}): make that folder writable, or "
                                "set POCL_CACHE_DIR to another one; otherwise, ",
                                fault);
        throw input_error(opening +
                          "for the CPU, install Debian's package pocl-opencl-icd (scripts/install "
                          "does this); for a GPU, install its driver");
    }
    std::string listing;
    std::vector<std::string> index(devices.size());
    unsigned platform = 0, number = 0;
    for (size_t i = 0; i < devices.size(); ++i) {
        const bool same = i > 0 && devices[i].platform == devices[i - 1].platform;
        platform += i > 0 && !same ? 1 : 0;
        number = same ? number + 1 : 0;
        index[i] = fmt::format("{}:{}", platform, number);
        listing +=
            fmt::format("\n  {}  {}  ({})", index[i], devices[i].name, devices[i].platform_name);
    }
    std::vector<IndexedDevice> found;
    const auto find = [&](auto &&matches) {
        for (size_t i = 0; i < devices.size(); ++i) {
            if (matches(i)) {
                found.push_back({index[i], devices[i]});
            }
        }
        return !found.empty();
    };
    const auto is_gpu = [&](size_t i) { return !devices[i].is_cpu; };
    const auto is_cpu = [&](size_t i) { return devices[i].is_cpu; };
    const auto has_index = [&](size_t i) { return index[i] == spec; };
    const auto has_name = [&](size_t i) {
        return in_lower_case(devices[i].name).find(in_lower_case(spec)) != std::string::npos;
    };
    const auto any = [](size_t) { return true; };
    const bool matches = spec.empty()                   ? find(is_gpu) || find(any)
                         : in_lower_case(spec) == "gpu" ? find(is_gpu)
                         : in_lower_case(spec) == "cpu" ? find(is_cpu)
                                                        : find(has_index) || find(has_name);
    if (!matches) {
        throw input_error(
            fmt::format("no OpenCL device matches '{}'; devices are:{}", spec, listing));
    }
    return found;
}

/// Requests huge pages for a large buffer in host memory, before anything touches it. Kernels read
/// all over such a buffer, and with small pages most reads would also wait for an address
/// translation. A refusal is not an error.
void prefer_huge_pages(cl_command_queue queue, cl_mem memory, uint64_t bytes) {
    constexpr uint64_t huge_page = 1u << 21;
    if (bytes < 2 * huge_page) {
        return;
    }
    cl_int status = CL_SUCCESS;
    void *mapped = clEnqueueMapBuffer(queue, memory, CL_TRUE, CL_MAP_WRITE_INVALIDATE_REGION, 0,
                                      bytes, 0, nullptr, nullptr, &status);
    check_cl(status, "mapping a buffer");
    const auto address = reinterpret_cast<uintptr_t>(mapped);
    const uintptr_t begin = (address + huge_page - 1) / huge_page * huge_page;
    const uintptr_t end = (address + bytes) / huge_page * huge_page;
    madvise(reinterpret_cast<void *>(begin), end - begin, MADV_HUGEPAGE);
    check_cl(clEnqueueUnmapMemObject(queue, memory, mapped, 0, nullptr, nullptr),
             "unmapping a buffer");
}

}  // namespace

bool is_pocl(const DeviceInfo &device) {
    return device.platform_name.find("Portable Computing Language") != std::string::npos;
}

std::vector<DeviceInfo> list_devices() {
    cl_uint platform_count = 0;
    // The loader reports a missing platform as an error (-1001, cl_khr_icd). The result is an empty
    // list, not a failure.
    if (clGetPlatformIDs(0, nullptr, &platform_count) != CL_SUCCESS) {
        return {};
    }
    std::vector<cl_platform_id> platforms(platform_count);
    check_cl(clGetPlatformIDs(platform_count, platforms.data(), nullptr),
             "listing OpenCL platforms");
    std::vector<DeviceInfo> devices;
    for (const cl_platform_id platform : platforms) {
        // A driver whose hardware is absent must not hide the devices of other platforms.
        cl_uint count = 0;
        if (clGetDeviceIDs(platform, CL_DEVICE_TYPE_ALL, 0, nullptr, &count) != CL_SUCCESS ||
            count == 0) {
            continue;
        }
        std::vector<cl_device_id> ids(count);
        check_cl(clGetDeviceIDs(platform, CL_DEVICE_TYPE_ALL, count, ids.data(), nullptr),
                 "listing OpenCL devices");
        for (const cl_device_id id : ids) {
            devices.push_back(describe(platform, id));
        }
    }
    return devices;
}

std::vector<std::string> matching_devices(const std::string &spec) {
    std::vector<std::string> indices;
    for (const IndexedDevice &device : select_devices(spec)) {
        indices.push_back(device.index);
    }
    return indices;
}

std::shared_ptr<const BuiltProgram> RecentPrograms::find(const std::string &key) {
    const auto found = std::find_if(entries_.begin(), entries_.end(),
                                    [&](const Entry &entry) { return entry.key == key; });
    if (found == entries_.end()) {
        return nullptr;
    }
    entries_.splice(entries_.begin(), entries_, found);
    return found->program;
}

void RecentPrograms::add(const std::string &key, std::shared_ptr<const BuiltProgram> program) {
    entries_.push_front({key, std::move(program)});
    if (entries_.size() > capacity) {
        entries_.pop_back();
    }
}

DeviceContext::DeviceContext(const std::string &spec, Binaries binaries)
    : info_(select_devices(spec).front().info) {
    keeps_binaries_ = binaries == Binaries::keep || !is_pocl(info_);
    if (is_pocl(info_)) {
        explain_pocl_crashes();
    }
    cl_int status = CL_SUCCESS;
    context_ = ClContext(clCreateContext(nullptr, 1, &info_.device, nullptr, nullptr, &status));
    check_cl(status, fmt::format("creating a context on '{}'", info_.name));
    queue_ =
        ClQueue(clCreateCommandQueue(context(), info_.device, CL_QUEUE_PROFILING_ENABLE, &status));
    check_cl(status, fmt::format("creating a queue on '{}'", info_.name));
}

void DeviceContext::finish() {
    check_cl(clFinish(queue()), "waiting for the device");
    profiler_.collect();
}

ClMemory DeviceContext::allocate(const std::string &name, uint64_t bytes) {
    if (bytes > info_.max_allocation) {
        throw run_error(fmt::format(
            "buffer '{}': needs {:.1f} MiB, but '{}' allocates at most {:.1f} MiB at once; use a "
            "device with more memory, or a smaller scene, image or stream capacity",
            name, static_cast<double>(bytes) / 0x1p20, info_.name,
            static_cast<double>(info_.max_allocation) / 0x1p20));
    }
    cl_int status = CL_SUCCESS;
    ClMemory memory(clCreateBuffer(context(), CL_MEM_READ_WRITE, bytes, nullptr, &status));
    check_cl(status, fmt::format("allocating buffer '{}' of {} bytes", name, bytes));
    ++traffic_.allocations;
    if (info_.is_cpu) {
        prefer_huge_pages(queue(), memory.get(), bytes);
    }
    return memory;
}

}  // namespace rtrays
