# SPDX-License-Identifier: MIT
"""The files that lint reads, and the offences that it finds."""

import pathlib
import re
import shutil
import subprocess

from rtrays.paths import ROOT


class Report:
    """Prints offences as FILE:LINE: RULE; `files` are all tracked files, relative to the
    repository."""

    def __init__(self):
        listed = subprocess.run(["git", "ls-files"], cwd=ROOT, capture_output=True, text=True)
        paths = map(pathlib.Path, listed.stdout.splitlines())
        self.files = [path for path in paths if (ROOT / path).is_file()]
        self.failed = False

    def offence(self, path, line, rule):
        """Prints an offence."""
        print(f"{path}:{line}: {rule}")
        self.failed = True

    def run(self, *command):
        """Runs a tool that prints its own findings."""
        if shutil.which(command[0]) is None:
            print(f"lint: {command[0]} is missing; run scripts/install --tests")
            self.failed = True
        elif subprocess.run(list(map(str, command)), cwd=ROOT).returncode != 0:
            self.failed = True

    def of(self, *suffixes, under=""):
        """Returns the files with one of the suffixes in a folder."""
        return [
            path for path in self.files if path.suffix in suffixes and str(path).startswith(under)
        ]

    def scripts(self, interpreter):
        """Returns the files without a suffix whose first line names the interpreter."""
        candidates = [path for path in self.of("") if not str(path).startswith("results/")]
        return [
            path
            for path in candidates
            if re.match(rb"#!.*" + interpreter, (ROOT / path).read_bytes()[:80])
        ]

    def documents(self):
        """Returns the Markdown files that people write."""
        return [path for path in self.of(".md") if not str(path).startswith("results/")]


def text_of(path):
    """Returns the text of a file."""
    return (ROOT / path).read_text(errors="replace")


def lines_of(path):
    """Returns (number, line) of all lines of a file."""
    return enumerate(text_of(path).splitlines(), 1)
