"""The other exact tests: a table of each."""

import numpy as np

import carter
import gears
import nafems_punch
import punches
import self_similar

KINDS = {"standard": {"basis": "standard"}, "dual": {}, "points": {"decision": "points"}}


def per_cent(errors):
    errors = 100 * np.abs(errors)
    return f"{errors.mean():.2f} ({errors.max():.2f})"


# --- a punch that slides ----------------------------------------------------------------------------------------------
FRICTIONS = (0.2, 0.5, 1.0)
# Facets over the half-width, and how often the outermost is halved.
SLIDING = ((10, 0), (20, 0), (40, 0), (10, 4), (20, 4))


def sliding(driver):
    head = ["element", "facets", "halved at the edges", *(f"p(0), mu = {mu:g}" for mu in FRICTIONS), *(f"p(a/2) / p(-a/2), mu = {mu:g}" for mu in FRICTIONS), "seconds"]
    body = []
    for name in ("dual", "points"):
        for facets, halved in SLIDING:
            middle, ratio = [], []
            for mu in FRICTIONS:
                punch = punches.Sliding(mu)
                run = driver.run(punch.scene(driver.output, facets, halved, **KINDS[name]), label=f"sliding_{mu:g}_{facets}_{halved}_{name}")
                x, found, exact, _ = punch.pressures(run)
                at = lambda values, place: values[np.argmin(np.abs(x - place))]
                middle.append(at(found, 0) / at(exact, 0) - 1)
                ratio.append(at(found, 0.5) / at(found, -0.5) * at(exact, -0.5) / at(exact, 0.5) - 1)
            body.append([name, str(facets), str(halved), *(f"{100 * v:.2f}" for v in middle + ratio), f"{run.summary['seconds']['total']:.2f}"])
    return head, body


# --- a rounded punch --------------------------------------------------------------------------------------------------
FLATS, ROUNDED = (0.5, 0.9), (5, 10, 20)


def rounded(driver):
    head = ["b/a", "element", *(f"load, {n} facets" for n in ROUNDED), *(f"pressure, {n} facets" for n in ROUNDED), "seconds"]
    body = []
    for flat in FLATS:
        for name, options in KINDS.items():
            loads, pressures = [], []
            for facets in ROUNDED:
                runs = [driver.run(punches.rounded_scene(driver.output, flat, n, **options), label=f"rounded_{flat:g}_{n:g}_{name}")
                        for n in punches.positions(facets)]
                loads.append(per_cent([punches.rounded_load(run, flat) - 1 for run in runs]))
                pressures.append(per_cent([punches.relative(*punches.rounded_pressures(run, flat)[1:]) for run in runs]))
            body.append([f"{flat:g}", name, *loads, *pressures, f"{np.median([run.summary['seconds']['total'] for run in runs]):.2f}"])
    return head, body


# --- NAFEMS 2 ---------------------------------------------------------------------------------------------------------
NAFEMS = (("quad", 2), ("quad", 1), ("quad", 0.5), ("quad", 0.25), ("quad8", 1), ("quad8", 0.5), ("quad8", 0.25))


def nafems(driver):
    head = ["friction", "cells", "facet at the edge", "u_y", "over published - 1", "sigma_yy", "over published - 1", "pressure there", "seconds"]
    body = []
    for mu, (way, stress) in nafems_punch.PUBLISHED.items():
        for cell, facet in NAFEMS:
            run = driver.run(nafems_punch.scene(driver.output, facet, mu, cell), label=f"nafems_{mu:g}_{cell}_{facet:g}")
            u, s = nafems_punch.middle(run)
            pressure = run.interface(nafems_punch.NAME)["p_lumped"][run.interface(nafems_punch.NAME)["X"].argmin()]
            body.append([f"{mu:g}", cell, f"{facet:g}", f"{u:.6f}", f"{100 * (u / way - 1):.2f} %", f"{s:.2f}", f"{100 * (s / stress - 1):.1f} %",
                         f"{pressure:.2f}", f"{run.summary['seconds']['total']:.2f}"])
    return head, body


