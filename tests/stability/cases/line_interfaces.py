"""Interfaces of lines: the cases of facets that have a form in the plane, turns, ties, and how far a step may go."""

import ctypes

import numpy as np

from cases import assembled, layers
from cell import ELEMENT, Outcome, series
from library import DUAL, STANDARD, Interface, pointer
from lines import RING, STRAIN, grid, turn

PLANE = {"model": STRAIN, "thickness": 1.0}
OPTIONS = assembled.OPTIONS
SIZES = ("3", "0.5", "1e-2")  # of the plates in layers, over the line's
DEGREES = (1, 15, 45, 90, 135, 180)
GAPS = ("0", "1e-6", "1e-2", "1", "1e3", "1e6")  # that a step closes, in lines
# Positions and normals of a turned interface are rounded; the largest force decides.
TURNED = 1e-12
# How far a node may go deeper in a step, in lines, how much before it a step may end, and how far beyond: rounding.
DEPTH, SHARPNESS, BEYOND = 0.1, 0.25, 1e-5
TIED = 2  # the law's number


def sides(bent=0.0):
    """A row of four lines over one of three that is longer at one end; the upper one may be bent."""
    x1, f1 = grid(4, down=True, z=-0.001)
    x2, f2 = grid(3, (-0.21,), 1.5)
    x1[:, 1] += bent * np.sin(3 * x1[:, 0])
    return x1, f1, x2, f2


def turned_at_once(degrees):
    """Both sides turn as one body in one step, and rest: the commit there turns normals and history, and with them forces
    and rows."""

    def run(context):
        outcome, random = Outcome(), np.random.default_rng(20261123)
        q = turn(np.radians(degrees))
        for basis in (STANDARD, DUAL):
            x1, f1, x2, f2 = sides(0.02)
            lam = assembled.pressed(x1) * random.uniform(0.5, 1, (len(x1), 1))
            options = OPTIONS | PLANE | {"basis": basis, "turn_max": np.pi}
            interface = Interface(context.library, x1, f1, x2, f2, **options)
            turned = x1 @ q.T, x2 @ q.T, lam @ q.T
            before = interface.residual(x1, x2, lam)
            interface.commit(*turned)
            after = interface.residual(*turned)
            interface.close()
            for what, a, b in zip(("force", "reaction", "rows"), before, after):
                error = np.abs(b - a @ q.T).max() / np.abs(before[0]).max()
                outcome.below(f"basis {basis}: {what}", error, TURNED, "turned with the bodies")
        return outcome

    return run


def tied(degrees):
    """Lines tied over an open gap, turned as one body in one step: nothing is strained."""

    def run(context):
        outcome, q = Outcome(), turn(np.radians(degrees))
        for basis in (STANDARD, DUAL):
            x1, f1, x2, f2 = sides()
            x1 += [0, 0.2]
            options = {"modulus": 1000.0, "friction": TIED, "basis": basis, "turn_max": np.pi} | PLANE
            interface = Interface(context.library, x1, f1, x2, f2, **options)
            zero = np.zeros_like(x1)
            shifted = np.abs(interface.residual(x1 + [0.1, 0.0], x2, zero)[2]).max() / 0.1
            rows = interface.residual(x1 @ q.T, x2 @ q.T, zero)[2]
            interface.close()
            outcome.true(f"basis {basis}: a shift is felt", shifted > 0, "it is tied")
            error = np.abs(rows).max() / shifted
            outcome.below(f"basis {basis}: rows, over those of a shift by 1", error, TURNED, "the gap turns, too")
        return outcome

    return run


def closed_by_a_step(text):
    """A step that would go far through the other side may be taken until its nodes are a tenth of a line deep."""
    gap = float(text) / 4

    def run(context):
        outcome = Outcome()
        for name, model in (("plane strain", PLANE), ("ring", {"model": RING})):
            x1, f1 = grid(4, (1.0,), down=True, z=gap)
            x2, f2 = grid(3, (0.8,), 1.5)
            interface = Interface(context.library, x1, f1, x2, f2, search_distance=2 * gap + 1, **OPTIONS, **model)
            motion, fraction = 10 * gap + 1, ctypes.c_double()
            step = np.tile((0.0, -motion), (len(x1), 1)), np.zeros_like(x2)
            found = ctypes.c_double(0), ctypes.byref(fraction)
            context.library.call("interface_step_limit", interface.handle, *map(pointer, (x1, x2, *step)), *found)
            interface.close()
            depth = DEPTH / 4
            short = (gap + depth - motion * fraction.value) / depth
            outcome.below(f"{name}: beyond the depth", max(-short, 0), BEYOND + gap * 1e-14 / depth, "a tenth of a line at most")
            outcome.below(f"{name}: short of it", max(short, 0), SHARPNESS + BEYOND, "the sharpness that the header says")
        return outcome

    return run


def cells():
    kind = {"kind": ELEMENT}
    flat = {"mesh": grid} | PLANE
    ring = {"mesh": lambda *a, lower=(0.0,), **more: grid(*a, lower=(lower[0] + 2,), **more), "model": RING}
    of_lines = lambda make, options: lambda text: make(text, **options)
    for name, options in (("plane strain", flat), ("rings", ring)):
        noise = of_lines(assembled.noise, options)
        yield from series(f"line interface, noise, {name}", assembled.NOISES[::2], noise, quick=("1e-13",), **kind)
    touching = of_lines(assembled.touching, flat)
    yield from series("line interface, first touch at a gap of", assembled.TOUCHES, touching, quick=("0",), **kind)
    apart = lambda text: layers.stacked(float(text), 0.2, search_distance=0.1, **flat)
    stacked = lambda text: layers.stacked(float(text), 0.2, **flat)
    yield from series("lines in layers, plates over line", SIZES, stacked, quick=("0.5",), **kind)
    yield from series("lines in layers with search distance", SIZES[1:], apart, quick=("0.5",), **kind)
    yield from series("lines turned in one step, degrees", DEGREES, turned_at_once, quick=(90,), **kind)
    yield from series("lines tied over a gap, degrees of turn", DEGREES, tied, quick=(90,), **kind)
    yield from series("a step of lines closes a gap, in lines", GAPS, closed_by_a_step, quick=("1",), **kind)
