# SPDX-License-Identifier: MIT
"""Tests the messages of scripts/peers if no peer is installed."""

import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

from rtrays.paths import ROOT


class MissingPeers(unittest.TestCase):
    def test_says_what_to_install(self):
        with tempfile.TemporaryDirectory() as folder:
            scripts = pathlib.Path(folder) / "scripts"  # a tree without build/peers
            shutil.copytree(ROOT / "scripts", scripts)
            done = subprocess.run(
                [sys.executable, scripts / "peers", "--programs", folder],
                capture_output=True,
                text=True,
                check=False,
                env={"PATH": folder},
            )
            self.assertEqual(done.returncode, 77, done.stderr)
            self.assertIn("scripts/install --peers", done.stderr)
            self.assertFalse((pathlib.Path(folder) / "build").exists())


if __name__ == "__main__":
    unittest.main()
