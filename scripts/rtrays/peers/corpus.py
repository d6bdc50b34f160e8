# SPDX-License-Identifier: MIT
"""Imports Mitsuba files and compares our pictures with Mitsuba's pictures of the same files.

The files are those of scenes/peers/mitsuba, each for one kind of feature, and the third-party files
of RTRAYS_MESHES, which are only loaded: third_party.py compares some of them."""

import pathlib
import re

from rtrays.documents.document import read_json, write_json, write_text
from rtrays.paths import RESULTS, ROOT, SCENES
from rtrays.peers.renderers import RUNS, average, compare, mitsuba, own_image
from rtrays.peers.results import kept, result_of, words
from rtrays.peers.table import percent
from rtrays.programs import ProgramError, call, start
from rtrays.tables.table import Table

FILES = SCENES / "peers/mitsuba"
STORED = RESULTS / "peers/corpus.json"
PAGE = ROOT / "docs/importers.md"
BEGIN, END = "<!-- corpus: written by scripts/peers --corpus -->\n", "<!-- end of corpus -->\n"
MAX_DEPTH = 0  # no limit, because passing a mask is an event in Mitsuba alone
SPP = 512
# Error rate over all files: Bonferroni over them, Holm within each.
ALPHA = 0.01

# What nearly every file uses.
COMMON = {"diffuse", "twosided", "rectangle", "area", "bitmap", "sphere", "perspective"}


def uses(text):
    """Returns the plugins that a file uses, apart from the most common ones."""
    plugins = re.findall(r'<(?:bsdf|texture|emitter|shape|sensor)\s+type="([\w-]+)"', text)
    return sorted(set(plugins) - COMMON)


def what(text):
    """Returns the description in the second comment of a file."""
    comments = re.findall(r"<!--\s*(.*?)\s*-->", text, re.DOTALL)
    return comments[1] if len(comments) > 1 else ""


def measure(file, folder):
    """Compares our picture of a file with that of Mitsuba, or returns the error of the import."""
    ours, theirs = folder / "renderer.exr", folder / "mitsuba.exr"
    depth = ["--set", f"integrator.max_depth={MAX_DEPTH}"]
    try:
        own_image("rtrays-render", file, ours, "--spp", SPP, "--seed", 31, *depth)
    except ProgramError as error:
        return {"missing": str(error)}
    runs = mitsuba(file, theirs, SPP // RUNS, 41, MAX_DEPTH, RUNS, "--variant", "scalar_rgb")
    average(runs, theirs)
    return result_of(compare(ours, theirs))


def first_error(lines, folder):
    """Returns the first error among the lines of a program, preferably one with a line number,
    without the remedy and the folder of the file."""
    errors = [line for line in lines if not line.startswith("notice")]
    placed = [line for line in errors if re.search(r":\d+: ", line)] or errors
    return re.sub(r"^rtrays-render: |;.*$", "", placed[0].replace(f"{folder}/", ""))


def load(file, folder):
    """Loads a file and renders a few pixels. Returns the first error of the import, if any."""
    small = ["-o", folder / "small.exr", "--spp", 1, "--size", "16x16", "--quiet"]
    done = start(["rtrays-render", file, *small], None, capture_output=True, text=True)
    if done.returncode == 0:
        return {}
    return {"missing": first_error(done.stderr.splitlines(), file.parent)}


def rows_of(files, state, work, produce):
    """Returns a row of the document for each file."""
    rows = []
    for name, file in files:
        text = file.read_text(encoding="utf-8")
        result = kept(work / name.replace("/", "_"), [*state, text], lambda to: produce(file, to))
        row = {"file": name, "what": what(text), "uses": uses(text), "result": result}
        rows.append(row)
        if result:
            print(f"{name}: {words(result)}", flush=True)
    return rows


def compare_corpus(mitsuba_version, work, meshes):
    """Compares all files; writes the document and the table in docs/importers.md. Returns whether
    all agree."""
    state = [call(["rtrays-render", "--version"]).strip(), mitsuba_version]
    own = [(file.name, file) for file in sorted(FILES.glob("*.xml"))]
    others = sorted(pathlib.Path(meshes).glob("*/*.xml")) if meshes else []
    named = [(f"{file.parent.name}/{file.name}", file) for file in others]
    document = {
        "schema_version": 1,
        "versions": state,
        "spp": SPP,
        "files": rows_of(own, state, work, measure),
        "of_others": rows_of(named, state, work, load),
    }
    write_json(STORED, document)
    write_text(PAGE, with_table(PAGE.read_text(encoding="utf-8"), table(document)))
    return all(agrees(row, len(own)) for row in document["files"])


def agrees(row, count):
    """Returns whether one of `count` files agrees with Mitsuba."""
    result = row["result"]
    return "missing" not in result and result["smallest_adjusted_p"] * count > ALPHA


def table(document):
    """Returns the table as Markdown."""
    files = document["files"]
    rows = []
    for row in files:
        result = row["result"]
        known = "missing" not in result
        verdict = "refused" if not known else "yes" if agrees(row, len(files)) else "no"
        difference = percent(result["relative_difference"]) if known else ["", "", ""]
        rows.append([row["file"], row["what"], ", ".join(row["uses"]), verdict, *difference])
    heads = ["file", "what", "plugins besides the common ones", "agrees"]
    text = Table("", [*heads, "difference, %", "from", "to"], rows).markdown()
    if document["of_others"]:
        text += "\nThird-party files, which are only loaded:\n\n" + others_table(document)
    return text


def others_table(document):
    """Returns the table of third-party files as Markdown."""
    rows = [
        [row["file"], ", ".join(row["uses"]), row["result"].get("missing", "yes")]
        for row in document["of_others"]
    ]
    return Table("", ["file", "plugins besides the common ones", "loads"], rows).markdown()


def with_table(page, text):
    """Returns a page with the text between its marks."""
    before, rest = page.split(BEGIN)
    return before + BEGIN + text + END + rest.split(END)[1]


def stored_table():
    """Returns the table of the stored document."""
    return table(read_json(STORED))
