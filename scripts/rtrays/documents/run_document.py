# SPDX-License-Identifier: MIT
"""Folders of finished runs of all kinds: run.json and the images beside it.

Everything made from a run is a function of its folder and of the prose of its experiment.
"""

import pathlib

from rtrays.documents.document import RunError, read_json, value
from rtrays.documents.experiments import experiment


SCHEMA_VERSION = 3


class Run:
    """One folder with run.json and, for curves, images/*.npy (exported by `rtrays-experiment
    report`)."""

    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        path = self.folder / "run.json"
        self.document = read_json(path, f"rtrays-experiment run ... --out {folder}")
        version = value(self.document, "schema_version")
        if version != SCHEMA_VERSION:
            raise RunError(
                f"{path}: schema_version {version}, these scripts read {SCHEMA_VERSION}; run the"
                " experiment again"
            )

    @property
    def kind(self):
        """The kind of the experiment: "curves", "stability", "bvh_build" and so on."""
        return self.get("kind")

    @property
    def curves(self):
        """The curves of the run."""
        return value(self.document, "curves")

    def get(self, path):
        """Returns the value at a dotted path. Raises RunError naming the file without one."""
        try:
            return value(self.document, path)
        except RunError as error:
            raise RunError(f"{self.folder / 'run.json'}: {error}") from error

    def prose(self, key):
        """Returns the "title", "thesis", "claim", "questions" or "findings" of the experiment.

        It comes from the experiment's file where that exists, so that its wording can improve after
        the run; else from run.json. The numbers of a page come from run.json alone.
        """
        own = experiment(self.get("experiment.name")).get(key)
        return own or value(self.document, "experiment").get(key) or ""

    @property
    def source(self):
        """The part of the thesis that the experiment is about; empty for other experiments."""
        return "" if self.prose("thesis").lower() in ("", "none") else self.prose("thesis")

    @property
    def clock(self):
        """The time that speeds compare: "wall" of a GPU, else "processor", the sum of all
        threads."""
        is_gpu = value(self.document, "context.device").get("type") == "gpu"
        return "wall" if is_gpu else "processor"

    def has_images(self):
        """Whether the images are here; a clone has only the plots that were made from them."""
        array = (self.folder / self.get("reference.image")).with_suffix(".npy")
        if not array.exists() and array.with_suffix(".exr").exists():
            raise RunError(
                f"{array}: missing; rtrays-experiment report {self.folder} makes it from the EXR"
            )
        return array.exists()

    def image(self, relative):
        """Returns linear R, G, B of an image named in run.json, shape (height, width, 3)."""
        return self._array((self.folder / relative).with_suffix(".npy"))

    def layer(self, relative, name):
        """Returns linear R, G, B of one layer of an image; the layers of an image add up to it."""
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


def run_in(folder):
    """Returns the run in a folder, or None."""
    return Run(folder) if (folder / "run.json").is_file() else None
