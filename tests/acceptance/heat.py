"""Heat: through bars and interfaces, of friction, over time, and of bodies that expand into each other."""

import numpy as np

from scene import write

# Linear cells and fields: rounding of the linear solvers and of Newton's method is left, over 80 degrees.
EXACT_BOUND = 1e-10
# Sums of the same numbers.
DISSIPATION_BOUND = 1e-12
# What friction makes and the supports take: what the linear solution leaves.
BALANCE_BOUND = 1e-10
# Solved in turns to 1e-9 of the temperatures' range; stresses and gaps are of that, over a gap of a tenth of the expansion.
TURNS_BOUND = 1e-7

HOT, COLD = 100.0, 20.0
PRESSURE, YOUNG = 10.0, 1000.0
CONDUCTIVITY = {"upper": 3.0, "lower": 7.0}


def heat(verdicts, driver):
    driver.output.mkdir(parents=True, exist_ok=True)
    bars(verdicts, driver)
    rubbing(verdicts, driver)
    over_time(verdicts, driver)
    expanding(verdicts, driver)
    growing(verdicts, driver)
    refused(verdicts, driver)


def two_bars(poisson=0.3, **interface):
    """A bar on another one whose mesh does not match, hot above and cold below."""
    box = {"type": "box", "young": YOUNG, "poisson": poisson, "small_strain": True}
    sides = ["upper", "lower"]
    return {
        "schema": 1,
        "bodies": sides,
        "upper": {**box, "lower": [0, 0, 0], "upper": [1, 1, 1], "cells": [3, 4, 2], "conductivity": CONDUCTIVITY["upper"]},
        "lower": {**box, "lower": [0, 0, -2], "upper": [1, 1, 0], "cells": [5, 3, 3], "conductivity": CONDUCTIVITY["lower"]},
        "supports": ["floor", "left", "front"],
        "floor": {"surface": "lower.zmin", "components": ["z"]},
        "left": {"surface": [f"{side}.xmin" for side in sides], "components": ["x"]},
        "front": {"surface": [f"{side}.ymin" for side in sides], "components": ["y"]},
        "loads": ["press"],
        "press": {"surface": "upper.zmax", "pressure": PRESSURE},
        "heat": {"initial": COLD},
        "temperatures": ["hot", "cold"],
        "hot": {"surface": "upper.zmax", "value": HOT},
        "cold": {"surface": "lower.zmin", "value": COLD},
        "interfaces": ["base"],
        "base": {"nonmortar": "upper.zmin", "mortar": "lower.zmax", "weights": "reference", **interface},
        "steps": {"count": 1},
        "output": {"vtu": "last", "csv": "last"},
    }


def check_bars(verdicts, what, run, conductance, exact_flux=None):
    flux = exact_flux or (HOT - COLD) / (1 / CONDUCTIVITY["upper"] + 1 / conductance + 2 / CONDUCTIVITY["lower"])
    points, _, _ = run.mesh()
    temperature, z = run.point_field("temperature").ravel(), points[:, 2]
    contact = np.isclose(z, 0)
    upper = HOT - flux / CONDUCTIVITY["upper"] * (1 - z)
    lower = COLD + flux / CONDUCTIVITY["lower"] * (z + 2)
    error = np.minimum(np.abs(temperature - upper), np.abs(temperature - lower))
    error[~contact] = np.abs(temperature - np.where(z > 0, upper, lower))[~contact]
    verdicts.below(f"{what}: temperatures", error.max() / (HOT - COLD), EXACT_BOUND, "closed form")
    of = run.steps[-1]["heat"]
    verdicts.near(f"{what}: heat through the interface", of["interfaces"]["base"]["across"] / flux, 1, EXACT_BOUND, "closed form")
    verdicts.near(f"{what}: heat in", of["supplied"]["hot"] / flux, 1, EXACT_BOUND, "closed form")
    verdicts.near(f"{what}: heat out", of["supplied"]["cold"] / flux, -1, EXACT_BOUND, "closed form")
    surface = run.interface("base")["temperature"]
    verdicts.below(f"{what}: temperatures of the CSV", np.abs(surface - (HOT - flux / CONDUCTIVITY["upper"])).max() / (HOT - COLD),
                   EXACT_BOUND, "closed form")


