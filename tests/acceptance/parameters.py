"""How reactions and probes follow the parameters of a scene (`parameters`): against differences of whole runs, through contact that sticks,
slips, opens and returns; on ranks, across a restart, and what is refused."""

import json

import numpy as np

from scene import SCENES, write

# Of a whole run: what the project asks for. Differences are of the fourth order, of runs that converge to 1e-13.
SLOPE_BOUND = 1e-7
# Offsets are a thousandth of the model: their differences lose three digits more to rounding.
OFFSET_BOUND = 1e-6
# Ranks add in another order, and so do MUMPS' fronts.
RANKS_BOUND = 1e-9
# Of derivatives of forces on free displacements, over the largest: what a direct solver leaves.
IMBALANCE_BOUND = 1e-8
CONVERGED = ("-snes_rtol", "1e-13")
# The library's tangents of quadrilaterals that are no parallelograms have the error of their rule (docs/gradients.md).
EXACT_RULE = {"quadrature": "degree_10"}

# With widths of the differences, so small that no node changes its state within them.
PARAMETERS = {
    "mu": ({"friction": "contact", "deviation": 0.02}, 3e-5, lambda v: ("-contact_friction", v), 0.3),
    "soft": ({"young": "upper", "deviation": 10}, 0.1, lambda v: ("-upper_young", v), 1000.0),
    "push": ({"load": "press"}, 1e-4, lambda v: ("-press_pressure", 8 * v), 1.0),
    "slide": ({"support": "grip"}, 1e-4, lambda v: ("-grip_value", ",".join(repr(v * u) for u in (0.02, 0.004, 0.0))), 1.0),
    "gap": ({"offset": "contact"}, 1e-6, lambda v: ("-contact_offset", v), 1e-4),
}


def parameters(verdicts, driver):
    driver.output.mkdir(parents=True, exist_ok=True)
    for name, changes in (("blocks", {}), ("tet", {"cell": "tet"}), ("hex27", {"cell": "hex27"}), ("neo", {"material": "neo_hooke"})):
        compare(verdicts, driver, name, blocks(**changes))
    compare(verdicts, driver, "plane", plane())
    ball(verdicts, driver)
    deviations(verdicts, driver)
    ranks(verdicts, driver)
    restart(verdicts, driver)
    refused(verdicts, driver)


def blocks(**changes):
    """A block that is pressed on another one, drawn along it and back."""
    body = {"type": "box", "poisson": 0.3, **changes}
    cells = [2, 2, 2] if changes.get("cell") == "hex27" else [4, 4, 3]
    return {
        "schema": 1,
        "bodies": ["upper", "lower"],
        "upper": {**body, "lower": [0.1, 0.1, 0.8], "upper": [0.9, 0.9, 1.6], "cells": cells, "young": 1000},
        "lower": {**body, "lower": [0, 0, 0], "upper": [1, 1, 0.8], "cells": [n + 1 for n in cells], "young": 2000},
        "supports": ["ground", "grip"],
        "ground": {"surface": "lower.zmin", "components": ["x", "y", "z"]},
        "grip": {"surface": "upper.zmax", "components": ["x", "y"], "value": [0.02, 0.004, 0], "curve": [0, 0, 1, 0.3, 2, -1]},
        "loads": ["press"],
        "press": {"surface": "upper.zmax", "pressure": 8},
        "interfaces": ["contact"],
        "contact": {"nonmortar": "upper.zmin", "mortar": "lower.zmax", "friction": 0.3, "offset": 1e-4, **EXACT_RULE},
        "probes": ["corner"],
        "corner": {"body": "upper", "point": [0.9, 0.9, 1.6]},
        "parameters": list(PARAMETERS),
        **{name: given[0] for name, given in PARAMETERS.items()},
        "steps": {"end": 2, "count": 6},
        "output": {"vtu": "none", "csv": "none"},
    }


def plane():
    """The same in the plane, lines."""
    scene = blocks()
    flat = {"cells": [6, 4], "cell": "quad8"}
    scene["upper"] = {**scene["upper"], **flat, "lower": [0.1, 0.8], "upper": [0.9, 1.6]}
    scene["lower"] = {**scene["lower"], **flat, "lower": [0, 0], "upper": [1, 0.8], "cells": [7, 4]}
    scene["ground"] = {"surface": "lower.ymin", "components": ["x", "y"]}
    scene["grip"] = {"surface": "upper.ymax", "components": ["x"], "value": [0.02, 0], "curve": [0, 0, 1, 0.3, 2, -1]}
    scene["press"] = {"surface": "upper.ymax", "pressure": 8}
    scene["contact"] = {"nonmortar": "upper.ymin", "mortar": "lower.ymax", "friction": 0.3, "offset": 1e-4}
    scene["corner"] = {"body": "upper", "point": [0.9, 1.6]}
    return {**scene, "model": "plane_strain"}


