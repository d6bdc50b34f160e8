# SPDX-License-Identifier: MIT
"""Judges the claims of chapter 4: each with its measurements and the verdict of its rule.

The file of claims has the rules; figures come from the folders of finished runs. A missing run is a
line, not an error.
"""

import collections
import dataclasses

from rtrays.claims.readers import READERS
from rtrays.claims.rules import combined, figure_advice, figure_verdict, rule_text
from rtrays.documents.document import value
from rtrays.documents.experiments import claim_sections
from rtrays.documents.undecided import advice
from rtrays.documents.verdicts import VERDICTS
from rtrays.tables.cells import number
from rtrays.tables.text import listed, name

NOT_MEASURED = "not measured"


@dataclasses.dataclass
class Judged:
    """A claim with its measurements; `verdict` is one of VERDICTS, `runs` the runs that
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
        """The verdict, and what would decide it if it is undecided."""
        text = self.verdict + (", of what was measured" if self.partial else "")
        return f"{text}: {self.advice}" if self.advice else text


def figure_text(text, figure):
    """Returns a figure as text, with its interval if it has one."""
    if "equivalence" in figure:
        low, high = (100 * value(figure, f"relative_difference.{end}") for end in ("low", "high"))
        return (
            f"{text}: {value(figure, 'rejected')} of {value(figure, 'tests')} tests reject, mean"
            f" [{low:+.3f}, {high:+.3f}] %"
        )
    middle, low, high = (value(figure, key) for key in ("value", "low", "high"))
    return f"{text}: {number(middle)}" + (f" [{number(low)}, {number(high)}]" if low < high else "")


def figures_of(claim, folder):
    """Returns (name, figure) of each that a run has, and the names of the runs with and without
    figures."""
    figures, found_in, missing = [], [], []
    for source in claim["figures"]:
        options = {key: option for key, option in source.items() if key not in ("run", "read")}
        path = folder / source["run"]
        found = list(READERS[source["read"]](path, **options)) if any(path.glob("*.json")) else []
        prefix = f"{name(source['run'])}, " if len(claim["figures"]) > 1 else ""
        figures += [(prefix + text, figure) for text, figure in found]
        (found_in if found else missing).append(source["run"])
    return figures, list(dict.fromkeys(found_in)), missing


def judge(claim, folder):
    """Judges one claim by the runs below `folder`."""
    figures, runs, missing = figures_of(claim, folder)
    texts = [figure_text(*figure) for figure in figures] + [
        f"{name(run)}: {NOT_MEASURED}" for run in missing
    ]
    verdicts = [figure_verdict(figure, claim["rule"]) for _, figure in figures]
    judged = Judged(
        claim["claim"],
        claim["thesis"],
        rule_text(claim["rule"]),
        texts,
        combined(verdicts) if figures else NOT_MEASURED,
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
    """Returns [(section's title, [Judged])] of all sections."""
    return [
        (
            f"Section {section['section']}: {section['title']}",
            [judge(claim, folder) for claim in section["claims"]],
        )
        for section in claim_sections()
    ]


def is_thesis(sections):
    """Whether any claim of the thesis has been measured by the runs of a folder."""
    return any(judged.runs for _, claims in sections for judged in claims)


def counts(claims):
    """Returns {verdict: number of claims}, in the order of VERDICTS."""
    found = collections.Counter(judged.verdict for judged in claims)
    return {word: found[word] for word in VERDICTS if found[word]}


def all_counts(sections):
    """Returns {verdict: number of claims} of all sections."""
    return counts([judged for _, claims in sections for judged in claims])


def verdicts_of_run(sections, run):
    """Returns the verdicts of the claims that a run decides, alone or with others."""
    return counts([judged for _, claims in sections for judged in claims if run in judged.runs])


PHRASES = {
    "holds": ("holds", "hold"),
    "holds partly": ("holds partly", "hold partly"),
    "does not hold here": ("does not hold here", "do not hold here"),
    "undecided": ("is undecided", "are undecided"),
    NOT_MEASURED: ("is not measured", "are not measured"),
}


def summary(sections):
    """Returns the sentence "Of 36 claims of chapter 4, 15 hold, ..."."""
    found = all_counts(sections)
    texts = [f"{count} {PHRASES[word][count > 1]}" for word, count in found.items()]
    return f"Of {sum(found.values())} claims of chapter 4, {listed(texts)}."
