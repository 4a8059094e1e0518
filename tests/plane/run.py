"""Plane and axisymmetric models as a two-dimensional host sees them, through the C ABI: run.py --library PATH

Prints one line per check with the measured figure and its bound; exits with 1 if anything failed."""

import argparse
import itertools
import sys
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path += [str(ROOT / "studies" / "common"), str(ROOT / "tests" / "stability")]
from library import COMMITTED, CURRENT, Library  # noqa: E402
from plane_cells import Body  # noqa: E402
from plane_host import SPACES, Host, Layer, Lines, choices  # noqa: E402
from plane_patch import pressed  # noqa: E402
from verdict import Verdicts  # noqa: E402

# Rounding of a solved system, over the answer.
PATCH = 1e-11
# Two ways to the same system: rounding, times what the solution of the system does to it.
SAME = 1e-9
YOUNG, POISSON = 1000.0, 0.3
# How far a plate's top goes down and along, step by step.
SLIDE = [(-0.004, 0.0), (-0.008, 0.0), (-0.008, 0.001), (-0.008, 0.01), (-0.008, 0.05), (-0.008, 0.1)]
OVERHANG = [(-0.004, 0.0), (-0.008, 0.0), (-0.008, 0.003), (-0.008, 0.05), (-0.006, 0.3)]


def patch(library, v):
    """A pressure goes through an interface of meshes that do not match: plane strain, plane stress, ring on ring."""
    worst = 0.0
    for model, (one, two), space in itertools.product(("strain", "stress", "ring"), itertools.product((4, 8), (4, 8)), SPACES):
        left = 1.0 if model == "ring" else 0.0
        upper = Body((5, 2), (left, 0, left + 2, 1), one, model, YOUNG, POISSON, 0.7)
        lower = Body((3, 2), (left, -1, left + 2, 0), two, model, YOUNG, POISSON, 0.7)
        worst = max(worst, pressed(library, upper, lower, 2.0, modulus=YOUNG, mu=0.3, **choices(space))[0])
    v.below("patch, 4 and 8 nodes, plane strain, plane stress, ring on ring, all multipliers: worst", worst, PATCH, "exact")


def shrink_fit(library, v):
    """A shaft in a hub: Lame. Both ends free, or both held."""
    b, c, delta = 10.0, 20.0, 1e-3
    for ends, nodes, bound in (("free", 8, 1e-3), ("held", 8, 1e-3), ("free", 4, 1e-3)):
        along = 24 if nodes == 4 else 6
        shaft = Body((along, 2), (0, 0, b + delta, 1), nodes, "ring", 2e5, 0.3)
        hub = Body((along, 3), (b, 0, c, 1), nodes, "ring", 2e5, 0.3)
        host = Host(library, (shaft, hub), ("right", "left"), modulus=2e5, mu=0.0)
        fixed = host.on(0, 0, 0.0, lambda x: x[0] == 0)
        for body in (0, 1):
            fixed |= host.on(body, 1, 0.0, lambda x: x[1] == 0 or (ends == "held" and x[1] == 1))
        iterations = host.step(fixed)
        pressure = 2e5 * delta / b * (c * c - b * b) / (2 * c * c) / (1 if ends == "free" else 1 - 0.3**2)
        # A free shaft becomes longer than its hub, whose edge then presses into it: the mean counts.
        found, area = host.lam[:, 0], host.states["coverage"]
        mean = found @ area / area.sum()
        v.near(f"shrink fit, ends {ends}, {nodes} nodes a cell, {iterations} iterations: mean pressure, Lame", mean, pressure, bound, "mesh")
        if ends == "held":
            error = np.abs(found[host.contact.has_row] - pressure).max() / pressure
            v.below("the same: worst pressure, over Lame's", error, bound, "mesh")


