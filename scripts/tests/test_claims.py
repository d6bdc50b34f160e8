# SPDX-License-Identifier: MIT
"""Verdicts on the thesis' claims: the rules, the readers, and the page, with and without runs."""

import copy
import json
import pathlib
import sys
import tempfile
import unittest

SCRIPTS = pathlib.Path(__file__).resolve().parent.parent
sys.path[:0] = [str(SCRIPTS), str(SCRIPTS / "tests")]

import numpy  # noqa: E402

import claim_figures  # noqa: E402
from claims import (  # noqa: E402
    CLAIMS,
    all_counts,
    claim_row,
    claims_page,
    figure_verdict,
    is_thesis,
    judge,
    judge_all,
    overview,
    summary,
    verdict,
)
from run_document import Run, RunError  # noqa: E402
from tables import edges_table  # noqa: E402
from test_report import made_up_run  # noqa: E402


def interval(low, high):
    return {"value": (low + high) / 2, "low": low, "high": high}


class Rules(unittest.TestCase):
    def test_bounds(self):
        rule = {"within": [2, 3], "partly": [1, None]}
        for low, high, expected in (
            (2.1, 2.9, "holds"),
            (1.5, 2.5, "holds partly"),
            (3.5, 4, "holds partly"),
            (0.5, 0.9, "does not hold here"),
            (0.9, 1.5, "does not hold here"),
            (0.9, 2.5, "undecided"),
        ):
            self.assertEqual(figure_verdict(interval(low, high), rule), expected, (low, high))
        self.assertEqual(figure_verdict(interval(-5, 1), {"within": [None, 1.1]}), "holds")
        self.assertEqual(figure_verdict(interval(1, 1.2), {"within": [None, 1.1]}), "undecided")

    def test_gains(self):
        for low, high, expected in (
            (1.9, 2.1, "holds"),
            (1.2, 1.9, "holds partly"),
            (0.8, 0.9, "does not hold here"),
            (0.8, 2.5, "undecided"),
        ):
            self.assertEqual(
                figure_verdict(interval(low, high), {"gain": 2}), expected, (low, high)
            )

    def test_several_figures(self):
        for verdicts, expected in (
            (["holds", "holds"], "holds"),
            (["holds", "does not hold here"], "holds partly"),
            (["holds", "undecided"], "undecided"),
            (["holds partly", "undecided"], "holds partly"),
            (["does not hold here", "undecided"], "does not hold here"),
        ):
            self.assertEqual(verdict(verdicts), expected, verdicts)


class Folders(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self.temporary.name)

    def tearDown(self):
        self.temporary.cleanup()

    def write(self, name, document, file="run.json"):
        (self.folder / name).mkdir(exist_ok=True)
        (self.folder / name / file).write_text(json.dumps(document))
        return self.folder / name

    def figures(self, reader, name, **options):
        return dict(claim_figures.READERS[reader](self.folder / name, **options))


class Readers(Folders):
    def truncated_run(self):
        """Path tracing, and truncated BDPT with a quarter of the MSE, three times the time, and 12
        more bytes."""
        document = made_up_run()
        truncated = copy.deepcopy(document["curves"][1])
        truncated.update(id="truncated_bdpt.mis", algorithm="truncated_bdpt")
        truncated["render_report"]["bytes_per_path"] += 12
        for point in truncated["points"]:
            for repetition in point["repetitions"]:
                # The reference's noise of 0.01 is no error of its own.
                repetition["mse"] = 0.01 + (repetition["mse"] - 0.01) / 4
                repetition["seconds_device"] *= 3
        document["curves"].append(truncated)
        return document

    def test_gains_and_costs(self):
        self.write("box", self.truncated_run())
        for of, expected in (("spp", 4), ("seconds", 4 / 3)):
            (figure,) = self.figures("gain", "box", of=of).values()
            self.assertAlmostEqual(figure["value"], expected)
            self.assertAlmostEqual(figure["low"], expected)
        (figure,) = self.figures("sample_cost", "box").values()
        self.assertAlmostEqual(figure["value"], 3)
        (more,) = self.figures("memory", "box", curve="truncated_bdpt.mis", form="more").values()
        (times,) = self.figures("memory", "box", curve="truncated_bdpt.mis", form="times").values()
        self.assertEqual((more["value"], times["value"]), (12, 124 / 112))
        with self.assertRaisesRegex(RunError, "no curve bdpt.mis"):
            self.figures("gain", "box", of="spp", curve="bdpt.mis")

    def test_errors_at_edges(self):
        folder = self.write("box", made_up_run())
        (folder / "images").mkdir()
        reference = numpy.ones((8, 8, 3), dtype=numpy.float32)
        reference[:, 4:] = 2
        ours = reference + 0.1
        ours[:, 3:5] += 0.1  # either side of the edge
        numpy.save(folder / "images/reference.npy", reference)
        numpy.save(folder / "images/ours.npy", ours)
        self.assertEqual(self.figures("edge_errors", "box"), {})
        edges_table(Run(folder))
        (figure,) = self.figures("edge_errors", "box").values()
        self.assertAlmostEqual(figure["value"], 4, places=4)
        numpy.save(folder / "images/reference.npy", numpy.ones((8, 8, 3)))
        self.assertEqual(edges_table(Run(folder)).rows, [])

    def test_convergence_control_takes_the_best_error(self):
        rows = [
            {
                "scene": scene,
                "algorithm": "path_tracing",
                "error": error,
                "seconds": interval(low, high),
            }
            for scene, error, low, high in (
                ("mirror_ring", 0.01, 0.45, 0.55),
                ("mirror_ring", 0.03, 0.2, 0.3),
                ("box", 0.03, 0.1, 0.1),
            )
        ]
        self.write("control", {"rows": rows}, "convergence_control.json")
        ((name, figure),) = self.figures("control_gain", "control", scene="mirror_ring").items()
        self.assertEqual(name, "path tracing, error 0.03")
        self.assertAlmostEqual(figure["value"], 4)
        self.assertAlmostEqual(figure["low"], 1 / 0.3)

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
            "schema_version": 1,
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
                "schema_version": 1,
                "rows": [
                    shape("hits", 0),
                    shape("watertight", 0, 0, 3),
                    shape("watertight", 1e-5, 9),
                ],
            },
        )
        (misses,) = self.figures("leaks", "traversal").values()
        self.assertEqual(misses["value"], 3)

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
                {"schema_version": 1, "experiment": {"settings": {"size": size}}, "rows": [row]},
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

        self.write("run", {"schema_version": 1, "rows": [row("a", 0.5), row("b", 2)]})
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


