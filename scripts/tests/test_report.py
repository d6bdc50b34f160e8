# SPDX-License-Identifier: MIT
"""Tables, plots and reports of a small made-up run."""

import copy
import csv
import io
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

SCRIPTS = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(SCRIPTS))

import numpy  # noqa: E402

from cells import latex_escape  # noqa: E402
from run_document import (  # noqa: E402
    Run,
    RunError,
    agreement_verdict,
    gain_verdict,
    slope_verdict,
    usable_points,
    value,
)
from tables import (  # noqa: E402
    TABLES,
    efficiency_table,
    errors_table,
    memory_table,
    repetitions_table,
    throughput_table,
)


def from_rgbe(pixels):
    """Linear values of viewer.to_rgbe's."""
    mantissa, exponent = pixels[..., :3].astype(float), pixels[..., 3:].astype(float)
    return numpy.where(exponent > 0, (mantissa + 0.5) * 2.0 ** (exponent - 136), 0)


def made_up_curve(strategies):
    points = []
    for spp in (1, 2, 4, 8):
        rmse = spp**-0.5
        repetitions = [
            {
                "seed": seed,
                "seconds_device": 0.1 * spp,
                "seconds_wall": 0.2 * spp,
                "l2": 10 * rmse,
                "rmse": rmse * (1 + 0.01 * seed),
                "mae": rmse / 2,
                "relmse": rmse**2,
                "mse": rmse**2,
            }
            for seed in range(1, 9)
        ]
        points.append(
            {
                "spp": spp,
                "seconds_device": 0.1 * spp,
                "seconds_wall": 0.2 * spp,
                "l2": 10 * rmse,
                "rmse": rmse,
                "mae": rmse / 2,
                "relmse": rmse**2,
                "mse": rmse**2,
                "mse_unbiased": rmse**2 - 0.01,
                "noise_dominates": spp == 8,
                "repetitions": repetitions,
            }
        )
    slope = {"value": -0.5, "low": -0.51, "high": -0.49, "confidence": 0.95, "spp": [1, 4]}
    return {
        "id": f"path_tracing.{strategies}",
        "scene": "box",
        "algorithm": "path_tracing",
        "strategies": strategies,
        "settings": {},
        "compile_seconds": 1.5,
        "bvh_seconds": 0.01,
        "render_report": {
            "bytes_per_path": 112,
            "light_vertex_bytes_per_path": 0,
            "features": [],
            "stages": [{"pass": "camera", "seconds": 3}, {"pass": "light", "seconds": 1}],
        },
        "points": points,
        "slope": slope,
        "slope_unbiased": slope,
        "image": "images/ours.exr",
        "image_spp": 64,
        "layers": [],
        "early_images": [{"spp": 2, "image": "images/early.exr"}],
        "agreement": {
            "block_size": 16,
            "alpha": 0.01,
            "tests": 51,
            "rejected": 0,
            "agrees": True,
            "largest_z": 2.5,
            "smallest_adjusted_p": 0.6,
            "equivalence": "equivalent",
            "relative_difference": {
                "value": 1e-4,
                "low": -2e-4,
                "high": 4e-4,
                "confidence": 0.99,
                "limit": 1e-3,
            },
        },
    }


def made_up_run():
    return {
        "schema_version": 2,
        "experiment": {
            "name": "box",
            "title": "A box & more",
            "thesis": "4.2",
            "claim": "It converges.",
            "profile": "ci",
            "size": [4, 4],
            "expected_slope": {"value": -0.5, "tolerance": 0.03},
        },
        "context": {
            "commit": "abc",
            "dirty": False,
            "started_at": "2026-01-01T00:00:00Z",
            "finished_at": "2026-01-01T00:01:00Z",
            "load_average_start": [0, 0, 0],
            "load_average_end": [1, 0, 0],
            "host": {
                "cpu": "cpu",
                "cores": 2,
                "kernel": "Linux",
                "compiler": "GNU",
                "build_type": "Release",
            },
            "cpu_use": {"own": 0.9, "foreign": 0.01, "steal": 0.0},
            "kernel_options": "-cl-std=CL1.2",
            "device": {
                "name": "pthread",
                "platform": "PoCL",
                "driver": "3.1",
                "c_version": "1.2",
                "compute_units": 2,
            },
        },
        "reference": {
            "engine": "embree",
            "files": ["a.exr", "b.exr"],
            "image": "images/reference.exr",
            "spp": 100,
            "scene_hash": "ff",
            "noise_floor": {"mse": 0.01, "rmse": 0.1, "l2": 0.7},
        },
        "curves": [made_up_curve("implicit"), made_up_curve("mis")],
        "throughput": {
            "curve": "path_tracing.mis",
            "samples_per_repetition": 1e6,
            "accepted": True,
            "repetitions": [],
            "renderer_samples_per_second": {"value": 2e6, "low": 1e6, "high": 3e6},
            "reference_samples_per_second": {"value": 1e6, "low": 1e6, "high": 1e6},
            "ratio": {"value": 2, "low": 1, "high": 3},
        },
    }


