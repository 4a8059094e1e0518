"""mpi_block on 1 to 4 processes is petsc_block on one: iterations, states, forces.

mpi_block_test.py PROGRAM PETSC_BLOCK MPIEXEC
"""

import re
import subprocess
import sys

# Newton's method balances forces to 1e-11, and the report has 12 digits. The whole load is what numbers are compared with.
SAME_FORCE, LOAD = 1e-9, 40.0
STEP = re.compile(r"step (\d+): (\d+) iterations, (\d+) gap (\d+) stick (\d+) slip, load (\S+) contact (\S+) (\S+) reaction (\S+)")
failures = 0


def check(what, value, bound):
    global failures
    passed = value <= bound  # not a number fails
    failures += not passed
    print(f"{what:60} {value:9.2e} <= {bound:.0e}  {'ok' if passed else 'FAILED'}")


def steps(*command):
    report = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    return [tuple(float(value) for value in found) for found in STEP.findall(report)]


for options in ([], ["-friction", "0", "-n", "5"], ["-push", "0.6", "-n", "4"]):
    one = steps(sys.argv[2], *options)
    for ranks in "1234":
        many = steps(sys.argv[3], "-n", ranks, sys.argv[1], *options)
        name = f"{' '.join(options) or 'default'}, {ranks} processes"
        check(f"{name}: steps", abs(len(many) - 10), 0)
        check(f"{name}: iterations and states", sum(a[:5] != b[:5] for a, b in zip(one, many)), 0)
        check(f"{name}: forces", max(abs(x - y) for a, b in zip(one, many) for x, y in zip(a[5:], b[5:])) / LOAD, SAME_FORCE)
sys.exit(failures > 0)
