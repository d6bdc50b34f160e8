# SPDX-License-Identifier: MIT
"""Tests of the program rtrays-experiment: exit codes, messages and complete output files."""

import json
import pathlib
import subprocess
import sys

from program_testing import EXPERIMENTS, PROGRAM, REFERENCES, ProgramTest, run_tests, shipped

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "scripts"))

from rtrays.documents.sweep import gain  # noqa: E402


class Program(ProgramTest):
    def test_help_and_version(self):
        for arguments in (["--help"], ["run", "--help"], ["--version"]):
            done = self.call(*arguments)
            self.assertEqual(done.returncode, 0)
            self.assertIn(
                "rtrays-experiment" if arguments == ["--version"] else "Usage", done.stdout)

    def test_bad_usage(self):
        self.refused(2, "--help")
        self.refused(2, "--profil", "run", "x.json", "--profil", "quick")
        self.refused(
            2, "profiles are: ci, full, quick", "run", self.experiment(), "--profile", "fast")
        done = self.refused(2, "subcommands are: run, ", "gate", "x.json")
        self.assertIn("run takes experiments of all kinds", done.stderr)

    def test_missing_experiment(self):
        self.refused(2, "nowhere.json", "run", "nowhere.json")

    def test_kind(self):
        self.refused(2, "unknown kind \"colours\"; kinds are: curves, ", "run",
                     self.experiment(kind="colours"))
        path = self.folder / "kindless.json"
        path.write_text('{"name": "box"}')
        self.refused(2, "missing key 'kind'", "run", path)

    def test_options_of_other_kinds_are_refused(self):
        for name, option in (("gate_cornell_box", ["--profile", "quick"]),
                             ("gate_cornell_box", ["--out", "out"]),
                             ("cornell_diffuse", ["--check", "bitwise"]),
                             ("convergence_control", ["--update-baseline"]),
                             ("algorithms", ["--compile"]),
                             ("bvh_build", ["--compile"])):
            done = self.refused(2, f"{option[0]} does not apply to kind", "run", shipped(name),
                                *option)
            self.assertIn("--dry-run", done.stderr)
            self.assertEqual(list(self.folder.iterdir()), [])

    def test_every_shipped_experiment_has_a_plan(self):
        files = [path for path in EXPERIMENTS.glob("*/*.json") if path.parent.name != "schema"]
        self.assertGreater(len(files), 20)
        for path in files:
            profiles = json.loads(path.read_text()).get("profiles", {None: None})
            for profile in profiles:
                options = ["--profile", profile] if profile else []
                done = self.call("run", path, "--dry-run", *options)
                self.assertEqual(done.returncode, 0, done.stderr)
                self.assertGreater(len(done.stdout), 0)
        self.assertEqual(list(self.folder.iterdir()), [])

    def test_unknown_key(self):
        self.refused(2, "unknown key 'colour'", "run", self.experiment(colour="red"))

    def test_missing_scene(self):
        self.refused(2, "nowhere.json", "run", self.experiment(scene="nowhere.json"))

    def test_missing_reference_names_the_command(self):
        path = self.experiment(reference={"folder": str(self.folder), "engine": "embree"})
        self.refused(4, "rtrays-reference", "run", path, "--out", self.folder / "out")
        self.assertFalse((self.folder / "out").exists())

    def test_dry_run_writes_nothing(self):
        done = self.call("run", self.experiment(), "--profile", "ci", "--dry-run")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("path_tracing.mis", done.stdout)
        self.assertEqual([entry.name for entry in self.folder.iterdir()], ["experiment.json"])

    def test_compile_fills_the_cache_and_renders_nothing(self):
        experiment, cache = self.experiment(), self.folder / "cache"
        done = self.call("run", experiment, "--profile", "ci", "--compile", "--device", "pthread",
                         POCL_CACHE_DIR=str(cache))
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(
            sorted(entry.name for entry in self.folder.iterdir()), ["cache", "experiment.json"])
        self.assertTrue(list(cache.rglob("*.so")))

    def test_unwritable_output(self):
        (self.folder / "file").write_text("")
        self.refused(
            2, "file", "run", self.experiment(), "--profile", "ci", "--out", self.folder / "file")

    def test_no_such_device(self):
        self.refused(
            2, "abacus", "run", self.experiment(), "--profile", "ci", "--device", "abacus",
            "--out", "out")
        self.assertFalse((self.folder / "out/run.json").exists())

    def test_compare(self):
        images = [REFERENCES / f"cornell_box.embree.{half}.exr" for half in "ab"]
        done = self.call("compare", *images, "--json")
        self.assertEqual(done.returncode, 0, done.stderr)
        comparison = json.loads(done.stdout)
        self.assertTrue({"l2", "rmse", "mae", "relmse"} <= comparison.keys())
        self.assertTrue(comparison["agreement"]["agrees"])
        same = json.loads(self.call("compare", images[0], images[0], "--json").stdout)
        self.assertEqual(same["rmse"], 0)
        self.assertEqual(same["mean_ratio"], [1, 1, 1])
        self.refused(2, "nowhere.exr", "compare", images[0], "nowhere.exr")

    def test_average(self):
        images = [REFERENCES / f"cornell_box.embree.{half}.exr" for half in "ab"]
        average = self.folder / "average.exr"
        self.assertEqual(self.call("average", *images, "-o", average).returncode, 0)
        # The average's noise is correlated with that of a half, so only the means are compared.
        ratios = json.loads(self.call("compare", average, images[0], "--json").stdout)["mean_ratio"]
        self.assertTrue(all(abs(ratio - 1) < 1e-3 for ratio in ratios), ratios)
        self.refused(2, "at least two", "average", images[0], "-o", self.folder / "one.exr")
        self.assertFalse((self.folder / "one.exr").exists())

    def test_report_of_an_empty_folder(self):
        self.refused(2, "run.json", "report", self.folder)

    def control(self, **changes):
        """Returns the shipped convergence control file with absolute paths and changes.

        Its profile takes a few seconds."""
        document = json.loads((shipped("convergence_control")).read_text())
        document["folder"] = str(EXPERIMENTS.parent / "scenes")
        document["reference"]["folder"] = str(REFERENCES)
        for curve in document["curves"]:
            curve["settings"] = {
                "integrator.convergence.start": 8, "integrator.convergence.interval": 4}
        document["errors"] = [0.5]
        document["profiles"]["quick"] = {
            "size": 16, "spp": 16, "seeds": 8, "scenes": ["cornell_box"]}
        document.update(changes)
        path = self.folder / "control.json"
        path.write_text(json.dumps(document))
        return path

    def test_control(self):
        out = self.folder / "out"
        done = self.call("run", self.control(), "--out", out, "--quiet")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(done.stdout.strip(), str(out / "run.json"))
        self.assertEqual([path.name for path in out.iterdir()], ["run.json"])
        rows = json.loads((out / "run.json").read_text())["rows"]
        self.assertEqual([row["algorithm"] for row in rows], ["path_tracing", "truncated_bdpt"])
        for row in rows:
            self.assertTrue(0 < row["live"] < 1)
            self.assertTrue(0.5 < row["paths"] < 1)
        reported = self.call("report", out)
        self.assertEqual(reported.returncode, 0, reported.stderr)
        page = (out / "convergence_control.md").read_text()
        for algorithm in ("path tracing", "truncated BDPT"):
            self.assertIn(f"| cornell box | {algorithm} | 0.5 |", page)

    def test_control_is_refused(self):
        self.refused(
            4, "rtrays-reference", "run",
            self.control(reference={"folder": ".", "engine": "embree"}))
        self.refused(
            2, "does not support convergence control", "run",
            self.control(curves=[{"algorithm": "bdpt"}]))
        self.refused(2, "errors", "run", self.control(errors=[0]))

    def sweep(self, **changes):
        """Returns the shipped sweep of lamps with an absolute path, two values and changes."""
        document = json.loads(shipped("light_size").read_text())
        (lamps,) = (each for each in document["sweeps"] if each["name"] == "ring_lamps")
        lamps["scene"] = str(EXPERIMENTS.parent / "scenes/mirror_ring/scene.json")
        document["sweeps"] = [{**lamps, **changes}]
        document["profiles"]["quick"] = {
            "size": [16, 16], "spp": 4, "seeds": 8, "values": {"ring_lamps": [0.2, 0.4]}}
        path = self.folder / "sweep.json"
        path.write_text(json.dumps(document))
        return path

    def test_sweep(self):
        out = self.folder / "out"
        done = self.call("run", self.sweep(), "--out", out, "--quiet")
        self.assertEqual(done.returncode, 0, done.stderr)
        rows = json.loads((out / "run.json").read_text())["rows"]
        self.assertEqual([row["value"] for row in rows], [0.2, 0.4])
        # The scene changes with the value: larger lamps are seen in more pixels of the mirror.
        small, large = (row["pixels"] for row in rows)
        self.assertLessEqual(small["light_behind_delta"], large["light_behind_delta"])
        self.assertEqual(small["other"], large["other"])
        errors = [row["curves"][1]["repetitions"][0]["mse"] for row in rows]
        self.assertNotEqual(*errors)
        for row in rows:
            for curve in row["curves"]:
                self.assertEqual([r["seed"] for r in curve["repetitions"]], list(range(1, 9)))
        reported = self.call("report", out)
        self.assertEqual(reported.returncode, 0, reported.stderr)
        self.assertIn("| 0.4 | truncated BDPT (MIS) |", (out / "light_size.md").read_text())

    def test_sweep_is_refused(self):
        for text, changes in (
                ("unknown name 'y'", {"properties": {"light_0.radius": "y"}}),
                ("light_9", {"properties": {"light_9.radius": "x"}}),
                ("the sweep 'other' has no values", {"name": "other"})):
            self.refused(2, text, "run", self.sweep(**changes), "--dry-run")

    def test_automatic_choice_loses_at_most_a_tenth(self):
        """Images and counts of rays are the same in every run."""
        out = self.folder / "out"
        done = self.call("run", shipped("automatic"), "--profile", "ci", "--out", out, "--quiet")
        self.assertEqual(done.returncode, 0, done.stderr)
        rows = json.loads((out / "run.json").read_text())["rows"]
        self.assertEqual(
            [row["scene"] for row in rows], ["features/environment_light", "veach_mis/scene"])
        for row in rows:
            self.assertGreater(
                gain(row, row["curves"][0], "rays")["value"], 0.9, row["scene"])
        reported = self.call("report", out)
        self.assertEqual(reported.returncode, 0, reported.stderr)
        self.assertIn("| veach_mis/scene |", (out / "automatic.md").read_text())

    def test_run_resume_and_report(self):
        """A run stopped by SIGTERM continues with the same command and has every seed once."""
        profiles = json.loads((shipped("cornell_diffuse")).read_text())["profiles"]
        profiles["ci"].update(spp=[1, 2, 4, 8], early_images=[4])
        path = self.experiment(profiles=profiles)
        out = self.folder / "out"
        command = ["run", path, "--profile", "ci", "--out", out, "--quiet"]
        process = subprocess.Popen([PROGRAM, *map(str, command)], stderr=subprocess.PIPE, text=True)
        while process.poll() is None and not list(out.glob(".partial/*/*.json")):
            try:
                process.wait(0.01)
            except subprocess.TimeoutExpired:
                pass
        process.terminate()
        message = process.communicate()[1]
        # Finished ladders when the run stopped, {(curve, seed): ladder}.
        # It is empty only if the run finished before the signal.
        kept = {}
        for path_of_seed in out.glob(".partial/*/*.json"):
            curve, seed, _ = path_of_seed.name.rsplit(".", 2)
            kept[curve, int(seed.removeprefix("seed"))] = json.loads(
                path_of_seed.read_text())["repetition"]["points"]
        if process.returncode != 0:  # it was stopped in time
            self.assertTrue(kept)
            self.assertEqual(process.returncode, 130, message)
            self.assertFalse((out / "run.json").exists())
        done = self.call(*command)
        self.assertEqual(done.returncode, 0, done.stderr)
        run = json.loads((out / "run.json").read_text())
        self.assertFalse((out / ".partial").exists())
        for curve in run["curves"]:
            for point in curve["points"]:
                self.assertEqual([r["seed"] for r in point["repetitions"]], list(range(1, 9)))
                self.assertGreater(point["seconds_device"], 0)
                for repetition in point["repetitions"]:
                    self.assertAlmostEqual(
                        sum(repetition["mse_parts"].values()) / repetition["mse"], 1, 12)
            self.assertTrue(curve["agreement"]["agrees"])
        # The box shows its lamp, but no mirror or glass.
        self.assertEqual(
            run["first_hits"]["pixels"], {"light_behind_delta": 0, "delta": 0, "other": 1})
        # A finished seed is not rendered again, so even its times are unchanged.
        points_of = {curve["id"]: curve["points"] for curve in run["curves"]}
        for (curve, seed), ladder in kept.items():
            for point, before in zip(points_of[curve], ladder, strict=True):
                self.assertEqual(
                    point["repetitions"][seed - 1]["seconds_wall"], before["seconds_wall"])
        reported = self.call("report", out)
        self.assertEqual(reported.returncode, 0, reported.stderr)
        self.assertTrue(pathlib.Path(reported.stdout.strip()).exists())
        # A finished run is left unchanged.
        before = (out / "run.json").read_bytes()
        again = self.call(*command)
        self.assertEqual(again.returncode, 0, again.stderr)
        self.assertIn("finished already", again.stderr)
        self.assertEqual((out / "run.json").read_bytes(), before)
        self.assertFalse((out / ".partial").exists())


