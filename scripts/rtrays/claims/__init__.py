# SPDX-License-Identifier: MIT
"""Judges the claims of chapter 4 by finished runs."""
