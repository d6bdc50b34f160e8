// SPDX-License-Identifier: MIT
// Named indices of refraction of Mitsuba scene files.
#pragma once

namespace rtrays::mitsuba {

struct IndexOfRefraction {
    const char *name;
    double value;
};

/// The names that a scene file may give instead of a number (Mitsuba 3.9, ior.h). Most values come
/// from the Blender wiki and from Wikipedia's list of refractive indices, at 589 nm.
inline constexpr IndexOfRefraction indices_of_refraction[] = {
    {"vacuum", 1.0},      {"helium", 1.000036},        {"hydrogen", 1.000132},
    {"air", 1.000277},    {"carbon dioxide", 1.00045}, {"water", 1.3330},
    {"acetone", 1.36},    {"ethanol", 1.361},          {"carbon tetrachloride", 1.461},
    {"glycerol", 1.4729}, {"benzene", 1.501},          {"silicone oil", 1.52045},
    {"bromine", 1.661},   {"water ice", 1.31},         {"fused quartz", 1.458},
    {"pyrex", 1.470},     {"acrylic glass", 1.49},     {"polypropylene", 1.49},
    {"bk7", 1.5046},      {"sodium chloride", 1.544},  {"amber", 1.55},
    {"pet", 1.5750},      {"diamond", 2.419},
};

}  // namespace rtrays::mitsuba
