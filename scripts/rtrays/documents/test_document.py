# SPDX-License-Identifier: MIT
"""Tests values of documents and names of files."""

import unittest

from rtrays.documents.document import RunError, entry_named, file_name, value


class Values(unittest.TestCase):
    def test_paths_lead_through_lists(self):
        document = {"reference": {"files": ["a.exr", "b.exr"]}}
        self.assertEqual(value(document, "reference.files.1"), "b.exr")

    def test_missing_values_are_errors(self):
        for document in ({}, {"rmse": None}, {"rmse": float("nan")}):
            with self.assertRaisesRegex(RunError, "rmse"):
                value(document, "rmse")
        with self.assertRaisesRegex(RunError, "third"):
            entry_named([{"name": "first"}], "third")

    def test_file_names_have_neither_blanks_nor_commas(self):
        self.assertEqual(
            file_name("truncated_bdpt.mis,light_paths=auto"), "truncated_bdpt.mis_light_paths=auto"
        )
        self.assertEqual(
            file_name("caustic r=0.1.path_tracing explicit"), "caustic_r=0.1.path_tracing_explicit"
        )


if __name__ == "__main__":
    unittest.main()
