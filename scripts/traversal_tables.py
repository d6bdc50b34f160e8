# SPDX-License-Identifier: MIT
"""Tables and finding of traversal: differing hits, and rays that leave closed shapes."""

from cells import Table
from measurement_text import name
from run_document import value


def large(count):
    return f"{1e-6 * count:.0f} million" if count >= 1e6 else f"{count:.0f}"


def traversal(run):
    hits, closed = [], []
    for row in run.get("rows"):
        for layout in value(row, "layouts"):
            head = [
                name(row["mesh"]),
                f"{value(row, 'triangles')}",
                name(layout["name"]),
                f"{value(row, 'rays'):.3g}",
            ]
            verdict = "passed" if value(layout, "passed") else "FAILED"
            if row["check"] == "hits":
                hits.append(
                    head
                    + [
                        f"{value(row, 'hits')}",
                        *(
                            f"{value(layout, key)}"
                            for key in ("random", "grazing", "tied", "wrong")
                        ),
                        verdict,
                    ]
                )
            else:
                closed.append(
                    head + [f"{value(layout, 'misses')}", f"{value(layout, 'limit'):g}", verdict]
                )
    tables = (
        Table(
            "Rays from inside closed shapes that hit nothing",
            ["shape", "triangles", "layout", "rays", "misses", "allowed share", "check"],
            closed,
        ),
        Table(
            "Fuzzed rays: differences from Embree, and wrong hits",
            [
                "mesh",
                "triangles",
                "layout",
                "rays",
                "hits",
                "random",
                "grazing",
                "tied",
                "wrong",
                "check",
            ],
            hits,
            [
                "Rays are in equal parts random, grazing a triangle (1e-1 to 1e-5 of its plane),"
                " and along an axis through a vertex or the middle of an edge (tied: either side"
                " may answer). A difference is a hit against a miss, or more than 1e-5 of the"
                " scene's diagonal in distance from Embree (ROBUST). Brute force in double"
                " precision judges the differences; at most 1e-6 of the rays may be wrong."
            ],
        ),
    )
    checked = [row for row in run.get("rows") if row["check"] == "hits"]
    wrong = sum(value(layout, "wrong") for row in checked for layout in row["layouts"])
    rays = sum(value(row, "rays") * len(row["layouts"]) for row in checked)
    shapes = [row for row in run.get("rows") if row["check"] != "hits"]
    leaving = sum(value(layout, "misses") for row in shapes for layout in row["layouts"])
    from_inside = sum(value(row, "rays") * len(row["layouts"]) for row in shapes)
    finding = (
        f"Of {large(rays)} fuzzed rays on {len(checked)} meshes {wrong or 'none'} have a wrong hit"
    )
    if shapes:
        finding += (
            f"; of {large(from_inside)} rays from inside {len(shapes)} closed shapes"
            f" {leaving or 'none'} hit nothing"
        )
    finding += "."
    return finding, tables
