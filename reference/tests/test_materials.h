// SPDX-License-Identifier: MIT
// Test materials: one per BSDF model and per kind of composite.
#pragma once

#include <string>
#include <vector>

#include "reference/bsdf.h"

namespace rtrays::reference {

/// A material and its expected properties.
struct TestMaterial {
    std::string name;
    std::vector<BxdfComponent> components;
    bool reciprocal = true;
    bool conserves_energy = true;
};

BxdfComponent lambert(double weight);
BxdfComponent oren_nayar(double sigma);
BxdfComponent disney_diffuse(double roughness, double flatness);
BxdfComponent disney_sheen();
BxdfComponent disney_clearcoat(double alpha);
/// A base under a coat of index 1.5, without the reflection of the coat.
BxdfComponent coated_lambert(BxdfComponent::Distribution distribution, double alpha, double weight,
                             bool nonlinear);
BxdfComponent ideal_reflection();
BxdfComponent ideal_refraction(double eta);
BxdfComponent blinn(double exponent);
BxdfComponent ward(double alpha_x, double alpha_y, bool bounded = true);
BxdfComponent microfacet(BxdfComponent::Distribution distribution, double alpha_x, double alpha_y);
BxdfComponent rough_refraction(BxdfComponent::Distribution distribution, double alpha, double eta);
BxdfComponent with_dielectric(BxdfComponent component, double eta, bool complement = false);

/// Returns one material per model and kind of composite. None of them is purely delta.
std::vector<TestMaterial> rough_materials();

/// Returns glass: reflection and refraction, ideal or rough, weighted by F and 1 - F.
std::vector<BxdfComponent> smooth_glass(double eta);
std::vector<BxdfComponent> rough_glass(BxdfComponent::Distribution distribution, double alpha,
                                       double eta);

Bsdf make_bsdf(const std::vector<BxdfComponent> &components, bool two_sided = true,
               const TextureArrays &textures = {});

}  // namespace rtrays::reference
