#!/usr/bin/env python3
"""CalculiX with contact pairs of stickslip (build.py), compared with its own contact, formulas and the driver.

    check.py --program ccx_stickslip --driver stickslip --out FOLDER
"""

import argparse
import os
import re
import subprocess
import sys
from pathlib import Path

import meshio
import numpy as np
from decks import CONTROLS, SAME, Deck, box, grid, quadratic, shell_on_block, tetrahedra, wedges

ROOT = Path(__file__).resolve().parents[2]
SCENE = ROOT / "c_examples/scenes/two_blocks.yaml"
# The driver's problem of hosts/check.py: a coarse mesh, and a way along which some nodes stick and others slip.
DRIVER = ["-upper_cells", "4,4,4", "-lower_cells", "5,5,4", "-grip_value", "0.002,0.0008,-0.005", "-steps_count", "4",
          "-steps_predictor", "false", "-snes_linesearch_type", "basic", "-output_vtu", "all"]
GRIP = (0.002, 0.0008, -0.005)
# CalculiX counts forces below 1e-6 as none: in this unit of forces that is nothing.
UNIT = 1e9
# Of the pressure. 1e-14 is measured.
PATCH = 1e-12
# The same after a step in which the blocks were apart for some iterations: what the tolerance of contact, 1e-10, leaves. 1e-11 is measured.
UNLOADED = 1e-10
# Of the largest displacement and multiplier. 2e-12 is measured.
FRICTION = 1e-7
# The forces of both sides together, over the normal force.
FORCES = 1e-14
# Of the largest force, between a run with cut-backs and one without. 4e-14 is measured.
CUTS = 1e-10
# What the meshes are worth: 0.5 % and 0.03 % are measured.
HERTZ = RING = 0.01
STRIPPED = {"OMP_NUM_THREADS": "1"}
failed = []


def judge(what, value, bound):
    print(f"{'ok    ' if value <= bound else 'FAILED'}  CalculiX, {what}: {value:.1e}, at most {bound:.0e}", flush=True)
    if not value <= bound:
        failed.append(what)


class Run:
    """CalculiX on a deck; what it printed and wrote."""

    def __init__(self, program, folder, deck):
        """deck: a Deck, or its text."""
        folder.mkdir(parents=True, exist_ok=True)
        for old in folder.glob("job.*"):
            old.unlink()
        (folder / "job.inp").write_text(deck if isinstance(deck, str) else deck.text())
        done = subprocess.run([program, "job"], cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                              errors="replace", env={**os.environ, **STRIPPED})
        self.folder, self.said, self.code = folder, done.stdout, done.returncode
        (folder / "log").write_text(done.stdout)

    def finished(self):
        if self.code:
            raise SystemExit(f"FAILED  CalculiX ends with code {self.code} in {self.folder}\n{self.said[-2000:]}")
        return self

    def nodes(self, increment=-1):
        """Rows of an increment, the last one, in job.stickslip: pair, side, node, X, u, force on the node, lambda, gap, state."""
        text = (self.folder / "job.stickslip").read_text().split("increment ")[1:][increment]
        rows = [line.split() for line in text.splitlines()[1:]]
        return np.array([[*map(float, row), *[np.nan] * (17 - len(row))] for row in rows])

    def total(self, name):
        """The last total that *NODE PRINT, TOTALS=ONLY prints of a set, three components."""
        found = re.findall(rf"total force.*for set {name} .*\n\s*\n(.*)\n", (self.folder / "job.dat").read_text())
        return np.array(found[-1].split(), float)

    def displacements(self, name):
        """Node: displacement, the last table of a set."""
        found = re.findall(rf"displacements.*for set {name} .*\n\s*\n((?:\s+\d.*\n)+)", (self.folder / "job.dat").read_text())
        rows = [line.split() for line in found[-1].splitlines()]
        return {int(row[0]): np.array(row[1:], float) for row in rows}

    def attempts(self):
        """(step, attempt, end in the step's time) of what went; CalculiX marks what did not by a U."""
        found = re.findall(r"^ +(\d+) +\d+ +(\d+) +\d+ +\S+ +(\S+) ", (self.folder / "job.sta").read_text(), re.MULTILINE)
        return [(int(number), int(attempt), float(end)) for number, attempt, end in found]

    def states(self):
        found = re.findall(r"stickslip: pair \d+ gap (\d+) stick (\d+) slip (\d+)", self.said)
        return [tuple(map(int, words)) for words in found]


def level(height):
    return lambda x, y, z: abs(z - height) < SAME


