# SPDX-License-Identifier: MIT
"""The table of what a GPU did, and the clock by which its runs are compared."""

import pathlib
import subprocess
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "scripts"))

from run_document import Run  # noqa: E402


def run_of(device):
    run = Run.__new__(Run)
    run.document = {"context": {"device": device}}
    return run


class GpuTable(unittest.TestCase):
    def test_the_stored_table_is_of_the_stored_runs(self):
        made = subprocess.run(
            [
                sys.executable,
                ROOT / "scripts/gpu_table",
                ROOT / "results/gpu/h100",
                ROOT / "results/chapter4",
            ],
            capture_output=True,
            text=True,
            check=True,
        )
        self.assertEqual(
            made.stdout,
            (ROOT / "results/gpu/h100.md").read_text(),
            "scripts/gpu_table results/gpu/h100 results/chapter4 > results/gpu/h100.md",
        )

    def test_a_gpu_is_timed_by_the_wall(self):
        self.assertEqual(run_of({"name": "H100", "type": "gpu"}).clock, "wall")
        self.assertEqual(run_of({"name": "EPYC", "type": "cpu"}).clock, "processor")
        self.assertEqual(run_of({"name": "of an older run"}).clock, "processor")


if __name__ == "__main__":
    unittest.main()
