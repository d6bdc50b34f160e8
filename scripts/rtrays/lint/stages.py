# SPDX-License-Identifier: MIT
"""Checks of the stages' heads: each kernel of renderer/kernels declares what it may touch.

A declaration is a comment, because it has lists of any length and OpenCL C has no variadic macros:

    // STAGE(name, reads(...), writes(...), to(...))

`reads` and `writes` list words of the path state (`hit` stands for all words of the hit), queues
and other resources; `to` lists the queues that the stage fills. The check follows the calls from
the kernel to the accessors, whatever the features. A kernel that keeps its path in private memory
touches no words. A plain pointer of a kernel is read if it is const; otherwise it is written, and
perhaps read.
"""

import re

from rtrays.lint.report import text_of
from rtrays.paths import ROOT

FUNCTION = re.compile(
    r"^(DEVICE|__kernel)\b[^;{}]*?\b(\w+)\(([^{;]*)\)\s*\{\n(.*?)^\}$", re.DOTALL | re.MULTILINE
)
KERNELS = "renderer/kernels"
KINDS = ("reads", "writes", "to")
LARGEST_KERNEL = 25

# {function: (list, resource)}: the functions through which stages touch what is not a path's word.
ACCESS = {
    "active_queue": ("reads", "active"),
    "shadow_queue": ("reads", "shadow"),
    "take_work": ("reads", "free"),
    "append_started": ("to", "active"),
    "append_continued": ("to", "next"),
    "append_free": ("to", "free"),
    "append_shadow": ("to", "shadow"),
    "free_slot": ("to", "free"),
    "reset_counters": ("writes", "counters"),
    "add_to_pixel": ("writes", "film"),
    "half_film_add_sample": ("writes", "half_film"),
    "load_light_vertex": ("reads", "vertices"),
    "has_light_vertex": ("reads", "vertices"),
    "store_light_vertex": ("writes", "vertices"),
    "clear_light_vertex": ("writes", "vertices"),
    "load_branch": ("reads", "branches"),
    "store_branch": ("writes", "branches"),
    "live_pixel": ("reads", "live_pixels"),
    "load_path": ("reads", "path"),
    "store_path": ("writes", "path"),
    "count_rays": ("writes", "counters"),
    "count_ray": ("writes", "ray_counts"),
}
# Parameters whose accesses are found by the functions above.
COVERED = {"film_words", "half_film_words", "vertex_words", "branch_words", "ray_counts"}


class Source:
    """A kernel's file with the headers that it includes."""

    def __init__(self, path):
        self.texts = {}
        self.include(path)
        whole = "".join(map(without_comments, self.texts.values()))
        self.functions = {match[2]: match[4] for match in FUNCTION.finditer(whole)}
        self.is_private = "#define PATH_STATES_PRIVATE 1" in text_of(path)

    def include(self, path):
        """Adds a file and, recursively, its headers."""
        if path in self.texts or not (ROOT / path).is_file():
            return
        self.texts[path] = text_of(path)
        for name in re.findall(r'^#include "(renderer/[^"]+)"', self.texts[path], re.MULTILINE):
            self.include(name)

    def reachable(self, name, seen=None):
        """Returns the names of the functions that a function calls, itself among them."""
        seen = set() if seen is None else seen
        if name in self.functions and name not in seen:
            seen.add(name)
            for called in set(re.findall(r"\b(\w+)\(", self.functions[name])):
                self.reachable(called, seen)
        return seen


def without_comments(text):
    """Returns a text without its comments."""
    return re.sub(r"//.*", "", re.sub(r"/\*.*?\*/", "", text, flags=re.DOTALL))


def path_fields():
    """Returns the names of the words of a path's state."""
    table = text_of("renderer/shared/path_state.h")
    return set(re.findall(r"X\(\w+, (?:uint|float|float3|trials), (\w+)\)", table))


def resource(field):
    """Returns the name by which heads list a word."""
    if "trial" in field:
        return "trials"
    return "hit" if field.startswith("hit_") else field


