# SPDX-License-Identifier: MIT
"""Calls of the renderers that are compared, and of the comparison."""

import json
import pathlib
import shutil
import sys

from rtrays.paths import ROOT
from rtrays.programs import ProgramError, call

MITSUBA_PYTHON = ROOT / "build/peers/bin/python"
PEERS_FOLDER = pathlib.Path(__file__).parent
MITSUBA_DRIVER = PEERS_FOLDER / "mitsuba_driver.py"
CYCLES_DRIVER = PEERS_FOLDER / "cycles_driver.py"
RUNS = 8


def drive(command, scene, output, spp, seed, max_depth, runs, *more):
    """Renders by a driver. Returns the JSON lines that it prints among the messages of its
    renderer."""
    options = ["--spp", spp, "--seed", seed, "--max-depth", max_depth, "--runs", runs, *more]
    printed = call([*command, scene, output, *options])
    return [json.loads(line) for line in printed.splitlines() if line.startswith('{"file"')]


def mitsuba(*arguments):
    """Renders an exported scene with Mitsuba 3; arguments as in `drive`."""
    return drive([MITSUBA_PYTHON, MITSUBA_DRIVER], *arguments)


def cycles(*arguments):
    """Renders an exported scene with Cycles; arguments as in `drive`."""
    blender = ["blender", "--background", "--factory-startup", "--python-exit-code", "1"]
    return drive([*blender, "--python", CYCLES_DRIVER, "--"], *arguments)


# Ending of the exported scene, renderer, and seed.
PEERS = {"mitsuba": (".xml", mitsuba, 41), "cycles": (".blender.json", cycles, 61)}


def export(scene, path, size=None):
    """Exports a scene for a peer."""
    film = ["--size", size] if size else []
    call(["rtrays-render", scene, "--export", path, "--quiet", *film])


def compare(image, reference):
    """Returns the comparison of two images."""
    return json.loads(call(["rtrays-experiment", "compare", image, reference, "--json"]))


def average(runs, output):
    """Writes the mean of the images of several runs, with their variance."""
    call(["rtrays-experiment", "average", *[run["file"] for run in runs], "-o", output])


def own_image(program, scene, output, *options):
    """Renders a scene with rtrays-render or rtrays-reference, both with independent samples."""
    sampler = ["--set", "integrator.sampler=independent"] if program == "rtrays-render" else []
    call([program, scene, "-o", output, "--quiet", *sampler, *options])


def mitsuba_version():
    """Returns the version of Mitsuba. Reports if it is missing and then returns None."""
    try:
        print_version = "import mitsuba; print(mitsuba.__version__)"
        return "Mitsuba " + call([MITSUBA_PYTHON, "-c", print_version]).strip()
    except ProgramError:
        print(
            "peers: mitsuba is not in build/peers; `scripts/install --peers` installs it there",
            file=sys.stderr,
        )
        return None


def blender_version():
    """Returns the version of Blender. Reports if it is missing and then returns None."""
    if shutil.which("blender"):
        return call(["blender", "--version"]).splitlines()[0]
    print(
        "peers: blender is not installed; `scripts/install --peers` installs it",
        file=sys.stderr,
    )
    return None


def versions():
    """Returns the versions of the peers, or None if one is missing."""
    found = [blender_version(), mitsuba_version()]
    return None if None in found else found
