// SPDX-License-Identifier: MIT
// The features: structural facts about a scene and its settings.
//
// Features decide which code is compiled, which fields the path state has, which buffers are
// allocated and which stages are launched. Numeric settings are kernel arguments and are never
// compiled in.
//
// This table is the only declaration. The host derives from it the mask, the names and the
// generated defines FEATURE_<name> (0 or 1).
#pragma once

// X(name, description)
#define RTRAYS_FEATURES(X)                                                                    \
    /* strategies and termination */                                                          \
    X(implicit_light, "emitters that paths hit contribute (strategies implicit, mis)")        \
    X(explicit_light, "paths are connected to light samples (strategies explicit, mis)")      \
    X(light_strategy, "light paths connected to the camera take part in the MIS weights")     \
    X(light_path_trials, "paths of a pilot, which compares settings")                         \
    X(vertex_connections, "light vertices are stored and connected to camera path vertices")  \
    X(light_emitters, "light paths also show emitters that the camera sees directly")         \
    X(from_camera, "this pass traces paths from the camera")                                  \
    X(from_light, "this pass traces paths from the lights")                                   \
    X(shadow_rays, "vertices are connected to lights, light vertices or the camera")          \
    X(branches, "paths return to vertices to follow several components")                      \
    X(roulette, "Russian roulette ends paths")                                                \
    X(late_roulette, "roulette spares the first events of a path")                            \
    X(roulette_scale, "roulette divides the throughput by a scale stored per path")           \
    X(adaptive, "paths end below a throughput threshold (biased)")                            \
    X(depth_limit, "max_depth is finite")                                                     \
    X(sobol, "samples are stratified or regular")                                             \
    /* geometry */                                                                            \
    X(triangles, "the scene has triangles: a hierarchy is built and traversed")               \
    X(shapes, "the scene has surfaces that are not made of triangles")                        \
    X(quadrics, "a shape is a quadric, a disc or a plane")                                    \
    X(julia, "a shape is a quaternion Julia set")                                             \
    X(smooth_normals, "vertices have shading normals, or a map tilts them")                   \
    X(texture_coordinates, "a texture or a tangent uses the (u, v) coordinates of a mesh")    \
    X(tangents, "a BxDF is anisotropic")                                                      \
    /* materials */                                                                           \
    X(scattering, "a material reflects or refracts: paths continue after the first hit")      \
    X(composite, "a material has more than one component")                                    \
    X(one_sided, "a material is black from behind")                                           \
    X(delta, "a BxDF is a delta distribution")                                                \
    X(refraction, "a BxDF refracts")                                                          \
    X(lambert, "diffuse reflection")                                                          \
    X(oren_nayar, "rough diffuse reflection")                                                 \
    X(ideal_reflection, "mirrors")                                                            \
    X(ideal_refraction, "smooth dielectrics")                                                 \
    X(blinn, "Torrance-Sparrow with Blinn's distribution")                                    \
    X(ward, "Ward's anisotropic reflection, bounded")                                         \
    X(ward_original, "Ward's anisotropic reflection as published")                            \
    X(microfacet_reflection, "GGX or Beckmann, reflection")                                   \
    X(microfacet_refraction, "GGX or Beckmann, refraction")                                   \
    X(coated_lambert, "diffuse reflection under a dielectric coat")                           \
    X(disney_diffuse, "diffuse reflection of Burley")                                         \
    X(disney_sheen, "sheen of Burley")                                                        \
    X(disney_clearcoat, "clear coat of Burley, GTR1")                                         \
    X(ggx, "a microfacet distribution is GGX")                                                \
    X(beckmann, "a microfacet distribution is Beckmann's")                                    \
    X(fresnel, "a weight has a Fresnel term")                                                 \
    X(fresnel_dielectric, "exact dielectric")                                                 \
    X(fresnel_conductor, "exact conductor")                                                   \
    X(fresnel_conductor_approximate, "approximate conductor of the thesis")                   \
    X(fresnel_schlick, "Schlick's approximation")                                             \
    X(fresnel_thin_dielectric, "thin plate of a dielectric")                                  \
    X(component_sides, "a BxDF reflects on one side of the surface only")                     \
    X(textures, "a weight or an emission has a texture")                                      \
    X(normal_maps, "a map of normals or heights tilts shading normals")                       \
    X(bump_maps, "such a map has heights")                                                    \
    X(roughness_textures, "a roughness has a texture")                                        \
    X(texture_mirror, "a texture is mirrored beyond its edges")                               \
    X(mixtures, "a texture mixes components")                                                 \
    X(vertex_colours, "the colours of vertices multiply a texture")                           \
    X(opacity, "rays may pass a surface: hits are accepted with its opacity")                 \
    /* lights */                                                                              \
    X(lights, "the scene has emitters")                                                       \
    X(direction_density, "paths store the density of their direction")                        \
    X(emission_density, "light paths store the density of their start")                       \
    X(arrival_density, "paths store the density of their arrival at a vertex")                \
    X(shadow_origin, "the shadow ray of a light path does not begin where its ray does")      \
    X(many_lights, "more than one light: a selection table is searched")                      \
    X(independent_lights, "every vertex is connected to every light, one after the other")    \
    X(area_lights, "emitting triangles")                                                      \
    X(light_triangles, "a mesh light has more than one triangle: its area table is searched") \
    X(shape_lights, "emitting discs and spheres")                                             \
    X(emission_textures, "an area light has a texture")                                       \
    X(point_lights, "point lights")                                                           \
    X(spot_lights, "spot lights")                                                             \
    X(directional_lights, "directional lights")                                               \
    X(infinite_lights, "radiance from infinity (dome, environment): misses are lit")          \
    X(dome, "uniform radiance from infinity")                                                 \
    X(environment, "radiance from infinity by an image")                                      \
    X(guided_emission, "tables guide the directions in which light paths start")              \
    X(guided_scattering, "tables guide camera paths behind mirrors and glass")                \
    /* camera and film */                                                                     \
    X(orthographic, "the rays of the camera are parallel")                                    \
    X(lens, "the camera has an aperture, or is far from the scene")                           \
    X(crop, "the film is a window of the full picture")                                       \
    X(convergence, "converged pixels receive no further camera paths (biased)")               \
    X(variance, "the film holds what the variance of its means follows from")                 \
    X(sequences, "that is one sum for each Sobol sequence, not second moments")               \
    X(int64_atomics, "the device has 64-bit integer atomics")

