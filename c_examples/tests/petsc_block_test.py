"""petsc_block by numbers: what presses the block is what the base carries, and friction has its limit.

petsc_block_test.py PROGRAM
"""

import re
import sys

import block_report
from block_report import check, run

# Newton's method balances forces to 1e-11, and the report has 12 digits.
SAME_FORCE = 1e-9
# The nodes' normals turn with the block's bottom, by no more than some of its strains, which are load / (4 E) here. The
# resultants keep the vertical's law to this part, the nodes their own law to the last digits.
LOAD, FRICTION, STRAIN = 0.4, 0.3, 1e-4
# One-sided differences with steps of 1e-8 of the unknowns. Newton's last iterate of the run is asked: an early one may
# lie at a kink, over which a difference means nothing.
SAME_TANGENT = 1e-6


def steps(*options):
    """States and forces of each step."""
    return [found[2:] for found in block_report.steps(sys.argv[1], "-load", str(LOAD), "-push", "1e-3", *options)]


def forces(name, found):
    check(f"{name}: ten steps are reported", abs(len(found) - 10), 0)
    for what, worst in (
        ("normal force = load", max(abs(normal - load) for *_, load, normal, _, _ in found)),
        ("friction = - reaction of the top", max(abs(along + reaction) for *_, along, reaction in found)),
    ):
        check(f"{name}: {what}", worst / LOAD, SAME_FORCE)


friction = steps("-friction", str(FRICTION))
forces("friction", friction)
pressing, pushing = friction[:5], friction[5:]
check("pressed only: no resultant along the base", max(abs(along) for *_, along, _ in pressing) / LOAD, SAME_FORCE)
check("some nodes stick while it is pressed", -min(stick for _, stick, *_ in pressing), -1)
gap, stick, slip, _, normal, along, _ = pushing[-1]
check("in the end every node that touches slips", stick, 0)
check("in the end friction is mu times the normal force", abs(-along / (FRICTION * normal) - 1), STRAIN)
beyond = max(-along / (FRICTION * normal) - 1 for *_, normal, along, _ in pushing)
check("no step goes beyond mu times the normal force", beyond, STRAIN)

smooth = steps("-friction", "0")
forces("no friction", smooth)
check("no friction: no force along the base", max(abs(along) for *_, along, _ in smooth) / LOAD, SAME_FORCE)

errors = re.findall(r"\|\|J - Jfd\|\|_F/\|\|J\|\|_F = ([^,]+),", run(sys.argv[1], "-n", "2", "-snes_test_jacobian"))
check("the tangent is compared with differences", -len(errors), -20)
check("the tangent is that of the residual", float(errors[-1]), SAME_TANGENT)
sys.exit(block_report.failures > 0)
