# SPDX-License-Identifier: MIT
"""What the generators of scenes have in common: how scenes are written, and their command line."""
import json
import sys



def text_of(value, indent=""):
    """JSON with whatever fits on a line on one line."""
    line = json.dumps(value)
    if len(indent) + len(line) <= 110 or not isinstance(value, (list, dict)):
        return line
    inner = indent + "  "
    if isinstance(value, list):
        return "[\n" + ",\n".join(inner + text_of(item, inner) for item in value) + f"\n{indent}]"
    return "{\n" + ",\n".join(f"{inner}{json.dumps(k)}: {text_of(v, inner)}" for k, v in value.items()) + f"\n{indent}}}"


def documents(scenes):
    """The files of scenes by path: path -> bytes."""
    return {path: (text_of(document) + "\n").encode() for path, document in scenes.items()}


def main(folder, files, descriptions, usage):
    """Writes files() (path below `folder` -> bytes), compares them (--check) or lists the scenes (--list); the exit code."""
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
        print(f"not what {sys.argv[0]} writes (run it): {', '.join(stale)}", file=sys.stderr)
    return 1 if stale else 0
