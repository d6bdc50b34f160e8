# SPDX-License-Identifier: MIT
"""Tests the figures of claims from measurements of the hierarchy."""

import unittest

from rtrays.claims.testing import Folders
from rtrays.testing import interval


class HierarchyFigures(Folders):
    def test_hierarchy(self):
        def row(mesh, triangles, ms):
            return {
                "mesh": mesh,
                "triangles": triangles,
                "contestants": [
                    {
                        "name": "sah",
                        "wall_ms": interval(ms, ms),
                        "processor_ms": interval(ms, ms),
                        "speed_over_embree": interval(0.01 * ms, 0.01 * ms),
                    }
                ],
            }

        published = {
            "rows": [
                {"mesh": mesh, "ms": {"thesis": ms}} for mesh, ms in (("a", 1), ("b", 2), ("c", 3))
            ]
        }
        document = {
            "schema_version": 3,
            "experiment": {"published": published},
            "stand_ins": {"x": "b"},
            "rows": [
                row("a", 1000, 10),
                row("x", 4000, 20),
                row("c", 6000, 15),
                row("other", 10, 1),
            ],
        }
        self.write("build", document)
        (order,) = self.figures("published_order", "build", contestant="sah").values()
        self.assertAlmostEqual(order["value"], 0.5)  # one of three out of place by one
        (rate,) = self.figures("build_rate", "build", contestant="sah").values()
        self.assertAlmostEqual(rate["value"], 0.4)
        ((name, gain),) = self.figures("build_gain", "build", contestant="sah").items()
        self.assertEqual((name, gain["value"]), ("x, over Embree", 0.2))

        def shape(check, limit, *misses):
            return {
                "check": check,
                "mesh": f"shape {limit}",
                "rays": 1000,
                "layouts": [{"misses": m, "limit": limit} for m in misses],
            }

        self.write(
            "traversal",
            {
                "schema_version": 3,
                "rows": [
                    shape("hits", 0),
                    shape("watertight", 0, 0, 3),
                    shape("watertight", 1e-5, 9),
                ],
            },
        )
        (misses,) = self.figures("leaks", "traversal").values()
        self.assertEqual(misses["value"], 3)


if __name__ == "__main__":
    unittest.main()
