# SPDX-License-Identifier: MIT
"""Reads run.json, from which tables, plots and pages are made.

Everything made from a run is a function of its folder and of the prose of the experiment file. A
missing value is an error, never a zero.
"""

import argparse
import json
import math
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
EXPERIMENTS = ROOT / "experiments"


def experiment_file(name):
    """Returns the path of an experiment below experiments/, or None if there is no such file."""
    return next(EXPERIMENTS.rglob(f"{name}.json"), None)


def experiment_path(name):
    """Returns the path of an experiment relative to the repository, for commands in texts."""
    return (experiment_file(name) or EXPERIMENTS / f"{name}.json").relative_to(ROOT).as_posix()


class RunError(Exception):
    """A run folder that cannot be used; the message names the file, the key and the remedy."""


class Run:
    """One folder with run.json and images/*.npy (exported by `rtrays-experiment report`)."""

    schema_version = 2

    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        path = self.folder / "run.json"
        try:
            self.document = json.loads(path.read_text())
        except OSError as error:
            raise RunError(
                f"{path}: {error.strerror}; rtrays-experiment run ... --out {folder} makes it"
            ) from error
        except ValueError as error:
            raise RunError(f"{path}: not JSON: {error}") from error
        version = value(self.document, "schema_version")
        if version != self.schema_version:
            raise RunError(
                f"{path}: schema_version {version}, these scripts read {self.schema_version}; run"
                " the experiment again"
            )

    @property
    def curves(self):
        return value(self.document, "curves")

    def get(self, path):
        """The value at a dotted path; RunError naming the file when there is none."""
        try:
            return value(self.document, path)
        except RunError as error:
            raise RunError(f"{self.folder / 'run.json'}: {error}") from error

    def prose(self, key):
        """Returns the "title", "thesis", "claim", "questions" or "findings" of the experiment.

        It comes from the file NAME.json below experiments/ where that exists, so that its wording
        can improve after the run; else from run.json. The numbers of a page come from run.json
        alone.
        """
        path = experiment_file(self.get("experiment.name"))
        own = json.loads(path.read_text()).get(key) if path else None
        return own or value(self.document, "experiment").get(key) or ""

    @property
    def source(self):
        """The part of the thesis that the experiment is about; empty for an experiment of one's
        own."""
        return "" if self.prose("thesis").lower() in ("", "none") else self.prose("thesis")

    @property
    def clock(self):
        """The time that speeds compare: "wall" of a GPU, else "processor", of all threads
        together."""
        return (
            "wall" if value(self.document, "context.device").get("type") == "gpu" else "processor"
        )

    def has_images(self):
        """Whether the images are here; a clone has only the plots that were made from them."""
        array = (self.folder / self.get("reference.image")).with_suffix(".npy")
        if not array.exists() and array.with_suffix(".exr").exists():
            raise RunError(
                f"{array}: missing; rtrays-experiment report {self.folder} makes it from the EXR"
            )
        return array.exists()

    def image(self, relative):
        """Linear R, G, B of an image named in run.json, shape (height, width, 3)."""
        return self._array((self.folder / relative).with_suffix(".npy"))

    def layer(self, relative, name):
        """Linear R, G, B of one layer of an image; the layers of an image add up to it."""
        return self._array((self.folder / relative).with_suffix(f".{name}.npy"))

    def _array(self, path):
        import numpy

        try:
            return numpy.load(path)
        except OSError as error:
            raise RunError(
                f"{path}: {error.strerror or error}; rtrays-experiment report {self.folder} makes"
                " it from the EXR"
            ) from error


class Measurement(Run):
    """One folder with the run.json of a measurement of the hierarchy, without images."""

    schema_version = 1


def value(document, path):
    """The number, text, list or object at a dotted path. Absent, null and non-finite are errors."""
    current = document
    for key in path.split("."):
        try:
            current = current[int(key)] if isinstance(current, list) else current[key]
        except (KeyError, IndexError, TypeError, ValueError):
            raise RunError(f"missing value: {path}") from None
    if current is None or (isinstance(current, float) and not math.isfinite(current)):
        raise RunError(f"missing value: {path}")
    return current


def shown_curves(run):
    """Returns the curves whose images have figures: path tracing by MIS and truncated BDPT with
    its defaults, or all curves of a run that has neither. The viewer has the images of all
    curves."""
    shown = [
        curve
        for curve in run.curves
        if value(curve, "id") in ("truncated_bdpt.mis", "path_tracing.mis")
    ]
    return shown or run.curves


