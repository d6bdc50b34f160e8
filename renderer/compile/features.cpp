// SPDX-License-Identifier: MIT
// Feature masks: names, requirements, and the layouts of records that depend on them.
#include "renderer/shared/features.h"

#include <array>
#include <utility>

#include "renderer/shared/branch.h"
#include "renderer/shared/light_vertex.h"
#include "renderer/shared/path_state.h"

namespace rtrays {

namespace {

constexpr std::array<std::pair<Feature, const char *>, static_cast<size_t>(Feature::count)>
    feature_table = {{
#define ROW(name, text) {Feature::name, #name},
        RTRAYS_FEATURES(ROW)
#undef ROW
    }};

/// Pairs of a feature and one that its code requires. Without the second, the first is off.
constexpr std::pair<Feature, Feature> requirements[] = {
    {Feature::smooth_normals, Feature::triangles},
    {Feature::texture_coordinates, Feature::triangles},
    {Feature::quadrics, Feature::shapes},
    {Feature::julia, Feature::shapes},
    {Feature::composite, Feature::scattering},
    {Feature::branches, Feature::composite},
    {Feature::branches, Feature::delta},
    {Feature::one_sided, Feature::scattering},
    {Feature::lambert, Feature::scattering},
    {Feature::oren_nayar, Feature::scattering},
    {Feature::ideal_reflection, Feature::scattering},
    {Feature::ideal_refraction, Feature::scattering},
    {Feature::blinn, Feature::scattering},
    {Feature::ward, Feature::scattering},
    {Feature::ward_original, Feature::scattering},
    {Feature::microfacet_reflection, Feature::scattering},
    {Feature::microfacet_refraction, Feature::scattering},
    {Feature::coated_lambert, Feature::scattering},
    {Feature::disney_diffuse, Feature::scattering},
    {Feature::disney_sheen, Feature::scattering},
    {Feature::disney_clearcoat, Feature::scattering},
    {Feature::fresnel, Feature::scattering},
    {Feature::fresnel_dielectric, Feature::fresnel},
    {Feature::fresnel_conductor, Feature::fresnel},
    {Feature::fresnel_conductor_approximate, Feature::fresnel},
    {Feature::fresnel_schlick, Feature::fresnel},
    {Feature::fresnel_thin_dielectric, Feature::fresnel},
    {Feature::component_sides, Feature::scattering},
    {Feature::tangents, Feature::scattering},
    {Feature::roughness_textures, Feature::textures},
    {Feature::mixtures, Feature::textures},
    {Feature::mixtures, Feature::scattering},
    {Feature::vertex_colours, Feature::textures},
    {Feature::vertex_colours, Feature::triangles},
    {Feature::vertex_colours, Feature::scattering},
    {Feature::normal_maps, Feature::textures},
    {Feature::normal_maps, Feature::smooth_normals},
    {Feature::normal_maps, Feature::tangents},
    {Feature::bump_maps, Feature::normal_maps},
    {Feature::roulette, Feature::scattering},
    {Feature::late_roulette, Feature::roulette},
    {Feature::adaptive, Feature::scattering},
    {Feature::depth_limit, Feature::scattering},
    {Feature::implicit_light, Feature::scattering},
    {Feature::implicit_light, Feature::lights},
    {Feature::explicit_light, Feature::scattering},
    {Feature::explicit_light, Feature::lights},
    {Feature::light_strategy, Feature::lights},
    {Feature::light_path_trials, Feature::light_strategy},
    {Feature::vertex_connections, Feature::scattering},
    {Feature::vertex_connections, Feature::light_strategy},
    {Feature::light_emitters, Feature::light_strategy},
    {Feature::from_light, Feature::lights},
    {Feature::area_lights, Feature::lights},
    {Feature::area_lights, Feature::triangles},
    {Feature::light_triangles, Feature::area_lights},
    {Feature::shape_lights, Feature::lights},
    {Feature::shape_lights, Feature::quadrics},
    {Feature::emission_textures, Feature::textures},
    {Feature::infinite_lights, Feature::lights},
    {Feature::dome, Feature::infinite_lights},
    {Feature::environment, Feature::infinite_lights},
    {Feature::guided_emission, Feature::lights},
    {Feature::guided_scattering, Feature::delta},
    {Feature::guided_scattering, Feature::light_strategy},
};

/// Features that only serve others. Each is off unless one of the features that it serves is on.
constexpr std::pair<Feature, std::array<Feature, 2>> supporting_features[] = {
    {Feature::scattering, {Feature::triangles, Feature::shapes}},
    {Feature::opacity, {Feature::triangles, Feature::shapes}},
    {Feature::textures, {Feature::scattering, Feature::lights}},
    {Feature::emission_textures, {Feature::area_lights, Feature::shape_lights}},
    {Feature::texture_mirror, {Feature::textures, Feature::opacity}},
    {Feature::shapes, {Feature::quadrics, Feature::julia}},
    {Feature::infinite_lights, {Feature::dome, Feature::environment}},
    {Feature::delta, {Feature::ideal_reflection, Feature::ideal_refraction}},
    {Feature::refraction, {Feature::ideal_refraction, Feature::microfacet_refraction}},
    {Feature::ggx, {Feature::microfacet_reflection, Feature::microfacet_refraction}},
    {Feature::beckmann, {Feature::microfacet_reflection, Feature::microfacet_refraction}},
    // Paths cannot hit these lights, and hits use no selection tables. Both matter only when lights
    // are sampled.
    {Feature::light_triangles, {Feature::explicit_light, Feature::from_light}},
    {Feature::point_lights, {Feature::explicit_light, Feature::from_light}},
    {Feature::spot_lights, {Feature::explicit_light, Feature::from_light}},
    {Feature::directional_lights, {Feature::explicit_light, Feature::from_light}},
    {Feature::many_lights, {Feature::explicit_light, Feature::from_light}},
    {Feature::independent_lights, {Feature::explicit_light, Feature::from_light}},
};

}  // namespace

std::vector<std::string> FeatureMask::names() const {
    std::vector<std::string> names;
    for (const auto &[feature, name] : feature_table) {
        if (has(feature)) {
            names.emplace_back(name);
        }
    }
    return names;
}

std::map<std::string, std::string> FeatureMask::defines() const {
    std::map<std::string, std::string> defines;
    for (const auto &[feature, name] : feature_table) {
        defines[std::string("FEATURE_") + name] = has(feature) ? "1" : "0";
    }
    return defines;
}

FeatureMask FeatureMask::closed() const {
    FeatureMask mask = *this;
    const auto drop = [&] {
        for (const auto &[feature, served] : supporting_features) {
            mask = mask.with(feature,
                             mask.has(feature) && (mask.has(served[0]) || mask.has(served[1])));
        }
        for (const auto &[feature, needed] : requirements) {
            mask = mask.with(feature, mask.has(feature) && mask.has(needed));
        }
    };
    // Repeats until nothing changes; each repetition drops at least one of finitely many features.
    for (FeatureMask before = FeatureMask::all(); before != mask;) {
        before = mask;
        drop();
    }
    // Features that follow from the others.
    const bool from_light = mask.has(Feature::from_light),
               strategy = mask.has(Feature::light_strategy);
    const bool connects = mask.has(Feature::vertex_connections);
    return mask.with(Feature::from_camera, !from_light)
        .with(Feature::convergence, mask.has(Feature::convergence) && !from_light)
        .with(Feature::shadow_rays, mask.has(Feature::explicit_light) || connects || from_light)
        .with(
            Feature::direction_density,
            connects || (!from_light && (mask.has(Feature::implicit_light) || strategy ||
                                         (mask.has(Feature::delta) && mask.has(Feature::lights)))))
        .with(Feature::emission_density,
              from_light && strategy && mask.has(Feature::explicit_light))
        .with(Feature::arrival_density, connects || (from_light && strategy))
        .with(Feature::shadow_origin, from_light && mask.has(Feature::guided_emission) &&
                                          mask.has(Feature::shape_lights) &&
                                          (!strategy || mask.has(Feature::light_emitters)))
        .with(Feature::roulette_scale,
              mask.has(Feature::roulette) && (mask.has(Feature::refraction) || from_light ||
                                              mask.has(Feature::guided_scattering)));
}

namespace {

/// Words of the types of fields.
constexpr uint32_t words_of_uint = 1, words_of_float = 1, words_of_float3 = 3,
                   words_of_trials = LIGHT_PATH_TRIALS;

/// Fields of a record (shared/path_state.h, shared/light_vertex.h, shared/branch.h), in the order
/// of their declaration.
class FieldList {
  public:
    void add(bool present, uint32_t words, const char *name) {
        if (present) {
            fields.push_back({name, words});
        }
    }

