// SPDX-License-Identifier: MIT
// Disables the features that a test did not define before it includes device code. The tables of
// shared/scene_buffers.h name these features and require each to be 0 or 1.
#pragma once

#ifndef FEATURE_triangles
#define FEATURE_triangles 0
#endif
#ifndef FEATURE_smooth_normals
#define FEATURE_smooth_normals 0
#endif
#ifndef FEATURE_texture_coordinates
#define FEATURE_texture_coordinates 0
#endif
#ifndef FEATURE_shapes
#define FEATURE_shapes 0
#endif
#ifndef FEATURE_scattering
#define FEATURE_scattering 0
#endif
#ifndef FEATURE_textures
#define FEATURE_textures 0
#endif
#ifndef FEATURE_lights
#define FEATURE_lights 0
#endif
#ifndef FEATURE_area_lights
#define FEATURE_area_lights 0
#endif
#ifndef FEATURE_environment
#define FEATURE_environment 0
#endif
#ifndef FEATURE_from_light
#define FEATURE_from_light 0
#endif
#ifndef FEATURE_light_strategy
#define FEATURE_light_strategy 0
#endif
