# SPDX-License-Identifier: MIT
"""Pages: escaping, the overview with and without the thesis, stored pages, and generated blocks."""

import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
SCRIPTS = ROOT / "scripts"
sys.path[:0] = [str(SCRIPTS), str(SCRIPTS / "tests")]

import matplotlib  # noqa: E402

from cells import Interval, Link, Table, verdict_of  # noqa: E402
from pages import Figure, Page, TableBlock, prose  # noqa: E402
from run_document import file_name  # noqa: E402
from test_report import RunFolder  # noqa: E402
import undecided  # noqa: E402
from undecided import advice, factor, factor_of_all, factor_of_gain  # noqa: E402

STORED = ROOT / "results/chapter4"
CURVES = sorted(path.parent.name for path in STORED.glob("*/report.md"))


def run(*command):
    return subprocess.run(
        [sys.executable, *map(str, command)], capture_output=True, text=True, check=False
    )


class OneSetting(unittest.TestCase):
    def test_a_measurement_without_builds_has_a_plot(self):
        document = json.loads((STORED / "ablations/run.json").read_text())
        for row in document["rows"]:
            row["frames"], row["builds"] = row["frames"][:2], row["builds"][:1]
        with tempfile.TemporaryDirectory() as folder:
            (pathlib.Path(folder) / "run.json").write_text(json.dumps(document))
            result = run(SCRIPTS / "measurements", folder)
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertTrue((pathlib.Path(folder) / "speeds_over_defaults.svg").exists())


class Undecided(unittest.TestCase):
    def test_widths_fall_as_the_root_of_the_number_of_samples(self):
        figure = {"value": 1.0, "low": 0.6, "high": 1.2}
        self.assertAlmostEqual(factor(figure, 0.8), 4)
        self.assertAlmostEqual(factor(figure, 1.1), 4)
        self.assertEqual(factor(figure, 2), 1)
        self.assertAlmostEqual(factor_of_all(figure, (0.8, 1.05)), 16)
        self.assertAlmostEqual(factor_of_all(figure, (None, 1.1)), 4)

    def test_a_gain_is_decided_above_one_or_below_the_claim(self):
        self.assertAlmostEqual(factor_of_gain({"value": 1.5, "low": 0.5, "high": 2.5}, 2), 4)
        self.assertAlmostEqual(factor_of_gain({"value": 0.9, "low": 0.5, "high": 3.1}, 2), 4)

    def test_the_mean_is_decided_within_or_beyond_the_limit(self):
        difference = {"value": 0.0, "low": -0.003, "high": 0.003, "limit": 0.001}
        self.assertAlmostEqual(
            undecided.factor_of_agreement({"relative_difference": difference}), 9
        )

    def test_words(self):
        self.assertEqual(advice(4), "about 4 times as many samples would decide it")
        self.assertEqual(advice(1.25), "about 1.3 times as many samples would decide it")
        self.assertEqual(advice(123, "seeds"), "about 130 times as many seeds would decide it")
        self.assertIn("hardly", advice(float("inf")))


class Cells(unittest.TestCase):
    def test_verdicts_are_read_from_the_start_of_a_cell(self):
        for cell, word in (
            ("holds", "holds"),
            ("holds partly", "holds partly"),
            ("undecided: about 4 times as many samples would decide it", "undecided"),
            ("holds, of what was measured", "holds"),
            ("holds if", None),
        ):
            self.assertEqual(verdict_of(cell), word, cell)

    def test_columns_of_numbers_are_right_aligned(self):
        table = Table("t", ["a", "b", "c"], [["x", "1.5 [1, 2]", "–"], ["y", "-3e-05", "12 of 70"]])
        self.assertEqual(table.numeric, [False, True, True])
        self.assertIn("| --- | ---: | ---: |", table.markdown())

    def test_intervals_and_their_minus_signs_are_kept_on_one_line(self):
        self.assertEqual(
            prose("in -0.5 [-0.6, -0.4] %"), "in <span class=n>−0.5 [−0.6, −0.4] %</span>"
        )
        self.assertEqual(prose("8.7e-13"), "<span class=n>8.7e-13</span>")
        self.assertEqual(prose("2026-11-25T04:28:34Z"), "2026-11-25T04:28:34Z")

    def test_text_is_escaped_once(self):
        self.assertEqual(prose("a's <b> & c"), "a&#39;s &lt;b&gt; &amp; c")

    def test_file_names_have_neither_blanks_nor_commas(self):
        self.assertEqual(
            file_name("truncated_bdpt.mis,light_paths=auto"), "truncated_bdpt.mis_light_paths=auto"
        )
        self.assertEqual(
            file_name("caustic r=0.1.path_tracing explicit"), "caustic_r=0.1.path_tracing_explicit"
        )


