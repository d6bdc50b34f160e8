# SPDX-License-Identifier: MIT
"""Generated blocks in Markdown files.

A block stands between the lines `<!-- generated: NAME -->` and `<!-- end generated -->`.
"""

import re

from rtrays.documents.document import RunError, write_text
from rtrays.summary.blocks import BLOCKS

BLOCK = re.compile(r"(<!-- generated: (\w+) -->\n)(.*?)(<!-- end generated -->)", re.DOTALL)


def block_text(name, place):
    """Returns the text of a block. Raises RunError, which names the `place`, if it is unknown."""
    if name not in BLOCKS:
        raise RunError(f"{place}: unknown block '{name}'; blocks are: {', '.join(BLOCKS)}")
    return BLOCKS[name]()


def replaced(path):
    """Returns a file's text, and the text with new blocks."""
    text = path.read_text()
    if text.count("<!-- generated: ") != len(BLOCK.findall(text)):
        raise RunError(f"{path}: a block has no end; write <!-- end generated --> after it")
    return text, BLOCK.sub(lambda found: found[1] + block_text(found[2], path) + found[4], text)


def update(path):
    """Writes new blocks into a file if they differ."""
    old, new = replaced(path)
    if old != new:
        write_text(path, new)


def is_current(path):
    """Whether all blocks of a file are those that results/ makes."""
    old, new = replaced(path)
    return old == new