def step(deck, *lines, nlgeom=False, increments="1., 1.", direct=False):
    deck.steps.append("\n".join([f"*STEP, INC=1000{', NLGEOM' if nlgeom else ''}", f"*STATIC{', DIRECT' if direct else ''}", increments,
                                 CONTROLS, *lines, "*END STEP"]))


def two_blocks(make, poisson, inset, contact="TYPE=STICKSLIP", interaction="*FRICTION\n0.3, 1000."):
    upper = make(box((inset, inset, 0.8), (1 - inset, 1 - inset, 1.6), (4, 4, 4)))
    lower = make(box((0, 0, 0), (1, 1, 0.8), (5, 5, 4)))
    bodies = [(upper, f"*ELASTIC\n{1000 * UNIT}, {poisson}"), (lower, f"*ELASTIC\n{2000 * UNIT}, {poisson}")]
    return Deck(bodies, [((0, level(0.8)), (1, level(0.8)))], contact, interaction, [])


def gripped(deck, grip):
    top = [deck.fixed(0, level(1.6), c + 1, value) for c, value in enumerate(grip)]
    return "\n".join(["*BOUNDARY", *top, *(deck.fixed(1, level(0), c) for c in (1, 2, 3))])


def column_pressure(nlgeom):
    """Two columns of height 0.8, moduli 1000 and 2000, together 0.005 shorter. With NLGEOM the second Piola-Kirchhoff stress is
    E times Green's strain, so that a stretch s needs the force s E (1 - s^2) / 2 on the area, which stays."""
    if not nlgeom:
        return 0.005 / (0.8 / 1000 + 0.8 / 2000)

    def stretch(p, young):
        s = 1.0
        for _ in range(50):
            s -= (s * young * (1 - s * s) / 2 - p) / (young * (1 - 3 * s * s) / 2)
        return s

    low, high = 0.0, 10.0
    for _ in range(100):
        p = (low + high) / 2
        shorter = sum(0.8 * (1 - stretch(p, young)) for young in (1000.0, 2000.0))
        low, high = (p, high) if shorter < 0.005 else (low, p)
    return low


def patch(program, out):
    kinds = {"C3D8": lambda m: m, "C3D4": tetrahedra, "C3D20": quadratic, "C3D10": lambda m: quadratic(tetrahedra(m)),
             "C3D6": wedges, "C3D15": lambda m: quadratic(wedges(m))}
    for name, make in kinds.items():
        for nlgeom in (False, True):
            deck = two_blocks(make, 0, 0)
            step(deck, gripped(deck, (0, 0, -0.005)), "*NODE FILE\nU", nlgeom=nlgeom)
            run = Run(program, out / f"patch_{name}_{nlgeom}", deck).finished()
            rows, pressure = run.nodes(), column_pressure(nlgeom)
            multipliers = rows[rows[:, 1] == 1][:, 12:15] / UNIT
            multipliers = multipliers[~np.isnan(multipliers[:, 0])]
            error = np.abs(multipliers + [0, 0, pressure]).max() / pressure
            judge(f"patch test, {name}{', NLGEOM' if nlgeom else ''}: multipliers", error, PATCH)
    # In the .frd, with the digits that it has: the pressure of every node of the slave surface.
    frd = (out / "patch_C3D8_False/job.frd").read_text().split("STICKSLI")[1].split(" -3")[0]
    pressures = [float(line[25:37]) for line in frd.splitlines() if line.startswith(" -1")]
    judge("patch test: pressures in the .frd", np.abs(np.array(pressures) / UNIT / column_pressure(False) - 1).max() + abs(len(pressures) - 25), 1e-5)
    deck = two_blocks(lambda m: m, 0, 0, "TYPE=SURFACE TO SURFACE", f"*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n{1e6 * UNIT}, 0.")
    step(deck, gripped(deck, (0, 0, -0.005)), "*NODE PRINT, NSET=N1, TOTALS=ONLY\nRF", nlgeom=True)
    reaction = Run(program, out / "patch_own", deck).finished().total("N1")[2] / UNIT
    print(f"        its own contact (surface to surface, penalty 1e6) on the same patch, NLGEOM: {reaction:.4f}, right {column_pressure(True):.4f}")


def shells(program, out):
    pressure = 4 * UNIT
    for kind in ("S4", "S8R"):
        rows = Run(program, out / f"shell_{kind}", shell_on_block(kind, UNIT, pressure)).finished().nodes()
        multipliers = rows[(rows[:, 1] == 1) & ~np.isnan(rows[:, 12])][:, 12:15]
        judge(f"a plate of {kind} under pressure: multipliers", np.abs(multipliers / pressure + [0, 0, 1]).max() + abs(len(multipliers) - 25), PATCH)