class Templates(unittest.TestCase):
    def test_whatever_a_run_is_called_is_escaped(self):
        evil = "<script>alert(1)</script>"
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            table = Table(
                evil,
                [evil, "b"],
                [[evil, Interval("1 [0, 2]", [1, 0, 2])], [Link(evil, f"../{evil}", "x.md"), "2"]],
                [evil],
            )
            Page(
                folder,
                "page.md",
                evil,
                evil,
                [TableBlock(table), Figure("a.svg", evil)],
                evil,
                evil,
                provenance=[evil],
            ).write()
            text = (folder / "index.html").read_text()
        self.assertNotIn("<script>", text)
        self.assertIn(
            "&lt;script&gt;alert(1)&lt;/script&gt;", text.replace("<span class=n>1</span>", "1")
        )
        self.assertIn('<meta name=viewport content="width=device-width, initial-scale=1">', text)


class Overview(RunFolder):
    def two_runs(self, *names):
        self.run_object()
        folders = [self.folder.parent / name for name in names]
        for folder in folders:
            shutil.copytree(self.folder, folder)
        shutil.rmtree(self.folder)
        done = self.script("report", *folders)
        self.assertEqual(done.returncode, 0, done.stderr)
        return pathlib.Path(done.stdout.strip())

    def test_runs_of_ones_own_are_not_chapter_4(self):
        index = self.two_runs("first", "second")
        text = index.read_text()
        self.assertIn("<title>RTRays: 2 experiments in ", text)
        self.assertNotIn("chapter 4", text)
        self.assertNotIn("not measured", text)
        self.assertFalse((index.parent / "claims").exists())
        self.assertEqual(text.count("<a class=card"), 2)
        self.assertIn('src="first/plots/reference.png"', text)
        self.assertIn(
            '<a href="../index.html">Overview</a>', (index.parent / "first/index.html").read_text()
        )

    def test_runs_of_the_thesis_have_verdicts_and_missing_charts_are_lines(self):
        index = self.two_runs("cornell_diffuse", "cornell_bumps")
        text = index.read_text()
        self.assertIn("<title>RTRays: chapter 4 of the thesis, reproduced", text)
        self.assertIn('<dt data-verdict="holds"><b>', text)
        self.assertIn('data-verdict="not measured"', text)
        for line in (
            "The gains of truncated BDPT need one of these runs",
            "needs the run bounces",
            "needs: bvh_build, ray_rates",
        ):
            self.assertIn(line, text)
        claims = (index.parent / "claims/index.html").read_text()
        self.assertIn('<a href="../cornell_diffuse/index.html">', claims)
        self.assertIn('data-verdict="holds"', claims)
        self.assertIn("](cornell_diffuse/report.md)", (index.parent / "index.md").read_text())

    def test_a_broken_neighbour_is_a_line(self):
        self.run_object()
        broken = self.folder.parent / "broken"
        broken.mkdir()
        (broken / "run.json").write_text("{")
        other = self.folder.parent / "other"
        shutil.copytree(self.folder, other)
        done = self.script("report", self.folder, other)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("not JSON", done.stderr)
        self.assertIn("Omitted: ", pathlib.Path(done.stdout.strip()).read_text())
        self.assertEqual(self.script("report", broken, other).returncode, 2)


