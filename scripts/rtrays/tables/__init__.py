# SPDX-License-Identifier: MIT
"""Tables of runs, as CSV, Markdown and LaTeX."""
