#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Runs what the documentation tells a user to type.

  docs/commands_test.py BUILD    with the build folder

Every line of the ```sh blocks of PAGES runs, in order, in a temporary folder that looks like the
repository. `make TARGET` runs as `make -n`, and commands of NOT_RUN are only counted. Every
```json block of experiments.md is checked by `rtrays-experiment run --dry-run`.
"""

import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent
BUILD = pathlib.Path(sys.argv[1]).resolve()
PAGES = ["README.md", "docs/quick-start.md", "docs/user-guide.md"]
# Needs the network, a display, or a file of the reader's.
NOT_RUN = re.compile(r"git clone|cd |scripts/install|blender |tev |.*YOUR_")


def blocks(page, language):
    return re.findall(rf"^```{language}\n(.*?)^```", (ROOT / page).read_text(),
                      re.DOTALL | re.MULTILINE)


class Documentation(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self.temporary.name)
        for name in ("experiments", "scenes", "results", "scripts", "renderer", "Makefile"):
            (self.folder / name).symlink_to(ROOT / name)
        (self.folder / "build").mkdir()
        (self.folder / "build/bin").symlink_to(BUILD / "bin")

    def tearDown(self):
        self.temporary.cleanup()

    def run_line(self, line):
        if NOT_RUN.match(line):
            return
        if line.startswith("make "):
            command, folder = line.replace("make ", "make -n ", 1), ROOT
        else:
            command, folder = line, self.folder
        result = subprocess.run(["bash", "-c", command], cwd=folder, capture_output=True, text=True,
                                timeout=600)
        self.assertEqual(result.returncode, 0, f"{line}\n{result.stdout}{result.stderr}")

    def test_commands(self):
        for page in PAGES:
            lines = [line for block in blocks(page, "sh") for line in block.splitlines()
                     if line and not line.startswith("#")]
            self.assertGreater(len(lines), 0, page)
            for line in lines:
                with self.subTest(page=page, line=line):
                    self.run_line(line)

    def test_experiments(self):
        found = blocks("docs/experiments.md", "json")
        self.assertGreater(len(found), 0)
        for number, block in enumerate(found):
            with self.subTest(block=block):
                # Paths in an experiment are relative to its folder.
                folder = self.folder / "mine/questions"
                folder.mkdir(exist_ok=True, parents=True)
                file = folder / f"experiment_{number}.json"
                file.write_text(block)
                (folder.parent / "schema").unlink(missing_ok=True)
                (folder.parent / "schema").symlink_to(ROOT / "experiments/schema")
                self.run_line(f"build/bin/rtrays-experiment run {file} --dry-run")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