def friction(program, driver, out):
    """Four increments in two steps, against the driver's four."""
    deck = two_blocks(lambda m: m, 0.3, 0.1)
    for part in (0.5, 1.0):
        step(deck, gripped(deck, [part * value for value in GRIP]), increments=".5, 1.", direct=True)
    run = Run(program, out / "friction", deck).finished()
    printed = subprocess.run([driver, "-scene", SCENE, "-output_dir", out / "driver", *DRIVER], stdout=subprocess.PIPE, text=True, check=True)
    counts = [tuple(map(int, words)) for words in re.findall(r"contact +(\d+) gap +(\d+) stick +(\d+) slip", printed.stdout)]
    mesh = meshio.read(out / "driver/step_4.vtu")
    rows, displacements = run.nodes(), mesh.point_data["displacement"]
    multipliers = mesh.point_data["multiplier_contact"]
    worst = {"displacements": 0.0, "multipliers": 0.0}
    for row in rows:
        near = np.flatnonzero(np.abs(mesh.points - row[3:6]).max(axis=1) < SAME)
        worst["displacements"] = max(worst["displacements"], np.abs(displacements[near] - row[6:9]).max(axis=1).min())
        if row[1] == 1:
            worst["multipliers"] = max(worst["multipliers"], np.abs(multipliers[near] - row[12:15] / UNIT).max(axis=1).min())
    assert len(rows) == 25 + 36
    judge("friction: displacements against the driver", worst["displacements"] / np.abs(displacements).max(), FRICTION)
    judge("friction: multipliers against the driver", worst["multipliers"] / np.abs(multipliers).max(), FRICTION)
    print(f"        gap, stick, slip: {run.states()}; of the driver {counts}")
    judge("friction: increments with other states", float(sum(a != b for a, b in zip(run.states(), counts)) + abs(len(run.states()) - 4)), 0)


def turning(program, out):
    """Pressed, then turned by half a radian in one increment: the library takes 20 degrees from one commit to the next at most, so
    CalculiX has to cut. The increments that went, each given as a step of its own, must lead to the same forces."""
    def turned(deck, angle):
        def way(x, y, z):
            return (x - 0.5) * (np.cos(angle) - 1) - (y - 0.5) * np.sin(angle), (x - 0.5) * np.sin(angle) + (y - 0.5) * (np.cos(angle) - 1), -0.005

        return [lambda *place, c=c: way(*place)[c] for c in range(3)]

    def solved(name, fractions):
        deck = two_blocks(lambda m: m, 0.3, 0.3)
        step(deck, gripped(deck, (0, 0, -0.005)), nlgeom=True)
        full = turned(deck, 0.5)
        for part in fractions:
            ways = [lambda *place, c=c, part=part: part * full[c](*place) for c in (0, 1)]
            step(deck, gripped(deck, (*ways, -0.005)), nlgeom=True)
        return Run(program, out / f"turning_{name}", deck).finished()

    run = solved("cut", [1.0])
    went = [(attempt, end) for number, attempt, end in run.attempts() if number == 2]
    fractions = [end for _, end in went]
    print(f"        turning: (attempt, end) of each increment {went}")
    judge("turning: runs without a cut-back", float(max(attempt for attempt, _ in went) < 2), 0)
    rows, other = run.nodes(), solved("given", fractions).nodes()
    slave, master = (rows[rows[:, 1] == side][:, 9:12] for side in (1, 2))
    normal = slave[:, 2].sum()
    judge("turning: forces of both sides", np.abs(slave.sum(axis=0) + master.sum(axis=0)).max() / normal, FORCES)
    judge("turning: forces against those without cut-backs", np.abs(rows[:, 9:12] - other[:, 9:12]).max() / np.abs(rows[:, 9:12]).max(), CUTS)


