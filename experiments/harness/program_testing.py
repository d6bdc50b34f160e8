# SPDX-License-Identifier: MIT
"""What the tests of the program rtrays-experiment share. The first argument is the program."""

import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

PROGRAM = os.path.abspath(sys.argv[1])
EXPERIMENTS = pathlib.Path(__file__).resolve().parent.parent
REFERENCES = EXPERIMENTS.parent / "results/references"


def shipped(name):
    """Returns the path of an experiment of the repository."""
    (path,) = EXPERIMENTS.glob(f"*/{name}.json")
    return path


class ProgramTest(unittest.TestCase):
    """Calls the program in a temporary folder."""

    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self.temporary.name)

    def tearDown(self):
        self.temporary.cleanup()

    def call(self, *arguments, **environment):
        return subprocess.run(
            [PROGRAM, *map(str, arguments)], capture_output=True, text=True, check=False,
            cwd=self.folder, env={**os.environ, **environment})

    def refused(self, code, text, *arguments):
        """Asserts that the call fails with the code and one message that contains the text."""
        done = self.call(*arguments)
        self.assertEqual(done.returncode, code, done.stderr)
        self.assertIn(text, done.stderr)
        self.assertTrue(done.stderr.startswith("rtrays-experiment: "), done.stderr)
        return done

    def experiment(self, **changes):
        """Returns a copy of the shipped experiment with absolute paths and changes."""
        document = json.loads((shipped("cornell_diffuse")).read_text())
        document["scene"] = str(EXPERIMENTS.parent / "scenes/cornell_box/scene.json")
        document["reference"]["folder"] = str(REFERENCES)
        document.update(changes)
        path = self.folder / "experiment.json"
        path.write_text(json.dumps(document))
        return path

    def measurement(self, name, **changes):
        """Returns a shipped measurement with changes."""
        document = json.loads((shipped(name)).read_text())
        document.update(changes)
        path = self.folder / f"{name}.json"
        path.write_text(json.dumps(document))
        return path


def run_tests():
    """Runs the tests of the main module with the arguments that follow the program."""
    del sys.argv[1]
    unittest.main()