class Page(Folders):
    def test_every_reader_is_told_what_it_takes(self):
        for section in json.loads(CLAIMS.read_text())["sections"]:
            for claim in section["claims"]:
                for source in claim["figures"]:
                    options = {
                        key: option for key, option in source.items() if key not in ("run", "read")
                    }
                    reader = claim_figures.READERS[source["read"]]
                    count = reader.__code__.co_argcount
                    needed = reader.__code__.co_varnames[1 : count - len(reader.__defaults__ or ())]
                    self.assertLessEqual(set(needed), set(options), source)
                    self.assertLessEqual(
                        set(options), set(reader.__code__.co_varnames[1:count]), source
                    )

    def test_gains_are_those_of_the_experiments(self):
        rules = {
            (source["run"], source.get("of")): claim["rule"].get("gain")
            for section in json.loads(CLAIMS.read_text())["sections"]
            for claim in section["claims"]
            for source in claim["figures"]
            if source["read"] == "gain" and "curve" not in source
        }
        for name in ("mirror_ring", "glass_goblets", "door_ajar", "floor_lamps"):
            expected = json.loads((CLAIMS.parent / f"chapter4/{name}.json").read_text())[
                "expected_gain"
            ]
            self.assertEqual(
                (rules[name, "spp"], rules[name, "seconds"]),
                (expected["samples"], expected["time"]),
                name,
            )

    def test_missing_runs_are_lines(self):
        sections = judge_all(self.folder)
        self.assertFalse(is_thesis(sections))
        claims_page(sections, self.folder).write()
        text = (self.folder / "claims/claims.md").read_text()
        self.assertNotIn("holds |", text)
        count = sum(
            len(section["claims"]) for section in json.loads(CLAIMS.read_text())["sections"]
        )
        self.assertIn(f"Of {count} claims of chapter 4, {count} are not measured.", text)
        self.assertEqual(
            summary(sections), f"Of {count} claims of chapter 4, {count} are not measured."
        )
        self.assertEqual(text.count(": not measured | not measured |"), count)
        self.assertEqual(overview(sections).columns[1:], ["not measured"])
        self.assertEqual(sum(int(row[1]) for row in overview(sections).rows), count)
        self.assertEqual(all_counts(sections), {"not measured": count})

    def test_what_was_measured_is_judged(self):
        self.write("cornell_diffuse", made_up_run())
        claim = {
            "claim": "It falls.",
            "thesis": "-1/2",
            "rule": {"within": [-0.53, -0.47]},
            "figures": [{"run": "cornell_diffuse", "read": "slopes"}],
        }
        row = claim_row(judge(claim, self.folder), self.folder)
        self.assertEqual(row[-1], "holds")
        self.assertIn("path tracing (MIS): -0.5 [-0.51, -0.49]", row[-2])
        self.assertEqual(row[0].html, "../cornell_diffuse/index.html")
        claim["figures"].append({"run": "cornell_bumps", "read": "slopes"})
        row = claim_row(judge(claim, self.folder), self.folder)
        self.assertEqual(row[-1], "holds, of what was measured")
        self.assertIn("cornell bumps: not measured", row[-2])
        claim["rule"] = {"within": [-0.45, -0.4]}
        self.assertEqual(
            claim_row(judge(claim, self.folder), self.folder)[-1],
            "does not hold here, of what was measured",
        )

    def test_undecided_claims_say_how_many_more_samples(self):
        self.write("cornell_diffuse", made_up_run())  # slopes of -0.5 [-0.51, -0.49]
        claim = {
            "claim": "It falls.",
            "thesis": "-1/2",
            "rule": {"within": [-0.505, None]},
            "figures": [{"run": "cornell_diffuse", "read": "slopes"}],
        }
        judged = judge(claim, self.folder)
        self.assertEqual(judged.verdict, "undecided")
        self.assertEqual(
            judged.verdict_text, "undecided: about 4 times as many repetitions would decide it"
        )


if __name__ == "__main__":
    unittest.main()
