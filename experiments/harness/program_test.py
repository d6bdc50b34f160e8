# SPDX-License-Identifier: MIT
"""Tests of the program rtrays-experiment: exit codes, messages and complete output files."""

import json
import pathlib
import subprocess
import sys
import xml.etree.ElementTree

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

    def other_renderer(self, *arguments):
        """Returns an experiment of path tracing and of a command: the renderer as another one."""
        render = pathlib.Path(PROGRAM).with_name("rtrays-render")
        script = f'{render} "$@" -q && echo rendering... && echo \'{{"seconds": 0.25}}\''
        command = ["sh", "-c", script, "sh", "{scene}", "-o", "{output}", "--spp", "{spp}",
                   "--seed", "{seed}", "--size", "{width}x{height}", *arguments]
        return self.experiment(
            profiles={"quick": {"size": [32, 32], "spp": [1, 2, 4], "seeds": 8}},
            curves=[{"engine": "command", "label": "Mine 1.0", "command": command},
                    {"algorithm": "path_tracing"}])

    def test_a_missing_program_is_found_before_the_run(self):
        path = self.other_renderer()
        path.write_text(path.read_text().replace('"sh", "-c"', '"no-such-renderer", "-c"'))
        self.refused(2, "/curves/0/command: program 'no-such-renderer' was not found", "run",
                     path, "--dry-run")

    def test_another_renderer_is_a_curve(self):
        out = self.folder / "out"
        done = self.call("run", self.other_renderer(), "--out", out, "--quiet")
        self.assertEqual(done.returncode, 0, done.stderr)
        other, own = json.loads((out / "run.json").read_text())["curves"]
        self.assertEqual((other["id"], other["engine"]), ("command.mine_1_0", "Mine 1.0"))
        self.assertTrue(other["agreement"]["agrees"])
        mse = []
        for point in other["points"]:
            for repetition in point["repetitions"]:
                self.assertEqual(repetition["seconds_wall"], 0.25)
                mse.append(repetition["mse"])
        self.assertEqual(len(set(mse)), len(mse))  # no image has the samples of another one
        for point, same in zip(other["points"], own["points"], strict=True):
            self.assertAlmostEqual(point["mse"] / same["mse"], 1, delta=0.5)
        reported = self.call("report", out)
        self.assertEqual(reported.returncode, 0, reported.stderr)
        page = (out / "report.md").read_text()
        self.assertIn("| Mine 1.0 | 4 |", page)
        self.assertIn("equal wall time", page)
        self.assertNotIn("equal device time", page)

    def test_finished_images_become_a_curve(self):
        """The images of the run's own curve have the errors of that curve."""
        out, render = self.folder / "out", pathlib.Path(PROGRAM).with_name("rtrays-render")
        done = self.call("run", self.experiment(
            profiles={"quick": {"size": [32, 32], "spp": [1, 2, 4], "seeds": 8}},
            curves=[{"algorithm": "path_tracing"}]), "--out", out, "--quiet")
        self.assertEqual(done.returncode, 0, done.stderr)
        lines = ["spp,seed,seconds,image"]
        for seed in range(1, 9):
            for spp in (1, 2, 4):
                image = f"{seed}.{spp}.exr"
                subprocess.run(
                    [render, EXPERIMENTS.parent / "scenes/cornell_box/scene.json", "-q", "-o",
                     self.folder / image, "--seed", str(seed), "--spp", str(spp), "--size", "32x32",
                     "--set", "integrator.sampler=independent"], check=True)
                lines.append(f"{spp},{seed},{0.5 * spp},{image}")
        images = self.folder / "images.csv"
        images.write_text("\n".join(lines) + "\n")
        for _ in range(2):  # the second time replaces the curve
            added = self.call("add-curve", out, images, "--label", "Again 1.0")
            self.assertEqual(added.returncode, 0, added.stderr)
        curve, own = json.loads((out / "run.json").read_text())["curves"]
        self.assertEqual((curve["id"], curve["label"]), ("added.again_1_0", "Again 1.0"))
        for point, same in zip(curve["points"], own["points"], strict=True):
            self.assertEqual(point["seconds_wall"], 0.5 * point["spp"])
            self.assertAlmostEqual(point["mse"] / same["mse"], 1, 5)
        self.assertEqual(self.call("report", out).returncode, 0)
        self.refused(2, "another label", "add-curve", out, images, "--label", "Again-1 0")
        for text, broken in (
                ("has 1 samples per pixel, but is listed with 4",
                 [line.replace("4,1,2.0,1.4", "4,1,2.0,1.1") for line in lines]),
                ("expected the columns", ["seed,spp,seconds,image", *lines[1:]]),
                ("7 seeds; at least 8", [line for line in lines if ",8," not in line]),
                ("other sample counts", lines[:-1]),
                ("a second image of seed 1 at 1 spp", [*lines, lines[1]]),
                ("expected a positive number, got '-1'", [*lines, "8,1,-1,1.1.exr"]),
                ("nowhere.exr", [line.replace("1.1.exr", "nowhere.exr") for line in lines])):
            images.write_text("\n".join(broken) + "\n")
            self.refused(2, text, "add-curve", out, images, "--label", "x")

    def test_new_experiment_is_run_by_what_its_messages_say(self):
        scene = EXPERIMENTS.parent / "scenes/cornell_box/scene.json"
        done = self.call("new", scene, "-o", "mine/box.json")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.refused(2, "--overwrite", "new", scene, "-o", "mine/box.json")
        path = self.folder / "mine/box.json"
        experiment = json.loads(path.read_text())
        experiment["profiles"]["quick"]["size"] = [32, 32]
        path.write_text(json.dumps(experiment))
        command = ["run", "mine/box.json", "--quiet"]
        missing = self.refused(4, "does not exist", *command).stderr
        script = "\n".join(line for line in missing.splitlines() if line.startswith("  "))
        self.assertEqual(script.count("--size 32x32"), 2)
        subprocess.run(["sh", "-e", "-c", script], cwd=self.folder, check=True, capture_output=True)
        done = self.call(*command)
        self.assertEqual(done.returncode, 0, done.stderr)
        reported = self.call("report", "cornell_box.quick")
        self.assertEqual(reported.returncode, 0, reported.stderr)
        page = (self.folder / "cornell_box.quick/report.md").read_text()
        self.assertIn("truncated BDPT with Sobol points", page)
        self.assertNotIn("thesis", page)

    def test_another_renderer_resumes_with_the_same_samples(self):
        """Fails at the twelfth image; the next run has the images of an uninterrupted one."""
        count = self.folder / "count"
        stop = f'echo >> {count}; [ "$(wc -l < {count})" -ne 12 ] || exit 9; '
        experiment = json.loads(self.other_renderer().read_text())
        command = experiment["curves"][0]["command"]
        path = self.folder / "experiment.json"
        runs = []
        for script, code in ((command[2], [0]), (stop + command[2], [1, 0])):
            command[2] = script
            path.write_text(json.dumps(experiment))
            out = self.folder / f"out{len(runs)}"
            for expected in code:
                done = self.call("run", path, "--out", out, "--quiet")
                self.assertEqual(done.returncode, expected, done.stderr)
            runs.append(json.loads((out / "run.json").read_text())["curves"][0])
        for points in zip(*(run["points"] for run in runs), strict=True):
            self.assertEqual(*([r["mse"] for r in point["repetitions"]] for point in points))

    def test_another_renderer_that_fails(self):
        done = self.call(
            "run", self.other_renderer("--spq"), "--out", self.folder / "out", "--quiet")
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertIn("'Mine 1.0' ended with exit code 2: sh -c", done.stderr)
        self.assertFalse((self.folder / "out/run.json").exists())

    def test_gate_of_one_scene(self):
        """A gate with a single check: a planted error that nothing catches fails it."""
        gate = json.loads(shipped("gate_cornell_box").read_text())
        for key in ("bitwise", "convergence", "baseline"):
            del gate[key]
        harmless = {"name": "nothing <much>", "algorithm": "path_tracing", "settings": {},
                    "file": "kernels/light/area_light.h", "search": "sample.pdf_a = emitter.pdf_a;",
                    "replacement": "sample.pdf_a = 1.0f * emitter.pdf_a;"}
        gate.update(scene=str(EXPERIMENTS.parent / "scenes/cornell_box/scene.json"),
                    reference={"folder": str(REFERENCES), "engine": "embree"}, size=[16, 16],
                    curves=[{"algorithm": "path_tracing"}],
                    agreement={"spp": 64, "planted_errors": [harmless]})
        path, saved = self.folder / "gate.json", self.folder / "saved"
        path.write_text(json.dumps(gate))
        done = self.call("run", path, "--quiet", "--save", saved)
        self.assertEqual(done.returncode, 3, done.stderr)
        lines = done.stdout.splitlines()
        self.assertRegex(lines[0], "^ok   path_tracing.mis: agrees with the reference")
        self.assertRegex(lines[1], "^FAIL planted 'nothing <much>' in path_tracing: not caught: ")
        self.assertEqual(lines[-1], "1 of 2 checks failed")
        self.assertEqual(
            [each["passed"] for each in json.loads((saved / "checks.json").read_text())["checks"]],
            [True, False])
        suite = xml.etree.ElementTree.parse(saved / "checks.xml").getroot()
        self.assertEqual((suite.get("tests"), suite.get("failures")), ("2", "1"))
        self.assertIn("not caught", suite.find("testcase/failure").get("message"))
        self.assertEqual([case.get("name") for case in suite],
                         ["path_tracing.mis", "planted 'nothing <much>' in path_tracing"])
        self.refused(2, 'has no checks "bitwise"', "run", path, "--check", "bitwise")
        self.refused(2, "convergence", "run", path, "--update-baseline")

    def test_gate_shows_what_failed(self):
        done = self.call("new", EXPERIMENTS.parent / "scenes/cornell_box/scene.json", "--gate")
        self.assertEqual(done.returncode, 0, done.stderr)
        gate = json.loads((self.folder / "cornell_box.json").read_text())
        gate.update(reference={"folder": str(REFERENCES), "engine": "embree"}, size=[32, 32],
                    agreement={"spp": 64},
                    curves=[{"algorithm": "path_tracing",
                             "settings": {"integrator.max_depth": 2}}])
        path, saved = self.folder / "cornell_box.json", self.folder / "saved"
        path.write_text(json.dumps(gate))
        done = self.call("run", path, "--quiet", "--save", saved)
        self.assertEqual(done.returncode, 3, done.stderr)
        (check,) = json.loads((saved / "checks.json").read_text())["checks"]
        self.assertEqual(
            check["images"],
            ["agreement.path_tracing.mis,max_depth=2.exr", "agreement.reference.exr"])
        for image in check["images"]:
            self.assertTrue((saved / image).exists())

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