class RunFolder(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self.temporary.name) / "box"
        (self.folder / "images").mkdir(parents=True)
        self.document = made_up_run()
        generator = numpy.random.default_rng(1)
        for name in ("reference", "ours", "early"):
            numpy.save(
                self.folder / f"images/{name}.npy", generator.random((4, 4, 3), dtype=numpy.float32)
            )

    def tearDown(self):
        self.temporary.cleanup()

    def run_object(self):
        (self.folder / "run.json").write_text(json.dumps(self.document))
        return Run(self.folder)

    def script(self, name, *arguments):
        return subprocess.run(
            [sys.executable, SCRIPTS / name, *arguments],
            capture_output=True,
            text=True,
            check=False,
        )


class Documents(RunFolder):
    def test_missing_values_are_errors(self):
        for path, where in (
            ("rmse", self.document["curves"][0]["points"][1]),
            ("l2", self.document["curves"][1]["points"][0]),
        ):
            kept = where.pop(path)
            with self.assertRaisesRegex(RunError, path):
                errors_table(self.run_object())
            where[path] = None
            with self.assertRaisesRegex(RunError, path):
                errors_table(self.run_object())
            where[path] = kept
        errors_table(self.run_object())

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

    def test_values_of_lists(self):
        self.assertEqual(value(self.document, "reference.files.1"), "b.exr")

    def test_verdicts(self):
        self.assertEqual(slope_verdict({"low": -0.52, "high": -0.48}, -0.5, 0.03), "holds")
        self.assertEqual(slope_verdict({"low": -0.54, "high": -0.48}, -0.5, 0.03), "undecided")
        self.assertEqual(
            slope_verdict({"low": -0.40, "high": -0.30}, -0.5, 0.03), "does not hold here"
        )
        for low, high, verdict in (
            (1.9, 2.1, "holds"),
            (2.5, 3, "holds"),
            (1.2, 1.9, "holds partly"),
            (0.8, 1.5, "does not hold here"),
            (0.8, 2.5, "undecided"),
        ):
            self.assertEqual(gain_verdict({"low": low, "high": high}, 2), verdict)
        agreement = copy.deepcopy(self.document["curves"][0]["agreement"])
        self.assertEqual(agreement_verdict(agreement), "holds")
        agreement["equivalence"] = "undecided"
        self.assertEqual(agreement_verdict(agreement), "undecided")
        agreement["agrees"] = False
        self.assertEqual(agreement_verdict(agreement), "does not hold here")


