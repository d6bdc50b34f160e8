# SPDX-License-Identifier: MIT
"""Tests that results are kept while their key is the same."""

import pathlib
import tempfile
import unittest

from rtrays.peers.results import kept


class Kept(unittest.TestCase):
    def test_a_result_is_produced_once_for_a_key(self):
        produced = []

        def produce(folder):
            produced.append(folder)
            return {"run": len(produced)}

        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name) / "scene"
            self.assertEqual(kept(folder, ["version 1"], produce), {"run": 1})
            self.assertEqual(kept(folder, ["version 1"], produce), {"run": 1})
            self.assertEqual(kept(folder, ["version 2"], produce), {"run": 2})
        self.assertEqual(produced, [folder, folder])


if __name__ == "__main__":
    unittest.main()
