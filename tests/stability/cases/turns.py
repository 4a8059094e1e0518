"""Bodies pressed together that turn as one, all in one step: the normals of its start no longer mean the surfaces. The
answer is the pressure that was there before, in the turned frame; steps that turn by too much are cut back."""

import numpy as np

import host
from cell import series

DEGREES = (5, 15, 30, 60, 90, 180)
# A step below the limit leaves 1e-4 of the pressure without friction (docs/host_steps.md); a turn of many steps as much, for
# each of them starts from the rest of the one before.
SAME_PRESSURE = 1e-4
# Where all stick on a curve, what the wrong normals make of the gaps between chords stays, with the square of a step's
# turn; steps that were cut back are 20 degrees at most.
STUCK_ON_A_CURVE = 5e-5
# Steps until t = 1, the last of them at rest: normals and areas are those of the pressed surfaces then. Steps after t = 2.
SETTLE, REST = 10, 2


def times():
    pressed = [k / SETTLE for k in range(1, SETTLE + 1)]
    return {"times": pressed + [2] + [2 + 0.1 * k for k in range(1, REST + 1)]}


def pressures(run, step):
    table = run.interface("contact", step)
    return np.linalg.norm([table[f"lambda_{c}"] for c in ("n", "tx", "ty", "tz")], axis=0)


def compared(context, scene, bound, *options):
    run = context.solve(scene, *options)
    result = host.outcome(run)
    if result.refusal is None:
        states = [step["interfaces"]["contact"] for step in run.steps]
        same = all(states[SETTLE - 1][s] == states[-1][s] for s in ("gap", "stick", "slip"))
        result.true("states as before the turn", same, "it is rigid")
        steps = [round(step["t"], 9) for step in run.steps]
        before, after = pressures(run, steps.index(1) + 1), pressures(run, len(steps))
        result.below("pressures after it", np.abs(after - before).max() / before.max(), bound, "those before")
    return result


def blocks(degrees):
    """A block pressed on a larger one, turned about an axis in the surface and out of the middle, without friction."""
    angle = float(np.radians(degrees))
    body = {"type": "box", "young": 1000, "poisson": 0.3, "material": "neo_hooke"}
    turn = {"components": ["x", "y", "z"], "rotate": [0, angle, 0], "rotate_curve": [1, 0, 2, 1]}
    scene = {
        "schema": 1,
        "bodies": ["upper", "lower"],
        "upper": {"lower": [0, 0, 1], "upper": [1, 1, 1.5], "cells": [3, 4, 1]} | body,
        "lower": {"lower": [-0.5, -0.5, 0], "upper": [1.5, 1.5, 1], "cells": [5, 4, 2]} | body,
        "supports": ["head", "ground"],
        "head": {"surface": "upper.zmax", "value": [0, 0, -0.01], "curve": [0, 0, 0.2, 1]} | turn,
        "ground": {"surface": "lower.zmin"} | turn,
        "interfaces": ["contact"],
        "contact": {"nonmortar": "upper.zmin", "mortar": "lower.zmax"},
        "steps": times(),
        "output": {"vtu": "none"},
    }
    return lambda context: compared(context, scene, SAME_PRESSURE)


def shaft(degrees):
    """A shaft stuck in a hub that turns."""
    turn = ("-turn_rotate", f"0,0,{float(np.radians(degrees))!r}")
    return lambda context: compared(context, context.adapted("turned_shaft", times()), STUCK_ON_A_CURVE, *turn)


def cells():
    yield from series("turn in one step, blocks without friction", DEGREES, blocks, quick=(15, 90))
    yield from series("turn in one step, shaft stuck in its hub", DEGREES, shaft, quick=(90,))
