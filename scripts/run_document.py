# SPDX-License-Identifier: MIT
"""Reads run.json: what tables, plots and the report are made of.

Everything made from a run is a pure function of its folder. A missing value is an error, never a zero.
"""

import argparse
import json
import math
import pathlib
import sys


class RunError(Exception):
    """A run folder that cannot be used; the message names file, key and remedy."""


class Run:
    """One folder with run.json and images/*.npy (exported by `rtrays-experiment report`)."""

    schema_version = 2

    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        path = self.folder / "run.json"
        try:
            self.document = json.loads(path.read_text())
        except OSError as error:
            raise RunError(f"{path}: {error.strerror}; rtrays-experiment run ... --out {folder} makes it") from error
        except ValueError as error:
            raise RunError(f"{path}: not JSON: {error}") from error
        version = value(self.document, "schema_version")
        if version != self.schema_version:
            raise RunError(f"{path}: schema_version {version}, these scripts read {self.schema_version}; run it anew")

    @property
    def curves(self):
        return value(self.document, "curves")

    def get(self, path):
        """The value at a dotted path; RunError naming the file when there is none."""
        try:
            return value(self.document, path)
        except RunError as error:
            raise RunError(f"{self.folder / 'run.json'}: {error}") from error

    @property
    def clock(self):
        """The time that speeds compare: "wall" where a GPU works, else "processor", of all threads together."""
        return "wall" if value(self.document, "context.device").get("type") == "gpu" else "processor"

    def has_images(self):
        """Whether they are there; a clone has the pages that were made of them."""
        return (self.folder / self.get("reference.image")).with_suffix(".npy").exists()

    def image(self, relative):
        """Linear R, G, B of an image named in run.json, shape (height, width, 3)."""
        return self._array((self.folder / relative).with_suffix(".npy"))

    def layer(self, relative, name):
        """The same of one of its layers, which add up to it."""
        return self._array((self.folder / relative).with_suffix(f".{name}.npy"))

    def _array(self, path):
        import numpy

        try:
            return numpy.load(path)
        except OSError as error:
            raise RunError(
                f"{path}: {error.strerror or error}; rtrays-experiment report {self.folder} makes it from the EXR"
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
    """Those whose images have figures, of path tracing by MIS and of truncated BDPT as it is by default; all of a run that
    has neither. The viewer has the images of all."""
    shown = [curve for curve in run.curves if value(curve, "id") in ("truncated_bdpt.mis", "path_tracing.mis")]
    return shown or run.curves


def is_blind(curve):
    """Whether the algorithm does not see all light of the scene: of light tracing, what mirrors and glass show."""
    return value(curve, "algorithm") == "light_tracing" and "delta" in value(curve, "render_report.features")


def is_stratified(curve):
    """Whether its samples fill the domain evenly, so that errors may fall faster than those of independent ones."""
    return value(curve, "settings").get("integrator.sampler") == "sobol"


def pilot_seconds(curve):
    """Device time of the pilot that chose the number of light paths; zero where there was none."""
    return value(curve, "render_report.pilot.seconds") if "pilot" in value(curve, "render_report") else 0.0


def usable_points(curve):
    """The points before the first where the reference's noise dominates: where curves stop."""
    points = []
    for point in value(curve, "points"):
        if value(point, "noise_dominates"):
            break
        points.append(point)
    return points


def slope_verdict(slope, expected, tolerance):
    """Whether an interval lies within, outside of, or across expected +/- tolerance."""
    low, high = expected - tolerance, expected + tolerance
    measured_low, measured_high = value(slope, "low"), value(slope, "high")
    if low <= measured_low and measured_high <= high:
        return "holds"
    if measured_high < low or measured_low > high:
        return "does not hold here"
    return "undecided"


def gain_verdict(gain, claimed):
    """Whether an interval reaches the factor claimed, is a gain at all, or a loss."""
    if value(gain, "low") > 1:
        return "holds" if value(gain, "high") >= claimed else "holds partly"
    return "does not hold here" if value(gain, "high") < claimed else "undecided"


def agreement_verdict(agreement):
    """The image claim: the same picture as the reference, up to noise."""
    if not value(agreement, "agrees") or value(agreement, "equivalence") == "different":
        return "does not hold here"
    return "holds" if value(agreement, "equivalence") == "equivalent" else "undecided"


def label(curve):
    """How a curve is called in tables and legends."""
    algorithm, _, settings = value(curve, "id").partition(".")
    return f"{algorithm} ({settings})".replace("_", " ").replace(",", ", ").replace("=", " = ")


def write_text(path, text):
    """Writes a file whole or not at all."""
    temporary = path.with_name(path.name + ".tmp")
    temporary.write_text(text)
    temporary.replace(path)


def run_script(program, description, body):
    """A script's main: calls `body` with the runs of the folders named on the command line; returns the exit code.

    An error becomes one line on stderr: exit code 2 for a folder that cannot be used, 1 for anything else.
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
        print(f"{program}: {error}; install python3-numpy, python3-matplotlib and python3-markdown", file=sys.stderr)
        return 1
    except OSError as error:
        print(f"{program}: {error}", file=sys.stderr)
        return 1
    return 0