class Reproduce(ProgramTest):
    """Collections: `reproduce` is stopped, continued, and repeated."""

    def collection(self):
        """Returns a collection of a curves experiment and a measurement, both of seconds."""
        folder = self.folder / "questions"
        folder.mkdir()
        document = json.loads(self.experiment().read_text())
        document["profiles"]["quick"] = {
            **document["profiles"]["ci"], "spp": [1, 2, 4, 8], "early_images": [4]}
        (folder / "box.json").write_text(json.dumps(document))
        self.measurement("bvh_build").rename(folder / "speed.json")
        path = self.folder / "collection.json"
        path.write_text(json.dumps({
            "name": "some", "title": "Some", "folders": ["questions"],
            "profiles": {"quick": {"profile_of": {"bvh_build": "ci"}}, "ci": {}}}))
        return path

    def test_steps(self):
        done = self.call("reproduce", "chapter4", "--dry-run", "--out", "out")
        self.assertEqual(done.returncode, 0, done.stderr)
        lines = done.stdout.splitlines()
        names = [pathlib.Path(line.split()[-1]).name for line in lines]
        self.assertEqual(len(names), len(set(names)))
        self.assertLessEqual({"door_ajar", "ray_rates", "stability", "traversal"}, set(names))
        self.refused(2, "profiles are: full, quick", "reproduce", "chapter4", "--profile", "gpu")
        self.refused(2, "nothing.json", "reproduce", "nothing")

    def test_stop_and_continue(self):
        path, out = self.collection(), self.folder / "out"
        command = ["reproduce", path, "--out", out, "--quiet"]
        process = subprocess.Popen([PROGRAM, *map(str, command)], stderr=subprocess.PIPE,
                                   stdout=subprocess.PIPE, text=True)
        while process.poll() is None and not list(out.glob("*/.partial/*/*.json")):
            try:
                process.wait(0.01)
            except subprocess.TimeoutExpired:
                pass
        process.terminate()
        message = process.communicate()[1]
        self.assertEqual(process.returncode, 130, message)
        kept = {file: file.read_bytes() for file in out.glob("*/.partial/*/*.json")}
        self.assertTrue(kept)
        self.assertFalse((out / "index.html").exists())
        done = self.call(*command)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("[2 of 2] bvh_build: ", done.stdout)
        self.assertTrue((out / "bvh_build/run.json").exists())
        self.assertIn("index.html", done.stdout)
        run = json.loads((out / "cornell_diffuse/run.json").read_text())
        stored = {
            (curve["id"], repetition["seed"]): repetition["seconds_wall"]
            for curve in run["curves"]
            for repetition in curve["points"][-1]["repetitions"]}
        for file, text in kept.items():
            curve, seed, _ = file.name.rsplit(".", 2)
            points = json.loads(text)["repetition"]["points"]
            self.assertEqual(
                stored[curve, int(seed.removeprefix("seed"))], points[-1]["seconds_wall"])
        again = self.call(*command)
        self.assertEqual(again.returncode, 0, again.stderr)
        self.assertEqual(again.stderr.count("finished already"), 2)

    def test_kernels_that_do_not_compile_stop_it(self):
        path = self.collection()
        document = json.loads((self.folder / "questions/box.json").read_text())
        document["scene"] = "nowhere.json"
        (self.folder / "questions/box.json").write_text(json.dumps(document))
        done = self.call("reproduce", path, "--out", self.folder / "out")
        self.assertEqual(done.returncode, 2)
        self.assertIn("nowhere.json", done.stderr)
        self.assertIn("cornell_diffuse: cannot compile its kernels", done.stderr)


if __name__ == "__main__":
    run_tests()
