# SPDX-License-Identifier: MIT
"""Tests the figures of claims from measurements of frames."""

import unittest

from rtrays.claims.testing import Folders
from rtrays.testing import interval


class FrameFigures(Folders):
    def test_frames(self):
        def stage(name, ms):
            return {"name": name, "ms": interval(0.9 * ms, 1.1 * ms)}

        row = {
            "mesh": "sponza_inside",
            "rays": {"primary": 1000, "shadow": 900, "secondary": 800},
            "primary_ms": interval(1, 1),
            "shadow_ms": interval(2, 2),
            "secondary_ms": interval(2, 2),
            "frame_ms": interval(9, 11),
            "stages": [
                stage("intersect_nearest", 4),
                stage("intersect_any", 2),
                stage("extend_path", 2),
            ],
        }
        for size in ([1024, 768], [256, 192]):  # the smaller last
            self.write(
                "frames",
                {"schema_version": 3, "experiment": {"settings": {"size": size}}, "rows": [row]},
            )
            self.assertEqual(
                [figure["high"] for figure in self.figures("frame_time", "frames").values()],
                [11] if size == [1024, 768] else [],
            )
        self.assertAlmostEqual(
            self.figures("frame_rate", "frames", kind="secondary")["sponza inside"]["value"], 0.4
        )
        self.assertAlmostEqual(self.figures("coherence", "frames")["sponza inside"]["value"], 2.5)
        share = self.figures("traced_share", "frames")["sponza inside"]
        self.assertAlmostEqual(share["value"], 0.75)
        self.assertAlmostEqual(share["low"], 5.4 / (5.4 + 2.2))

    def test_scenes_where_it_holds_best(self):
        def row(mesh, speed):
            depths = [
                {"bounces": b, "wavefront_over": {"megakernel": interval(b * speed, b * speed)}}
                for b in (1, 8)
            ]
            frames = [
                {"name": name, "speed_over_defaults": interval(s, s)}
                for name, s in (("defaults", 1), ("axes", 1 / speed))
            ]
            return {"mesh": mesh, "depths": depths, "frames": frames}

        self.write("run", {"schema_version": 3, "rows": [row("a", 0.5), row("b", 2)]})
        every = self.figures("wavefront_gain", "run", rival="megakernel", bounces=8)
        self.assertEqual(
            {name: figure["value"] for name, figure in every.items()}, {"a": 4, "b": 16}
        )
        self.assertEqual(
            list(self.figures("wavefront_gain", "run", rival="megakernel", bounces=8, best=True)),
            ["b"],
        )
        self.assertEqual(len(self.figures("ablation", "run", setting="axes")), 2)
        ((name, loss),) = self.figures("ablation", "run", setting="axes", best=True).items()
        self.assertEqual((name, loss["value"]), ("b, defaults over it", 2))
        self.assertEqual(self.figures("ablation", "run", setting="none", best=True), {})


if __name__ == "__main__":
    unittest.main()
