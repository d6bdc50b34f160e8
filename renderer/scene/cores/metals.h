// SPDX-License-Identifier: MIT
// Optical constants of metals.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace rtrays {

struct Metal {
    const char *name;
    Eigen::Vector3d eta;
    Eigen::Vector3d k;
};

/// Returns the complex indices of refraction eta + i k of the metals in thesis figure 3.17. They
/// are from the SOPRA n&k database, averaged over the linear Rec. 709 channels (as tabulated by
/// Tungsten, B. Bitterli, ComplexIorData: Ag, Au, Cu).
inline const std::vector<Metal> &metals() {
    static const std::vector<Metal> table = {
        {"silver",
         {0.1552646489, 0.1167232965, 0.1383806959},
         {4.8283433224, 3.1222459278, 2.1469504455}},
        {"gold",
         {0.1431189557, 0.3749570432, 1.4424785571},
         {3.9831604247, 2.3857207478, 1.6032152899}},
        {"copper",
         {0.2004376970, 0.9240334304, 1.1022119527},
         {3.9129485033, 2.4528477015, 2.1421879552}},
    };
    return table;
}

}  // namespace rtrays
