# SPDX-License-Identifier: MIT
"""Functions shared by the scene generators: writing of scene files and the command line."""
import json
import sys


def text_of(value, indent=""):
    """Returns JSON text. A value that fits on a line is written on one line."""
    line = json.dumps(value)
    if len(indent) + len(line) <= 110 or not isinstance(value, (list, dict)):
        return line
    inner = indent + "  "
    if isinstance(value, list):
        return "[\n" + ",\n".join(inner + text_of(item, inner) for item in value) + f"\n{indent}]"
    return ("{\n"
            + ",\n".join(f"{inner}{json.dumps(k)}: {text_of(v, inner)}" for k, v in value.items())
            + f"\n{indent}}}")


def documents(scenes):
    """Returns the contents of scene files: path -> bytes."""
    return {path: (text_of(document) + "\n").encode() for path, document in scenes.items()}


def main(folder, files, descriptions, usage):
    """Runs the command line of a generator and returns its exit code.

    Without options it writes files() (path below `folder` -> bytes). --check compares them with
    the existing files, --list lists the scenes."""
    arguments = sys.argv[1:]
    if arguments == ["--list"]:
        for name, description in descriptions.items():
            print(f"{name}\t{description}")
        return 0
    if arguments not in ([], ["--check"]):
        print(usage, file=sys.stderr)
        return 2
    stale = []
    for name, content in files().items():
        path = folder / name
        if arguments:
            if not path.is_file() or path.read_bytes() != content:
                stale.append(name)
        else:
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(content)
    if stale:
        print(
            f"{sys.argv[0]}: files are out of date; run it without options to rewrite: "
            f"{', '.join(stale)}", file=sys.stderr)
    return 1 if stale else 0
