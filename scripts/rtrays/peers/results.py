# SPDX-License-Identifier: MIT
"""Results of comparisons, kept in folders so that a comparison can be resumed."""

from rtrays.documents.document import read_json, write_json

KEPT = (
    "tests",
    "rejected",
    "largest_z",
    "largest_z_at",
    "smallest_adjusted_p",
    "relative_difference",
    "equivalence",
)


def result_of(comparison):
    """Returns the values of a comparison that agreement.json keeps."""
    return {key: comparison["agreement"][key] for key in KEPT}


def kept(folder, key, produce):
    """Returns the result that the folder holds for the key; else calls `produce` with the folder
    and stores its result."""
    folder.mkdir(parents=True, exist_ok=True)
    file = folder / "result.json"
    if file.exists():
        document = read_json(file)
        if document["key"] == key:
            return document["result"]
    result = produce(folder)
    write_json(file, {"key": key, "result": result})
    return result


def words(result):
    """Returns a result as text for a line of progress."""
    if "missing" in result:
        return "cannot express the scene"
    difference = result["relative_difference"]["value"]
    return (
        f"{result['rejected']} of {result['tests']} rejected, z {result['largest_z']:.1f},"
        f" {100 * difference:+.3f} %"
    )
