# SPDX-License-Identifier: MIT
"""Checks of prose: plain English everywhere, and the length of sentences in documents."""

import re

from rtrays.lint.report import lines_of, text_of

PROSE_RULES = [
    (r"\banew\b", "say again, or rebuilt"),
    (r"\bgo(es|ne|ing)? on (with|from|where|until)\b", "say continue or resume"),
    (r"\btaken off\b", "say subtracted or removed"),
    (
        r"\b(is|are) no "
        r"(setting|option|texture|image|scene|file|folder|number|light|algorithm)s?\b",
        "say unknown, not a, or missing",
    ),
    (r"\btold apart\b|\bto be told\b", "say distinguished"),
    (r"\bwhere (those|they|it) (are|is) not (there|installed)\b", "say if missing"),
    (r"\bin turns\b", "say interleaved"),
    (r"\bservants?\b", "say requirements"),
    (r"\blikewise\b|\bas above\b|\bditto\b", "repeat what is meant"),
    (
        r"(///|//|#|\"\"\"|<- ) ?Of (the|a|an|all|every|each|what|camera|light|those)\b",
        "begin with a noun or a verb",
    ),
    (r"\bstands? in for\b", "say replaces"),
    (
        r"\bwhat (it|this|that|he|they|a scene|the scene|the user) (has|needs|does|did)\b",
        "name the thing",
    ),
]

SUFFIXES = {".h", ".cpp", ".cl", ".py", ".md", ".cmake", ".json", ""}
EXEMPT = ("results/", "scripts/rtrays/lint/")
LONGEST_SENTENCE = 30  # words, in README and docs; the rule is 25, symbols count as words


def check_prose(report):
    """Looks for constructions to avoid, and for long sentences."""
    for path in report.files:
        if path.suffix in SUFFIXES and not str(path).startswith(EXEMPT):
            for number, line in lines_of(path):
                for pattern, rule in PROSE_RULES:
                    if re.search(pattern, line):
                        report.offence(path, number, f"{rule}: {line.strip()[:80]}")
    for path in report.documents():
        for number, words in long_sentences(text_of(path)):
            report.offence(path, number, f"a sentence of {words} words")


def long_sentences(text):
    """Yields (line, words) of each sentence above the limit, without code, tables and generated
    blocks."""
    blank = re.compile(
        r"```.*?```|<!-- generated:.*?<!-- end generated -->|^\|.*?$|^ {4,}.*?$",
        re.DOTALL | re.MULTILINE,
    )
    text = blank.sub(lambda found: "\n" * found.group().count("\n"), text)
    line = 1
    for paragraph in re.split(r"(\n\s*\n|\n(?=\s*[-*0-9]+[.]? )|\n(?=#))", text):
        words_of = re.sub(r"\]\([^)]*\)|`[^`]*`", " x ", paragraph)
        for sentence in re.split(r"[.:;!?][*_)]*\s", words_of):
            words = re.findall(r"[\w'’-]+", sentence)
            if len(words) > LONGEST_SENTENCE:
                yield line, len(words)
        line += paragraph.count("\n")
