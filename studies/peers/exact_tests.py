"""Tests with exact answers in other programs, on the same meshes: a wave, a rounded and a sliding punch. The answers and what is an
error are those of tests/acceptance; the library solves them in the plane, the others as one layer of hexahedra that is held in depth."""

import re
from dataclasses import dataclass, field

import numpy as np

import formulas
import layer
import peers
import punches
import westergaard

OURS = {"stickslip, defaults": {}, "stickslip, points": {"decision": "points"}}
# Positions of the border on fine meshes: every other one.
FINE = 20


def some(facets, positions):
    return positions[::2] if facets >= FINE else positions


# The layer is as deep as a facet is long.
depth = lambda case: np.ptp(case.points[:, 2])
stiff = lambda case: peers.PENALTY / depth(case)
# Over PENALTY: CalculiX' mortar contact is no softer, to four digits.
HARDER = 1000
NODES, FACES, MORTAR = "CalculiX, node to face (penalty)", "CalculiX, surface to surface (penalty)", "CalculiX, mortar"
PEERS = {
    f"{NODES}, 50 E / h": lambda case, folder: peers.calculix(case, folder, "NODE TO SURFACE", stiff(case)),
    f"{FACES}, 50 E": lambda case, folder: peers.calculix(case, folder, "SURFACE TO SURFACE"),
    f"{FACES}, 50 E / h": lambda case, folder: peers.calculix(case, folder, "SURFACE TO SURFACE", stiff(case)),
    f"{MORTAR}, hard": lambda case, folder: peers.calculix(case, folder, "MORTAR"),
    f"{MORTAR}, 50 000 E": lambda case, folder: peers.calculix(case, folder, "MORTAR", HARDER * peers.PENALTY),
    "GetFEM, nodes against faces": peers.getfem,
    "GetFEM, integral, r = E": lambda case, folder: peers.getfem(case, folder, peers.by_integrals(1)),
    "GetFEM, integral, r = E / h": lambda case, folder: peers.getfem(case, folder, peers.by_integrals(1 / depth(case))),
    "Kratos, mortar, augmented Lagrangian": peers.kratos,
}
# It takes no node of the non-mortar side that is supported twice: both halves are there.
takes_whole = lambda program: program.startswith(MORTAR)


# --- a wave pressed flat ----------------------------------------------------------------------------------------------
class Wave:
    title, facets = "Wave, light load", (5, 10, 20)
    columns = ("pressure",)
    symmetric = True
    # Of half the wave: what is beyond touches nothing, and is no side of the contact in other programs.
    BEYOND = 0.8

    def positions(self, facets):
        return some(facets, [(facets, a) for a in westergaard.half_widths(facets, westergaard.LIGHT)])

    def scene(self, folder, position, options):
        facets, a = position
        count = westergaard.cells(westergaard.DUAL, facets, westergaard.LIGHT)
        return westergaard.scene(folder, "quad", count, westergaard.WAVE.mean_pressure(a)), options

    def case(self, name, run, position, whole):
        half, wave = westergaard.WAVE.length / 2, westergaard.WAVE
        held = [(lambda x: np.abs(np.abs(x[:, 0]) - half) < layer.ON, 0), (lambda x: np.abs(x[:, 1] + westergaard.DEPTH) < layer.ON, 1)]
        foot = lambda x: (np.abs(x[:, 1] + wave.gap(x[:, 0])) < layer.ON) & (np.abs(x[:, 0]) < self.BEYOND * half)
        size = half / westergaard.cells(westergaard.DUAL, position[0], westergaard.LIGHT)
        return layer.case_of(name, run, size, westergaard.YOUNG, westergaard.POISSON, held, (foot, lambda x: np.abs(x[:, 1]) < layer.ON),
                             self.symmetric, whole, stress=layer.STIFFER * wave.pressure(0.0, position[1]))

    def errors(self, position, x, shear, normal):
        """At equal force."""
        wave = westergaard.WAVE
        a = wave.half_width(-normal.sum() / (wave.length / 2 if x.min() >= 0 else wave.length))
        at, share = formulas.nodal_shares(x)
        area = share.sum(axis=1)
        return (punches.relative(-normal / area, share @ wave.pressure(at, a) / area, area),)