class Tables(RunFolder):
    def test_forms_hold_the_same_cells(self):
        table = errors_table(self.run_object())
        rows = list(csv.reader(io.StringIO(table.csv())))
        self.assertEqual(rows[0], table.columns)
        self.assertEqual(rows[1:], table.rows)
        self.assertEqual(len(table.rows), 8)
        self.assertEqual(table.markdown().count("\n"), 10)
        self.assertEqual(table.latex().count(r"\\"), 9)
        self.assertIn(r"\toprule", table.latex())

    def test_latex_is_escaped(self):
        self.assertEqual(latex_escape("50 % & a_b"), r"50 \% \& a\_b")

    def test_repetitions_are_exact(self):
        table = repetitions_table(self.run_object())
        self.assertEqual(len(table.rows), 2 * 4 * 8)
        self.assertEqual(
            float(table.rows[0][table.columns.index("rmse")]),
            self.document["curves"][0]["points"][0]["repetitions"][0]["rmse"],
        )

    def test_efficiency_compares_what_is_beyond_the_reference_noise(self):
        mis, other = self.document["curves"][1], self.document["curves"][0]
        # At 4 spp the MSE is 0.25, 0.01 of it that of the reference. The other curve has twice the
        # rest in 1.5 times the time, without its pilot of 0.2 s.
        for repetition in other["points"][2]["repetitions"]:
            repetition.update(mse=0.01 + 2 * 0.24, seconds_device=1.5 * 0.4 + 0.2)
        other["render_report"]["pilot"] = {"seconds": 0.2}
        rows = {row[0]: row for row in efficiency_table(self.run_object()).rows}
        self.assertEqual(rows["path tracing (MIS)"][5:], ["1 (baseline)", "1 (baseline)"])
        self.assertEqual(
            rows["path tracing (implicit)"][4:],
            ["0.2", "0.5 [0.5, 0.5]", "0.3333 [0.3333, 0.3333]"],
        )
        mis["points"][0]["noise_dominates"] = True
        with self.assertRaisesRegex(RunError, "path_tracing.mis has no point above"):
            efficiency_table(self.run_object())

    def test_memory_is_what_the_run_reports(self):
        self.document["curves"][0]["algorithm"] = "bdpt"
        self.assertEqual(
            memory_table(self.run_object()).rows[0][1:],
            ["112", "0", "3.5 KB, 16 vertices from either end"],
        )

    def test_refused_throughput_is_said(self):
        self.document["throughput"] = {
            "curve": "path_tracing.mis",
            "accepted": False,
            "reason": "foreign load",
            "repetitions": [],
            "samples_per_repetition": 1.0,
        }
        self.assertIn("Refused: foreign load.", throughput_table(self.run_object()).markdown())

    def test_times_contain_the_pilot(self):
        curve = self.document["curves"][0]
        curve["render_report"]["pilot"] = {"seconds": 3.0}
        run = self.run_object()
        table, raw = errors_table(run), repetitions_table(run)
        self.assertEqual(table.rows[0][table.columns.index("wall time, s")], "3.2")
        self.assertEqual(table.rows[0][table.columns.index("device time, s")], "0.1")
        self.assertEqual(float(raw.rows[0][raw.columns.index("seconds_wall")]), 3.2)
        self.assertIn("include the pilot", table.notes[0])

    def test_intervals_have_three_columns_of_numbers_in_csv(self):
        rows = list(csv.reader(io.StringIO(efficiency_table(self.run_object()).csv())))
        column = rows[0].index("gain in equal device time, times")
        self.assertEqual(rows[0][column + 1], "gain in equal device time, times low")
        self.assertEqual([float(cell) for cell in rows[1][column : column + 3]], [1.0, 1.0, 1.0])

    def test_script_writes_all_forms(self):
        self.run_object()
        done = self.script("tabulate", self.folder)
        self.assertEqual(done.returncode, 0, done.stderr)
        for name in TABLES:
            for extension in ("csv", "md", "tex"):
                self.assertTrue((self.folder / "tables" / f"{name}.{extension}").stat().st_size > 0)


