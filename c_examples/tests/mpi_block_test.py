"""mpi_block on 1 to 4 processes is petsc_block on one: iterations, states, forces.

mpi_block_test.py PROGRAM PETSC_BLOCK MPIEXEC
"""

import sys

import block_report
from block_report import check, steps

# Newton's method balances forces to 1e-11, and the report has 12 digits. The whole load is what numbers are compared with.
SAME_FORCE, LOAD = 1e-9, 40.0

for options in ([], ["-friction", "0", "-n", "5"], ["-push", "0.6", "-n", "4"]):
    one = steps(sys.argv[2], *options)
    for ranks in "1234":
        many = steps(sys.argv[3], "-n", ranks, sys.argv[1], *options)
        name = f"{' '.join(options) or 'default'}, {ranks} processes"
        check(f"{name}: steps", abs(len(many) - 10), 0)
        check(f"{name}: iterations and states", sum(a[:5] != b[:5] for a, b in zip(one, many)), 0)
        check(f"{name}: forces", max(abs(x - y) for a, b in zip(one, many) for x, y in zip(a[5:], b[5:])) / LOAD, SAME_FORCE)
sys.exit(block_report.failures > 0)
