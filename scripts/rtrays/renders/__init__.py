# SPDX-License-Identifier: MIT
"""Renders with the built programs: comparisons, measurements, and the picture of README."""