class Stored(unittest.TestCase):
    """The stored pages are those that the stored documents make, without any measured image."""

    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.root = pathlib.Path(cls.temporary.name)
        for folder in ("scripts", "experiments"):
            shutil.copytree(ROOT / folder, cls.root / folder)
        cls.kept = [
            path
            for path in STORED.rglob("*")
            if path.suffix in (".json", ".md", ".svg", ".png")
            and not {"tables", "images"} & set(path.relative_to(STORED).parts)
        ]
        for path in cls.kept:
            copy = cls.root / path.relative_to(ROOT)
            copy.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(path, copy)
        folders = [cls.root / "results/chapter4" / name for name in CURVES]
        cls.done = run(cls.root / "scripts/report", *folders)

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def test_pages_and_plots_are_current(self):
        self.assertEqual(self.done.returncode, 0, self.done.stderr)
        version = f"Matplotlib v{matplotlib.__version__},"
        for path in self.kept:
            made = self.root / path.relative_to(ROOT)
            drawn_by_another = path.suffix == ".svg" and version not in path.read_text()
            if path.suffix in (".md", ".svg") and not drawn_by_another:
                self.assertEqual(
                    made.read_text(),
                    path.read_text(),
                    f"{path.relative_to(ROOT)}: run make report PROFILE=full",
                )

    def test_every_page_is_stored_and_linked_files_exist(self):
        folder = self.root / "results/chapter4"
        for page in folder.glob("**/index.html"):
            for link in re.findall(r'(?:href|src)="([^"#:]+)', page.read_text()):
                if not link.endswith("docs/statistics.md"):
                    self.assertTrue((page.parent / link).exists(), f"{page}: {link}")
        for page in folder.glob("**/*.md"):
            if "tables" not in page.parts:
                stored = STORED / page.relative_to(folder)
                self.assertTrue(stored.exists(), f"{stored}: is not stored")

    def test_every_card_has_a_picture(self):
        text = (self.root / "results/chapter4/index.html").read_text()
        self.assertEqual(text.count("<a class=card"), text.count("<span class=label>"))
        self.assertEqual(
            text.count("<a class=card"), len(list(STORED.glob("*/"))) - 1
        )  # but claims

    def test_file_names_of_results_have_neither_blanks_nor_commas(self):
        listed = subprocess.run(
            ["git", "ls-files", "--cached", "--others", "--exclude-standard", "results"],
            cwd=ROOT,
            capture_output=True,
            text=True,
            check=False,
        )
        if listed.returncode != 0:
            self.skipTest("not a git repository")
        for name in listed.stdout.splitlines():
            if (ROOT / name).exists():
                self.assertNotRegex(name, "[ ,]")


class Summary(unittest.TestCase):
    def test_blocks_are_checked_and_updated(self):
        with tempfile.TemporaryDirectory() as name:
            file = pathlib.Path(name) / "README.md"
            file.write_text("a\n<!-- generated: gains -->\nold\n<!-- end generated -->\nb\n")
            checked = run(SCRIPTS / "summary", "--check", file)
            self.assertEqual(checked.returncode, 1)
            self.assertIn("--update", checked.stderr)
            self.assertEqual(run(SCRIPTS / "summary", "--update", file).returncode, 0)
            self.assertEqual(run(SCRIPTS / "summary", "--check", file).returncode, 0)
            text = file.read_text()
            self.assertTrue(text.startswith("a\n<!-- generated: gains -->\n| scene |"))
            self.assertTrue(text.endswith("<!-- end generated -->\nb\n"))
            printed = run(SCRIPTS / "summary", "gains").stdout
            self.assertIn(printed, text)

    def test_unknown_and_open_blocks_are_errors(self):
        with tempfile.TemporaryDirectory() as name:
            file = pathlib.Path(name) / "README.md"
            for text in (
                "<!-- generated: nothing -->\n<!-- end generated -->\n",
                "<!-- generated: gains -->\n",
            ):
                file.write_text(text)
                self.assertEqual(run(SCRIPTS / "summary", "--check", file).returncode, 2)
        self.assertEqual(run(SCRIPTS / "summary", "--check").returncode, 0)

    def test_the_list_of_results_is_current(self):
        checked = run(SCRIPTS / "summary", "--check", ROOT / "results/README.md")
        self.assertEqual(checked.returncode, 0, checked.stderr)

    def test_blocks_agree_with_the_documents(self):
        claims = run(SCRIPTS / "summary", "claims").stdout
        count = sum(
            len(section["claims"])
            for section in json.loads((ROOT / "experiments/claims.json").read_text())["sections"]
        )
        self.assertIn(f"Of {count} claims", claims)
        self.assertEqual(sum(map(int, re.findall(r"\| (\d+) \|$", claims, re.MULTILINE))), count)


if __name__ == "__main__":
    unittest.main()
