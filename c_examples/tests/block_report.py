"""What petsc_block and mpi_block print, step by step, and checks of numbers."""

import re
import subprocess

# step, iterations; nodes in gap, stick, slip; load, contact's two forces, reaction
STEP = re.compile(r"step (\d+): (\d+) iterations, (\d+) gap (\d+) stick (\d+) slip, load (\S+) contact (\S+) (\S+) reaction (\S+)")
failures = 0


def check(what, value, bound):
    global failures
    passed = value <= bound  # not a number fails
    failures += not passed
    print(f"{what:60} {value:9.2e} <= {bound:.0e}  {'ok' if passed else 'FAILED'}")


def run(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def steps(*command):
    """Of each step all of its numbers."""
    return [tuple(float(value) for value in found) for found in STEP.findall(run(*command))]
