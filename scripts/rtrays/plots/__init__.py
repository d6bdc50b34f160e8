# SPDX-License-Identifier: MIT
"""Plots and charts of runs, as SVG and PNG."""