def bars(verdicts, driver):
    """A linear temperature through meshes that do not match, at conductances of the pressure and of the gap."""
    reference = 4.0
    for basis in ("standard", "dual"):
        scene = two_bars(basis=basis, conductance=2.0, conductance_pressure=reference, conductance_exponent=0.95)
        run = driver.run(write(scene, driver.output / f"pressure_{basis}.yaml"))
        check_bars(verdicts, f"conductance of the pressure, {basis}", run, 2.0 * (PRESSURE / reference) ** 0.95)
    both = {"conductance_constant": 0.5, "gap_conductivity": 0.3, "gap_distance": 0.1, "conductance_reach": 1.0}
    run = driver.run(write(two_bars(friction=0.3, **both), driver.output / "constant.yaml"))
    check_bars(verdicts, "constant conductance and gas, touching", run, 0.5 + 0.3 / 0.1)
    apart = two_bars(offset=0.2, **both)
    del apart["loads"], apart["press"]
    apart["supports"] = [*apart["supports"], "lid"]
    apart["lid"] = {"surface": "upper.zmax", "components": ["z"]}
    run = driver.run(write(apart, driver.output / "gap.yaml"))
    check_bars(verdicts, "over a gap", run, 0.5 + 0.3 / (0.2 + 0.1))
    nearly = {"conductance_constant": 1e4, "conductance_reach": 1.0}
    check_bars(verdicts, "nearly perfect", driver.run(write(two_bars(**nearly), driver.output / "perfect.yaml")), 1e4)
    tied = two_bars(law="tied", **nearly)
    check_bars(verdicts, "tied, nearly perfect", driver.run(write(tied, driver.output / "tied.yaml")), 1e4)
    scene = write(two_bars(**both), driver.output / "ranks.yaml")
    check_bars(verdicts, "two ranks", driver.run(scene, ranks=2), 0.5 + 0.3 / 0.1)


def rubbing(verdicts, driver):
    """A block that is drawn over another one: what friction makes is what the supports take."""
    for share, duration in ((0.5, 1.0), (0.2, 0.25)):
        scene = two_bars(friction=0.3, conductance_constant=2.0, conductance_reach=0.1, friction_heat=share, weights="current",
                         lag_max=1)  # as many steps as are asked for
        scene["left"]["surface"] = "lower.xmin"
        scene["supports"].append("drag")
        scene["drag"] = {"surface": "upper.zmax", "components": ["x"], "value": [0.2, 0, 0]}
        scene["hot"]["value"] = COLD
        scene["steps"] = {"count": 2, "end": duration}
        for name in ("press", "hot", "cold"):
            scene[name]["curve"] = [0, 1, duration, 1]
        scene["drag"]["curve"] = [0, 0, duration, 1]
        run = driver.run(write(scene, driver.output / f"rubbing_{share}.yaml"))
        work = [0.0, *(step["friction_work"] for step in run.steps)]
        for k, step in enumerate(run.steps):
            made = step["heat"]["interfaces"]["base"]["friction"]
            spent = (work[k + 1] - work[k]) / (duration / len(run.steps))
            what = f"rubbing, share {share}, step {k + 1}"
            verdicts.near(f"{what}: heat over work", made / spent, 1, DISSIPATION_BOUND, "the dissipation")
            taken = -sum(step["heat"]["supplied"].values())
            verdicts.near(f"{what}: heat out over heat made", taken / made, 1, BALANCE_BOUND, "conserved")
        verdicts.at_least(f"rubbing, share {share}: heat", run.steps[-1]["heat"]["interfaces"]["base"]["friction"], 0.1, "it slides")


