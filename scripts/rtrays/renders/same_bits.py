# SPDX-License-Identifier: MIT
"""Renders a scene under settings that must not change a bit of the image, and compares."""

import json

from rtrays.programs import ProgramError, call

ALGORITHMS = ("path_tracing", "light_tracing", "bdpt", "truncated_bdpt")
METHODS = ("loopvec", "loops", "cbs")
SHORT = ("--size", "16x16", "--spp", "1", "--set", "integrator.max_depth=2")
FULL = ("--size", "32x32", "--spp", "4")  # unlimited depth, because a limit is a feature, too
OCLGRIND = ("oclgrind", "--data-races", "--max-errors", "10", "--build-options", "-fno-inline")


class Comparison:
    """One scene by one algorithm: programs of a folder write images into another one."""

    def __init__(self, programs, work, scene, algorithm):
        self.programs, self.work, self.scene, self.algorithm = programs, work, scene, algorithm

    def render(self, name, arguments, environment, before=()):
        """Renders an image; returns its path."""
        image = self.work / f"{name}.exr"
        program = self.programs / "rtrays-render"
        options = ["--algorithm", self.algorithm, "--layers", "none", "--quiet", *arguments]
        call([*before, program, self.scene, "-o", image, *options], environment)
        return image

    def same(self, one, other):
        """Returns whether the L2 distance of two images is exactly zero."""
        program = self.programs / "rtrays-experiment"
        return json.loads(call([program, "compare", one, other, "--json"]))["l2"] == 0

    def differences(self, variants):
        """Renders with each of the settings, {name: (arguments, environment)}. Returns a message
        that names all whose bits differ from the first image, or an empty string."""
        images = {name: self.render(name, *settings) for name, settings in variants.items()}
        first, *others = images
        different = [name for name in others if not self.same(images[first], images[name])]
        return f"{', '.join(different)}: bits differ from {first}" if different else ""


def by_methods(comparison):
    """Compares PoCL's methods to run a work-group."""
    variants = {}
    for method in METHODS:
        caches = {
            f"{name.upper()}_CACHE_DIR": str(comparison.work / f"{name}.{method}")
            for name in ("pocl", "rtrays")
        }
        (comparison.work / f"pocl.{method}").mkdir(exist_ok=True)
        variants[method] = (SHORT, {"POCL_WORK_GROUP_METHOD": method, **caches})
    return comparison.differences(variants)


def by_features(comparison):
    """Compares kernels with only the required features with kernels that have all features."""
    return comparison.differences(
        {
            features: ((*FULL, "--set", f"device.features={features}"), {})
            for features in ("all", "scene")
        }
    )


def by_oclgrind(comparison):
    """Renders under Oclgrind; returns its report of memory accesses and data races."""
    log = comparison.work / "oclgrind.log"
    comparison.render(
        "checked",
        (*SHORT, "--set", "device.bvh_layout=bvh2"),
        {"RTRAYS_CACHE_DIR": str(comparison.work / "rtrays")},
        (*OCLGRIND, "--log", str(log)),
    )
    return log.read_text().strip() if log.exists() else ""


CHECKS = {"methods": by_methods, "features": by_features, "oclgrind": by_oclgrind}


def check(name, programs, work, scene, algorithm):
    """Returns the message of a failed check, or an empty string."""
    try:
        return CHECKS[name](Comparison(programs, work, scene, algorithm))
    except ProgramError as error:
        return str(error)
