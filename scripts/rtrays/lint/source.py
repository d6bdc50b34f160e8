# SPDX-License-Identifier: MIT
"""Checks of sources: format, licence line, head sentence of headers, the common subset of OpenCL C
and C++, and the independence of the reference."""

import re

from rtrays.lint.report import lines_of, text_of

RULES_FOLDER = "scripts/rtrays/lint/"
SOURCE_RULES = [
    # (files, pattern, rule). The device rules keep to the common subset of OpenCL C and C++.
    ("device", r"\((float|uint|int)[2348]\)\(", "vector literal; use make_floatN"),
    ("device", r"\.(s[0-9]|[xyzw]{2,4}|lo|hi|even|odd)\b[^\"(]*;", "swizzle"),
    (
        "device",
        r"^[^/\"]*[^A-Za-z0-9_.][0-9]+\.[0-9]+([eE][-+]?[0-9]+)?([^0-9A-Za-z.]|$)",
        "double literal",
    ),
    (
        "device",
        r"__VA_ARGS__|#define +[A-Za-z_0-9]+\([^)]*\.\.\.",
        "variadic macro; OpenCL C has none",
    ),
    (
        "device",
        r"\b(local|private|constant|global)\b *[=;,)]",
        "address space used as an identifier",
    ),
    (
        "reference",
        r'#include "renderer/(device|bvh|shared|kernels|compile|film|session|integrators)',
        "the reference uses only renderer/{base,scene,import}",
    ),
    ("sources", r"\b(TODO|FIXME|XXX)\b|#if 0", "unfinished code"),
]


def check_format(report):
    """Runs the formatters and linters of other projects."""
    report.run("clang-format", "--dry-run", "-Werror", *report.of(".h", ".cpp", ".cl"))
    report.run("flake8", *report.of(".py"), *report.scripts(b"python3"))
    report.run("shellcheck", *report.scripts(b"bash"))


def code_of(report):
    """Returns all files of code, scripts and build files among them."""
    code = report.of(".h", ".cpp", ".cl", ".py", ".cmake") + report.scripts(b"")
    return code + [path for path in report.files if path.name in ("CMakeLists.txt", "Makefile")]


def groups_of(report):
    """Returns {group of SOURCE_RULES: its files}."""
    device = report.of(".h", ".cl", under="renderer/kernels/")
    device += report.of(".h", ".cl", under="renderer/shared/")
    return {
        "device": [path for path in device if path.name != "compat.h"],
        "reference": report.of(".h", ".cpp", under="reference/"),
        "sources": [path for path in code_of(report) if not str(path).startswith(RULES_FOLDER)],
    }


def check_source(report):
    """Applies the rules of sources, and looks for licence lines and head sentences."""
    groups = groups_of(report)
    for group, pattern, rule in SOURCE_RULES:
        for path in groups[group]:
            for number, line in lines_of(path):
                if re.search(pattern, line):
                    report.offence(path, number, rule)
    for path in code_of(report):
        if not any("SPDX-License-Identifier: MIT" in line for _, line in list(lines_of(path))[:4]):
            report.offence(path, 1, "no SPDX line")
    for path in report.of(".h", ".cl"):
        if not text_of(path).splitlines()[1:2][0].startswith("// "):
            report.offence(path, 2, "no sentence that says what the file is")