    uint32_t words() const {
        uint32_t words = 0;
        for (const PathStateField &field : fields) {
            words += field.words;
        }
        return words;
    }

    std::vector<PathStateField> fields;
};

}  // namespace

#define FEATURE_VARIABLE(name, text) \
    [[maybe_unused]] const bool FEATURE_##name = mask.has(Feature::name);
#define ROW(feature, type, name) list.add(feature, words_of_##type, #name);

std::vector<PathStateField> path_state_fields(FeatureMask mask) {
    RTRAYS_FEATURES(FEATURE_VARIABLE)
    FieldList list;
    PATH_STATE_FIELDS(ROW)
    return list.fields;
}

uint32_t light_vertex_words(FeatureMask mask) {
    RTRAYS_FEATURES(FEATURE_VARIABLE)
    FieldList list;
    LIGHT_VERTEX_FIELDS(ROW)
    return list.words();
}

uint32_t branch_words(FeatureMask mask) {
    RTRAYS_FEATURES(FEATURE_VARIABLE)
    FieldList list;
    BRANCH_FIELDS(ROW)
    return list.words();
}

#undef FEATURE_VARIABLE
#undef ROW

uint32_t path_state_words(FeatureMask mask) {
    FieldList list;
    list.fields = path_state_fields(mask);
    return list.words();
}

}  // namespace rtrays
