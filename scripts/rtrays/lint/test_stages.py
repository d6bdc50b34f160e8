# SPDX-License-Identifier: MIT
"""Tests the checks of the stages' heads, with errors planted in the kernels."""

import pathlib
import re
import unittest

from rtrays.lint import stages
from rtrays.lint.report import Report

EXTEND = "renderer/kernels/extend_path.cl"
SCATTER = "renderer/kernels/path/scatter.h"


class Recorder(Report):
    """Keeps offences instead of printing them."""

    def __init__(self):
        super().__init__()
        self.found = []

    def offence(self, path, line, rule):
        self.found.append(f"{path}: {rule}")


class Planted(unittest.TestCase):
    def offences(self, check, planted=None):
        """Returns the offences if `planted` = (file, text, replacement)."""
        read = stages.text_of

        def text_of(path):
            text = read(path)
            if planted and str(path) == planted[0]:
                self.assertIn(planted[1], text)
                text = text.replace(planted[1], planted[2], 1)
            return text

        report = Recorder()
        stages.text_of = text_of
        try:
            check(report)
        finally:
            stages.text_of = read
        return report.found

    def expect(self, check, planted, *rules):
        found = self.offences(check, planted)
        self.assertEqual(len(found), len(rules), found)
        for rule in rules:
            self.assertTrue(any(re.search(rule, offence) for offence in found), (rule, found))

    def test_kernels_are_as_declared(self):
        self.assertEqual(self.offences(stages.check_stages), [])
        self.assertEqual(self.offences(stages.check_includes), [])

    def test_word_read_by_a_body(self):
        planted = (SCATTER, "get_roulette_scale(path)", "get_shadow_vector(path)")
        rules = ("reads shadow_vector", "does not touch roulette_scale; reads")
        self.expect(stages.check_stages, planted, *rules)

    def test_word_that_is_not_touched(self):
        planted = (EXTEND, "roulette_scale,", "roulette_scale, light,")
        self.expect(stages.check_stages, planted, "extend_path does not touch light; reads")

    def test_queue(self):
        planted = (EXTEND, "append_free(stream, &ended)", "append_shadow(stream, &ended)")
        self.expect(stages.check_stages, planted, "to shadow", "does not touch free; to")

    def test_film(self):
        planted = ("renderer/kernels/path/splat.h", "add_to_pixel(", "ignore_pixel(")
        self.expect(stages.check_stages, planted, "splat_unblocked does not touch film")

    def test_missing_head(self):
        planted = (EXTEND, "STAGE(extend_path", "STAGE(extend_paths")
        rules = (r"no STAGE\(extend_path", "no kernel extend_paths")
        self.expect(stages.check_stages, planted, *rules)

    def test_long_kernel(self):
        (kernel,) = stages.stages(pathlib.Path(EXTEND))
        missing = stages.LARGEST_KERNEL + 1 - kernel[2]
        planted = (EXTEND, "    PushBuffer continued", "\n" * missing + "    PushBuffer continued")
        self.expect(stages.check_stages, planted, "a kernel of 26 lines; at most 25")

    def test_include_inside_a_condition(self):
        include = '#include "renderer/kernels/stream.h"\n'
        planted = (EXTEND, include, f"#if FEATURE_lights\n{include}#endif\n")
        self.expect(stages.check_includes, planted, "include inside #if")

    def test_include_of_a_stage(self):
        planted = (EXTEND, "kernels/stream.h", "kernels/sample_light.cl")
        self.expect(stages.check_includes, planted, "include of a stage")

    def test_rows_of_the_table(self):
        rows = {row[0]: row for row in stages.stage_rows()}
        self.assertIn("next, free", rows["`extend_path`"][3])
        self.assertEqual(list(rows)[0], "`reset_streams`")
        self.assertIn("`list_live_pixels`", rows)


if __name__ == "__main__":
    unittest.main()
