# SPDX-License-Identifier: MIT
"""Judges the claims of chapter 4 (experiments/claims.json): each with its measurements and the
verdict of its rule.

Rules are in that file; figures come from the folders of finished runs. A missing run is a line,
not an error.
"""

import collections
import dataclasses
import json

from cells import VERDICTS, Lines, Link, Table, number
from claim_figures import READERS
from pages import Page, TableBlock
from run_document import EXPERIMENTS, agreement_verdict, gain_verdict, value
from undecided import advice, factor_of_agreement, factor_of_all, factor_of_gain

CLAIMS = EXPERIMENTS / "claims.json"
NOT_MEASURED = "not measured"


@dataclasses.dataclass
class Judged:
    """A claim with its measurements; `verdict` is one of cells.VERDICTS, `runs` the runs that
    decide it, if they are there."""

    claim: str
    thesis: str
    rule: str
    measured: list
    verdict: str
    runs: list
    partial: bool = False
    advice: str = ""

    @property
    def verdict_text(self):
        """The verdict, with what it leaves open."""
        text = self.verdict + (", of what was measured" if self.partial else "")
        return f"{text}: {self.advice}" if self.advice else text


def place(figure, bounds):
    """Whether an interval lies inside, outside or across bounds, of which None is open."""
    low, high = (-float("inf") if bounds[0] is None else bounds[0]), (
        float("inf") if bounds[1] is None else bounds[1]
    )
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


def figure_advice(figure, rule):
    """By how many times the samples must grow to decide an undecided figure, and what counts as
    samples."""
    if "agrees" in rule:
        return factor_of_agreement(figure), "samples"
    if "gain" in rule:
        return factor_of_gain(figure, rule["gain"]), "seeds"
    return factor_of_all(figure, rule["within"]), "repetitions"


def verdict(verdicts):
    """Combines the verdicts on all figures of a claim.

    A claim holds partly if it holds for some figures and not for others; it is undecided only if
    none fails.
    """
    kinds = set(verdicts)
    if len(kinds) == 1:
        return kinds.pop()
    if kinds & {"holds", "holds partly"}:
        return "undecided" if kinds == {"holds", "undecided"} else "holds partly"
    return "does not hold here"


def rule_text(rule):
    if "agrees" in rule:
        return (
            "no block of 16 x 16 pixels differs, 99 % interval of the mean difference within 0.1 %"
        )
    if "gain" in rule:
        return "interval above 1" + (
            f" and reaches {rule['gain']:g}; partly: above 1 alone" if rule["gain"] > 1 else ""
        )

    def words(bounds):
        if bounds[0] is None or bounds[1] is None:
            return f"at most {bounds[1]:g}" if bounds[0] is None else f"at least {bounds[0]:g}"
        return (
            f"is {bounds[0]:g}"
            if bounds[0] == bounds[1]
            else f"from {bounds[0]:g} to {bounds[1]:g}"
        )

    return f"interval {words(rule['within'])}" + (
        f"; partly: {words(rule['partly'])}" if "partly" in rule else ""
    )


def figure_text(name, figure):
    """A figure with its interval, if it has one."""
    if "equivalence" in figure:
        low, high = (100 * value(figure, f"relative_difference.{end}") for end in ("low", "high"))
        return (
            f"{name}: {value(figure, 'rejected')} of {value(figure, 'tests')} tests reject, mean"
            f" [{low:+.3f}, {high:+.3f}] %"
        )
    middle, low, high = (value(figure, key) for key in ("value", "low", "high"))
    return f"{name}: {number(middle)}" + (f" [{number(low)}, {number(high)}]" if low < high else "")


def figures_of(claim, folder):
    """Returns (name, figure) of each that a run has, and the names of the runs with and without
    figures."""
    figures, found_in, missing = [], [], []
    for source in claim["figures"]:
        options = {key: option for key, option in source.items() if key not in ("run", "read")}
        path = folder / source["run"]
        found = list(READERS[source["read"]](path, **options)) if any(path.glob("*.json")) else []
        prefix = f"{source['run'].replace('_', ' ')}, " if len(claim["figures"]) > 1 else ""
        figures += [(prefix + name, figure) for name, figure in found]
        (found_in if found else missing).append(source["run"])
    return figures, list(dict.fromkeys(found_in)), missing


def judge(claim, folder):
    """Judges one claim by the runs below `folder`."""
    figures, runs, missing = figures_of(claim, folder)
    texts = [figure_text(*figure) for figure in figures] + [
        f"{run.replace('_', ' ')}: {NOT_MEASURED}" for run in missing
    ]
    verdicts = [figure_verdict(figure, claim["rule"]) for _, figure in figures]
    judged = Judged(
        claim["claim"],
        claim["thesis"],
        rule_text(claim["rule"]),
        texts,
        verdict(verdicts) if figures else NOT_MEASURED,
        runs,
        bool(figures and missing),
    )
    if judged.verdict == "undecided":
        open_ones = [
            figure_advice(figure, claim["rule"])
            for (_, figure), word in zip(figures, verdicts)
            if word == "undecided"
        ]
        judged.advice = advice(*max(open_ones))
    return judged


