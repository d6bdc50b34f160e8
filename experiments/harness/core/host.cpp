// SPDX-License-Identifier: MIT
#include "experiments/harness/core/host.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <algorithm>
#include <ctime>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "renderer/base/commit.h"
#include "renderer/base/error.h"
#include "renderer/device/program.h"

namespace rtrays {

namespace {

std::string cpu_name() {
    std::ifstream file("/proc/cpuinfo");
    for (std::string line; std::getline(file, line);) {
        if (line.rfind("model name", 0) == 0) {
            return line.substr(line.find(':') + 2);
        }
    }
    return "unknown";
}

double seconds(const timeval &time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

}  // namespace

Json describe_host() {
    utsname system{};
    uname(&system);
    return {{"cpu", cpu_name()},
            {"cores", std::thread::hardware_concurrency()},
            {"kernel", fmt::format("{} {}", system.sysname, system.release)},
            {"compiler", RTRAYS_COMPILER},
            {"build_type", RTRAYS_BUILD_TYPE}};
}

Json load_average() {
    double load[3] = {};
    if (getloadavg(load, 3) != 3) {
        throw run_error("cannot read the load average; the load of the machine is unknown");
    }
    return {load[0], load[1], load[2]};
}

std::string utc_now() {
    const std::time_t now = std::time(nullptr);
    std::tm utc{};
    gmtime_r(&now, &utc);
    char text[32];
    std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &utc);
    return text;
}

void CpuMeter::start() {
    start_ = read();
}

CpuMeter::Ticks CpuMeter::read() {
    std::ifstream file("/proc/stat");
    std::string label;
    double user = 0, nice = 0, system = 0, idle = 0, iowait = 0, irq = 0, softirq = 0, steal = 0;
    if (!(file >> label >> user >> nice >> system >> idle >> iowait >> irq >> softirq >> steal)) {
        throw run_error("cannot read /proc/stat; the load of the machine is unknown");
    }
    const auto per_second = static_cast<double>(sysconf(_SC_CLK_TCK));
    rusage own{};
    getrusage(RUSAGE_SELF, &own);
    const double busy = user + nice + system + irq + softirq;
    return {(busy + idle + iowait + steal) / per_second, busy / per_second, steal / per_second,
            seconds(own.ru_utime) + seconds(own.ru_stime)};
}

CpuUse CpuMeter::use() const {
    const Ticks now = read();
    // /proc/stat counts full ticks, so an interval shorter than one tick has no total.
    const double total = std::max(now.total - start_.total, 0.01);
    const double own = now.own - start_.own;
    // The process' own time is finer than ticks. On an idle machine the difference may therefore be
    // slightly negative.
    return {own / total, std::max(0.0, now.busy - start_.busy - own) / total,
            (now.steal - start_.steal) / total};
}

uint32_t host_threads(const DeviceInfo &device) {
    return device.is_cpu ? device.compute_units : std::max(1u, std::thread::hardware_concurrency());
}

Json describe_device(const DeviceInfo &device) {
    return {{"name", device.name},
            {"type", device.is_cpu ? "cpu" : "gpu"},
            {"platform", device.platform_name},
            {"driver", device.driver},
            {"c_version", device.c_version},
            {"compute_units", device.compute_units}};
}

RunContext::RunContext() : started_at_(utc_now()), load_average_(load_average()) {}

Json RunContext::finish(const DeviceInfo &device) const {
    const CpuUse use = meter_.use();
    return {{"commit", commit()},
            {"dirty", built_from_changed_sources()},
            {"started_at", started_at_},
            {"finished_at", utc_now()},
            {"host", describe_host()},
            {"device", describe_device(device)},
            {"kernel_options", program_options(device)},
            {"load_average_start", load_average_},
            {"load_average_end", load_average()},
            {"cpu_use", {{"own", use.own}, {"foreign", use.foreign}, {"steal", use.steal}}}};
}

}  // namespace rtrays