#ifndef __OPENCL_VERSION__

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace rtrays {

enum class Feature : uint32_t {
#define RTRAYS_FEATURE(name, text) name,
    RTRAYS_FEATURES(RTRAYS_FEATURE)
#undef RTRAYS_FEATURE
        count
};

/// A set of features.
class FeatureMask {
  public:
    constexpr FeatureMask() = default;

    static constexpr FeatureMask all() {
        FeatureMask mask;
        for (uint32_t i = 0; i < static_cast<uint32_t>(Feature::count); ++i) {
            mask = mask.with(static_cast<Feature>(i));
        }
        return mask;
    }

    constexpr bool has(Feature feature) const {
        return (words_[word(feature)] & bit(feature)) != 0;
    }
    constexpr FeatureMask with(Feature feature, bool on = true) const {
        FeatureMask mask = *this;
        uint64_t &changed = mask.words_[word(feature)];
        changed = on ? changed | bit(feature) : changed & ~bit(feature);
        return mask;
    }
    constexpr FeatureMask without(FeatureMask others) const {
        FeatureMask mask = *this;
        for (uint32_t i = 0; i < words; ++i) {
            mask.words_[i] &= ~others.words_[i];
        }
        return mask;
    }
    constexpr FeatureMask operator|(FeatureMask other) const {
        FeatureMask mask = *this;
        for (uint32_t i = 0; i < words; ++i) {
            mask.words_[i] |= other.words_[i];
        }
        return mask;
    }
    bool operator==(FeatureMask other) const { return words_ == other.words_; }
    bool operator!=(FeatureMask other) const { return words_ != other.words_; }

    /// Returns the set without the features whose requirements are missing. For example,
    /// explicit_light requires lights and scattering.
    FeatureMask closed() const;

    /// Returns the names of the features in the set, in table order.
    std::vector<std::string> names() const;

    /// Returns the defines "FEATURE_<name>" -> "0" or "1" of all features.
    std::map<std::string, std::string> defines() const;

  private:
    static constexpr uint32_t words = (static_cast<uint32_t>(Feature::count) + 63) / 64;

    static constexpr uint32_t word(Feature feature) { return static_cast<uint32_t>(feature) / 64; }
    static constexpr uint64_t bit(Feature feature) {
        return uint64_t{1} << static_cast<uint32_t>(feature) % 64;
    }

    std::array<uint64_t, words> words_{};
};

}  // namespace rtrays

#endif
