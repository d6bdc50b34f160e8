# SPDX-License-Identifier: MIT
"""Tests runs: versions, missing folders, curves, and the clock that speeds compare."""

import unittest

from rtrays.documents.curves import usable_points
from rtrays.documents.document import RunError
from rtrays.documents.run_document import Run
from rtrays.testing import RunFolder


class Documents(RunFolder):
    def test_other_schema_version_is_refused(self):
        self.document["schema_version"] = 99
        with self.assertRaisesRegex(RunError, "99"):
            self.run_object()

    def test_missing_folder_names_the_command(self):
        with self.assertRaisesRegex(RunError, "rtrays-experiment run"):
            Run(self.folder / "nowhere")

    def test_curves_stop_at_the_noise_floor(self):
        self.assertEqual(
            [point["spp"] for point in usable_points(self.document["curves"][0])], [1, 2, 4]
        )


class Clock(unittest.TestCase):
    def clock(self, device):
        run = Run.__new__(Run)
        run.document = {"context": {"device": device}}
        return run.clock

    def test_a_gpu_is_timed_by_the_wall(self):
        self.assertEqual(self.clock({"name": "H100", "type": "gpu"}), "wall")
        self.assertEqual(self.clock({"name": "EPYC", "type": "cpu"}), "processor")
        self.assertEqual(self.clock({"name": "of an older run"}), "processor")


if __name__ == "__main__":
    unittest.main()
