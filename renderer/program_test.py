#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Tests the program rtrays-render: bad input, interrupted runs, resumed and merged films.

Usage: program_test.py PROGRAM SCENES
"""
import json
import os
import pathlib
import resource
import signal
import subprocess
import sys
import tempfile
import time
import unittest

PROGRAM, SCENES = sys.argv[1], pathlib.Path(sys.argv[2])
CORNELL = SCENES / "cornell_box" / "scene.json"
SMALL = ["--size", "16x16", "--set", "device.stream_capacity=256"]


class Program(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.path = pathlib.Path(self.folder.name)

    def tearDown(self):
        self.folder.cleanup()

    def run_program(self, *arguments, **options):
        return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True,
                              timeout=300, **options)

    def expect_error(self, code, fragments, *arguments, **options):
        """Expects one clear message on stderr, that exit code, and no new file in the folder."""
        before = sorted(self.path.iterdir())
        result = self.run_program(*arguments, **options)
        self.assertEqual(result.returncode, code, result.stderr)
        self.assertEqual(result.stdout, "")
        for fragment in fragments:
            self.assertIn(fragment, result.stderr)
        self.assertEqual(result.stderr.count("rtrays-render: "), 1, result.stderr)
        self.assertEqual(sorted(self.path.iterdir()), before)

    def scene(self, change):
        """Writes the Cornell box after `change(text) -> text` and returns its path."""
        path = self.path / "scene.json"
        path.write_text(change(CORNELL.read_text()))
        return path

    def output(self):
        return self.path / "out.exr"

    def test_missing_scene(self):
        self.expect_error(2, ["nowhere.json"], self.path / "nowhere.json", "-o", self.output())

    def test_directory_as_scene(self):
        self.expect_error(2, ["directory"], self.path, "-o", self.output())

    def test_broken_scene(self):
        scene = self.scene(lambda text: text[: len(text) // 2])
        self.expect_error(2, ["scene.json:"], scene, "-o", self.output())

    def test_unknown_key(self):
        scene = self.scene(lambda text: text.replace('"film"', '"flim"', 1))
        self.expect_error(2, ["flim", "film", "scene.json:"], scene, "-o", self.output())

    def test_duplicate_key(self):
        scene = self.scene(
            lambda text: text.replace('"version": 1,', '"version": 1, "version": 1,', 1))
        self.expect_error(2, ["version", "scene.json:2"], scene, "-o", self.output())

    def test_vertex_that_is_no_number(self):
        for bad in ("1e999", "null", "NaN"):
            scene = self.scene(lambda text, bad=bad: text.replace(
                "[343, 548.3, 227]", f"[{bad}, 548.3, 227]", 1))
            self.expect_error(2, ["scene.json:"], scene, "-o", self.output())

    def test_unwritable_output(self):
        self.expect_error(2, ["no/such/folder"],
                          CORNELL, "-o", self.path / "no/such/folder/out.exr")

    def test_output_that_is_a_directory(self):
        self.expect_error(2, ["directory"], CORNELL, "-o", self.path)

    def test_output_of_another_format(self):
        self.expect_error(2, ["unknown image format", ".exr", ".png"],
                          CORNELL, "-o", self.path / "out.tga")

    def test_missing_output_names_what_it_could_be(self):
        self.expect_error(2, ["cornell_box.png", "cornell_box.exr"], CORNELL)
        self.expect_error(2, ["furnace_050.png"], SCENES / "analytic" / "furnace_050.json")

    def test_display_images_beside_the_exr(self):
        image, again, exposed = (self.path / name for name in ("out.png", "again.png", "out.jpg"))
        result = self.run_program(CORNELL, "-o", self.output(), "-o", image, "--spp", 2, *SMALL)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn(f"wrote {image}", result.stderr)
        self.assertEqual(image.read_bytes()[:4], b"\x89PNG")
        result = self.run_program("develop", self.output(), "-o", again, "-o", exposed)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(again.read_bytes(), image.read_bytes())
        self.assertEqual(exposed.read_bytes()[:2], b"\xff\xd8")
        self.run_program("develop", self.output(), "-o", again, "--exposure", 2)
        self.assertNotEqual(again.read_bytes(), image.read_bytes())
        self.expect_error(2, ["nowhere.exr"],
                          "develop", self.path / "nowhere.exr", "-o", self.path / "none.png")

    def run_until_the_disk_is_full(self, *arguments):
        """Runs the program on files that cannot grow any more once the kernels are compiled."""
        process = subprocess.Popen(
            [PROGRAM, *map(str, arguments), "--time", "2", "-q"], stderr=subprocess.PIPE,
            text=True, preexec_fn=lambda: signal.signal(signal.SIGXFSZ, signal.SIG_IGN))
        maps = pathlib.Path(f"/proc/{process.pid}/maps")
        while "/end_round.so" not in maps.read_text():  # the last kernel of a round
            self.assertIsNone(process.poll())
            time.sleep(0.01)
        resource.prlimit(process.pid, resource.RLIMIT_FSIZE, (1000, 1000))
        _, errors = process.communicate(timeout=120)
        self.assertEqual(process.returncode, 1, errors)
        return errors

    def test_full_disk(self):
        errors = self.run_until_the_disk_is_full(CORNELL, "-o", self.output(), *SMALL)
        self.assertIn("out.exr: cannot be written", errors)
        self.assertEqual(list(self.path.iterdir()), [])

    def test_full_disk_under_statistics(self):
        image, stats = self.path / "out.png", self.path / "stats.json"
        errors = self.run_until_the_disk_is_full(
            CORNELL, "-o", image, "--stats", stats, "--size", "2x2", "--set",
            "device.stream_capacity=256")
        self.assertIn("stats.json: cannot be written", errors)
        self.assertEqual(list(self.path.iterdir()), [image])

    def test_full_disk_under_the_compiler(self):
        def limit():
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
            resource.setrlimit(resource.RLIMIT_FSIZE, (1000, 1000))

        self.expect_error(1, ["CL_BUILD_PROGRAM_FAILURE", "PoCL's cache may be on a full disk"],
                          CORNELL, "-o", self.output(), "--spp", 1, "-q", *SMALL,
                          preexec_fn=limit)

    def test_full_disk_under_standard_output(self):
        with open("/dev/full", "w", encoding="ascii") as full:
            for arguments in (["--list-algorithms"], [CORNELL, "--print-scene"]):
                result = subprocess.run([PROGRAM, *map(str, arguments)], stdout=full,
                                        stderr=subprocess.PIPE, text=True, timeout=300)
                self.assertEqual(result.returncode, 1, result.stderr)
                self.assertIn("No space left on device", result.stderr)

    def test_a_lost_output_folder_keeps_the_samples(self):
        gone, temporary = self.path / "gone", self.path / "temporary"
        gone.mkdir()
        temporary.mkdir()
        command = [PROGRAM, CORNELL, "-o", gone / "out.exr", "--time", "4", *SMALL]
        process = subprocess.Popen([*map(str, command)], stderr=subprocess.PIPE, text=True,
                                   env=dict(os.environ, TMPDIR=str(temporary)))
        time.sleep(2)  # the program checks its outputs at the start
        gone.rmdir()
        _, errors = process.communicate(timeout=300)
        self.assertEqual(process.returncode, 1, errors)
        (kept,) = temporary.iterdir()
        self.assertIn(f"the samples are kept in {kept}", errors)
        result = self.run_program("merge", kept, "-o", self.output())
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertTrue(self.output().exists())

    def test_no_device(self):
        environment = dict(os.environ, OCL_ICD_VENDORS=str(self.path))
        self.expect_error(2, ["pocl-opencl-icd"], CORNELL, "-o", self.output(), *SMALL,
                          env=environment)

    def test_cache_that_the_driver_cannot_write(self):
        environment = {name: value for name, value in os.environ.items()
                       if name not in ("POCL_CACHE_DIR", "XDG_CACHE_HOME")}
        self.expect_error(2, ["no OpenCL device", "/dev/null/.cache/pocl/kcache", "POCL_CACHE_DIR"],
                          CORNELL, "-o", self.output(), *SMALL,
                          env=dict(environment, HOME="/dev/null"))

    def test_damage_in_the_cache_of_the_driver_names_its_folder(self):
        cache = self.path / "cache"
        cache.mkdir()
        environment = dict(os.environ, POCL_CACHE_DIR=str(cache), RTRAYS_CACHE_DIR=str(cache))
        arguments = [SCENES / "analytic" / "furnace_050.json", "-o", self.output(), "--spp", "1",
                     "--algorithm", "ray_casting", *SMALL]
        result = self.run_program(*arguments, env=environment)
        self.assertEqual(result.returncode, 0, result.stderr)
        kernels = list(cache.rglob("*.so"))
        if not kernels:
            self.skipTest("the driver does not cache kernels as PoCL does")
        for kernel in kernels:
            kernel.write_bytes(b"damaged")
        result = self.run_program(*arguments, env=environment)
        self.assertNotEqual(result.returncode, 0)
        self.assertIn("the OpenCL driver has crashed", result.stderr)
        self.assertIn(str(cache), result.stderr)

    def test_unknown_device(self):
        self.expect_error(2, ["'toaster'", "0:0"],
                          CORNELL, "-o", self.output(), "--device", "toaster", *SMALL)

    def test_bad_settings(self):
        for assignment, fragment in (("integrator.strategies=all", "implicit, explicit, mis"),
                                     ("integrator.beta=x", "number"),
                                     ("nonsense=1", "integrator.beta"),
                                     ("integrator.termination=fixed", "max_depth"),
                                     ("device.group_size=5000", "4096"),
                                     ("scene.nowhere.radiance=1", "nowhere"),
                                     ("scene.luminaire.radience=1", "radiance")):
            self.expect_error(2, [fragment], CORNELL, "-o", self.output(), "--set", assignment)

    def test_bad_numbers(self):
        for message, arguments in (("from 1 to 65536", ["--size", "0x5"]),
                                   ("separated by 'x'", ["--size", "5"]),
                                   ("separated by ','", ["--crop", "5"]),
                                   ("is not in the film", ["--crop", "250,0,7x7"]),
                                   ("below END", ["--samples", "5:5"]),
                                   ("separated by ':'", ["--samples", "a:b"]),
                                   ("--spp excludes --samples", ["--samples", "0:4", "--spp", "4"]),
                                   ("--time excludes --spp", ["--time", "1", "--spp", "4"]),
                                   ("--state", ["--resume"]),
                                   ("path_tracing", ["--algorithm", "magic"])):
            self.expect_error(2, [message], CORNELL, "-o", self.output(), *arguments)

    def test_another_size_needs_another_crop(self):
        window = '"film": {"crop": {"x": 1, "y": 2, "width": 9, "height": 7}, '
        scene = self.scene(lambda text: text.replace('"film": {', window, 1))
        self.expect_error(2, ["--size: the scene crops its film", "--crop none"],
                          scene, "-o", self.output(), *SMALL)

    def test_usage_errors_exit_with_2(self):
        for arguments in (["--no-such-option"], [], [CORNELL]):
            self.assertEqual(self.run_program(*arguments).returncode, 2)
        for message, option in (("--spp: 0: expected a positive number", ["--spp", "0"]),
                                ("--fov: 181: expected a number from 0 to 180", ["--fov", "181"]),
                                ("--preview: x: expected a number, 0 or more",
                                 ["--preview", "x"])):
            result = self.run_program(CORNELL, "-o", self.output(), *option)
            self.assertEqual(result.returncode, 2)
            self.assertIn(message, result.stderr)

    def test_help_and_version(self):
        for option in ("--help", "--version", "--list-devices", "--list-algorithms"):
            result = self.run_program(option)
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertTrue(result.stdout)

    def test_stats_name_what_the_scene_needed(self):
        stats = self.path / "stats.json"
        result = self.run_program(CORNELL, "-o", self.output(), "--spp", 2, "-q",
                                  "--stats", stats, *SMALL)
        self.assertEqual(result.returncode, 0, result.stderr)
        document = json.loads(stats.read_text())
        self.assertIn("explicit_light", document["features"])
        self.assertNotIn("many_lights", document["features"])
        self.assertEqual(document["samples"], 2 * 16 * 16)
        self.assertTrue(all(stage["launches"] > 0 for stage in document["stages"]))
        self.assertTrue(all(buffer["bytes"] > 0 for buffer in document["buffers"]))

    def test_convergence_control_says_what_it_did(self):
        stats = self.path / "stats.json"
        control = ["--set", "integrator.convergence.error=0.5",
                   "--set", "integrator.convergence.start=8",
                   "--set", "integrator.convergence.interval=4"]
        result = self.run_program(CORNELL, "-o", self.output(), "--spp", 16, "-q",
                                  "--stats", stats, *SMALL, *control)
        self.assertEqual(result.returncode, 0, result.stderr)
        document = json.loads(stats.read_text())
        checks = document["convergence"]["checks"]
        self.assertEqual([check["samples"] for check in checks], [8, 12, 16])
        live = [1] + [check["live"] for check in checks]
        self.assertEqual(live, sorted(live, reverse=True))
        self.assertLess(live[-1], 1)
        spent = 16 * 16 * sum(share * samples for share, samples in zip(live, [8, 4, 4]))
        self.assertEqual(document["convergence"]["camera_paths"], spent)
        self.assertEqual(document["samples"], spent)
        self.output().unlink()
        stats.unlink()
        self.expect_error(2, ["from 0 on"], CORNELL, "-o", self.output(), "--samples", "8:16",
                          *SMALL, *control)
        self.expect_error(2, ["bdpt does not support"], CORNELL, "-o", self.output(),
                          "--algorithm", "bdpt", *SMALL, *control)

    def test_a_converged_image_ends_before_its_time(self):
        stats = self.path / "stats.json"
        furnace = SCENES / "analytic" / "furnace_050.json"  # without black pixels
        start = time.monotonic()
        result = self.run_program(furnace, "-o", self.output(), "--time", 200, "-q",
                                  "--stats", stats, *SMALL,
                                  "--set", "integrator.convergence.error=0.5")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertLess(time.monotonic() - start, 150)
        convergence = json.loads(stats.read_text())["convergence"]
        self.assertEqual(convergence["checks"][-1]["live"], 0)
        self.assertGreaterEqual(convergence["camera_paths"], 200 * 16 * 16)

    def film(self, name, *arguments, **options):
        state = self.path / name
        result = self.run_program(CORNELL, "-o", self.path / (name + ".exr"), "-q",
                                  "--state", state, *SMALL, *arguments, **options)
        self.assertEqual(result.returncode, 0, result.stderr)
        return state

    @staticmethod
    def words(path):
        """Returns the sums of a film without the header, which contains times."""
        return path.read_bytes().split(b"\n", 2)[2]

    def test_both_ways_of_pocl_to_run_work_groups_give_the_same_bits(self):
        films = []
        # The methods need separate caches, because PoCL's cache key does not include the method.
        for method in ("loops", "loopvec"):
            cache = self.path / ("cache_" + method)
            cache.mkdir()
            environment = dict(os.environ, POCL_WORK_GROUP_METHOD=method, POCL_CACHE_DIR=str(cache),
                               RTRAYS_CACHE_DIR=str(cache))
            films.append(self.words(self.film(method, "--spp", "4", env=environment)))
        self.assertEqual(films[0], films[1])

    def test_merged_and_resumed_films_have_the_same_bits(self):
        whole = self.path / "whole"
        self.film("whole", "--samples", "0:6")
        first = self.film("first", "--samples", "0:2")
        second = self.film("second", "--samples", "2:6")
        merged = self.path / "merged"
        result = self.run_program("merge", second, first, "-o", self.path / "merged.exr",
                                  "--state", merged)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.film("first", "--spp", "6", "--resume")

        self.assertEqual(self.words(merged), self.words(whole))
        self.assertEqual(self.words(first), self.words(whole))
        self.expect_error(2, ["overlap"], "merge", whole, second, "-o", self.path / "none.exr")

    def sampler(self, *arguments):
        """Returns integrator.sampler of a dry run."""
        result = self.run_program(CORNELL, "--dry-run", *SMALL, *arguments)
        self.assertEqual(result.returncode, 0, result.stderr)
        return json.loads(result.stdout)["settings"]["integrator.sampler"]

    def test_samples_are_sobol_points_unless_told_otherwise(self):
        for arguments, sampler in ((["--algorithm", "path_tracing"], "sobol"),
                                   (["--algorithm", "whitted"], "regular"),
                                   (["--set", "integrator.sampler=independent"], "independent")):
            self.assertEqual(self.sampler(*arguments), sampler)
        self.assertIn("integrator.sampler = sobol", self.run_program("--help").stdout)
        default = self.film("default", "--spp", "2")
        sobol = self.film("sobol", "--spp", "2", "--set", "integrator.sampler=sobol")
        independent = self.film("independent", "--spp", "2",
                                "--set", "integrator.sampler=independent")
        self.assertEqual(self.words(default), self.words(sobol))
        self.assertNotEqual(self.words(default), self.words(independent))
        difference = "integrator.sampler = independent, and this render has sobol"
        self.expect_error(2, ["rendered with " + difference], CORNELL, "-o", self.output(),
                          "--spp", 4, "--resume", "--state", independent, *SMALL)
        later = self.film("later", "--samples", "2:4")
        self.expect_error(2, ["differ in integrator.sampler"],
                          "merge", independent, later, "-o", self.output())

    def test_names_and_line_ends_of_other_systems_change_no_bit(self):
        expected = self.words(self.film("plain", "--spp", "2"))
        folder = self.path / "\u0645\u0634\u0647\u062f \u00e4\u00f6"  # Arabic and German letters
        folder.mkdir()
        scene, state = folder / "\u0635\u0648\u0631\u0629.json", folder / "\u0641"
        text = CORNELL.read_text(encoding="utf-8").replace("\n", "\r\n")
        scene.write_bytes(b"\xef\xbb\xbf" + text.encode())
        result = self.run_program(scene, "-o", folder / "out.exr", "-q", "--spp", "2",
                                  "--state", state, *SMALL,
                                  env=dict(os.environ, LC_ALL="de_DE.UTF-8"))
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(self.words(state), expected)

    def test_processes_that_fill_an_empty_cache_together(self):
        cache = self.path / "cache"
        cache.mkdir()
        environment = dict(os.environ, POCL_CACHE_DIR=str(cache), RTRAYS_CACHE_DIR=str(cache))
        states = [self.path / f"state_{i}" for i in range(4)]
        processes = [
            subprocess.Popen(
                [PROGRAM, str(SCENES / "analytic" / "furnace_050.json"), "-q", "--spp", "1",
                 "--algorithm", "ray_casting", "-o", str(state) + ".exr", "--state", str(state),
                 *SMALL], env=environment, stderr=subprocess.PIPE, text=True)
            for state in states]
        for process in processes:
            _, errors = process.communicate(timeout=300)
            self.assertEqual(process.returncode, 0, errors)
        self.assertEqual({self.words(state) for state in states}, {self.words(states[0])})

    def test_passes_of_two_devices_have_the_bits_of_one(self):
        environment = dict(os.environ, POCL_DEVICES="basic pthread")
        devices = self.run_program("--list-devices", env=environment).stdout.splitlines()
        if (len(devices) < 2 or not devices[0].startswith("basic")
                or not devices[1].startswith("pthread")):
            self.skipTest("PoCL with two devices is not the first platform")
        settings = ("--spp", "2", "--algorithm", "truncated_bdpt")
        whole = self.film("whole", *settings, "--device", "0:1", env=environment)
        camera = self.film("camera", *settings, "--passes", "camera", "--device", "0:0",
                           env=environment)
        light = self.film("light", *settings, "--passes", "light", "--device", "0:1",
                          env=environment)
        merged = self.path / "merged"
        result = self.run_program("merge", light, camera, "-o", self.path / "merged.exr",
                                  "--state", merged)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertNotEqual(self.words(camera), self.words(whole))
        self.assertEqual(self.words(merged), self.words(whole))

    def test_a_resumed_film_is_filled_where_samples_are_missing(self):
        whole = self.film("whole", "--spp", 9)
        gaps = self.film("gaps", "--samples", "2:4")
        self.film("high", "--samples", "6:7")
        merged = self.path / "merged"
        result = self.run_program("merge", gaps, self.path / "high", "-o", self.output(),
                                  "--state", merged)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.film("merged", "--spp", 9, "--resume")
        self.assertEqual(self.words(merged), self.words(whole))
        self.assertIn(b"[[0,9]]", merged.read_bytes())

    def test_printed_parts_have_the_bits_of_one_render(self):
        whole = self.film("whole", "--spp", 7)
        shards = subprocess.run(
            [pathlib.Path(__file__).parent.parent / "scripts" / "shards", "--programs",
             pathlib.Path(PROGRAM).parent, CORNELL, "7", "2", "-o", self.output(), "--state",
             self.path / "merged", *SMALL], capture_output=True, text=True, check=True)
        for line in shards.stdout.splitlines():
            subprocess.run(["sh", "-c", line], check=True, timeout=300)
        self.assertEqual(self.words(self.path / "merged"), self.words(whole))
        self.assertTrue(self.output().exists())

    def test_an_existing_film_is_not_replaced_unless_asked(self):
        state = self.film("film", "--spp", "2")
        before = state.read_bytes()
        for arguments in ((CORNELL, "-o", self.output(), "--spp", 1, *SMALL),
                          ("merge", state, "-o", self.output())):
            self.expect_error(2, ["the file exists", "--overwrite"], *arguments, "--state", state)
        self.expect_error(2, ["--resume continues it"], CORNELL, "-o", self.output(), "--spp", 1,
                          "--state", state, *SMALL)
        self.expect_error(2, ["--resume excludes --overwrite"], CORNELL, "-o", self.output(),
                          "--state", state, "--resume", "--overwrite", *SMALL)
        self.assertEqual(state.read_bytes(), before)
        self.film("film", "--spp", "1", "--overwrite")
        self.assertNotEqual(self.words(state), before.split(b"\n", 2)[2])

    def test_a_damaged_film_is_refused(self):
        state = self.film("film", "--spp", "1")
        content = bytearray(state.read_bytes())
        content[-1] ^= 1
        state.write_bytes(content)
        self.expect_error(2, ["film", "damaged"], CORNELL, "-o", self.output(), "--resume",
                          "--state", state, *SMALL)

    def test_an_interrupted_render_can_be_resumed(self):
        state = self.path / "state"
        command = [PROGRAM, str(CORNELL), "-o", str(self.output()), "--spp", "1000000",
                   "--state", str(state)]
        process = subprocess.Popen(command, stderr=subprocess.PIPE, text=True)
        while "rendering: " not in process.stderr.readline():
            self.assertIsNone(process.poll())
        process.send_signal(signal.SIGTERM)
        _, errors = process.communicate(timeout=120)
        self.assertEqual(process.returncode, 130, errors)
        self.assertIn("--resume", errors)
        self.assertTrue(state.exists())
        self.assertFalse(self.output().exists())

    def test_an_interrupt_ends_compilation_at_once(self):
        caches = self.path / "caches"
        caches.mkdir()
        environment = dict(os.environ, POCL_CACHE_DIR=str(caches), RTRAYS_CACHE_DIR=str(caches))
        process = subprocess.Popen([PROGRAM, str(CORNELL), "-o", str(self.output()), *SMALL],
                                   stderr=subprocess.PIPE, text=True, env=environment)
        while not any(caches.iterdir()):
            self.assertIsNone(process.poll())
            time.sleep(0.01)
        process.send_signal(signal.SIGINT)
        start = time.monotonic()
        _, errors = process.communicate(timeout=120)
        self.assertLess(time.monotonic() - start, 0.5)
        self.assertEqual(process.returncode, 130, errors)
        self.assertIn("interrupted", errors)

    def test_a_preview_is_written_while_it_renders(self):
        command = [PROGRAM, str(CORNELL), "-o", str(self.output()), "--spp", "1000000",
                   "--size", "32x32", "--preview", "0.1"]
        process = subprocess.Popen(command, stderr=subprocess.PIPE, text=True)
        while not self.output().exists():
            self.assertIsNone(process.poll())
            time.sleep(0.01)
        process.send_signal(signal.SIGTERM)
        process.communicate(timeout=120)
        self.run_program("develop", self.output(), "-o", self.path / "preview.png")

    def test_a_render_ends_with_what_it_wrote_and_how_long_it_took(self):
        errors = self.run_program(CORNELL, "-o", self.output(), *SMALL).stderr
        self.assertRegex(errors, r"wrote .* \(\d+ x \d+\)\nrendered in [\d.]+ s, .* per second\n$")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
