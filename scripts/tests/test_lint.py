# SPDX-License-Identifier: MIT
"""Lint finds what it is there to find."""

import importlib.machinery
import importlib.util
import pathlib
import re
import unittest

PATH = pathlib.Path(__file__).resolve().parent.parent / "lint"
loader = importlib.machinery.SourceFileLoader("lint", str(PATH))
lint = importlib.util.module_from_spec(importlib.util.spec_from_loader("lint", loader))
loader.exec_module(lint)


def offends(line, rules):
    return any(re.search(pattern, line) for pattern, *_ in rules)


class Rules(unittest.TestCase):
    def test_prose(self):
        for line in ("// The hierarchy is built anew.", "/// Of camera paths, the index.",
                     "it goes on where it was", "'x' is no setting", "measured in turns",
                     "kernels omit what a scene does not need: what it needs stays"):
            self.assertTrue(offends(line, lint.PROSE_RULES), line)
        for line in ("// Rebuilds the hierarchy.", "/// Index of the path.", "the loop turns back",
                     "// is none of the caller's concern"):
            self.assertFalse(offends(line, lint.PROSE_RULES), line)

    def test_device_code(self):
        rules = [(pattern, rule) for group, pattern, rule in lint.SOURCE_RULES if group == "device"]
        for line in ("x = (float4)(1.0f, 2.0f);", "a = b.xyz;", "float x = 1.0;",
                     "#define F(a, ...) g(a)", "float local = 1.0f;"):
            self.assertTrue(offends(line, rules), line)
        for line in ("x = make_float4(1.0f, 2.0f);", "a = b.x;", "float x = 1.0f;"):
            self.assertFalse(offends(line, rules), line)

    def test_sentences(self):
        short, long = "word " * 20 + "end.", "word " * 40 + "end."
        self.assertEqual(list(lint.long_sentences(f"{short} {short}\n\n{short}\n")), [])
        self.assertEqual([line for line, _ in lint.long_sentences(f"{short}\n\n{long}\n")], [3])
        self.assertEqual(list(lint.long_sentences(f"```\n{long}\n```\n\n| {long} |\n")), [])

    def test_anchors(self):
        self.assertEqual(lint.anchors("# One two\n\n## What's `new`?\n"), {"one-two", "whats-new"})


if __name__ == "__main__":
    unittest.main()
