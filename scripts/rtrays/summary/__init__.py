# SPDX-License-Identifier: MIT
"""Generated blocks of the Markdown documents."""
