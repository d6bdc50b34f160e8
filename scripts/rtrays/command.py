# SPDX-License-Identifier: MIT
"""The part that all commands share: help texts, and errors as exit codes."""

import argparse
import sys

from rtrays.documents.document import RunError
from rtrays.programs import ProgramError


def parser(name, description):
    """Returns a parser of a command's arguments that prints the description as it is written."""
    return argparse.ArgumentParser(
        prog=name, description=description, formatter_class=argparse.RawDescriptionHelpFormatter
    )


def run(name, body, *arguments):
    """Calls the body of a command; returns its exit code, or 0 if it returns none.

    An error is one line on stderr. The exit code is 2 for an input that cannot be used, and 1 for
    any other error.
    """
    try:
        return body(*arguments) or 0
    except RunError as error:
        print(f"{name}: {error}", file=sys.stderr)
        return 2
    except ImportError as error:
        print(
            f"{name}: {error}; install python3-numpy, python3-matplotlib and python3-jinja2",
            file=sys.stderr,
        )
    except (OSError, ProgramError) as error:
        print(f"{name}: {error}", file=sys.stderr)
    return 1