# --- Spence -----------------------------------------------------------------------------------------------------------
BALLS, STEPS, FACETS = (0.1, 0.2, 0.3), (2, 10, 50, 200), 30
# Of the formula that neglects what shear does to pressure.
STICKS = {0.1: 0.2240, 0.2: 0.7334, 0.3: 0.9186}


def spence_runs(driver):
    """{(mu, steps): [(contact radius, stick radius) of ten loads, those that the steps meet]}"""
    found = {}
    for mu in BALLS:
        for steps in STEPS:
            run = driver.run(self_similar.scene(driver.output, FACETS, mu, steps), label=f"spence_{mu:g}_{steps}")
            found[mu, steps] = self_similar.at_loads(run), run.summary["seconds"]["processor"]
    return found


def spence(found):
    head = ["friction", "steps", "c/a at the last load", "least and largest of ten loads", "largest c - its mean part of a, in facets", "formula", "seconds"]
    body = []
    for (mu, steps), (radii, seconds) in found.items():
        ratio = radii[:, 1] / radii[:, 0]
        off = np.abs(radii[:, 1] - radii[:, 1].sum() / radii[:, 0].sum() * radii[:, 0]).max() * FACETS
        loads = f"{ratio.min():.3f}, {ratio.max():.3f}" if len(radii) > 2 else "-"
        body.append([f"{mu:g}", str(steps), f"{ratio[-1]:.3f}", loads, f"{off:.2f}" if len(radii) > 2 else "-", f"{STICKS[mu]:.3f}", f"{seconds:.1f}"])
    return head, body


# --- Carter -----------------------------------------------------------------------------------------------------------
ROLLING = ((5, 40), (5, 80), (5, 160), (10, 80), (10, 160))
SHARES = (0.25, 0.5, 0.75)


def rolling(driver):
    head = ["facets", "steps a facet", *(f"creepage, Q / (mu P) = {q:g}" for q in SHARES), *(f"end of stick, {q:g}" for q in SHARES), "seconds"]
    body = []
    for facets, steps in ROLLING:
        creepages, ends = [], []
        for share in SHARES:
            run = driver.run(carter.scene(driver.output, facets, share, steps), label=f"carter_{facets}_{steps}_{share:g}")
            creepages.append(f"{carter.steady(run)[3].mean():.3f}")
            ends.append(f"{carter.end_of_stick(run) * facets:.2f}")
        body.append([str(facets), f"{steps / (facets * carter.WAY):g}", *creepages, *ends, f"{run.summary['seconds']['total']:.0f}"])
    return head, body


# --- gears ------------------------------------------------------------------------------------------------------------
SUB, DECIDED = {"multiplier_space": "sub"}, {"decision": "points"}
GEARS = (("quad", 12, "dual", {}), ("quad", 24, "dual", {}), ("quad", 48, "dual", {}), ("quad", 12, "points", DECIDED), ("quad", 24, "points", DECIDED),
         ("quad", 24, "points, a fifth of the load", {**DECIDED, "back": gears.BACK / 5}), ("quad8", 6, "corner, dual", {}),
         ("quad8", 12, "corner, dual", {}), ("quad8", 6, "sub", SUB), ("quad8", 12, "sub", SUB))
ANGLES = 20


def gear_runs(driver):
    for cell, flank, name, options in GEARS:
        run = driver.run(gears.scene(driver.output, flank, ANGLES, cell, **options), label=f"gears_{cell}_{flank}_{name.replace(', ', '_').replace(' ', '_')}")
        yield cell, flank, name, gears.torques(run), run.summary["seconds"]["processor"]


def gear_table(runs):
    head = ["cells", "facets of a flank", "element", "least T_A / T_B", "largest", "half of the angles within", "four fifths within", "largest error", "seconds"]
    body = []
    for cell, flank, name, torques, seconds in runs:
        ratio = torques[:, 1]
        errors = 100 * np.abs(ratio / gears.RATIO - 1)
        body.append([cell, str(flank), name, f"{ratio.min():.4f}", f"{ratio.max():.4f}", *(f"{np.quantile(errors, part):.2f} %" for part in (0.5, 0.8, 1)), f"{seconds:.0f}"])
    return head, body
