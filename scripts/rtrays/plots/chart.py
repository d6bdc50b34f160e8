# SPDX-License-Identifier: MIT
"""A chart of the overview, with a sentence that its numbers write."""

import dataclasses


@dataclasses.dataclass
class Chart:
    """STEM.svg and STEM.png of the overview; `missing` replaces them if a run is not there."""

    stem: str
    finding: str
    note: str = ""
    missing: str = ""