def over_time(verdicts, driver):
    """One cell, heated from above: two temperatures by the implicit Euler method."""
    conductivity, capacity, flow, steps = 2.0, 5.0, 30.0, 4
    scene = {
        "schema": 1,
        "bodies": ["cube", "other"],
        "cube": {"type": "box", "lower": [0, 0, 0], "upper": [1, 1, 1], "cells": [1, 1, 1], "young": YOUNG, "poisson": 0,
                 "small_strain": True, "conductivity": conductivity, "heat_capacity": capacity},
        "other": {"type": "box", "lower": [0, 0, -1], "upper": [1, 1, 0], "cells": [1, 1, 1], "young": YOUNG, "poisson": 0,
                  "small_strain": True},
        "supports": ["top", "ground"],
        "top": {"surface": "cube.zmax", "components": ["x", "y", "z"]},
        "ground": {"surface": "other.zmin", "components": ["x", "y", "z"]},
        "heat": {"initial": COLD},
        "flows": ["burner"],
        "burner": {"surface": "cube.zmax", "flow": flow, "curve": [0, 1, 1, 1]},
        "interfaces": ["base"],
        "base": {"nonmortar": "cube.zmin", "mortar": "other.zmax", "friction": 0},
        "probes": ["above", "below", "there"],
        "above": {"body": "cube", "point": [0, 0, 1]},
        "below": {"body": "cube", "point": [0, 0, 0]},
        "there": {"body": "other", "point": [0, 0, 0]},
        "steps": {"count": steps},
    }
    run = driver.run(write(scene, driver.output / "over_time.yaml"))
    dt, t = 1 / steps, np.full(2, COLD)
    conduct = conductivity * np.array([[1, -1], [-1, 1]])
    store = capacity / dt * np.array([[1 / 3, 1 / 6], [1 / 6, 1 / 3]])
    for k, step in enumerate(run.steps):
        t = np.linalg.solve(conduct + store, store @ t + np.array([flow, 0]))
        found = step["heat"]["probes"]
        error = max(abs(found["above"] - t[0]), abs(found["below"] - t[1])) / flow
        verdicts.below(f"heating, step {k + 1}: temperatures", error, EXACT_BOUND, "implicit Euler")
    verdicts.near("heating: a body without conductivity", found["there"], COLD, 0, "as it was")
    verdicts.near("heating: the mean", (t.mean() - COLD) * capacity / flow, 1, EXACT_BOUND, "all that came in")


def expanding(verdicts, driver):
    """Bars between two walls that are warmed until they touch: heat closes the gap, and the pressure lets heat through."""
    gap, expansion, reference = 0.01, 1e-3, 20.0
    scene = two_bars(poisson=0, offset=gap, conductance=2.0, conductance_pressure=reference, conductance_exponent=0.95,
                     conductance_constant=0.5, conductance_reach=1.0)
    scene["heat"]["coupling"] = "two_way"
    del scene["loads"], scene["press"]
    sides = ["upper", "lower"]
    scene["supports"] = ["floor", "lid", "x", "y"]
    scene["lid"] = {"surface": "upper.zmax", "components": ["z"]}
    scene["x"] = {"surface": [f"{s}.{face}" for s in sides for face in ("xmin", "xmax")], "components": ["x"]}
    scene["y"] = {"surface": [f"{s}.{face}" for s in sides for face in ("ymin", "ymax")], "components": ["y"]}
    del scene["left"], scene["front"]
    for side in sides:
        scene[side]["expansion"] = expansion

    def flux_at(pressure):
        h = 0.5 + 2.0 * (pressure / reference) ** 0.95
        return (HOT - COLD) / (1 / CONDUCTIVITY["upper"] + 1 / h + 2 / CONDUCTIVITY["lower"])

    def closes(pressure):
        """How much more the bars expand than fits at this pressure."""
        flux = flux_at(pressure)
        upper, lower = HOT - flux / CONDUCTIVITY["upper"] / 2 - COLD, flux / CONDUCTIVITY["lower"]
        return expansion * (upper + 2 * lower) - gap - pressure * 3 / YOUNG

    low, high = 1e-3, YOUNG
    for _ in range(200):
        middle = (low + high) / 2
        low, high = (middle, high) if closes(middle) > 0 else (low, middle)
    flux = flux_at(low)
    for ranks in (1, 2):
        run = driver.run(write(scene, driver.output / f"expanding_{ranks}.yaml"), ranks=ranks)
        what = f"expanding bars, {ranks} ranks"
        found = run.steps[-1]
        verdicts.near(f"{what}: heat", found["heat"]["interfaces"]["base"]["across"] / flux, 1, TURNS_BOUND, "closed form")
        verdicts.near(f"{what}: pressure", -found["interfaces"]["base"]["force"][2] / low, -1, TURNS_BOUND, "closed form")
        verdicts.at_least(f"{what}: turns", found["heat"]["turns"], 2, "they settle")


