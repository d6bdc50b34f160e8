// SPDX-License-Identifier: MIT
// The common subset of OpenCL C 1.2 and C++17 in which all device functions are written.
//
// Tests compile the shipped kernel code for the host. Rules of the subset, enforced by
// scripts/lint:
// - Vectors are made by make_float2/3/4, never by literals: in C++ `(float4)(1, 2, 3, 4)` silently
//   yields 4, 4, 4, 4.
// - Components are accessed as .x .y .z .w, without swizzles.
// - There are no double literals and no implicit conversions between address spaces.
//
// Floating-point contraction is off everywhere. Both compilers therefore produce the same bits, and
// the edge functions of the triangle test keep their exact antisymmetry. Where a fused operation is
// intended, the code calls fma().
#pragma once

// Prefetches a cache line on a CPU. A GPU hides memory latency by switching to other work-items.
#define CACHE_LINE 64u
#if defined(__x86_64__) || defined(__aarch64__)
#define HAS_PREFETCH 1
#define PREFETCH(address) __builtin_prefetch(address)
#else
#define HAS_PREFETCH 0
#define PREFETCH(address) ((void)(address))
#endif

#ifdef __OPENCL_VERSION__

#pragma OPENCL FP_CONTRACT OFF

// Features are constants, so that `FEATURE_a && (!FEATURE_b || x)` may be constant too.
#if defined(__clang__)
#pragma clang diagnostic ignored "-Wconstant-logical-operand"
#endif

#define DEVICE static inline
// For functions in loops that the compiler should vectorise. LLVM vectorises no loop with calls.
#define DEVICE_LANE static inline __attribute__((always_inline))
#define GLOBAL __global
#define PRIVATE __private
#define CONSTANT static __constant
#define MAYBE_UNUSED

#define make_float2(x, y) ((float2)((x), (y)))
#define make_float3(x, y, z) ((float3)((x), (y), (z)))
#define make_float4(x, y, z, w) ((float4)((x), (y), (z), (w)))
#define make_uint4(x, y, z, w) ((uint4)((x), (y), (z), (w)))
#define splat_float8(x) ((float8)(x))

#define PI M_PI_F
#define INV_PI M_1_PI_F

/// Returns the index of the lowest set bit; x must not be 0.
DEVICE uint lowest_bit(uint x) {
    return popcount(~x & (x - 1u));
}

/// Returns the vector with its upper four lanes before its lower four.
DEVICE float8 swap_halves(float8 v) {
    return (float8)(v.hi, v.lo);
}

/// Returns one bit per lane of a comparison result; lane 0 is the lowest bit.
DEVICE uint lane_bits(int8 mask) {
#if defined(__AVX__) && defined(__clang__)
    return (uint)__builtin_ia32_movmskps256(as_float8(mask));
#else
    const int8 bits = mask & (int8)(1, 2, 4, 8, 16, 32, 64, 128);
    const int4 four = bits.lo | bits.hi;
    const int2 two = four.lo | four.hi;
    return (uint)(two.x | two.y);
#endif
}

#else

#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

// Vectors of eight are passed between inline functions only, where no calling convention matters.
#pragma GCC diagnostic ignored "-Wpsabi"

#define DEVICE [[maybe_unused]] static inline
#define DEVICE_LANE DEVICE
#define GLOBAL
#define PRIVATE
#define CONSTANT static const
// Marks parameters that only some features read.
#define MAYBE_UNUSED [[maybe_unused]]

using uint = unsigned int;
using ulong = unsigned long;

struct float2 {
    float x, y;
};
struct float3 {
    float x, y, z;
};
struct float4 {
    float x, y, z, w;
};
struct uint4 {
    uint x, y, z, w;
};

// Vectors of eight lanes with the operators of OpenCL C: arithmetic, comparisons that yield 0 or -1
// per lane, and selection by ?:.
using float8 = float __attribute__((vector_size(32)));
using int8 = int __attribute__((vector_size(32)));

constexpr float PI = 3.14159274101257f;
constexpr float INV_PI = 0.31830988618379f;

DEVICE float2 make_float2(float x, float y) {
    return {x, y};
}
DEVICE float3 make_float3(float x, float y, float z) {
    return {x, y, z};
}
DEVICE float4 make_float4(float x, float y, float z, float w) {
    return {x, y, z, w};
}
DEVICE uint4 make_uint4(uint x, uint y, uint z, uint w) {
    return {x, y, z, w};
}

