# SPDX-License-Identifier: MIT
"""Compares the renderer, Mitsuba 3 and Blender's Cycles with the Embree reference."""

import hashlib
import os
import pathlib

from rtrays.documents.document import write_json, write_text
from rtrays.paths import SCENES
from rtrays.peers.calibration import CALIBRATION, calibrate
from rtrays.peers.renderers import (
    MITSUBA_DRIVER,
    PEERS,
    PEERS_FOLDER,
    RUNS,
    average,
    compare,
    export,
    own_image,
)
from rtrays.peers.results import kept, result_of, words
from rtrays.peers.scenes import EXPLAINED, FULL, PROFILES, QUICK
from rtrays.peers.table import table
from rtrays.peers.third_party import compare_third_party
from rtrays.programs import ProgramError, call

# Error rate over all comparisons of a profile: Bonferroni over them, Holm within each.
ALPHA = 0.01


def peer_result(peer, scene, max_depth, profile, folder):
    """Renders a scene with a peer. Returns the comparison with the reference, or {"missing":
    reason} if the peer cannot express the scene."""
    ending, render, seed = PEERS[peer]
    exported, image = folder / f"scene{ending}", folder / f"{peer}.exr"
    try:
        export(scene, exported, f"{profile['size']}x{profile['size']}")
    except ProgramError as error:
        return {"missing": str(error)}
    runs = render(exported, image, profile["spp"] // RUNS, seed, max_depth, RUNS)
    average(runs, image)
    return {
        **result_of(compare(image, folder / "embree.exr")),
        "engine": runs[0]["engine"],
        "seconds": sum(run["seconds"] for run in runs),
    }


def measure(scene, max_depth, profile, folder):
    """Compares one scene: returns {renderer: result}."""
    spp, size = profile["spp"], f"{profile['size']}x{profile['size']}"
    image, reference = folder / "renderer.exr", folder / "embree.exr"
    options = ["--size", size, "--spp", 2 * spp, "--seed", 21, "--max-depth", max_depth]
    own_image("rtrays-reference", scene, reference, *options)
    options = ["--size", size, "--spp", spp, "--seed", 31]
    own_image("rtrays-render", scene, image, *options, "--set", f"integrator.max_depth={max_depth}")
    return {
        "renderer": result_of(compare(image, reference)),
        **{peer: peer_result(peer, scene, max_depth, profile, folder) for peer in PEERS},
    }


def planted_error(folder, profile):
    """Renders a lamp that is 2 % too bright. Returns whether the comparison detects it."""
    bright, reference = folder / "bright.exr", folder.parent / "cornell_box/embree.exr"
    radiance = "scene.luminaire.radiance=18.75474, 11.207046, 2.8086414"
    options = ["--spp", 8 * profile["spp"], "--seed", 33, "--set", radiance]
    size = f"{profile['size']}x{profile['size']}"
    scene = SCENES / "cornell_box/scene.json"
    own_image("rtrays-render", scene, bright, "--size", size, *options)
    return compare(bright, reference)["agreement"]["relative_difference"]["low"] > 0


def state_of(versions, profile):
    """Returns the state on which all results depend: versions, drivers and settings."""
    drivers = [MITSUBA_DRIVER, *sorted(PEERS_FOLDER.glob("cycles_*.py"))]
    code = hashlib.sha256(b"".join(path.read_bytes() for path in drivers)).hexdigest()
    return [*versions, code, profile, RUNS, CALIBRATION]


def compare_scenes(scenes, state, profile, work):
    """Compares all scenes of a profile. Returns the entries of the document."""
    entries = []
    for name, path, max_depth in scenes:
        scene = SCENES / f"{path}.json"
        key = [*state, hashlib.sha256(scene.read_bytes()).hexdigest(), max_depth]
        results = kept(
            work / name.replace(", ", "_").replace(" ", "_"),
            key,
            lambda folder: measure(scene, max_depth, profile, folder),
        )
        entries.append({"scene": name, "max_depth": max_depth, "results": results})
        texts = [f"{renderer} {words(result)}" for renderer, result in results.items()]
        print(f"{name}: {'; '.join(texts)}", flush=True)
    return entries


def agreements(entries):
    """Notes the known cause of every difference in the entries. Returns whether each result
    agrees."""
    results = []
    for entry in entries:
        for renderer, result in entry["results"].items():
            if "missing" not in result:
                result["explained"] = EXPLAINED.get((entry["scene"], renderer))
                results.append(result)
    return [
        abs(result["relative_difference"]["value"]) < 2e-3
        if result["explained"]
        else result["smallest_adjusted_p"] * len(results) > ALPHA
        for result in results
    ]


def compare_all(profile_name, peer_versions, work, out):
    """Compares all scenes of a profile; writes agreement.json and agreement.md into `out`.
    Returns whether all agree."""
    profile, is_full = PROFILES[profile_name], profile_name == "full"
    versions = [call(["rtrays-render", "--version"]).strip(), *peer_versions]
    state = state_of(versions, profile)
    document = {"schema_version": 1, "versions": versions, **profile, "runs": RUNS, "scenes": []}
    document["calibration"] = kept(work / "calibration", state, calibrate)
    document["scenes"] = compare_scenes(FULL if is_full else QUICK, state, profile, work)
    document["planted_error_is_seen"] = kept(
        work / "planted", state, lambda folder: planted_error(folder, profile)
    )
    document["of_others"], meshes = [], os.environ.get("RTRAYS_MESHES")
    if meshes and is_full:
        document["of_others"] = kept(
            work / "of_others",
            state,
            lambda folder: compare_third_party(pathlib.Path(meshes), folder),
        )
    agreeing = agreements(document["scenes"])
    calibrated = all(row["meets"] for row in document["calibration"])
    document["agrees"] = all(agreeing) and calibrated and document["planted_error_is_seen"]
    out.mkdir(parents=True, exist_ok=True)
    write_json(out / "agreement.json", document)
    write_text(out / "agreement.md", table(document))
    verdict = "agree" if document["agrees"] else "DIFFER"
    print(f"{verdict}: {len(agreeing)} comparisons; {out / 'agreement.md'}")
    return document["agrees"]