def first_piola(law, theta, stretch, young, poisson):
    """P along each axis of a body that would have the length theta, and has `stretch`: theta^2 P_e(F / theta)."""
    shear = young / (2 * (1 + poisson))
    lame = 2 * shear * poisson / (1 - 2 * poisson)
    e = np.array(stretch) / theta
    if law == "neo_hooke":
        return theta**2 * (shear * (e - 1 / e) + lame * np.log(e.prod()) / e)
    green = (e**2 - 1) / 2
    return theta**2 * e * (2 * shear * green + lame * green.sum())


# A body that is warmed by 200 and would grow by a tenth: what is held, in the axes x, y, z.
WARM_SPACES = {
    "solid": ("solid", "hex"), "solid, tet10": ("solid", "tet10"), "plane strain": ("plane_strain", "quad"), "plane stress": ("plane_stress", "quad"),
    "a ring": ("axisymmetric", "quad9"),
}


def growing(verdicts, driver):
    """Finite strain: what is free grows without stress; held all round, or along its length, it has the closed form's."""
    grown, young, poisson = 1.1, 1000.0, 0.3
    for law in ("neo_hooke", "st_venant_kirchhoff"):
        for name, (model, cell) in WARM_SPACES.items():
            d = 3 if model == "solid" else 2
            along = "xyz"[d - 1]
            for dilatation in ("pointwise", "mean")[: 1 if model == "plane_stress" else 2]:
                for held in ("free", "along", "all round"):
                    what = f"growing, {law}, {name}, {dilatation}, {held}"
                    held_axes = {"free": "", "along": along, "all round": "xyz"[:d]}[held]
                    if model == "axisymmetric" and held == "all round":
                        continue
                    symmetric = [axis for axis in "xyz"[:d] if not (model == "axisymmetric" and axis == "x")]
                    scene = {"schema": 1, "model": model, "bodies": ["body"], "heat": {"initial": 20, "coupling": "two_way"},
                             "body": {"type": "box", "lower": [0] * d, "upper": [1] * d, "cells": [2] * d, "cell": cell, "young": young, "poisson": poisson, "material": law,
                                      "dilatation": dilatation, "conductivity": 1, "expansion": (grown - 1) / 200},
                             "temperatures": ["warm"], "warm": {"surface": [f"body.{along}min", f"body.{along}max"], "value": 220},
                             "supports": [f"low{axis}" for axis in symmetric] + [f"high{axis}" for axis in held_axes], "steps": {"count": 2},
                             "probes": ["corner"], "corner": {"body": "body", "point": [1] * d}, "output": {"vtu": "last", "csv": "none"}}
                    for axis in symmetric:
                        scene[f"low{axis}"] = {"surface": f"body.{axis}min", "components": [axis]}
                    for axis in held_axes:
                        scene[f"high{axis}"] = {"surface": f"body.{axis}max", "components": [axis]}
                    result = driver.run(write(scene, driver.output / "growing.yaml"), label=what.replace(" ", "_").replace(",", ""),
                                        ranks=2 if name == "solid" else 1)
                    stretch = [grown if axis not in held_axes else 1.0 for axis in "xyz"]
                    if model == "plane_strain":
                        stretch[2] = 1.0
                    free = [k for k, axis in enumerate("xyz") if axis not in held_axes and not (model == "plane_strain" and k == 2)]
                    low, high = 0.5, 2.0
                    for _ in range(200):  # the stretch of what is free, in all its directions
                        middle = (low + high) / 2
                        for k in free:
                            stretch[k] = middle
                        low, high = (middle, high) if free and first_piola(law, grown, stretch, young, poisson)[free[0]] < 0 else (low, middle)
                    there = np.array(result.steps[-1]["probes"]["corner"])[:d]
                    verdicts.below(f"{what}: places", np.abs(there - (np.array(stretch)[:d] - 1)).max(), TURNS_BOUND, "closed form")
                    area = np.pi if model == "axisymmetric" else 1  # reactions are of the undeformed face, with P
                    for axis in held_axes:
                        k = "xyz".index(axis)
                        force = result.steps[-1]["reactions"][f"high{axis}"][k]
                        verdicts.near(f"{what}: force along {axis}", force / (first_piola(law, grown, stretch, young, poisson)[k] * area), 1, TURNS_BOUND, "closed form")


