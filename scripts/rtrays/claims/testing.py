# SPDX-License-Identifier: MIT
"""Folders of runs for the tests of claims."""

import json
import pathlib
import tempfile
import unittest

from rtrays.claims.readers import READERS


class Folders(unittest.TestCase):
    """A temporary folder of runs, from which claims are judged."""

    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self.temporary.name)

    def tearDown(self):
        self.temporary.cleanup()

    def write(self, name, document):
        """Writes the document of a run; returns its folder."""
        (self.folder / name).mkdir(exist_ok=True)
        (self.folder / name / "run.json").write_text(json.dumps(document))
        return self.folder / name

    def figures(self, reader, name, **options):
        """Returns the figures that a reader finds in a run."""
        return dict(READERS[reader](self.folder / name, **options))
