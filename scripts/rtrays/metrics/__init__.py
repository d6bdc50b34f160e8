# SPDX-License-Identifier: MIT
"""Metrics that are computed from images here; those of run.json come from the harness."""
