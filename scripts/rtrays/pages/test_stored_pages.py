# SPDX-License-Identifier: MIT
"""Tests that the stored pages are those that the stored documents make."""

import pathlib
import re
import shutil
import subprocess
import tempfile
import unittest

import matplotlib

from rtrays.paths import ROOT
from rtrays.testing import script


STORED = ROOT / "results/chapter4"
CURVES = sorted(path.parent.name for path in STORED.glob("*/report.md"))


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
        cls.done = script("results", "report", *folders, root=cls.root)

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


if __name__ == "__main__":
    unittest.main()
