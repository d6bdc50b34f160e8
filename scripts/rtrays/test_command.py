# SPDX-License-Identifier: MIT
"""Tests the exit codes of commands, and calls of programs."""

import contextlib
import io
import unittest

from rtrays import command
from rtrays.documents.document import RunError
from rtrays.programs import ProgramError, call


class ExitCodes(unittest.TestCase):
    def run_body(self, body):
        """Returns the exit code and the lines on stderr."""
        printed = io.StringIO()
        with contextlib.redirect_stderr(printed):
            code = command.run("name", body)
        return code, printed.getvalue()

    def test_errors_are_one_line(self):
        for error, code in (
            (RunError("run.json: missing"), 2),
            (ImportError("No module named 'numpy'"), 1),
            (OSError("disk full"), 1),
            (ProgramError("blender: no scene"), 1),
        ):

            def body(error=error):
                raise error

            found, text = self.run_body(body)
            self.assertEqual(found, code)
            self.assertTrue(text.startswith(f"name: {error}"))
            self.assertEqual(text.count("\n"), 1)

    def test_a_body_may_return_its_code(self):
        self.assertEqual(self.run_body(lambda: 77), (77, ""))
        self.assertEqual(self.run_body(lambda: None), (0, ""))


class Programs(unittest.TestCase):
    def test_output_and_environment(self):
        self.assertEqual(call(["sh", "-c", "echo $RTRAYS_TEST"], {"RTRAYS_TEST": "yes"}), "yes\n")

    def test_an_error_names_the_program_and_its_last_line(self):
        with self.assertRaisesRegex(ProgramError, "^sh: second$"):
            call(["sh", "-c", "echo first >&2; echo second >&2; exit 3"])
        with self.assertRaisesRegex(ProgramError, "no_such_program: No such file"):
            call(["no_such_program"])


if __name__ == "__main__":
    unittest.main()