def judge_all(folder):
    """[(section's title, [Judged])] of all sections."""
    return [
        (
            f"Section {section['section']}: {section['title']}",
            [judge(claim, folder) for claim in section["claims"]],
        )
        for section in json.loads(CLAIMS.read_text())["sections"]
    ]


def is_thesis(sections):
    """Whether any claim of the thesis has been measured by the runs of a folder."""
    return any(judged.runs for _, claims in sections for judged in claims)


def counts(claims):
    """{verdict: number of claims}, in the order of VERDICTS."""
    found = collections.Counter(judged.verdict for judged in claims)
    return {word: found[word] for word in VERDICTS if found[word]}


def all_counts(sections):
    return counts([judged for _, claims in sections for judged in claims])


def verdicts_of_run(sections, run):
    """The verdicts of the claims that a run decides, alone or with others."""
    return counts([judged for _, claims in sections for judged in claims if run in judged.runs])


def overview(sections):
    """How many claims of each section got which verdict."""
    shown = [word for word in VERDICTS if any(word in counts(claims) for _, claims in sections)]
    rows = [
        [title, *(str(counts(claims).get(word, "")) for word in shown)]
        for title, claims in sections
    ]
    return Table("Claims by verdict", ["section of the thesis", *shown], rows)


def run_rows(names, folder):
    """Where the figures come from, a row for every run that is there."""
    for name in names:
        for path in sorted((folder / name).glob("*.json")):
            run = json.loads(path.read_text())
            if "schema_version" not in run:
                continue
            # Documents of convergence control have at the top level what others have
            # in "context" and "experiment".
            context = run.get("context", run)
            yield [
                Link(name.replace("_", " "), f"../{name}", markdown_name(folder / name)),
                run.get("experiment", run).get("profile", ""),
                value(context, "commit")[:12] + (", changed" if context.get("dirty") else ""),
                (
                    context["device"]["name"]
                    if isinstance(context["device"], dict)
                    else context["device"]
                ),
                context.get("finished_at", ""),
            ]
            break


def markdown_name(folder):
    """The Markdown page of a run's folder."""
    return "report.md" if (folder / "report.md").exists() else f"{folder.name}.md"


def claim_row(judged, folder):
    """Claim, thesis, rule, measurements, verdict; the links lead to the runs that decide it."""
    run = judged.runs[0] if judged.runs else ""
    claim = Link(judged.claim, f"../{run}", markdown_name(folder / run)) if run else judged.claim
    return [claim, judged.thesis, judged.rule, Lines(judged.measured), judged.verdict_text]


WORDS = {
    "holds": ("holds", "hold"),
    "holds partly": ("holds partly", "hold partly"),
    "does not hold here": ("does not hold here", "do not hold here"),
    "undecided": ("is undecided", "are undecided"),
    NOT_MEASURED: ("is not measured", "are not measured"),
}


def summary(sections):
    """Returns the sentence "Of 36 claims of chapter 4, 15 hold, ..."."""
    found = all_counts(sections)
    texts = [f"{count} {WORDS[word][count > 1]}" for word, count in found.items()]
    listed = ", ".join(texts[:-1]) + (" and " if texts[:-1] else "") + texts[-1]
    return f"Of {sum(found.values())} claims of chapter 4, {listed}."


def claims_page(sections, folder):
    """The page claims/claims.md: every claim with its verdict."""
    (folder / "claims").mkdir(exist_ok=True)
    document = json.loads(CLAIMS.read_text())
    names = sorted(
        {
            source["run"]
            for section in document["sections"]
            for claim in section["claims"]
            for source in claim["figures"]
        }
    )
    blocks = [TableBlock(overview(sections))]
    for title, claims in sections:
        blocks.append(
            TableBlock(
                Table(
                    title,
                    ["claim", "thesis", "holds if", "measured", "verdict"],
                    [claim_row(judged, folder) for judged in claims],
                    widths=(22, 14, 17, 33, 14),
                )
            )
        )
    blocks.append(
        TableBlock(
            Table(
                "Runs",
                ["run", "profile", "commit", "device", "finished"],
                list(run_rows(names, folder)),
            )
        )
    )
    note = (
        "experiments/claims.json states them before the results. Numbers of the thesis are from its"
        " hardware, which its tables name; ours are from the runs at the end of the page."
    )
    return Page(
        folder / "claims",
        "claims.md",
        "The thesis' claims and their verdicts",
        summary(sections),
        blocks,
        claim=note,
        claim_head="Rules",
        verdicts=list(all_counts(sections)),
    )
