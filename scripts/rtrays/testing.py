# SPDX-License-Identifier: MIT
"""What the tests share: a small made-up run, and calls of scripts."""

import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

import numpy

from rtrays.documents.run_document import Run
from rtrays.paths import ROOT


def script(name, *arguments, root=ROOT):
    """Runs a command of scripts/ to its end."""
    return subprocess.run(
        [sys.executable, root / "scripts" / name, *map(str, arguments)],
        capture_output=True,
        text=True,
        check=False,
    )


def interval(low, high):
    """Returns an interval with its middle."""
    return {"value": (low + high) / 2, "low": low, "high": high}


def made_up_errors(spp):
    """Returns the times and errors of an image of so many samples per pixel."""
    rmse = spp**-0.5
    return {
        "seconds_device": 0.1 * spp,
        "seconds_wall": 0.2 * spp,
        "l2": 10 * rmse,
        "rmse": rmse,
        "mae": rmse / 2,
        "relmse": rmse**2,
        "mse": rmse**2,
    }


def made_up_point(spp):
    """Returns a point of a curve with its repetitions."""
    errors = made_up_errors(spp)
    repetitions = [
        {**errors, "seed": seed, "rmse": errors["rmse"] * (1 + 0.01 * seed)} for seed in range(1, 9)
    ]
    return {
        **errors,
        "spp": spp,
        "mse_unbiased": errors["mse"] - 0.01,
        "noise_dominates": spp == 8,
        "repetitions": repetitions,
    }


def made_up_curve(strategies):
    """Returns a curve of path tracing."""
    slope = {"value": -0.5, "low": -0.51, "high": -0.49, "confidence": 0.95, "spp": [1, 4]}
    return {
        "id": f"path_tracing.{strategies}",
        "scene": "box",
        "algorithm": "path_tracing",
        "strategies": strategies,
        "settings": {},
        "compile_seconds": 1.5,
        "bvh_seconds": 0.01,
        "render_report": {
            "bytes_per_path": 112,
            "light_vertex_bytes_per_path": 0,
            "features": [],
            "stages": [{"pass": "camera", "seconds": 3}, {"pass": "light", "seconds": 1}],
        },
        "points": [made_up_point(spp) for spp in (1, 2, 4, 8)],
        "slope": slope,
        "slope_unbiased": slope,
        "image": "images/ours.exr",
        "image_spp": 64,
        "layers": [],
        "early_images": [{"spp": 2, "image": "images/early.exr"}],
        "agreement": {
            "block_size": 16,
            "alpha": 0.01,
            "tests": 51,
            "rejected": 0,
            "agrees": True,
            "largest_z": 2.5,
            "smallest_adjusted_p": 0.6,
            "equivalence": "equivalent",
            "relative_difference": {
                "value": 1e-4,
                "low": -2e-4,
                "high": 4e-4,
                "confidence": 0.99,
                "limit": 1e-3,
            },
        },
    }


def made_up_run():
    """Returns the document of a run of two curves."""
    return {
        "schema_version": 3,
        "kind": "curves",
        "experiment": {
            "name": "box",
            "title": "A box & more",
            "thesis": "4.2",
            "claim": "It converges.",
            "profile": "ci",
            "size": [4, 4],
            "expected_slope": {"value": -0.5, "tolerance": 0.03},
        },
        "context": {
            "commit": "abc",
            "dirty": False,
            "started_at": "2026-01-01T00:00:00Z",
            "finished_at": "2026-01-01T00:01:00Z",
            "load_average_start": [0, 0, 0],
            "load_average_end": [1, 0, 0],
            "host": {
                "cpu": "cpu",
                "cores": 2,
                "kernel": "Linux",
                "compiler": "GNU",
                "build_type": "Release",
            },
            "cpu_use": {"own": 0.9, "foreign": 0.01, "steal": 0.0},
            "kernel_options": "-cl-std=CL1.2",
            "device": {
                "name": "pthread",
                "platform": "PoCL",
                "driver": "3.1",
                "c_version": "1.2",
                "compute_units": 2,
            },
        },
        "reference": {
            "engine": "embree",
            "files": ["a.exr", "b.exr"],
            "image": "images/reference.exr",
            "spp": 100,
            "scene_hash": "ff",
            "noise_floor": {"mse": 0.01, "rmse": 0.1, "l2": 0.7},
        },
        "curves": [made_up_curve("implicit"), made_up_curve("mis")],
        "throughput": {
            "curve": "path_tracing.mis",
            "samples_per_repetition": 1e6,
            "accepted": True,
            "repetitions": [],
            "renderer_samples_per_second": {"value": 2e6, "low": 1e6, "high": 3e6},
            "reference_samples_per_second": {"value": 1e6, "low": 1e6, "high": 1e6},
            "ratio": {"value": 2, "low": 1, "high": 3},
        },
    }


def add_parts(document):
    """Adds the parts of all errors to a run: an eighth of the MSE is in lights behind mirrors, a
    quarter in other mirrors."""
    document["first_hits"] = {
        "image": "images/first_hits.exr",
        "pixels": {"light_behind_delta": 0.0625, "delta": 0.25, "other": 0.6875},
        "noise_mse": {"light_behind_delta": 0.0, "delta": 0.0, "other": 0.01},
    }
    for curve in document["curves"]:
        for point in curve["points"]:
            point["mse_clipped"] = point["mse"] / 2
            for repetition in point["repetitions"]:
                mse = repetition["mse"]
                repetition["mse_clipped"] = mse / 2
                repetition["mse_parts"] = {
                    "light_behind_delta": mse / 8,
                    "delta": mse / 4,
                    "other": 5 * mse / 8,
                }


def legend_gap(figure):
    """Returns the distance, in inches, from the labels of a figure's first axes to its legend."""
    figure.canvas.draw()
    (legend,) = figure.legends
    bottom = figure.axes[0].xaxis.get_tightbbox().y0
    return (bottom - legend.get_window_extent().y1) / figure.dpi


class RunFolder(unittest.TestCase):
    """A temporary folder with the made-up run and its images."""

    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self.temporary.name) / "box"
        (self.folder / "images").mkdir(parents=True)
        self.document = made_up_run()
        generator = numpy.random.default_rng(1)
        for name in ("reference", "ours", "early"):
            numpy.save(
                self.folder / f"images/{name}.npy", generator.random((4, 4, 3), dtype=numpy.float32)
            )

    def tearDown(self):
        self.temporary.cleanup()

    def add_parts(self):
        """Adds the parts of all errors to the run, and the picture of the classes."""
        add_parts(self.document)
        classes = numpy.zeros((4, 4, 3), dtype=numpy.float32)
        classes[..., 2] = 1
        classes[0] = (0, 1, 0)
        classes[0, 0] = (1, 0, 0)
        numpy.save(self.folder / "images/first_hits.npy", classes)

    def run_object(self):
        """Writes the document; returns its run."""
        (self.folder / "run.json").write_text(json.dumps(self.document))
        return Run(self.folder)

    def results(self, *arguments):
        """Runs scripts/results."""
        return script("results", *arguments)
