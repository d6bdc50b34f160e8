# SPDX-License-Identifier: MIT
"""Compares other renderers with the reference, and drives them."""
