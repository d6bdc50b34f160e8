// SPDX-License-Identifier: MIT
#include "experiments/harness/models/tracers.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <thread>
#include <utility>

#include "renderer/base/error.h"

namespace rtrays {

namespace {

/// Flattens vertices or triangles into an array of their three components.
template <typename Number, typename Three>
std::vector<Number> numbers_of(const std::vector<Three> &all) {
    std::vector<Number> numbers;
    numbers.reserve(3 * all.size());
    for (const Three &three : all) {
        numbers.insert(numbers.end(), three.data(), three.data() + 3);
    }
    return numbers;
}

Defines defines(BvhLayout layout, bool counts) {
    return {{"BVH_LAYOUT", std::to_string(static_cast<uint32_t>(layout))},
            {"TRAVERSAL_COUNTS", counts ? "1" : "0"}};
}

constexpr size_t packet_size = 16;

/// Sets one lane of a packet.
void set_ray(RTCRay16 &packet, size_t lane, const RayRecord &ray) {
    packet.org_x[lane] = ray.origin[0];
    packet.org_y[lane] = ray.origin[1];
    packet.org_z[lane] = ray.origin[2];
    packet.dir_x[lane] = ray.direction[0];
    packet.dir_y[lane] = ray.direction[1];
    packet.dir_z[lane] = ray.direction[2];
    packet.tnear[lane] = 0;
    packet.tfar[lane] = ray.t_max;
    packet.time[lane] = 0;
    packet.mask[lane] = ~0u;
    packet.flags[lane] = 0;
}

/// Traces the rays [begin, end) in packets of sixteen and returns the number of hits.
size_t trace_packets(RTCScene scene, const std::vector<RayRecord> &rays, size_t begin, size_t end,
                     Query query, bool coherent) {
    size_t found = 0;
    for (size_t first = begin; first < end; first += packet_size) {
        const size_t lanes = std::min(packet_size, end - first);
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        context.flags =
            coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
        alignas(64) int valid[packet_size] = {};
        RTCRayHit16 packet{};
        for (size_t lane = 0; lane < lanes; ++lane) {
            valid[lane] = -1;
            set_ray(packet.ray, lane, rays[first + lane]);
            packet.hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
            packet.hit.instID[0][lane] = RTC_INVALID_GEOMETRY_ID;
        }
        if (query == Query::nearest) {
            rtcIntersect16(valid, scene, &context, &packet);
        } else {
            rtcOccluded16(valid, scene, &context, &packet.ray);
        }
        for (size_t lane = 0; lane < lanes; ++lane) {
            const bool hit = query == Query::nearest
                                 ? packet.hit.geomID[lane] != RTC_INVALID_GEOMETRY_ID
                                 : packet.ray.tfar[lane] < 0;
            found += hit ? 1 : 0;
        }
    }
    return found;
}

}  // namespace

std::vector<HierarchyVariant> hierarchy_variants(const DeviceInfo &device) {
    const BvhBuildParameters usual = BvhBuildParameters::for_device(device);
    std::vector<HierarchyVariant> variants;
    const auto add = [&](BvhMethod method, BvhLayout layout) {
        BvhBuildParameters parameters = usual;
        parameters.method = method;
        parameters.layout = layout;
        variants.push_back(
            {fmt::format("{} {}", to_string(method), to_string(layout)), parameters});
    };
    for (const Named<BvhLayout> &named : bvh_layouts) {
        add(usual.method, named.value);
    }
    for (const Named<BvhMethod> &named : bvh_methods) {
        if (named.value != usual.method) {
            add(named.value, usual.layout);
        }
    }
    return variants;
}

DeviceMesh::DeviceMesh(DeviceContext &device, const test::Mesh &mesh)
    : positions(device, "positions", numbers_of<float>(mesh.positions)),
      indices(device, "indices", numbers_of<uint32_t>(mesh.triangles)) {}

DeviceRays::DeviceRays(DeviceContext &device, const std::vector<RayRecord> &records, Query asked)
    : query(asked),
      count(static_cast<uint32_t>(records.size())),
      rays(device, "rays", records),
      hits(device, "hits", asked == Query::nearest ? records.size() : 1),
      occlusion(device, "occlusion", asked == Query::any ? records.size() : 1) {}

size_t DeviceRays::hit_count() const {
    if (query == Query::any) {
        const std::vector<uint32_t> flags = occlusion.read();
        return std::accumulate(flags.begin(), flags.end(), size_t{0});
    }
    const std::vector<Hit> found = hits.read();
    return static_cast<size_t>(std::count_if(
        found.begin(), found.end(), [](const Hit &hit) { return hit.triangle != NO_HIT; }));
}

DeviceTracer::DeviceTracer(DeviceContext &device, Bvh bvh)
    : device_(&device),
      bvh_(std::move(bvh)),
      trace_(device, {"kernels/traversal/trace_rays.cl"}, defines(bvh_.layout(), false)),
      count_(device, {"kernels/traversal/trace_rays.cl"}, defines(bvh_.layout(), true)) {}

template <typename T>
Kernel DeviceTracer::kernel(const Program &program, const std::string &name, const DeviceRays &rays,
                            const Buffer<T> &results) const {
    Kernel kernel(program, name, 64);
    bvh_.visit([&](const auto &nodes, const auto &triangles) {
        kernel.bind({nodes, triangles, rays.rays, rays.count, results});
    });
    return kernel;
}

void DeviceTracer::trace(const DeviceRays &rays) const {
    Kernel query = rays.query == Query::nearest
                       ? kernel(trace_, "trace_nearest_rays", rays, rays.hits)
                       : kernel(trace_, "trace_any_rays", rays, rays.occlusion);
    query.enqueue(rays.count);
    device_->finish();
}

std::pair<double, double> DeviceTracer::work_per_ray(const DeviceRays &rays) const {
    const Buffer<RayWork> work(*device_, "work of rays", rays.count);
    kernel(count_, rays.query == Query::nearest ? "count_nearest_rays" : "count_any_rays", rays,
           work)
        .enqueue(rays.count);
    device_->finish();
    double nodes = 0, triangles = 0;
    for (const RayWork &ray : work.read()) {
        nodes += ray.nodes;
        triangles += ray.triangles;
    }
    return {nodes / rays.count, triangles / rays.count};
}

const char *name_of(EmbreeCall call, Query query) {
    static const char *const names[2][2] = {{"rtcIntersect1", "rtcOccluded1"},
                                            {"rtcIntersect16", "rtcOccluded16"}};
    return names[call == EmbreeCall::packets ? 1 : 0][query == Query::any ? 1 : 0];
}

std::vector<EmbreeIsa> embree_isas() {
    std::vector<EmbreeIsa> present;
    for (const EmbreeIsa &isa :
         {EmbreeIsa{"sse4.2", 128}, EmbreeIsa{"avx2", 256}, EmbreeIsa{"avx512", 512}}) {
        if (const RTCDevice device =
                rtcNewDevice(fmt::format("threads=1,isa={}", isa.name).c_str())) {
            rtcReleaseDevice(device);
            present.push_back(isa);
        }
    }
    if (present.empty()) {
        throw Error(ExitCode::run_failed, "Embree needs a processor with SSE4.2");
    }
    return present;
}

EmbreeTracer::EmbreeTracer(const test::Mesh &mesh, uint32_t threads, const EmbreeIsa &isa)
    : isa_(isa.name),
      threads_(threads),
      scene_(mesh, fmt::format("threads={},isa={},frequency_level=simd{}", threads, isa.name,
                               isa.width)) {}

template <typename Work>
size_t EmbreeTracer::on_all_threads(size_t count, const Work &work) const {
    std::vector<size_t> found(threads_);
    std::vector<std::thread> workers;
    for (size_t worker = 0; worker < threads_; ++worker) {
        workers.emplace_back([&, worker] {
            found[worker] = work(count * worker / threads_, count * (worker + 1) / threads_);
        });
    }
    for (std::thread &worker : workers) {
        worker.join();
    }
    return std::accumulate(found.begin(), found.end(), size_t{0});
}

size_t EmbreeTracer::trace(const std::vector<RayRecord> &rays, Query query, EmbreeCall call,
                           bool coherent) const {
    return on_all_threads(rays.size(), [&](size_t begin, size_t end) {
        if (call == EmbreeCall::packets) {
            return trace_packets(scene_.scene(), rays, begin, end, query, coherent);
        }
        size_t found = 0;
        for (size_t i = begin; i < end; ++i) {
            const bool hit = query == Query::nearest ? scene_.nearest(rays[i]) < rays[i].t_max
                                                     : scene_.occluded(rays[i]);
            found += hit ? 1 : 0;
        }
        return found;
    });
}

std::vector<float> EmbreeTracer::nearest(const std::vector<RayRecord> &rays) const {
    std::vector<float> distances(rays.size());
    on_all_threads(rays.size(), [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) {
            distances[i] = scene_.nearest(rays[i]);
        }
        return size_t{0};
    });
    return distances;
}

std::vector<std::unique_ptr<EmbreeTracer>> embree_tracers(const test::Mesh &mesh,
                                                          uint32_t threads) {
    std::vector<std::unique_ptr<EmbreeTracer>> tracers;
    for (const EmbreeIsa &isa : embree_isas()) {
        tracers.push_back(std::make_unique<EmbreeTracer>(mesh, threads, isa));
    }
    return tracers;
}

}  // namespace rtrays