def touched(source, kernel, parameters):
    """Returns {"reads": ..., "writes": ..., "to": ...}: what a kernel may touch."""
    lists = {kind: set() for kind in KINDS}
    fields = set() if source.is_private else path_fields()
    for function in source.reachable(kernel):
        for called in re.findall(r"\b(\w+)\(", source.functions[function]):
            access, _, field = called.partition("_")
            if field in fields and access in ("get", "set"):
                lists["reads" if access == "get" else "writes"].add(resource(field))
            if called in ACCESS:
                lists[ACCESS[called][0]].add(ACCESS[called][1])
    for qualifier, name in re.findall(r"GLOBAL (const )?\w+ \*(\w+)", parameters):
        if name not in COVERED:
            lists["reads" if qualifier else "writes"].add(name)
    return lists


def declared(text):
    """Returns {stage: ({kind: names}, line)} of the heads in a kernel's file."""
    found = {}
    for match in re.finditer(r"^/{2,3} STAGE\((\w+)(.*?)\)\)$", text, re.DOTALL | re.MULTILINE):
        body = re.sub(r"\n/{2,3}", " ", match[2] + ")")
        lists = {kind: [] for kind in KINDS}
        for kind, items in re.findall(r"(reads|writes|to)\(([^)]*)\)", body):
            lists[kind] = re.findall(r"\w+", items)
        found[match[1]] = (lists, text[: match.start()].count("\n") + 1)
    return found


def stages(path):
    """Yields (name, parameters, lines of code, line) of the kernels in a file."""
    text = text_of(path)
    for match in FUNCTION.finditer(text):
        if match[1] == "__kernel":
            line = text[: match.start()].count("\n") + 1
            yield match[2], match[3], match[0].count("\n") + 1, line


def files_of(report):
    """Returns the files of stages."""
    return [path for path in report.of(".cl") if str(path.parent) == KERNELS]


def stage_rows():
    """Returns rows (stage, reads, writes, fills) of all heads, in the order of the stage table."""
    heads = {}
    for path in sorted((ROOT / KERNELS).glob("*.cl")):
        heads.update(declared(path.read_text()))
    table = re.findall(r'X\((\w+), \w+, "kernels', text_of("renderer/compile/stage_table.h"))
    others = [stage for stage in heads if stage not in table]
    return [
        [f"`{stage}`", *(", ".join(heads[stage][0][kind]) for kind in KINDS)]
        for stage in table + others
    ]


def check_stages(report):
    """Compares the heads of the stages with what they touch, and limits their kernels."""
    for path in files_of(report):
        heads = declared(text_of(path))
        source = Source(str(path))
        for name, parameters, length, line in stages(path):
            if length > LARGEST_KERNEL:
                report.offence(path, line, f"a kernel of {length} lines; at most {LARGEST_KERNEL}")
            if name not in heads:
                report.offence(path, line, f"no STAGE({name}, ...) in the head")
                continue
            lists, head = heads.pop(name)
            for kind, found in touched(source, name, parameters).items():
                for item in sorted(found - set(lists[kind])):
                    report.offence(path, head, f"{name} {kind} {item}; the head does not list it")
                for item in sorted(set(lists[kind]) - found):
                    report.offence(path, head, f"{name} does not touch {item}; {kind} lists it")
        for name, (_, head) in heads.items():
            report.offence(path, head, f"there is no kernel {name}")


def check_includes(report):
    """Looks for includes that the resolver of includes would expand wrongly."""
    for path in report.of(".h", ".cl", under=f"{KERNELS}/"):
        depth = 0
        for number, line in enumerate(text_of(path).splitlines(), 1):
            if re.match(r"\s*#\s*if", line):
                depth += 1
            elif re.match(r"\s*#\s*endif", line):
                depth -= 1
            elif re.match(r'\s*#\s*include "', line):
                if depth > 0:
                    report.offence(path, number, "include inside #if; the resolver expands it")
                if line.rstrip().endswith('.cl"'):
                    report.offence(path, number, "include of a stage; put its body into a header")
