# SPDX-License-Identifier: MIT
"""HTML and Markdown pages of runs."""
