// SPDX-License-Identifier: MIT
// A triangle whose material has a map of normals or heights, for tests of device code on the host.
#pragma once

// Must precede all device code.
#include "testing/all_features.h"

#include <vector>

#include "renderer/kernels/bsdf/shading_frame.h"

namespace rtrays {

/// A triangle with a map of float texels. Its (u, v) are those of its corners.
struct MappedTriangle {
    SurfaceTriangle surface{};
    TriangleNormals normals{};
    TriangleUv uvs{};
    TriangleColours colours{{{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}};
    MaterialRecord material{0, 0, MATERIAL_MAPPED, 0};
    TextureRecord texture{0, 1, 1, TEXTURE_FLOAT | TEXTURE_BILINEAR, {1, 1}, {0, 0}};
    std::vector<uint> texels = {as_uint(0.5f), as_uint(0.5f), as_uint(1.0f)};
    NormalMapRecord map{0, 1.0f, 0, 0};

    /// The triangle (0, 0, 0), (1, 0, 0), (0, 1, 0) in the plane z = 0 with u = x and v = y.
    MappedTriangle() {
        set_corners(make_float3(0, 0, 0), make_float3(1, 0, 0), make_float3(0, 1, 0));
        uvs = {{{0, 0}, {1, 0}, {0, 1}}};
    }

    void set_corners(float3 p0, float3 p1, float3 p2) {
        const float3 n = triangle_normal(p0, p1, p2);
        for (const auto &[from, to] : {std::pair(p0, surface.p0), std::pair(p1, surface.p1),
                                       std::pair(p2, surface.p2), std::pair(n, surface.normal)}) {
            to[0] = from.x;
            to[1] = from.y;
            to[2] = from.z;
        }
        surface.extent = triangle_extent(p0, p1, p2);
        surface.emitter = NO_EMITTER;
    }

    void set_smooth_normal(float3 n) {
        normals.is_smooth = 1;
        for (auto &corner : normals.normal) {
            corner[0] = n.x;
            corner[1] = n.y;
            corner[2] = n.z;
        }
    }

    /// Sets a map of one normal, whose length need not be 1.
    void set_texel(float3 n) {
        texels = {as_uint(0.5f * n.x + 0.5f), as_uint(0.5f * n.y + 0.5f),
                  as_uint(0.5f * n.z + 0.5f)};
    }

    /// Sets a map of heights, row by row from the top.
    void set_heights(uint width, uint height, const std::vector<float> &heights) {
        map.flags |= NORMAL_MAP_HEIGHTS;
        texture.width = width;
        texture.height = height;
        texels.clear();
        for (const float h : heights) {
            texels.insert(texels.end(), 3, as_uint(h));
        }
    }

    SceneView view() const {
        SceneView scene{};
        scene.surface_triangles = &surface;
        scene.triangle_normals = &normals;
        scene.triangle_uvs = &uvs;
        scene.triangle_colours = &colours;
        scene.materials = &material;
        scene.textures = &texture;
        scene.texels = texels.data();
        scene.normal_maps = &map;
        return scene;
    }

    /// Returns the frame at barycentrics (1 - u - v, u, v), seen from wo.
    SurfaceFrame frame(float3 wo, float u = 0.25f, float v = 0.25f) const {
        const SceneView scene = view();
        return shading_frame(&scene, triangle_hit(&scene, 0, u, v), wo);
    }
};

}  // namespace rtrays