def results(steps, parameter=None):
    """(steps, 2, n): reactions and probes of each step, or their derivatives."""
    rows = []
    for step in steps:
        found = step["sensitivity"][parameter] if parameter else step
        rows.append([np.ravel(list(found.get(kind, {}).values())) for kind in ("reactions", "probes")])
    return rows


def apart(found, reference):
    """Of each step and kind, over the largest of the kind in the run; kinds that nothing moves do not count."""
    worst = 0.0
    for kind in range(2):
        largest = max(np.abs(step[kind]).max(initial=0) for step in reference)
        if largest > 0:
            worst = max([worst, *(np.abs(f[kind] - r[kind]).max() / largest for f, r in zip(found, reference, strict=True))])
    return worst


def differences(driver, path, label, options, value, width, further=()):
    """Central ones of the fourth order, of whole runs without parameters."""
    runs = []
    for k in (-2, -1, 1, 2):
        key, changed = options(value + k * width)
        runs.append(results(driver.run(path, key, changed, *further, *CONVERGED, label=f"{label}_{k}").steps))
    return [
        [(a - 8 * b + 8 * c - d) / (12 * width) for a, b, c, d in zip(*step, strict=True)] for step in zip(*runs, strict=True)
    ]


def without(scene):
    """The scene without what it wants to know the influence of."""
    names = scene["parameters"]
    return {key: value for key, value in scene.items() if key != "parameters" and key not in names}


def compare(verdicts, driver, name, scene):
    run = driver.run(write(scene, driver.output / f"{name}.yaml"), *CONVERGED)
    plain = write(without(scene), driver.output / f"{name}_plain.yaml")
    states = {s for step in run.steps for s in ("gap", "stick", "slip") if step["interfaces"]["contact"][s]}
    verdicts.true(f"{name}: nodes stick and slip", {"stick", "slip"} <= states, f"states {sorted(states)}")
    verdicts.below(f"{name}: imbalance", max(s["sensitivity"]["imbalance"] for s in run.steps), IMBALANCE_BOUND, "equilibrium")
    for parameter, (_, width, options, value) in PARAMETERS.items():
        if name == "plane" and parameter == "slide":
            options = lambda v: ("-grip_value", f"{0.02 * v!r},0")  # noqa: E731
        slopes = differences(driver, plain, f"{name}_{parameter}", options, value, width)
        error = apart(results(run.steps, parameter), slopes)
        verdicts.below(f"{name}: derivatives by {parameter}", error, OFFSET_BOUND if parameter == "gap" else SLOPE_BOUND, "differences of runs")


def ball(verdicts, driver):
    """An analytic ball, pressed into a block and drawn along."""
    scene = {
        "schema": 1,
        "bodies": ["block", "ball"],
        "block": {"type": "box", "lower": [-1, -1, -1], "upper": [1, 1, 0], "cells": [7, 7, 3], "young": 1000, "poisson": 0.3},
        "ball": {"type": "analytic", "shape": "sphere", "point": [0, 0, 1.5], "radius": 1.5},
        "supports": ["base", "press"],
        "base": {"surface": "block.zmin", "components": ["x", "y", "z"]},
        "press": {"body": "ball", "components": ["x", "y", "z"], "value": [0.06, 0.02, -0.12], "curve": [0, 0, 1, 1]},
        "interfaces": ["contact"],
        "contact": {"nonmortar": "block.zmax", "mortar": "ball.surface", "friction": 0.3},
        "probes": ["middle"],
        "middle": {"body": "block", "point": [0.14285714285714285, 0.14285714285714285, 0]},
        "parameters": ["mu", "deeper"],
        "mu": {"friction": "contact"},
        "deeper": {"support": "press"},
        "steps": {"count": 4},
        "output": {"vtu": "none", "csv": "none"},
    }
    run = driver.run(write(scene, driver.output / "ball.yaml"), *CONVERGED)
    plain = write(without(scene), driver.output / "ball_plain.yaml")
    for parameter, options, value, width in (
        ("mu", lambda v: ("-contact_friction", v), 0.3, 1e-4),
        ("deeper", lambda v: ("-press_value", ",".join(repr(v * u) for u in scene["press"]["value"])), 1.0, 1e-4),
    ):
        slopes = differences(driver, plain, f"ball_{parameter}", options, value, width)
        verdicts.below(f"ball: derivatives by {parameter}", apart(results(run.steps, parameter), slopes), SLOPE_BOUND, "differences of runs")


