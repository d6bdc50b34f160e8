# SPDX-License-Identifier: MIT
"""Checks of the sources and documents that no compiler makes."""
