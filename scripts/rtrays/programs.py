# SPDX-License-Identifier: MIT
"""Runs other programs."""

import os
import pathlib
import subprocess


class ProgramError(Exception):
    """A program failed; the text names it and the last line that it printed."""


def start(command, environment, **options):
    """Runs a program to its end; `environment` adds variables to those of this process."""
    try:
        variables = {**os.environ, **(environment or {})}
        return subprocess.run([str(word) for word in command], env=variables, **options)
    except OSError as error:
        raise ProgramError(f"{command[0]}: {error.strerror}") from error


def call(command, environment=None):
    """Returns the standard output of a program. Raises ProgramError if it cannot be started or
    fails."""
    done = start(command, environment, capture_output=True, text=True)
    if done.returncode != 0:
        lines = (done.stderr or done.stdout).strip().splitlines() or ["no reason given"]
        raise ProgramError(f"{pathlib.Path(command[0]).name}: {lines[-1]}")
    return done.stdout


def run(command, environment=None):
    """Runs a program that prints its progress. Raises ProgramError if it cannot be started or
    fails."""
    done = start(command, environment)
    if done.returncode != 0:
        raise ProgramError(f"{pathlib.Path(command[0]).name}: exit code {done.returncode}")