def slide(library, v):
    """Plates slide on each other with friction, one that stays on the other and one that overhangs it: lines and one layer of
    quadrilaterals give the same numbers and iterations."""
    plates = {
        "on a longer one": ((4, (0.3, 1.5)), (9, (0.0, 2.2)), SLIDE),
        "over both edges": ((9, (0.0, 2.2)), (5, (0.33, 1.77)), OVERHANG),
    }
    for (where, sides), (space, weights) in itertools.product(plates.items(), (("corner", CURRENT), ("dual", CURRENT), ("dual", COMMITTED))):
        found = []
        for kind in (Lines, Layer):
            (n, (a, b)), (m, (c, d)), path = sides
            upper = Body((n, 2), (a, 0, b, 0.6), 4, "strain", YOUNG, POISSON, 0.5)
            lower = Body((m, 2), (c, -0.5, d, 0), 4, "strain", 2 * YOUNG, POISSON, 0.5)
            # Newton's way depends on the augmentation, the answer does not: let it be the same.
            options = dict(augmentation=0.3 * YOUNG, mu=0.3, weights=weights, **choices(space))
            host = Host(library, (upper, lower), ("bottom", "top"), kind, **options)
            base = host.on(1, 0, 0.0, lambda x: x[1] == -0.5) | host.on(1, 1, 0.0, lambda x: x[1] == -0.5)
            steps, states = [], set()
            for down, along in path:
                top = host.on(0, 0, along, lambda x: x[1] == 0.6) | host.on(0, 1, down, lambda x: x[1] == 0.6)
                steps.append(host.step(base | top))
                states |= set(host.states["state"])
            found.append((steps, np.concatenate([host.u, host.lam.ravel() / YOUNG]), states))
        (own, u, states), (layer, w, _) = found
        what = f"plate {where}, {space}, weights of {'now' if weights == CURRENT else 't_n'}"
        v.below(f"{what}: lines against one layer", np.abs(u - w).max() / np.abs(u).max(), SAME, "rounding")
        v.below(f"the same: difference of iterations ({own})", np.abs(np.subtract(own, layer)).max(), 0, "the same system")
        v.at_least("the same: states that occur", len(states), 2, "stick and slip")


def ball(library, v):
    """An elastic ball on an elastic block: Hertz, from the force to the largest pressure."""
    radius, far = 50.0, 24.0
    # Cells grow with the distance from the point where the ball touches.
    def graded(s):
        return far * (0.08 * s + 0.92 * s**3)

    for nodes, along, bound in ((8, 24, 1e-2), (4, 48, 1e-2)):
        def upper_map(p):
            r = graded(p[0])
            return np.array([r, graded(p[1]) + r * r / (2 * radius) * (1 - p[1])])

        upper = Body((along, along // 2), (0, 0, 1, 1), nodes, "ring", YOUNG, POISSON, map=upper_map)
        lower = Body((along, along // 2), (0, -1, 1, 0), nodes, "ring", YOUNG, POISSON, map=lambda p: np.array([graded(p[0]), -graded(-p[1])]))
        host = Host(library, (upper, lower), ("bottom", "top"), modulus=YOUNG, mu=0.0)
        fixed = host.on(0, 0, 0.0, lambda x: x[0] == 0) | host.on(1, 0, 0.0, lambda x: x[0] == 0)
        fixed |= host.on(1, 1, 0.0, lambda x: x[1] == -far) | host.on(1, 0, 0.0, lambda x: x[1] == -far)
        for down in np.linspace(0, -0.06, 4)[1:]:
            top = upper.x[:, 1].max()
            iterations = host.step(fixed | host.on(0, 1, down, lambda x: x[1] > far - 1e-9))
        assert top >= far
        residual = np.split(host.contact.residual(*host.at()), [2 * len(host.nodes[0])])[0]
        force = -residual[1::2].sum()
        stiffness = YOUNG / (1 - POISSON**2) / 2
        peak = (6 * force * stiffness**2 / (np.pi**3 * radius**2)) ** (1 / 3)
        found = -host.lam[:, 1].min()
        v.near(f"ball on block, {nodes} nodes a cell, {iterations} iterations in the last step: largest pressure, Hertz", found, peak, bound, "mesh, and bodies of 24 radii of contact")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--library", required=True, help="libstickslip.so")
    library, verdicts = Library(parser.parse_args().library), Verdicts()
    for check in (patch, shrink_fit, slide, ball):
        check(library, verdicts)
    verdicts.print()
    return 0 if verdicts.passed else 1


if __name__ == "__main__":
    sys.exit(main())