def hertz(program, out):
    """A cylinder of radius 8 on a flat body of the same material, plane strain, half of it: the pressure over that of Hertz for
    the force that is found."""
    radius, width, thickness, young, poisson, fine = 8.0, 4.0, 0.05, 200.0, 0.3, 0.45

    def along(s):  # two thirds of the facets within `fine`
        return 1.5 * s * fine if s <= 2 / 3 else fine + (width - fine) * (3 * s - 2) ** 2

    def cylinder(s, t, u):
        x = along(s)
        low = radius - np.sqrt(radius**2 - x * x)
        return x, thickness * t, low + (radius - low) * u**3

    flat = grid((24, 1, 8), lambda s, t, u: (2 * along(s), thickness * t, -8 * (1 - u) ** 3))
    upper = grid((36, 1, 8), cylinder)

    def arc(ends, middle):
        on = np.abs(radius - np.sqrt(radius**2 - ends[:, 0] ** 2) - ends[:, 2]).max() < SAME
        return np.array([middle[0], middle[1], radius - np.sqrt(radius**2 - middle[0] ** 2)]) if on else middle

    bodies = [(quadratic(upper, arc), f"*ELASTIC\n{young}, {poisson}"), (quadratic(flat), f"*ELASTIC\n{young}, {poisson}")]

    def bottom(x, y, z):
        return x < width + SAME and abs(radius - np.sqrt(max(radius**2 - x * x, 0)) - z) < SAME

    deck = Deck(bodies, [((0, bottom), (1, level(0)))], "TYPE=STICKSLIP", "*FRICTION\n1.E-9, 1.", [], suffix="")
    anywhere, middle = (lambda *_: True), (lambda x, y, z: x < SAME)
    fixed = ["*BOUNDARY", *(deck.fixed(k, where, c) for k in (0, 1) for where, c in ((anywhere, 2), (middle, 1))), deck.fixed(1, level(-8), 3)]
    step(deck, *fixed, deck.fixed(0, level(radius), 3, -0.02), increments=".25, 1.")
    rows = Run(program, out / "hertz", deck).finished().nodes()
    slave = rows[(rows[:, 1] == 1)]
    force = 2 * slave[:, 11].sum() / thickness  # of both halves, a unit of length
    modulus = young / (2 * (1 - poisson**2))
    half = np.sqrt(4 * force * radius / (np.pi * modulus))
    peak = 2 * force / (np.pi * half)
    x, pressure = slave[:, 3] + slave[:, 6], -slave[:, 14]
    inside = (x < 0.8 * half) & ~np.isnan(pressure)
    error = np.abs(pressure[inside] - peak * np.sqrt(1 - (x[inside] / half) ** 2)).max() / peak
    print(f"        Hertz: force {force:.5f}, half-width {half:.4f}, {inside.sum()} nodes within 0.8 of it, peak {peak:.4f}, "
          f"found {pressure[inside].max():.4f}")
    judge("Hertz: pressures over the peak", error, HERTZ)


def ring(program, out):
    """A ring that is heated in a hub of plastic material, a quarter, plane strain: against CalculiX' own contact on a finer mesh."""
    bore, fit, outside, thickness = 5.0, 10.0, 20.0, 0.5
    elastic = "*ELASTIC\n200000., 0.3"
    hot, plastic = elastic + "\n*EXPANSION, ZERO=0.\n1.E-5", elastic + "\n*PLASTIC\n300., 0.\n500., 0.1"

    def sector(inner, outer, cells):
        def place(s, t, u):
            r, angle = inner + (outer - inner) * s, np.pi / 2 * t
            return r * np.cos(angle), r * np.sin(angle), thickness * u

        def curved(ends, middle):
            r = np.hypot(ends[:, 0], ends[:, 1])
            return middle * [*[r.mean() / np.hypot(*middle[:2])] * 2, 1] if np.ptp(r) < SAME else middle

        return quadratic(grid(cells, place), curved)

    def circle(radius):
        return lambda x, y, z: abs(np.hypot(x, y) - radius) < SAME

    def solved(name, contact, interaction, factor):
        shaft, hub = sector(bore, fit, (4 * factor, 11 * factor, 1)), sector(fit, outside, (6 * factor, 8 * factor, 1))
        deck = Deck([(shaft, hot), (hub, plastic)], [((0, circle(fit)), (1, circle(fit)))], contact, interaction, [], suffix="R")
        lines = ["*BOUNDARY"]
        for k in (0, 1):
            for component, where in ((3, lambda *_: True), (1, lambda x, y, z: abs(x) < SAME), (2, lambda x, y, z: abs(y) < SAME)):
                lines.append(deck.fixed(k, where, component))
        sets = [f"*NSET, NSET={label}\n" + "\n".join(map(str, deck.numbers(1, where)))
                for label, where in (("CUT", lambda x, y, z: abs(y) < SAME), ("OUTER", circle(outside)))]
        deck.model = "\n".join([*sets, "*INITIAL CONDITIONS, TYPE=TEMPERATURE\nN0, 0.\nN1, 0."])
        step(deck, *lines, "*TEMPERATURE\nN0, 500.", "*NODE PRINT, NSET=CUT, TOTALS=ONLY\nRF", "*NODE PRINT, NSET=OUTER\nU",
             "*EL PRINT, ELSET=E1\nPEEQ", increments=".1, 1.")
        run = Run(program, out / f"ring_{name}", deck).finished()
        outer = np.mean([np.hypot(*u[:2]) for u in run.displacements("OUTER").values()])
        plastic_strain = max(float(line.split()[2]) for line in (run.folder / "job.dat").read_text().split("strain")[-1].splitlines()
                             if len(line.split()) == 3)
        return abs(run.total("CUT")[1]) / (fit * thickness), outer, plastic_strain

    pressure, outer, plastic_strain = solved("stickslip", "TYPE=STICKSLIP", "*FRICTION\n1.E-9, 1.", 1)
    own_pressure, own_outer, _ = solved("own", "TYPE=SURFACE TO SURFACE", "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n1.E7, 0.", 2)
    print(f"        ring: pressure {pressure:.3f} and {own_pressure:.3f}, the hub's outer radius moves by {outer:.6f} and {own_outer:.6f}, "
          f"plastic strain up to {plastic_strain:.4f}")
    judge("ring in a plastic hub: an elastic hub", float(plastic_strain < 1e-3), 0)
    judge("ring in a plastic hub: pressure against its own contact on a finer mesh", abs(pressure / own_pressure - 1), RING)
    judge("ring in a plastic hub: outer radius against the same", abs(outer / own_outer - 1), RING)


