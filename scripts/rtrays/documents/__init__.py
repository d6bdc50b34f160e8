# SPDX-License-Identifier: MIT
"""Reads run documents and derives numbers and verdicts from them."""