# --- a punch with rounded edges ---------------------------------------------------------------------------------------
@dataclass
class Rounded:
    flat: float
    facets: tuple = (5, 10)
    columns: tuple = ("load", "pressure")
    symmetric: bool = True

    @property
    def title(self):
        return f"Rounded punch, b/a = {self.flat:g}"

    def positions(self, facets):
        return some(facets, [(facets, n) for n in punches.positions(facets)])

    def scene(self, folder, position, options):
        return punches.rounded_scene(folder, self.flat, position[1], **options), {}

    def case(self, name, run, position, whole):
        far = lambda x: (np.abs(x[:, 0]) > punches.FAR - layer.ON) | (x[:, 1] < layer.ON - punches.FAR)
        foot = lambda x: (np.abs(x[:, 1]) < layer.ON) & (np.abs(x[:, 0]) < punches.FINE + layer.ON)
        exact = punches.rounded(self.flat)
        under = lambda x: np.abs(x[:, 1] - exact.rise(x[:, 0])) < layer.ON
        return layer.case_of(name, run, 1 / position[1], punches.YOUNG, punches.POISSON, [(far, 0), (far, 1)], (foot, under),
                             self.symmetric, whole, stress=layer.STIFFER * exact.force / 2)

    def errors(self, position, x, shear, normal):
        exact = punches.rounded(self.flat)
        at, share = formulas.nodal_shares(x)
        length = share.sum(axis=1)
        load = -(2 if x.min() >= 0 else 1) * normal.sum() / exact.force - 1
        return load, punches.relative(-normal / length, share @ exact.pressure(at) / length, length)


# --- a flat punch that slides -----------------------------------------------------------------------------------------
@dataclass
class Sliding:
    mu: float
    facets: tuple = (10, 20)
    columns: tuple = ("p(0) a / P", "p(a/2) / p(-a/2)")
    symmetric: bool = False
    # Of the punch, as punches.Sliding has it.
    WIDE, CELLS = 1.2, 5

    @property
    def title(self):
        return f"Sliding punch, mu = {self.mu:g}"

    def positions(self, facets):
        return [(facets, facets)]

    def scene(self, folder, position, options):
        return punches.Sliding(self.mu).scene(folder, position[0], **options), {}

    def case(self, name, run, position, whole):
        far = lambda x: (np.abs(x[:, 0]) > punches.FAR - layer.ON) | (x[:, 1] < layer.ON - punches.FAR)
        foot = lambda x: (np.abs(x[:, 1]) < layer.ON) & (np.abs(x[:, 0]) < 1 + layer.ON)
        # The punch goes down as the middle of its foot does in the library's run.
        points, _, displacement = run.mesh()
        middle = np.argmin(np.hypot(points[:, 0], points[:, 1]))
        x = np.linspace(-self.WIDE, self.WIDE, self.CELLS + 1)
        corners = np.arange(self.CELLS)[:, None] + [0, 1, self.CELLS + 2, self.CELLS + 1]
        punch = np.vstack([np.column_stack([x, 0 * x]), np.column_stack([x, 0 * x + 1])]), corners, (-punches.Sliding.way, displacement[middle, 1])
        return layer.case_of(name, run, 1 / position[1], punches.YOUNG, punches.POISSON, [(far, 0), (far, 1)],
                             (foot, lambda x: np.abs(x[:, 1]) < layer.ON), punch=punch, friction=self.mu, stress=layer.STIFFER * punches.Sliding(self.mu).load)

    def errors(self, position, x, shear, normal):
        """At equal force."""
        exact = punches.Sliding(self.mu).exact
        ratio = normal / normal.sum() / (exact.nodal_force(x) / exact.force)
        at = lambda place: ratio[np.argmin(np.abs(x - place))]
        return at(0) - 1, at(0.5) / at(-0.5) - 1


TESTS = {"wave": (Wave(),), "rounded": (Rounded(0.5), Rounded(0.9)), "sliding": tuple(Sliding(mu) for mu in (0.2, 0.5, 1.0))}


