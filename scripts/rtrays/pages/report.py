# SPDX-License-Identifier: MIT
"""The report of finished runs: the page of one run, or pages and an overview of several."""

import concurrent.futures
import os
import pathlib
import sys

from rtrays.documents.document import RunError
from rtrays.pages.index_page import write_index
from rtrays.pages.make_page import page_or_error, write_page


def with_siblings(folders):
    """Returns the folders, then all other folders of their common parent, and the parent."""
    own = [folder.resolve() for folder in folders]
    parent = pathlib.Path(os.path.commonpath(own))
    others = [folder for folder in sorted(parent.iterdir()) if folder.is_dir()]
    return own + [folder for folder in others if folder not in own], parent


def write_overview(folders):
    """Writes the pages of runs and of their siblings, and the overview; returns its path.

    A run among the siblings that cannot be used is a line in the overview.
    """
    every, parent = with_siblings(folders)
    with concurrent.futures.ProcessPoolExecutor() as pool:
        made = list(pool.map(page_or_error, every))
    pages, skipped = [], []
    for index, page in enumerate(made):
        if isinstance(page, str) and index < len(folders):
            raise RunError(page)
        if isinstance(page, str):
            print(f"results: {page}", file=sys.stderr)
            skipped.append(f"Omitted: {page}")
        elif page:
            pages.append(page)
    write_index(parent, pages, skipped)
    for page in pages:  # after the overview, to which they link
        page.write()
    return parent / "index.html"


def write_report(folders):
    """Writes the report of runs; returns its path."""
    if len(folders) == 1:
        return write_page(folders[0]).folder / "index.html"
    return write_overview(folders)
