# SPDX-License-Identifier: MIT
"""Tests of the program rtrays-experiment: measurements, their tables and plots."""

import json
import pathlib
import subprocess
import sys

from program_testing import EXPERIMENTS, ProgramTest, run_tests, shipped


class Measurements(ProgramTest):
    def tables(self, out):
        return subprocess.run(
            [sys.executable, EXPERIMENTS.parent / "scripts/results", "page", out],
            capture_output=True, text=True, check=False)

    def test_measurements(self):
        """Every contestant has its figures, and tables and plots are made from them."""
        rows = {"bvh_build": 7, "bvh_animation": 3, "ray_rates": 6, "traversal": 4}
        for name, contestants in rows.items():
            out = self.folder / name
            done = self.call(
                "run", shipped(name), "--profile", "ci", "--out", out, "--quiet")
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertEqual(done.stdout.splitlines()[-1], str(out / "run.json"))
            self.assertEqual([path.name for path in out.iterdir()], ["run.json"])
            run = json.loads((out / "run.json").read_text())
            for row in run["rows"]:
                for group in row.get("kinds", [row]):
                    entries = group.get("contestants", group.get("layouts", group.get("frames")))
                    self.assertGreaterEqual(len(entries), contestants)
            made = self.tables(out)
            self.assertEqual(made.returncode, 0, made.stderr)
            table = pathlib.Path(made.stdout.strip()).read_text()
            for row in run["rows"]:
                self.assertIn(row["mesh"].replace("_", " "), table)
        self.assertTrue((self.folder / "bvh_build/build_time.svg").exists())
        self.assertTrue((self.folder / "bvh_animation/animation.svg").exists())
        self.assertTrue((self.folder / "ray_rates/speeds.svg").exists())
        # A missing figure is an error, never a gap in a table.
        run = json.loads((self.folder / "bvh_build/run.json").read_text())
        del run["rows"][1]["contestants"][2]["wall_ms"]
        (self.folder / "bvh_build/run.json").write_text(json.dumps(run))
        made = self.tables(self.folder / "bvh_build")
        self.assertEqual(made.returncode, 2)
        self.assertIn("wall_ms", made.stderr)
        self.refused(2, "wall_ms", "report", self.folder / "bvh_build")

    def frames(self, name, figure):
        """Returns the run of a ci profile and the page made from it."""
        out = self.folder / name
        done = self.call(
            "run", shipped(name), "--profile", "ci", "--out", out, "--quiet")
        self.assertEqual(done.returncode, 0, done.stderr)
        run = json.loads((out / "run.json").read_text())
        made = self.tables(out)
        self.assertEqual(made.returncode, 0, made.stderr)
        self.assertTrue((out / f"{figure}.svg").exists())
        text = pathlib.Path(made.stdout.strip()).read_text()
        for row in run["rows"]:
            self.assertIn(row["mesh"].replace("_", " ") + " (procedural)", text)
        return run, text

    def test_references_are_tested_against_each_other(self):
        """Every pair is tested once, and missing renderers have no row."""
        out = self.folder / "out"
        done = self.call(
            "run", shipped("reference_agreement"), "--profile", "ci",
            "--out", out, "--quiet")
        self.assertEqual(done.returncode, 0, done.stderr)
        rows = json.loads((out / "run.json").read_text())["rows"]
        self.assertEqual(
            [row.get("scene") or row["probe"] for row in rows], ["cornell_box", "goblet_rim_flat"])
        for row in rows:
            there = [renderer["name"] for renderer in row["renderers"]]
            self.assertEqual(
                sorted(there + row["absent"]), ["cycles", "embree", "mitsuba", "renderer"])
            self.assertEqual(
                {(pair["image"], pair["against"]) for pair in row["pairs"]},
                {(image, against) for i, image in enumerate(there) for against in there[:i]})
        for pair in rows[0]["pairs"]:
            self.assertTrue(pair["agreement"]["agrees"], pair)
        made = self.tables(out)
        self.assertEqual(made.returncode, 0, made.stderr)
        page = pathlib.Path(made.stdout.strip()).read_text()
        self.assertIn("| cornell box | renderer | embree |", page)
        self.assertIn("| goblet rim flat | RTRays, path tracing (MIS) | 4 |", page)

    def test_frame_times(self):
        """No kind has more rays than pixels, and the launched stages are listed."""
        run, text = self.frames("frame_times", "stage_shares")
        self.assertIn("GTX 580", text)
        width, height = run["experiment"]["settings"]["size"]
        for row in run["rows"]:
            # Each lamp has two triangles.
            self.assertEqual(row["triangles"] - 1000, 0 if "court" in row["mesh"] else 6)
            self.assertEqual(row["rays"]["primary"], width * height)
            for kind in ("shadow", "secondary"):
                self.assertTrue(0 < row["rays"][kind] <= width * height, row["rays"])
            self.assertGreater(row["rays"]["frame"], row["rays"]["primary"] + row["rays"]["shadow"])
            self.assertLessEqual(
                {"generate_camera_rays", "intersect_nearest", "intersect_any", "extend_path"},
                {stage["name"] for stage in row["stages"]})

    def test_bounces(self):
        """Explicit paths with b bounces trace at most 2 (b + 1) rays, also in the reference."""
        run, _ = self.frames("bounces", "samples_per_second")
        for row in run["rows"]:
            self.assertEqual([depth["bounces"] for depth in row["depths"]], [1, 4, 8])
            for depth in row["depths"]:
                for key in ("rays_per_sample", "reference_rays_per_sample"):
                    self.assertTrue(1 < depth[key] <= 2 * depth["bounces"] + 2, depth)
                self.assertAlmostEqual(
                    depth["rays_per_sample"] / depth["reference_rays_per_sample"], 1, delta=0.2)
                self.assertEqual(len(depth["contestants"]), 3)

    def test_renderers(self):
        document = json.loads((shipped("renderers")).read_text())
        document["profiles"]["ci"].update(peers=["scalar_rgb"])
        out = self.folder / "out"
        done = self.call(
            "run", self.measurement("renderers", profiles=document["profiles"]),
            "--profile", "ci", "--out", out, "--quiet")
        self.assertEqual(done.returncode, 0, done.stderr)
        made = self.tables(out)
        self.assertEqual(made.returncode, 0, made.stderr)
        (row,) = json.loads((out / "run.json").read_text())["rows"]
        others = [c["name"] for c in row["contestants"] if not c["is_ours"]]
        self.assertEqual(len(row["contestants"]), 3 + len(others))
        self.assertEqual(len(others), 0 if row["absent_peers"] else 2)
        for contestant in row["contestants"]:
            for turn in contestant["turns"]:
                self.assertGreater(turn["mse"], 0)
                self.assertGreater(turn["seconds_processor"], 0)

    def test_peers_are_contestants_or_listed_as_absent(self):
        document = json.loads((shipped("bounces")).read_text())
        document["profiles"]["ci"].update(scenes=["hall_100"], peers=["scalar_rgb", "cycles"])
        out = self.folder / "out"
        done = self.call(
            "run", self.measurement("bounces", profiles=document["profiles"]),
            "--profile", "ci", "--out", out, "--quiet")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(self.tables(out).returncode, 0)
        (row,) = json.loads((out / "run.json").read_text())["rows"]
        for depth in row["depths"]:
            peers = [c["name"] for c in depth["contestants"]
                     if c["name"].startswith(("Mitsuba 3", "Cycles"))]
            self.assertEqual(len(peers) + len(row["absent_peers"]), 2)
            self.assertTrue(set(peers) <= set(depth["wavefront_over"]))

    def settings_in_turn(self, name):
        """Checks that every setting has its figures, and returns the builds by setting."""
        run, text = self.frames(name, "speeds_over_defaults")
        (row,) = run["rows"]
        frames, builds = (
            {entry["name"]: entry for entry in row[what]} for what in ("frames", "builds"))
        self.assertEqual(list(frames), ["defaults", *run["experiment"]["settings"]["settings"]])
        for setting in (*frames, *builds):
            self.assertIn(f"| {setting} |", text)
        return builds

    def test_ablations(self):
        self.settings_in_turn("ablations")

    def test_binning(self):
        """Changed bins give another tree, and equal bins give an equal tree."""
        builds = self.settings_in_turn("binning")
        self.assertEqual(builds["device.bvh_bins=16"]["sah"], builds["defaults"]["sah"])
        for other in ("device.bvh_bins=4", "device.bvh_axes=widest"):
            self.assertGreater(builds[other]["sah"], builds["defaults"]["sah"])

    def test_measurement_is_refused(self):
        self.refused(2, "ray_rates", "run", self.measurement("bvh_build", kind="colours"))
        self.refused(2, "unknown key 'colour'", "run", self.measurement("bvh_build", colour="red"))
        profiles = {
            name: {"meshes": ["cornell_box"], "rays": 10} for name in ("quick", "full", "ci")}
        self.refused(2, "repetitions", "run", self.measurement("ray_rates", profiles=profiles))
        self.refused(2, "watertight_rays", "run", self.measurement("traversal", profiles=profiles))
        self.refused(2, "scenes", "run", self.measurement("frame_times", profiles=profiles))

    def test_setting_that_is_none(self):
        profiles = {
            name: {
                "scenes": ["hall_100"], "size": [8, 8], "repetitions": 6,
                "settings": ["device.bvh_bins=5"]}
            for name in ("quick", "full", "ci")}
        self.refused(
            2, "4, 8, 16, 32", "run", self.measurement("ablations", profiles=profiles),
            "--profile", "ci")

    def test_absent_meshes_are_replaced_or_listed(self):
        profiles = {
            name: {"meshes": ["bunny", "sibenik"], "rays": 64, "repetitions": 6}
            for name in ("quick", "full", "ci")}
        path = self.measurement(
            "bvh_build", profiles=profiles, stand_ins={"bunny": "scattered_100"})
        done = self.call("run", path, "--profile", "ci", "--out", self.folder / "out", "--quiet",
                         RTRAYS_MESHES=str(self.folder))
        self.assertEqual(done.returncode, 0, done.stderr)
        run = json.loads((self.folder / "out/run.json").read_text())
        self.assertEqual(run["stand_ins"], {"scattered_100": "bunny"})
        self.assertEqual(run["absent"], ["sibenik"])
        self.assertEqual(
            [(row["mesh"], row["triangles"]) for row in run["rows"]], [("scattered_100", 100)])

    def test_unknown_meshes_and_scenes_are_errors(self):
        for key, name in (("meshes", "bvh_build"), ("scenes", "bounces")):
            profiles = json.loads(shipped(name).read_text())["profiles"]
            profiles["ci"][key] = ["nowhere"]
            self.refused(
                2, "'nowhere': unknown name", "run", self.measurement(name, profiles=profiles),
                "--profile", "ci", "--dry-run")


if __name__ == "__main__":
    run_tests()
