# SPDX-License-Identifier: MIT
"""Scenes that the peers render, their profiles, and differences whose cause is known."""

PROFILES = {"quick": {"size": 32, "spp": 512}, "full": {"size": 64, "spp": 1024}}
# Name, file and --max-depth (0: no limit).
QUICK = [
    ("cornell_box", "cornell_box/scene", 0),
    ("glass", "features/glass", 0),
    ("combined_lights", "features/combined_lights", 0),
    ("rough_reflection", "peers/rough_reflection", 0),
]
FULL = QUICK + [
    ("cornell_box, depth 2", "cornell_box/scene", 2),
    ("smooth_lambert", "peers/smooth_lambert", 0),
]
FULL += [
    (name, f"features/{name}", 0)
    for name in (
        "spot_light",
        "point_light",
        "sphere_light",
        "environment_light",
        "thin_lens",
        "texture_sphere",
        "ggx",
        "gold",
        "rough_glass_ggx",
        "light_in_glass",
        "texture_nearest",
        "texture_bilinear",
        "directional_light",
        "disc_light",
        "dome_light",
        "one_sided",
        "glass_tinted",
        "fresnel",
        "car_paint",
        "car_paint_thesis",
        "schlick",
        "cylinder",
        "cone",
        "paraboloid",
        "ellipsoid",
        "beckmann",
        "oren_nayar_079",
        "ward_010",
    )
]

# Differences whose cause is known and that no scene file can avoid. The test is waived for these
# images, but their means must still agree within 0.2 %.
SUMMED_IN_FLOAT = (
    "The peer sums samples in float32. The rounding shows where the dome is seen directly, because "
    "no noise hides it. RTRays sums integers, and the reference sums in double precision."
)
EXPLAINED = {
    ("dome_light", "mitsuba"): SUMMED_IN_FLOAT,
    ("dome_light", "cycles"): SUMMED_IN_FLOAT,
    (
        "smooth_lambert",
        "mitsuba",
    ): "Where the interpolated normal turns away from the eye, Mitsuba's twosided shades the "
    "back, which darkens pixels of the silhouette. RTRays and Cycles use the geometric normal "
    "there.",
}
