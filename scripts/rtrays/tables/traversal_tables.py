# SPDX-License-Identifier: MIT
"""Tables and finding of traversal: differing hits, and rays that leave closed shapes."""

from rtrays.documents.document import value
from rtrays.tables.table import Table
from rtrays.tables.text import name


def large(count):
    """Returns a number of rays as text, in millions if it is large."""
    return f"{1e-6 * count:.0f} million" if count >= 1e6 else f"{count:.0f}"


def layout_columns(shape):
    """Returns the columns that both tables share; an item is (row, layout)."""
    return [
        (shape, lambda e: name(e[0]["mesh"])),
        ("triangles", lambda e: f"{value(e[0], 'triangles')}"),
        ("layout", lambda e: name(e[1]["name"])),
        ("rays", lambda e: f"{value(e[0], 'rays'):.3g}"),
    ]


CHECK = ("check", lambda e: "passed" if value(e[1], "passed") else "FAILED")


def layouts_of(rows):
    """Returns (row, layout) of all layouts of rows."""
    return [(row, layout) for row in rows for layout in value(row, "layouts")]


def closed_table(rows):
    """Returns the rays from inside closed shapes that hit nothing."""
    columns = [
        *layout_columns("shape"),
        ("misses", lambda e: f"{value(e[1], 'misses')}"),
        ("allowed share", lambda e: f"{value(e[1], 'limit'):g}"),
        CHECK,
    ]
    caption = "Rays from inside closed shapes that hit nothing"
    return Table.of(caption, columns, layouts_of(rows))


def hits_table(rows):
    """Returns the fuzzed rays that differ from Embree's, and wrong hits."""
    columns = [
        *layout_columns("mesh"),
        ("hits", lambda e: f"{value(e[0], 'hits')}"),
        ("random", lambda e: f"{value(e[1], 'random')}"),
        ("grazing", lambda e: f"{value(e[1], 'grazing')}"),
        ("tied", lambda e: f"{value(e[1], 'tied')}"),
        ("wrong", lambda e: f"{value(e[1], 'wrong')}"),
        CHECK,
    ]
    note = (
        "Rays are in equal parts random, grazing a triangle (1e-1 to 1e-5 of its plane), and along"
        " an axis through a vertex or the middle of an edge (tied: either side may answer). A"
        " difference is a hit against a miss, or more than 1e-5 of the scene's diagonal in distance"
        " from Embree (ROBUST). Brute force in double precision judges the differences; at most"
        " 1e-6 of the rays may be wrong."
    )
    caption = "Fuzzed rays: differences from Embree, and wrong hits"
    return Table.of(caption, columns, layouts_of(rows), [note])


def traversal_finding(checked, shapes):
    """Returns how many fuzzed rays have a wrong hit, and how many rays leave closed shapes."""
    wrong = sum(value(layout, "wrong") for _, layout in layouts_of(checked))
    rays = sum(value(row, "rays") for row, _ in layouts_of(checked))
    finding = (
        f"Of {large(rays)} fuzzed rays on {len(checked)} meshes {wrong or 'none'} have a wrong hit"
    )
    if shapes:
        leaving = sum(value(layout, "misses") for _, layout in layouts_of(shapes))
        inside = sum(value(row, "rays") for row, _ in layouts_of(shapes))
        finding += (
            f"; of {large(inside)} rays from inside {len(shapes)} closed shapes"
            f" {leaving or 'none'} hit nothing"
        )
    return finding + "."


def traversal(run):
    """Returns the finding and the tables of traversal."""
    checked = [row for row in run.get("rows") if row["check"] == "hits"]
    shapes = [row for row in run.get("rows") if row["check"] != "hits"]
    return traversal_finding(checked, shapes), (closed_table(shapes), hits_table(checked))
