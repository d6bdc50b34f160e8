# SPDX-License-Identifier: MIT
"""Tests the rules of sources."""

import re
import unittest

from rtrays.lint.source import SOURCE_RULES


class Rules(unittest.TestCase):
    def test_device_code(self):
        patterns = [pattern for group, pattern, _ in SOURCE_RULES if group == "device"]
        for line, offends in (
            ("x = (float4)(1.0f, 2.0f);", True),
            ("a = b.xyz;", True),
            ("float x = 1.0;", True),
            ("#define F(a, ...) g(a)", True),
            ("float local = 1.0f;", True),
            ("x = make_float4(1.0f, 2.0f);", False),
            ("a = b.x;", False),
            ("float x = 1.0f;", False),
        ):
            found = any(re.search(pattern, line) for pattern in patterns)
            self.assertEqual(found, offends, line)


if __name__ == "__main__":
    unittest.main()