# --- rows -------------------------------------------------------------------------------------------------------------
@dataclass
class Row:
    test: str
    facets: int
    program: str
    errors: list = field(default_factory=list)  # of each position, in each column
    iterations: list = field(default_factory=list)
    seconds: list = field(default_factory=list)
    failures: list = field(default_factory=list)

    def add(self, errors, iterations, seconds):
        self.errors.append(errors)
        self.iterations.append(iterations)
        self.seconds.append(seconds)

    def mean(self, column):
        return 100 * np.abs(np.array(self.errors)[:, column]).mean()


def contact(run):
    """(x, nodal forces along x and y) of a plane run."""
    table = run.interface("contact")
    table = table[np.argsort(table["X"])]
    return table["X"], table["fx"], table["fy"]


def rows(driver, test, key, missing, said):
    """A Row for each number of facets and each program."""
    for facets in test.facets:
        of = {name: Row(test.title, facets, name) for name in (*OURS, *PEERS)}
        for k, position in enumerate(test.positions(facets)):
            for name, options in OURS.items():
                path, rest = test.scene(driver.output, position, options)
                words = [word for option, value in rest.items() for word in (f"-contact_{option}", value)]
                run = driver.run(path, *words, "-output_vtu", "last", label=f"{key}_{facets}_{k}_{name.split(', ')[1]}")
                of[name].add(test.errors(position, *contact(run)), run.newton_iterations, run.summary["seconds"]["total"])
                first = run if not options else first
            cases = [test.case(f"{key}_{facets}_{k}{'_whole' * whole}", first, position, bool(whole)) for whole in range(1 + test.symmetric)]
            for name, program in PEERS.items():
                case = cases[-1] if takes_whole(name) else cases[0]
                folder = driver.output / f"{case.name}_{re.sub(r'[^a-z0-9]+', '_', name.lower())}"
                try:
                    answer = peers.kept(program, case, folder)
                except peers.Missing as what:
                    missing.add(str(what))
                except Exception as failure:  # whatever another program does
                    of[name].failures.append(said(failure))
                else:
                    of[name].add(test.errors(position, *layer.profile(case, answer.displacement)), answer.iterations, answer.seconds)
        yield from (row for row in of.values() if row.errors or row.failures)




def errors_of(row, column, count):
    """In per cent: mean and worst of `count` positions, or the one error with its sign."""
    if not row.errors:
        return "-"
    found = 100 * np.array(row.errors)[:, column]
    return f"{found[0]:.2f}" if count == 1 else f"{np.abs(found).mean():.2f} ({np.abs(found).max():.2f})"


def line_of(test, of):
    """A line of the table: a program's Rows by facets."""
    last = of[max(of)]
    errors = [errors_of(of[n], column, len(test.positions(n))) if n in of else "-" for column in range(len(test.columns)) for n in test.facets]
    failures = [what for row in of.values() for what in row.failures]
    mean = lambda values: f"{np.mean(values):.1f}" if values else "-"
    failed = f"{len(failures)} of {sum(len(test.positions(n)) for n in test.facets)}: {failures[0]}" if failures else ""
    return [last.test, last.program, *errors, mean(last.iterations), mean(last.seconds), failed]


def table(driver, key, missing, said):
    """((head, body), rows) of a test: a line for each program; rows are printed as they come."""
    first = TESTS[key][0]
    errors = [f"{column}, {n} facets" for column in first.columns for n in first.facets]
    head, body, found = ["test", "program", *errors, "Newton iterations", "seconds", "failure"], [], []
    for test in TESTS[key]:
        of = {}
        for row in rows(driver, test, f"{key}_{test.title.split()[-1]}", missing, said):
            found.append(row)
            of.setdefault(row.program, {})[row.facets] = row
            told = [errors_of(row, column, len(test.positions(row.facets))) for column in range(len(test.columns))]
            print(" | ".join([row.test, str(row.facets), row.program, *told, *row.failures[:1]]), flush=True)
        body += [line_of(test, each) for each in of.values()]
    return (head, body), found