class Reports(RunFolder):
    def test_report_is_self_contained_and_reproducible(self):
        self.run_object()
        done = self.script("report", self.folder)
        self.assertEqual(done.returncode, 0, done.stderr)
        page = pathlib.Path(done.stdout.strip())
        text = page.read_text()
        self.assertNotIn("http", text)
        self.assertIn("A box &amp; more", text)
        self.assertNotIn("&amp;amp;", text)
        for link in (
            "plots/rmse_spp.svg",
            "plots/rmse_spp.png",
            "plots/images_path_tracing.mis.png",
            "tables/errors.tex",
        ):
            self.assertIn(link, text)
            self.assertTrue((self.folder / link).stat().st_size > 0)
        self.assertIn("commit abc", (self.folder / "report.md").read_text())
        first = (self.folder / "plots/rmse_spp.svg").read_bytes()
        self.script("plot", self.folder)
        self.assertEqual((self.folder / "plots/rmse_spp.svg").read_bytes(), first)

    def test_passes_and_gains_have_figures_and_rows(self):
        curve = self.document["curves"][0]
        curve.update(
            id="truncated_bdpt.mis", algorithm="truncated_bdpt", layers=["camera", "light"]
        )
        self.document["experiment"]["expected_gain"] = {
            "algorithm": "truncated_bdpt",
            "samples": 4,
            "time": 2,
        }
        for layer in curve["layers"]:
            shutil.copy(self.folder / "images/ours.npy", self.folder / f"images/ours.{layer}.npy")
        self.run_object()
        done = self.script("report", self.folder)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertTrue(
            (self.folder / "plots/contributions_truncated_bdpt.mis.png").stat().st_size > 0
        )
        self.assertTrue((self.folder / "plots/early.png").stat().st_size > 0)
        page = (self.folder / "report.md").read_text()
        self.assertIn(
            (
                "| truncated BDPT (MIS) | gain over path tracing (MIS) in equal samples | 4 times |"
                " 1.00 [1.00, 1.00] | does not hold here |"
            ),
            page,
        )
        self.assertIn(
            (
                "| truncated BDPT (MIS) | gain over path tracing (MIS) in equal device time | 2"
                " times | 1.00 [1.00, 1.00] | does not hold here |"
            ),
            page,
        )
        self.assertIn(
            (
                "**In equal device time truncated BDPT (MIS) has 1.00 [1.00, 1.00] times the"
                " efficiency of path tracing (MIS); the thesis claims 2.**"
            ),
            page,
        )
        self.assertIn("takes 1.00 times as much device time; its light pass is 25 % of that", page)

    def test_slopes_are_judged_where_the_claim_is_made(self):
        from curve_page import verdict_table

        self.document["curves"][0]["settings"]["integrator.sampler"] = "sobol"
        self.document["curves"].append(copy.deepcopy(self.document["curves"][1]))
        self.document["curves"][2].update({"id": "light_tracing.mis", "algorithm": "light_tracing"})
        self.document["curves"][2]["render_report"]["features"] = ["delta"]
        slopes = [
            row[-1].partition(":")[0]
            for row in verdict_table(self.run_object()).rows
            if row[1].startswith("slope")
        ]
        self.assertEqual(slopes, ["not expected", "holds", "not expected"])

    def test_viewer_has_the_images(self):
        from viewer import to_rgbe

        picture = numpy.array(
            [[[1.0, 0.5, 0.0], [1e4, 1e-4, 3.0]], [[0, 0, 0], [-1, 2e-30, 1e-30]]]
        )
        decoded = from_rgbe(to_rgbe(picture))
        largest = numpy.max(picture, axis=-1, keepdims=True)
        self.assertTrue((abs(decoded - numpy.maximum(picture, 0)) <= largest * 2.0**-8).all())
        self.run_object()
        self.assertEqual(self.script("report", self.folder).returncode, 0)
        text = (self.folder / "images.js").read_text()
        shown = json.loads(text[text.index("[") : text.rindex(";")])
        self.assertEqual(
            [image["name"] for image in shown][:3],
            ["reference, 100 spp", "path tracing (MIS), 64 spp", "path tracing (MIS), 2 spp"],
        )

    @unittest.skipUnless(shutil.which("chromium"), "Chromium is not installed")
    def test_viewer_compares_in_a_browser(self):
        from viewer import to_rgbe

        self.run_object()
        self.assertEqual(self.script("report", self.folder).returncode, 0)
        page = self.folder / "driven.html"
        page.write_text(
            (self.folder / "index.html").read_text()
            + """<pre id=told></pre><script>
            const root = document.getElementById("viewer"), canvas = root.querySelector("canvas");
            const [left, right, mode] = root.querySelectorAll("select");
            const [exposure] = root.querySelectorAll("input");
            const set = (control, value) => { control.value = value; control.oninput(); };
            const context = canvas.getContext("2d");
            const data = () => context.getImageData(0, 0, canvas.width, canvas.height).data;
            const shown = () => Array.from(data());
            const told = {size: [canvas.width, canvas.height]};
            set(mode, 1); told.left = shown();
            set(mode, 2); told.right = shown();
            set(mode, 3); set(exposure, 1); told.difference = shown();
            const box = canvas.getBoundingClientRect();
            const corner = {clientX: box.right - 1, clientY: box.bottom - 1};
            canvas.dispatchEvent(new PointerEvent("pointermove", corner));
            told.readout = root.querySelector(".readout").textContent;
            document.getElementById("told").textContent = JSON.stringify(told);</script>"""
        )
        done = subprocess.run(
            [
                "chromium",
                "--headless",
                "--no-sandbox",
                "--disable-gpu",
                "--dump-dom",
                page.as_uri(),
            ],
            capture_output=True,
            text=True,
            timeout=120,
        )
        told = json.loads(done.stdout.rpartition('<pre id="told">')[2].partition("</pre>")[0])
        run = Run(self.folder)
        reference, image = (
            from_rgbe(to_rgbe(run.image(name)))
            for name in (run.get("reference.image"), value(run.curves[-1], "image"))
        )
        height, width = reference.shape[:2]
        self.assertEqual(told["size"], [width, height])

        def bytes_of(linear):  # IEC 61966-2-1
            x = numpy.clip(linear, 0, 1)
            return 255 * numpy.where(x <= 0.0031308, 12.92 * x, 1.055 * x ** (1 / 2.4) - 0.055)

        for key, linear in (
            ("left", reference),
            ("right", image),
            ("difference", 20 * abs(reference - image)),
        ):
            drawn = numpy.array(told[key]).reshape(height, width, 4)
            self.assertTrue((drawn[..., 3] == 255).all())
            self.assertLess(abs(drawn[..., :3] - bytes_of(linear)).max(), 0.51, key)
        self.assertTrue(
            told["readout"].startswith(f"({width - 1}, {height - 1})  left "), told["readout"]
        )

    def test_a_run_without_images_keeps_its_pictures(self):
        self.run_object()
        self.assertEqual(self.script("report", self.folder).returncode, 0)
        pages = {
            name: (self.folder / name).read_bytes()
            for name in ("report.md", "plots/early.png", "edges.json")
        }
        clone = self.folder.parent / "clone"
        shutil.copytree(
            self.folder, clone, ignore=shutil.ignore_patterns("images", "*.html", "*.js")
        )
        (clone / "plots/images_path_tracing.mis.png").unlink()
        done = self.script("report", clone)
        self.assertEqual(done.returncode, 0, done.stderr)
        page = (clone / "index.html").read_text()
        self.assertIn("plots/early.png", page)
        self.assertNotIn("images_path_tracing.mis.png", page)
        self.assertNotIn("images.js", page)
        self.assertIn("rtrays-experiment run experiments/box.json --profile ci --out DIR", page)
        for name in ("plots/early.png", "edges.json"):
            self.assertEqual((clone / name).read_bytes(), pages[name], name)

    def test_images_that_are_not_exported_are_an_error(self):
        self.run_object()
        (self.folder / "images/reference.npy").rename(self.folder / "images/reference.exr")
        done = self.script("report", self.folder)
        self.assertEqual(done.returncode, 2)
        self.assertIn("rtrays-experiment report", done.stderr)

    def test_missing_image_is_one_clear_error(self):
        self.run_object()
        (self.folder / "images/ours.npy").unlink()
        done = self.script("report", self.folder)
        self.assertEqual(done.returncode, 2)
        self.assertIn("ours.npy", done.stderr)
        self.assertEqual(done.stderr.count("\n"), 1)

    def test_difference_is_ten_times(self):
        from plots import images_figure, to_display

        run = self.run_object()
        figure = images_figure(run, run.curves[0])
        shown = figure.axes[2].images[0].get_array()
        reference, ours = (
            numpy.load(self.folder / f"images/{name}.npy") for name in ("reference", "ours")
        )
        numpy.testing.assert_allclose(
            shown, to_display(10 * numpy.abs(ours.astype(float) - reference)), atol=1e-12
        )
        self.assertAlmostEqual(float(to_display(numpy.array(0.5))), 0.7353569830524495)


if __name__ == "__main__":
    unittest.main()
