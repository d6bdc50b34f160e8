# SPDX-License-Identifier: MIT
"""Folders of the repository, or of an installation, which looks alike."""

import pathlib

ROOT = pathlib.Path(__file__).resolve().parents[2]
EXPERIMENTS = ROOT / "experiments"
RESULTS = ROOT / "results"
SCENES = ROOT / "scenes"