def chain(program, out):
    """Three blocks, two pairs; two nodes of a surface joined by an equation that the answer fulfils; a second step unloads by half."""
    bodies = [(box((0, 0, low), (1, 1, low + 0.8), (n, n, 2)), f"*ELASTIC\n{young * UNIT}, 0.")
              for low, n, young in ((1.6, 3, 1000), (0.8, 4, 2000), (0, 5, 1000))]
    pairs = [((0, level(1.6)), (1, level(1.6))), ((2, level(0.8)), (1, level(0.8)))]
    deck = Deck(bodies, pairs, "TYPE=STICKSLIP", "*FRICTION\n0.3, 1000.", [])
    joined = deck.numbers(1, level(1.6))
    deck.model = "\n".join(f"*EQUATION\n2\n{a}, 3, 1., {b}, 3, -1." for a, b in ((joined[6], joined[18]), (joined[7], joined[13])))
    for way in (-0.005, -0.0025):
        sides = [deck.fixed(0, level(2.4), c, value) for c, value in ((1, 0), (2, 0), (3, way))]
        step(deck, "*BOUNDARY", *sides, *(deck.fixed(2, level(0), c) for c in (1, 2, 3)))
    run = Run(program, out / "chain", deck).finished()
    for number, (way, bound) in enumerate(((0.005, PATCH), (0.0025, UNLOADED))):
        rows, pressure = run.nodes(number), way / (0.8 / 1000 + 0.8 / 2000 + 0.8 / 1000)
        for pair, sign in ((1, -1), (2, 1)):
            multipliers = rows[(rows[:, 0] == pair) & (rows[:, 1] == 1)][:, 12:15] / UNIT
            judge(f"three blocks, step {number + 1}, pair {pair}: multipliers", np.abs(multipliers - [0, 0, sign * pressure]).max() / pressure, bound)


def refusals(program, out):
    """What pairs do not go with ends with a sentence."""
    for name, parameter, words in (("parameter", "ADJUST=0.1", "a parameter"), ("modulus", "MODULUS=-1.", "MODULUS > 0")):
        deck = two_blocks(lambda m: m, 0, 0, f"TYPE=STICKSLIP, {parameter}")
        step(deck, gripped(deck, (0, 0, -0.005)))
        run = Run(program, out / f"refused_{name}", deck)
        judge(f"refusals: {name} without a word", float(run.code == 0 or words not in run.said), 0)
    deck = two_blocks(lambda m: m, 0, 0)
    deck.bodies = [(mesh, material + "\n*DENSITY\n1.") for mesh, material in deck.bodies]
    deck.steps = ["*STEP\n*DYNAMIC\n.1, 1.\n" + gripped(deck, (0, 0, -0.005)) + "\n*END STEP"]
    run = Run(program, out / "refused_dynamic", deck)
    judge("refusals: *DYNAMIC without a word", float(run.code == 0 or "are for static steps" not in run.said), 0)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", required=True, type=Path)
    parser.add_argument("--driver", required=True, type=Path)
    parser.add_argument("--out", required=True, type=Path)
    arguments = parser.parse_args()
    program, out = arguments.program.resolve(), arguments.out.resolve()
    patch(program, out)
    shells(program, out)
    friction(program, arguments.driver.resolve(), out)
    turning(program, out)
    chain(program, out)
    hertz(program, out)
    ring(program, out)
    refusals(program, out)
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
