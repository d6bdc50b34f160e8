#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Installs a build into a prefix, moves the prefix, and uses the programs there.

  install_test.py BUILD
"""

import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

BUILD = pathlib.Path(sys.argv[1])
STORED_RUN = pathlib.Path(__file__).resolve().parents[2] / "results/chapter4/cornell_diffuse"


class Installation(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        folder = pathlib.Path(cls.temporary.name)
        cls.prefix = folder / "moved"
        subprocess.run(["cmake", "--install", BUILD, "--prefix", folder / "prefix"],
                       check=True, stdout=subprocess.DEVNULL)
        (folder / "prefix").rename(cls.prefix)
        cls.share = cls.prefix / "share/rtrays"

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def run_program(self, name, *arguments):
        result = subprocess.run([self.prefix / "bin" / name, *map(str, arguments)],
                                cwd=self.prefix, capture_output=True, text=True)
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        return result.stdout

    def test_programs_state_their_version(self):
        for name in ("rtrays-render", "rtrays-reference", "rtrays-experiment"):
            self.assertIn(name, self.run_program(name, "--version"))

    def test_a_scene_with_textures_renders_for_display(self):
        image = self.prefix / "image.png"
        scene = self.share / "scenes/features/texture_nearest.json"
        self.run_program("rtrays-render", scene, "-o", image, "--size", "8x8", "--spp", 1)
        self.assertEqual(image.read_bytes()[:4], b"\x89PNG")

    def test_experiments_find_their_scenes_and_references(self):
        for name in ("chapter4/cornell_diffuse", "speed/bvh_build",
                     "chapter4/reference_agreement"):
            file = self.share / f"experiments/{name}.json"
            self.run_program("rtrays-experiment", "run", file, "--dry-run")

    def test_a_report_is_made_by_the_installed_scripts(self):
        run = self.prefix / "run"
        shutil.copytree(STORED_RUN, run, ignore=shutil.ignore_patterns("index.html"))
        self.run_program("rtrays-experiment", "report", run)
        self.assertTrue((run / "index.html").exists())


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