def is_blind(curve):
    """Whether the algorithm misses light of the scene: light tracing does not see into mirrors and
    glass."""
    return value(curve, "algorithm") == "light_tracing" and "delta" in value(
        curve, "render_report.features"
    )


def is_stratified(curve):
    """Whether the samples fill the domain evenly, so that errors may fall faster than with
    independent samples."""
    return value(curve, "settings").get("integrator.sampler") == "sobol"


def commit_of(context):
    """The commit of a run, and whether the tree had changes."""
    return value(context, "commit") + (
        " with uncommitted changes" if value(context, "dirty") else ""
    )


def pilot_seconds(curve):
    """Device time of the pilot that chose the number of light paths; zero without a pilot."""
    return (
        value(curve, "render_report.pilot.seconds")
        if "pilot" in value(curve, "render_report")
        else 0.0
    )


def seconds(curve, entry, clock):
    """Seconds of a point or repetition, the pilot included, by `clock`: "device" or "wall".

    In run.json the device's seconds include the pilot, those on the wall do not; its device time
    is added to them.
    """
    return value(entry, f"seconds_{clock}") + (pilot_seconds(curve) if clock == "wall" else 0.0)


def usable_points(curve):
    """Returns the points before the first one that the reference's noise dominates; curves stop
    there."""
    points = []
    for point in value(curve, "points"):
        if value(point, "noise_dominates"):
            break
        points.append(point)
    return points


def slope_verdict(slope, expected, tolerance):
    """Judges whether an interval lies within, outside of, or across expected +/- tolerance."""
    low, high = expected - tolerance, expected + tolerance
    measured_low, measured_high = value(slope, "low"), value(slope, "high")
    if low <= measured_low and measured_high <= high:
        return "holds"
    if measured_high < low or measured_low > high:
        return "does not hold here"
    return "undecided"


def gain_verdict(gain, claimed):
    """Judges whether an interval reaches the claimed factor, is a gain at all, or a loss."""
    if value(gain, "low") > 1:
        return "holds" if value(gain, "high") >= claimed else "holds partly"
    return "does not hold here" if value(gain, "high") < claimed else "undecided"


def agreement_verdict(agreement):
    """Judges whether the image equals the reference up to noise."""
    if not value(agreement, "agrees") or value(agreement, "equivalence") == "different":
        return "does not hold here"
    return "holds" if value(agreement, "equivalence") == "equivalent" else "undecided"


NAMES = {"bdpt": "BDPT", "truncated_bdpt": "truncated BDPT", "mis": "MIS"}


def algorithm_name(name):
    """The name of an algorithm in text, of the harness' "path_tracing explicit" too."""
    return " ".join(NAMES.get(word, word.replace("_", " ")) for word in name.split(" "))


def label(curve):
    """The name of a curve in tables and legends."""
    algorithm, _, settings = value(curve, "id").partition(".")
    shown = [
        NAMES.get(setting, setting.replace("_", " ").replace("=", " = "))
        for setting in settings.split(",")
    ]
    return f"{algorithm_name(algorithm)} ({', '.join(shown)})"


def file_name(text):
    """A file name without blanks and commas, made from the id of a curve."""
    return re.sub(r"[^\w.=-]+", "_", text)


def write_text(path, text):
    """Writes a file completely or not at all."""
    temporary = path.with_name(path.name + ".tmp")
    temporary.write_text(text)
    temporary.replace(path)


def run_script(program, description, body):
    """Calls `body` with the runs of the folders named on the command line, as a script's main;
    returns the exit code.

    An error becomes one line on stderr: exit code 2 for a folder that cannot be used, 1 for
    anything else.
    """
    parser = argparse.ArgumentParser(prog=program, description=description)
    parser.add_argument("runs", metavar="DIR", nargs="+", help="folder of a finished run")
    folders = parser.parse_args().runs
    try:
        body([Run(folder) for folder in folders])
    except RunError as error:
        print(f"{program}: {error}", file=sys.stderr)
        return 2
    except ImportError as error:
        print(
            f"{program}: {error}; install python3-numpy, python3-matplotlib and python3-jinja2",
            file=sys.stderr,
        )
        return 1
    except OSError as error:
        print(f"{program}: {error}", file=sys.stderr)
        return 1
    return 0
