# SPDX-License-Identifier: MIT
"""Tables, plots, pages and checks of RTRays, which the commands in scripts/ call."""