DEVICE float3 operator+(float3 a, float3 b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
DEVICE float3 operator-(float3 a, float3 b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
DEVICE float3 operator*(float3 a, float3 b) {
    return {a.x * b.x, a.y * b.y, a.z * b.z};
}
DEVICE float3 operator/(float3 a, float3 b) {
    return {a.x / b.x, a.y / b.y, a.z / b.z};
}
DEVICE float3 operator*(float3 a, float s) {
    return {a.x * s, a.y * s, a.z * s};
}
DEVICE float3 operator*(float s, float3 a) {
    return a * s;
}
DEVICE float3 operator/(float3 a, float s) {
    return {a.x / s, a.y / s, a.z / s};
}
DEVICE float3 operator-(float3 a) {
    return {-a.x, -a.y, -a.z};
}
DEVICE float3 &operator+=(float3 &a, float3 b) {
    return a = a + b;
}
DEVICE float3 &operator-=(float3 &a, float3 b) {
    return a = a - b;
}
DEVICE float3 &operator*=(float3 &a, float3 b) {
    return a = a * b;
}
DEVICE float3 &operator*=(float3 &a, float s) {
    return a = a * s;
}

DEVICE uint4 operator<<(uint4 a, uint n) {
    return {a.x << n, a.y << n, a.z << n, a.w << n};
}
DEVICE uint4 operator>>(uint4 a, uint n) {
    return {a.x >> n, a.y >> n, a.z >> n, a.w >> n};
}
DEVICE uint4 operator&(uint4 a, uint mask) {
    return {a.x & mask, a.y & mask, a.z & mask, a.w & mask};
}
DEVICE uint4 operator|(uint4 a, uint4 b) {
    return {a.x | b.x, a.y | b.y, a.z | b.z, a.w | b.w};
}

DEVICE float dot(float3 a, float3 b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
DEVICE float3 cross(float3 a, float3 b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
DEVICE float length(float3 a) {
    return sqrtf(dot(a, a));
}
DEVICE float3 normalize(float3 a) {
    return a / length(a);
}
DEVICE float3 fabs(float3 a) {
    return {fabsf(a.x), fabsf(a.y), fabsf(a.z)};
}

DEVICE float min(float a, float b) {
    return b < a ? b : a;
}
DEVICE float max(float a, float b) {
    return a < b ? b : a;
}
DEVICE uint min(uint a, uint b) {
    return b < a ? b : a;
}
DEVICE uint max(uint a, uint b) {
    return a < b ? b : a;
}
DEVICE int min(int a, int b) {
    return b < a ? b : a;
}
DEVICE int max(int a, int b) {
    return a < b ? b : a;
}
DEVICE float3 min(float3 a, float3 b) {
    return {min(a.x, b.x), min(a.y, b.y), min(a.z, b.z)};
}
DEVICE float3 max(float3 a, float3 b) {
    return {max(a.x, b.x), max(a.y, b.y), max(a.z, b.z)};
}

DEVICE float sinpi(float x) {
    return static_cast<float>(sin(3.14159265358979323846 * static_cast<double>(x)));
}

DEVICE uint as_uint(float x) {
    uint bits;
    memcpy(&bits, &x, sizeof bits);
    return bits;
}
DEVICE float as_float(uint bits) {
    float x;
    memcpy(&x, &bits, sizeof x);
    return x;
}

DEVICE float8 splat_float8(float x) {
    return float8{x, x, x, x, x, x, x, x};
}
DEVICE float3 vload3(size_t, const float *p) {
    return {p[0], p[1], p[2]};
}
DEVICE float8 vload8(size_t, const float *p) {
    float8 v;
    memcpy(&v, p, sizeof v);
    return v;
}
DEVICE void vstore8(float8 v, size_t, float *p) {
    memcpy(p, &v, sizeof v);
}
DEVICE float8 fma(float8 a, float8 b, float8 c) {
    for (int lane = 0; lane < 8; ++lane) {
        c[lane] = fmaf(a[lane], b[lane], c[lane]);
    }
    return c;
}
DEVICE float8 swap_halves(float8 v) {
    return __builtin_shufflevector(v, v, 4, 5, 6, 7, 0, 1, 2, 3);
}
DEVICE uint lowest_bit(uint x) {
    return static_cast<uint>(__builtin_ctz(x));
}
DEVICE uint lane_bits(int8 mask) {
    uint bits = 0;
    for (uint lane = 0; lane < 8; ++lane) {
        bits |= mask[lane] != 0 ? 1u << lane : 0u;
    }
    return bits;
}

// The atomics that tests use. Memory order is relaxed, as in OpenCL 1.2.
DEVICE uint atomic_add(volatile uint *p, uint v) {
    return __atomic_fetch_add(p, v, __ATOMIC_RELAXED);
}
DEVICE long atom_add(volatile long *p, long v) {
    return __atomic_fetch_add(p, v, __ATOMIC_RELAXED);
}

#endif