def refused(verdicts, driver):
    """What determines no temperature is said; wrong keys are named."""
    loose = two_bars()
    loose["temperatures"] = ["cold"]
    del loose["hot"]
    run = driver.run(write(loose, driver.output / "loose.yaml"), expect=None)
    verdicts.true("a body that nothing warms is refused", run.exit_code == 2 and "heat: the temperatures are not determined" in run.text,
                  "the upper bar has no temperature")

    def refuses(what, changes, says, exit_code=1):
        scene = two_bars(conductance_constant=0.5, conductance_reach=1.0)
        for name, values in changes.items():
            scene[name] = {**scene[name], **values} if name in scene and isinstance(values, dict) else values
        done = driver.run(write(scene, driver.output / "refused.yaml"), label="refused", expect=None)
        verdicts.true(f"refused, {what}", done.exit_code == exit_code and says in done.text and "PETSC ERROR" not in done.text,
                      f"exit code {exit_code}: {says}")

    edge = {"surface": "upper.xmax", "value": 90}
    for order in (["side", "hot", "cold"], ["hot", "side", "cold"]):
        refuses("two temperatures at an edge", {"temperatures": order, "side": edge}, "is prescribed differently by")
    refuses("two curves at an edge", {"temperatures": ["hot", "side", "cold"], "side": {**edge, "value": HOT, "curve": [0, 0, 0.5, 1]}},
            "is prescribed differently by 'hot'")
    for ranks in (1, 2):
        same = two_bars(conductance_constant=0.5, conductance_reach=1.0)
        same.update(temperatures=["hot", "also", "cold"], also={"surface": "upper.zmax", "value": HOT, "curve": [0, 0, 0.5, 0.5, 1, 1]})
        run = driver.run(write(same, driver.output / "same.yaml"), ranks=ranks)
        flux = (HOT - COLD) / (1 / CONDUCTIVITY["upper"] + 1 / 0.5 + 2 / CONDUCTIVITY["lower"])
        verdicts.near(f"two temperatures that say the same, {ranks} ranks", sum(run.steps[-1]["heat"]["supplied"][k] for k in ("hot", "also")) / flux,
                      1, EXACT_BOUND, "closed form")
    huge = {"base": {"conductance": 1e308, "conductance_pressure": 1e-3}}
    refuses("a conductance that overflows", huge, "refused by the library: ", 3)
    refuses("a conductance that overflows, of which step", huge, "That is the heat of the step from t = 0", 3)
