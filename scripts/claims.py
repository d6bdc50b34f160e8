# SPDX-License-Identifier: MIT
"""The claims of chapter 4 (experiments/claims.json), each with what was measured and the verdict of its rule.

Rules are in that file; figures come from the folders of finished runs. A run that is not there is a line, not an error.
"""

import collections
import json
import pathlib

from claim_figures import READERS
from measurement_tables import number
from run_document import agreement_verdict, gain_verdict, value
from tables import Table

CLAIMS = pathlib.Path(__file__).resolve().parent.parent / "experiments/claims.json"
NOT_MEASURED = "not measured"
VERDICTS = ("holds", "holds partly", "does not hold here", "undecided", NOT_MEASURED)


def place(figure, bounds):
    """Whether an interval lies inside, outside or across bounds, of which None is open."""
    low, high = (-float("inf") if bounds[0] is None else bounds[0]), (float("inf") if bounds[1] is None else bounds[1])
    if low <= value(figure, "low") and value(figure, "high") <= high:
        return "inside"
    return "outside" if value(figure, "high") < low or value(figure, "low") > high else "across"


def figure_verdict(figure, rule):
    """The verdict on one figure."""
    if "agrees" in rule:
        return agreement_verdict(figure)
    if "gain" in rule:
        return gain_verdict(figure, rule["gain"])
    where = place(figure, rule["within"])
    if where == "inside":
        return "holds"
    if "partly" in rule and place(figure, rule["partly"]) == "inside":
        return "holds partly"
    return "undecided" if where == "across" else "does not hold here"


def verdict(verdicts):
    """Of a claim on several figures, which is made of all of them: partly where it holds for some and not for others, and
    undecided only where none fails."""
    kinds = set(verdicts)
    if len(kinds) == 1:
        return kinds.pop()
    if kinds & {"holds", "holds partly"}:
        return "undecided" if kinds == {"holds", "undecided"} else "holds partly"
    return "does not hold here"


def rule_text(rule):
    if "agrees" in rule:
        return "no block of 16 x 16 pixels differs, 99 % interval of the mean difference within 0.1 %"
    if "gain" in rule:
        return "interval above 1" + (f", and reaches {rule['gain']:g}; partly: above 1 alone" if rule["gain"] > 1 else "")

    def words(bounds):
        if bounds[0] is None or bounds[1] is None:
            return f"at most {bounds[1]:g}" if bounds[0] is None else f"at least {bounds[0]:g}"
        return f"is {bounds[0]:g}" if bounds[0] == bounds[1] else f"from {bounds[0]:g} to {bounds[1]:g}"

    return f"interval {words(rule['within'])}" + (f"; partly: {words(rule['partly'])}" if "partly" in rule else "")


def figure_text(name, figure):
    """A figure with its interval, where it has one."""
    if "equivalence" in figure:
        low, high = (100 * value(figure, f"relative_difference.{end}") for end in ("low", "high"))
        return f"{name}: {value(figure, 'rejected')} of {value(figure, 'tests')} tests reject, mean [{low:+.3f}, {high:+.3f}] %"
    middle, low, high = (value(figure, key) for key in ("value", "low", "high"))
    return f"{name}: {number(middle)}" + (f" [{number(low)}, {number(high)}]" if low < high else "")


def figures_of(claim, folder):
    """(name, figure) of each that there is, and the runs that are not there."""
    figures, missing = [], []
    for source in claim["figures"]:
        options = {key: option for key, option in source.items() if key not in ("run", "read")}
        path = folder / source["run"]
        found = list(READERS[source["read"]](path, **options)) if any(path.glob("*.json")) else []
        prefix = f"{source['run'].replace('_', ' ')}, " if len(claim["figures"]) > 1 else ""
        figures += [(prefix + name, figure) for name, figure in found]
        if not found:
            missing.append(source["run"])
    return figures, missing


def claim_row(claim, folder):
    figures, missing = figures_of(claim, folder)
    texts = [figure_text(*figure) for figure in figures] + [f"{run.replace('_', ' ')}: {NOT_MEASURED}" for run in missing]
    judged = verdict([figure_verdict(figure, claim["rule"]) for _, figure in figures]) if figures else NOT_MEASURED
    if figures and missing:
        judged += ", of what was measured"
    return [claim["claim"], claim["thesis"], rule_text(claim["rule"]), "; ".join(texts), judged]


def run_rows(document, folder):
    """Where the figures come from, a row for every run that there is."""
    names = sorted({source["run"] for section in document["sections"] for claim in section["claims"] for source in claim["figures"]})
    for name in names:
        for path in sorted((folder / name).glob("*.json"))[:1]:
            run = json.loads(path.read_text())
            # Comparisons of convergence control keep on top what others keep in "context" and "experiment".
            context = run.get("context", run)
            yield [name, run.get("experiment", run).get("profile", ""), value(context, "commit") + (", changed" if context.get("dirty") else ""),
                   context["device"]["name"] if isinstance(context["device"], dict) else context["device"],
                   context.get("finished_at", "")]


def claim_tables(folder):
    """A table for every section, with its title; the last one of the runs."""
    document = json.loads(CLAIMS.read_text())
    for section in document["sections"]:
        yield (f"Section {section['section']}: {section['title']}",
               Table(section["title"], ["claim", "thesis", "holds if", "measured", "verdict"],
                     [claim_row(claim, folder) for claim in section["claims"]]))
    yield "Runs", Table("Runs", ["run", "profile", "commit", "device", "finished"], list(run_rows(document, folder)))


def verdict_counts(table):
    """{verdict: number of claims of a section}."""
    return collections.Counter(row[-1].partition(",")[0] for row in table.rows)


def claims_page(tables):
    """claims.md: every claim with its verdict."""
    counts = sum((verdict_counts(table) for _, table in tables[:-1]), collections.Counter())
    summary = ", ".join(f"{counts[word]} × {word}" for word in VERDICTS if counts[word])
    head = (f"# The thesis' claims and their verdicts\n\n{counts.total()} claims of chapter 4: {summary}. Rules are those of "
            "experiments/claims.json, which states them before the results; intervals are of 95 % unless said otherwise. Figures "
            "of the thesis are of its hardware, which its tables name; ours of the runs below.")
    return "\n\n".join([head, *(f"## {title}\n\n{table.markdown()}" for title, table in tables)])


def overview(tables):
    """How many claims of each section got which verdict."""
    counts = {title: verdict_counts(table) for title, table in tables[:-1]}
    verdicts = [word for word in VERDICTS if any(word in found for found in counts.values())]
    rows = [[title, *(str(found[word] or "") for word in verdicts)] for title, found in counts.items()]
    return Table("Claims by verdict", ["claims of the thesis", *verdicts], rows)