def deviations(verdicts, driver):
    """sqrt of the sum of squares."""
    step = json.loads((driver.output / "blocks" / "summary.json").read_text())["steps"][-1]["sensitivity"]
    for kind in ("reactions", "probes"):
        for name, found in step["deviation"][kind].items():
            parts = [PARAMETERS[p][0].get("deviation", 0) * np.array(step[p][kind][name]) for p in PARAMETERS]
            verdicts.below(f"deviation of {name}", np.abs(np.sqrt(np.square(parts).sum(0)) - found).max(), 1e-12, "sum of squares")


def ranks(verdicts, driver):
    alone = json.loads((driver.output / "blocks" / "summary.json").read_text())["steps"]
    for n in (2, 3):
        run = driver.run(driver.output / "blocks.yaml", *CONVERGED, ranks=n, label=f"blocks_{n}")
        for parameter in PARAMETERS:
            error = apart(results(run.steps, parameter), results(alone, parameter))
            verdicts.below(f"{n} ranks: derivatives by {parameter}", error, RANKS_BOUND, "one rank")


def restart(verdicts, driver):
    scene = blocks()
    scene["output"] = {**scene["output"], "restart_every": 3, "restart_keep": 0}
    path = write(scene, driver.output / "whole.yaml")
    whole = driver.run(path)
    again = driver.run(path, "-restart", str(whole.directory / "restart_3.bin"), label="again")
    same = [step["sensitivity"] for step in whole.steps] == [step["sensitivity"] for step in again.steps]
    verdicts.true("goes on from a restart file", same, "the same bits")


def refused(verdicts, driver):
    for name, change, words in (
        ("two", {"mu": {"friction": "contact", "young": "upper"}}, "a parameter is of one thing"),
        ("none", {"mu": {"deviation": 1}}, "what is it of?"),
        ("nobody", {"mu": {"friction": "nobody"}}, "there is no interface 'nobody'"),
        ("name", {"parameters": ["deviation"], "deviation": {"friction": "contact"}}, "something else that is called 'deviation'"),
        ("negative", {"mu": {"friction": "contact", "deviation": -1}}, "it must be at least 0"),
        ("condensed", {"unknowns": "displacements"}, "do not go with `unknowns: displacements` yet"),
        ("springs", {"springs": ["bed"], "bed": {"surface": "upper.zmax", "stiffness": [1, 1, 1]}}, "do not go with `springs` yet"),
        ("paper", {"method": "paper"}, "do not go with"),
    ):
        run = driver.run(write({**blocks(), **change}, driver.output / f"refused_{name}.yaml"), expect=1)
        verdicts.true(f"refused: {name}", words in run.text, run.text.strip().splitlines()[-1])


# Shipped scenes by their coarsest forms: of each what its parameters are, and how its key is changed.
SHIPPED = {
    "press_fit": (("-steps_times", "0.25,0.5,0.75,1,1.05,1.1,1.15,1.2"), {"mu": ("friction", "contact", 0.1, 1e-5), "soft": ("young", "slider", 1000.0, 0.1)}),
    "ironing_3d": (
        ("-die_file", str(SCENES.parent / "meshes" / "ironing_tube_coarse.msh"), "-slab_cells", "18,4,5", "-steps_stages", "1,14,1.2,8"),
        {"mu": ("friction", "contact", 0.3, 1e-5), "soft": ("young", "slab", 1.0, 1e-4)},
    ),
    "mindlin": ((), {"mu": ("friction", "contact", 0.3, 1e-4), "soft": ("young", "ball", 1000.0, 0.1)}),
}


def parameters_scenes(verdicts, driver):
    """Scenes that are shipped, with their own meshes and steps."""
    driver.output.mkdir(parents=True, exist_ok=True)
    for name, (options, wanted) in SHIPPED.items():
        text = (SCENES / f"{name}.yaml").read_text().replace("../meshes", str(SCENES.parent / "meshes"))
        asked = f"parameters: [{', '.join(wanted)}]\n" + "".join(f"{p}: {{{kind}: {of}}}\n" for p, (kind, of, *_) in wanted.items())
        path, plain = driver.output / f"{name}.yaml", driver.output / f"{name}_plain.yaml"
        path.write_text(text + asked)
        plain.write_text(text)
        run = driver.run(path, *options, *CONVERGED)
        for parameter, (kind, of, value, width) in wanted.items():
            slopes = differences(driver, plain, f"{name}_{parameter}", lambda v: (f"-{of}_{kind}", v), value, width, options)  # noqa: B023
            verdicts.below(f"{name}: derivatives by {parameter}", apart(results(run.steps, parameter), slopes), SLOPE_BOUND, "differences of runs")
