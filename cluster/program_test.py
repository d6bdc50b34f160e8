#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Tests the program rtrays-mpi: bits for any number of ranks, killed and slowed ranks, refusals.

Usage: program_test.py PROGRAM FOLDER SCENES [--full]

FOLDER has rtrays-render and rtrays-reference. An empty PROGRAM means that MPI is not installed:
exit code 77. --full repeats the tests with more ranks, algorithms and kills, and takes minutes.
"""
import json
import os
import pathlib
import random
import resource
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import time
import unittest

PROGRAM, FOLDER, SCENES = sys.argv[1], pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3])
FULL = "--full" in sys.argv
CORNELL = SCENES / "cornell_box" / "scene.json"
SMALL = ["--size", "16x16", "--seed", 3]
# A container has root alone, and fewer processors than ranks. Ranks do not compete for the first.
ENVIRONMENT = {
    **os.environ,
    "OMPI_ALLOW_RUN_AS_ROOT": "1",
    "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
    "OMPI_MCA_rmaps_base_oversubscribe": "1",
    "OMPI_MCA_hwloc_base_binding_policy": "none",
    "OMPI_MCA_odls_base_sigkill_timeout": "0",
    "OMPI_MCA_btl_vader_single_copy_mechanism": "none",
    "OMPI_MCA_mpi_yield_when_idle": "1",
    "POCL_MAX_PTHREAD_COUNT": "1",
}


def film_words(path):
    """Returns the header and the words of a film file of rtrays-render."""
    _, header, words = path.read_bytes().split(b"\n", 2)
    return json.loads(header), words


def state_words(path):
    """Returns the header and the words of a state file of rtrays-reference."""
    content = path.read_bytes()
    begin = 16 + struct.unpack("<I", content[12:16])[0]
    return json.loads(content[16:begin]), content[begin:-32]


def exr_parts(path):
    """Returns the attributes of an EXR file without times, and the bytes of its pixels."""
    content, at, attributes = path.read_bytes(), 8, {}
    while content[at] != 0:
        name_end = content.index(b"\0", at)
        type_end = content.index(b"\0", name_end + 1)
        size = struct.unpack("<i", content[type_end + 1:type_end + 5])[0]
        name = content[at:name_end].decode()
        attributes[name] = content[type_end + 5:type_end + 5 + size]
        at = type_end + 5 + size
    for time_name in ("renderTimeSeconds", "rtrays:deviceSeconds"):
        attributes.pop(time_name, None)
    return attributes, content[at:]


class Ranks(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.path = pathlib.Path(self.folder.name)

    def tearDown(self):
        self.folder.cleanup()

    def start(self, *words, **variables):
        """Starts mpirun with these words."""
        return subprocess.Popen(["mpirun", *map(str, words)], stderr=subprocess.PIPE, text=True,
                                stdout=subprocess.PIPE, env={**ENVIRONMENT, **variables})

    def finish(self, process):
        """Waits for mpirun; returns its exit code and its standard error."""
        _, errors = process.communicate(timeout=300)
        return process.returncode, errors

    def run_ranks(self, count, *arguments, **variables):
        """Runs the program to its end, which is a success."""
        code, errors = self.finish(
            self.start("-n", count, PROGRAM, *arguments, "--quiet", **variables))
        self.assertEqual(code, 0, errors)

    def run_serial(self, program, *arguments):
        result = subprocess.run([FOLDER / program, *map(str, arguments), "--quiet"],
                                capture_output=True, text=True, timeout=300, env=ENVIRONMENT)
        self.assertEqual(result.returncode, 0, result.stderr)

    def image(self, name):
        return self.path / f"{name}.exr"

    def render_arguments(self, name, *more):
        return (CORNELL, "-o", self.image(name), "--state", self.path / name, *SMALL, *more)

    def expect_same(self, words, *names):
        """Expects images and films that are equal to the first ones."""
        expected, pixels = words(self.path / names[0]), exr_parts(self.image(names[0]))
        self.assertNotEqual(expected[1].strip(b"\0"), b"")
        for name in names[1:]:
            header, found = words(self.path / name)
            self.assertEqual(header["ranges"], expected[0]["ranges"], name)
            self.assertEqual(found, expected[1], name)
            self.assertEqual(exr_parts(self.image(name)), pixels, name)

    def check_render(self, counts, *arguments, **variables):
        """Renders with each number of ranks, and by the serial program."""
        self.run_serial("rtrays-render", *self.render_arguments("serial", *arguments))
        for count in counts:
            self.run_ranks(count, "render", *self.render_arguments(f"ranks{count}", *arguments),
                           **variables)
        self.expect_same(film_words, "serial", *(f"ranks{count}" for count in counts))

    def test_path_tracing_has_the_bits_of_one_process(self):
        self.check_render((1, 2, 3, 4, 7) if FULL else (1, 4), "--spp", 21)

    def test_truncated_bdpt_has_the_bits_of_one_process(self):
        self.check_render((1, 2, 3, 4, 7) if FULL else (3,), "--spp", 20, "--algorithm",
                          "truncated_bdpt")

    @unittest.skipUnless(FULL, "one of the passes of truncated_bdpt")
    def test_light_tracing_has_the_bits_of_one_process(self):
        self.check_render((1, 2, 3, 4, 7), "--spp", 20, "--algorithm", "light_tracing")

    @unittest.skipUnless(FULL, "only the sums of squares are new")
    def test_independent_samples_have_the_bits_of_one_process(self):
        self.check_render((1, 2, 3, 4, 7), "--spp", 20, "--algorithm", "truncated_bdpt", "--set",
                          "integrator.sampler=independent")

    def test_the_reference_has_the_bits_of_one_process(self):
        self.run_serial("rtrays-reference", *self.render_arguments("serial", "--spp", 300))
        for count in (1, 2, 3, 4, 7):
            self.run_ranks(count, "reference",
                           *self.render_arguments(f"ranks{count}", "--spp", 300))
        # 16 x 16 pixels of 48 words do not fill the last of the slabs that are summed.
        self.run_ranks(3, "reference", *self.render_arguments("slabs", "--spp", 300),
                       RTRAYS_TEST_SLAB="1000")
        self.expect_same(state_words, "serial", "ranks1", "ranks2", "ranks3", "ranks4", "ranks7",
                         "slabs")
        # Another seed has other bits.
        self.run_ranks(2, "reference", CORNELL, "-o", self.image("other"), "--state",
                       self.path / "other", "--size", "16x16", "--seed", 4, "--spp", 300)
        self.assertNotEqual(state_words(self.path / "other")[1],
                            state_words(self.path / "serial")[1])

    def test_films_go_on_with_other_numbers_of_ranks(self):
        self.run_serial("rtrays-render", *self.render_arguments("whole", "--spp", 12))
        self.run_serial("rtrays-render", *self.render_arguments("film", "--samples", "3:6"))
        self.run_ranks(2, "render", *self.render_arguments("film", "--spp", 9, "--resume"),
                       "--checkpoint-interval", 0, "--preview", 0)
        self.run_serial("rtrays-render", *self.render_arguments("film", "--spp", 12, "--resume"))
        self.expect_same(film_words, "whole", "film")

    def test_the_documented_commands_run(self):
        """Those for a laptop; the others need GPUs or a batch system."""
        page = (SCENES.resolve().parent / "docs" / "cluster.md").read_text()
        section = page.split("## A laptop\n")[1].split("\n## ")[0]
        lines = section.split("```sh\n")[1].split("```")[0].splitlines()
        self.assertEqual(len(lines), 2)
        (self.path / "build").mkdir()
        (self.path / "build" / "bin").symlink_to(FOLDER.resolve())
        (self.path / "scenes").symlink_to(SCENES.resolve())
        for line in lines:
            result = subprocess.run(line, shell=True, cwd=self.path, env=ENVIRONMENT, timeout=120,
                                    capture_output=True, text=True)
            self.assertEqual(result.returncode, 0, result.stderr)
        self.assertTrue(self.image("reference").exists() and self.image("box").exists())

    def wait_for(self, state):
        for _ in range(6000):
            if state.exists():
                return
            time.sleep(0.01)
        self.fail("no checkpoint in a minute")

    def children(self, process):
        try:
            listed = pathlib.Path(f"/proc/{process.pid}/task/{process.pid}/children").read_text()
        except FileNotFoundError:
            return []  # it has ended
        return sorted(map(int, listed.split()))

    def check_kills(self, command, words, kills, ranks, spp):
        """Kills a rank after the first checkpoint, again and again, and continues at last."""
        self.run_serial(f"rtrays-{command}", *self.render_arguments("whole", "--spp", spp))
        arguments = (command, *self.render_arguments("killed", "--spp", spp, "--quiet", "--resume",
                                                     "--checkpoint-interval", 0.2))
        random_times, done = random.Random(17), 0
        for kill in range(kills):
            state = self.path / "killed"
            before = state.stat().st_mtime_ns if state.exists() else 0
            process = self.start("-n", ranks, PROGRAM, *arguments)
            self.wait_for(state)
            while state.stat().st_mtime_ns == before and process.poll() is None:
                time.sleep(0.01)
            time.sleep(random_times.uniform(0, 0.4))
            victims = self.children(process)
            if len(victims) < ranks:
                break  # the end was nearer than the kill
            os.kill(victims[random_times.randrange(ranks)], signal.SIGKILL)
            code, errors = self.finish(process)
            # mpirun reports the signal.
            self.assertEqual(code, 128 + signal.SIGKILL, errors)
            self.assertIn("exited on signal 9", errors)
            self.assertFalse(self.image("killed").exists())
            held = sum(end - begin for begin, end in words(state)[0]["ranges"])
            self.assertGreater(held, done, kill)
            done = held
        self.assertGreater(done, 0)
        code, errors = self.finish(self.start("-n", ranks, PROGRAM, *arguments))
        self.assertEqual(code, 0, errors)
        self.expect_same(words, "whole", "killed")

    def test_killed_references_go_on_from_the_checkpoint(self):
        self.check_kills("reference", state_words, 10 if FULL else 2, 3,
                         60000 if FULL else 9000)

    def test_killed_renders_go_on_from_the_checkpoint(self):
        self.check_kills("render", film_words, 10 if FULL else 1, 2, 60000 if FULL else 6000)

    def test_a_signal_saves_the_film(self):
        """Any rank may get it."""
        arguments = ("reference", *self.render_arguments("film", "--spp", 6000, "--quiet"))
        process = self.start("-n", 2, PROGRAM, *arguments, "--checkpoint-interval", 0.2)
        self.wait_for(self.path / "film")
        os.kill(self.children(process)[1], signal.SIGTERM)
        code, errors = self.finish(process)
        self.assertEqual(code, 130, errors)
        self.assertIn("continue with --resume", errors)
        self.assertLess(state_words(self.path / "film")[0]["ranges"][-1][1], 6000)
        self.run_ranks(2, *arguments, "--resume")
        self.run_serial("rtrays-reference", *self.render_arguments("whole", "--spp", 6000))
        self.expect_same(state_words, "whole", "film")

    def test_a_full_disk_loses_nothing_that_was_there(self):
        state = self.path / "film"
        arguments = self.render_arguments("film", "--quiet", "--spp", 100000)
        # A file beyond the limit is then an error instead of a signal.
        wrapper = ("sh", "-c", 'trap "" XFSZ; exec "$@"', "sh")
        process = self.start("-n", 2, *wrapper, PROGRAM, "reference", *arguments,
                             "--checkpoint-interval", 1)
        self.wait_for(state)
        before = state.read_bytes()
        resource.prlimit(self.children(process)[0], resource.RLIMIT_FSIZE, (50000, 50000))
        code, errors = self.finish(process)
        self.assertEqual(code, 1, errors)
        self.assertIn("film: cannot be written", errors)
        self.assertEqual(state.read_bytes(), before)
        self.assertGreater(state_words(state)[0]["ranges"][0][1], 0)

    def test_a_slow_rank_gets_fewer_samples(self):
        """A static split would give half of the samples to the rank that is ten times slower."""
        stats = self.path / "stats.json"
        arguments = self.render_arguments("slow", "--spp", 8000, "--threads", 1, "--stats", stats)
        self.run_ranks(2, "reference", *arguments, RTRAYS_TEST_DELAY="1:10")
        fast, slow = json.loads(stats.read_text())["job"]["ranks"]
        self.assertEqual(fast["samples"] + slow["samples"], 8000)
        self.assertLess(slow["samples"], 0.25 * 8000)
        self.assertGreater(slow["ranges"], 2)

    def expect_refused(self, fragments, first, second):
        """Runs two ranks with different words, and expects one message that names the rank."""
        code, errors = self.finish(self.start("-n", 1, *first, ":", "-n", 1, *second))
        self.assertEqual(code, 2, errors)
        self.assertEqual(errors.count("rtrays-mpi: "), 1, errors)
        for fragment in fragments:
            self.assertIn(fragment, errors)
        self.assertEqual(list(self.path.glob("*.exr")), [])

    def test_ranks_that_differ_are_refused_by_name(self):
        changed = self.path / "program"
        shutil.copy(PROGRAM, changed)
        with changed.open("ab") as file:
            file.write(b"another build")
        scene = SCENES / "analytic" / "furnace_050.json"
        common = ("--spp", 4, "-o", self.image("out"), "--size", "8x8")
        reference = (PROGRAM, "reference", CORNELL, *common)
        self.expect_refused(["rank 1 (", ") has scene ", "furnace_050", "cornell_box"],
                            reference, (PROGRAM, "reference", scene, *common))
        self.expect_refused(["rank 1 (", ") has seed 7, rank 0 (", ") has 1"],
                            reference, (*reference, "--seed", 7))
        self.expect_refused(["rank 1 (", ") has program "], reference, (changed, *reference[1:]))
        render = (PROGRAM, "render", CORNELL, *common)
        self.expect_refused(["rank 1 (", ") has integrator.max_depth 3, rank 0 (", ") has 0"],
                            render, (*render, "--set", "integrator.max_depth=3"))
        self.expect_refused(["rank 1 (", "runs another command"], reference, render)
        self.expect_refused(["rank 1 (", "nowhere.json"], reference,
                            (PROGRAM, "reference", "nowhere.json", *common))

    def test_refuses_bad_usage_once(self):
        for words, fragment in (((), "expected a command"), (("draw",), "unknown command 'draw'"),
                                (("render", CORNELL), "no output"),
                                (("reference", CORNELL, "-o", self.image("x"), "--spp", "1",
                                  "--engine", "cycles"), "embree alone"),
                                (("render", CORNELL, "-o", self.image("x"), "--spp", 400, "--set",
                                  "integrator.convergence.error=0.1"), "convergence control")):
            words = (PROGRAM, *words)
            self.expect_refused([fragment], words, words)
        for words, line in ((("--help",), "Usage: mpirun"), (("--version",), "rtrays-mpi "),
                            (("render", "--help"), "Usage: rtrays-mpi render")):
            process = self.start("-n", 2, PROGRAM, *words)
            output, errors = process.communicate(timeout=60)
            self.assertEqual(process.returncode, 0, errors)
            self.assertEqual(output.count(line), 1, output)


if __name__ == "__main__":
    if not PROGRAM or shutil.which("mpirun") is None:
        print("MPI is not installed; run scripts/install --mpi", file=sys.stderr)
        sys.exit(77)
    unittest.main(argv=[sys.argv[0]] + [word for word in sys.argv[4:] if word != "--full"])
