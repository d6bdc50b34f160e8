# SPDX-License-Identifier: MIT
"""JSON documents: reading them, values at paths in them, and files that are written as a whole.

A missing value is an error, never a zero.
"""

import json
import math
import re


class RunError(Exception):
    """An input that cannot be used; the message names the file, the key and the remedy."""


def read_json(path, remedy=""):
    """Returns the document in a file. Raises RunError if the file is missing or not JSON; the
    `remedy` is the command that makes the file."""
    try:
        return json.loads(path.read_text())
    except OSError as error:
        made = f"; {remedy} makes it" if remedy else ""
        raise RunError(f"{path}: {error.strerror}{made}") from error
    except ValueError as error:
        raise RunError(f"{path}: not JSON: {error}") from error


def value(document, path):
    """Returns the number, text, list or object at a dotted path. Absent, null and non-finite values
    are errors."""
    current = document
    for key in path.split("."):
        try:
            current = current[int(key)] if isinstance(current, list) else current[key]
        except (KeyError, IndexError, TypeError, ValueError):
            raise RunError(f"missing value: {path}") from None
    if current is None or (isinstance(current, float) and not math.isfinite(current)):
        raise RunError(f"missing value: {path}")
    return current


def entry_named(entries, name, key="name"):
    """Returns the first entry of a list whose `key` is `name`. Raises RunError without one."""
    for entry in entries:
        if entry[key] == name:
            return entry
    raise RunError(f"missing entry: {name}")


def write_text(path, text):
    """Writes a file completely or not at all."""
    temporary = path.with_name(path.name + ".tmp")
    temporary.write_text(text)
    temporary.replace(path)


def write_json(path, document):
    """Writes a document completely or not at all."""
    write_text(path, json.dumps(document, indent=1) + "\n")


def file_name(text):
    """Returns a file name without blanks and commas for a name of a curve or case."""
    return re.sub(r"[^\w.=-]+", "_", text)
