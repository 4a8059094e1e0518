"""A two-dimensional host: two linear elastic bodies, Newton's method, and a contact between them that is either lines or one layer of
quadrilaterals of a model in space, whose nodes above each other have the same unknowns."""

import numpy as np

from library import DUAL, ENDS, OF_COMMIT, STANDARD, Interface, mid_nodes

MODELS = {"strain": 1, "stress": 1, "ring": 2}
# Multipliers: the paper's element; standard ones at all nodes, and dual ones, with the normals that the library takes.
SPACES = {
    "corner": {"multiplier_space": 0, "basis": STANDARD, "normals": OF_COMMIT},
    "sub": {"multiplier_space": 1, "basis": STANDARD},
    "dual": {"multiplier_space": 0, "basis": DUAL},
}
# Of Newton's method: the last step over all displacements, after which its square is left; and iterations.
TOLERANCE, ITERATIONS = 1e-9, 30


class NotConverged(Exception):
    """Newton's method has no end."""


def choices(space):
    """The options of these multipliers."""
    return SPACES[space]


class Lines:
    """Contact of lines."""

    def __init__(self, library, x1, lines1, x2, lines2, body, **options):
        self.interface = Interface(library, x1, lines1, x2, lines2, model=MODELS[body.model], thickness=thickness(body), **options)
        self.has_row = np.full(len(x1), bool(options.get("multiplier_space"))) | ~mid_nodes(len(x1), lines1, ENDS)

    def residual(self, *at):
        return np.concatenate([v.ravel() for v in self.interface.residual(*at)])

    def tangent(self, *at):
        return self.interface.tangent(*at)

    def states(self, *at):
        return self.interface.states(*at)

    def commit(self, *at):
        self.interface.commit(*at)


class Layer(Lines):
    """The same contact of one layer, of lines with two nodes."""

    def __init__(self, library, x1, lines1, x2, lines2, body, **options):
        self.thickness, self.n = thickness(body), (len(x1), len(x2))
        quads = [[[a, b, b + n, a + n] for a, b in lines] for lines, n in zip((lines1, lines2), self.n)]
        self.interface = Interface(library, self.twice(x1), quads[0], self.twice(x2), quads[1], **options)
        self.has_row = np.ones(len(x1), bool)
        # Which unknown of the lines one of the layer is; none of those along z.
        n1, n2 = self.n
        self.of = []
        for first, n in ((0, n1), (2 * n1, n2), (2 * (n1 + n2), n1)):
            for node in range(2 * n):
                self.of += [first + 2 * (node % n), first + 2 * (node % n) + 1, -1]
        self.of = np.array(self.of)

    def twice(self, v, height=None):
        height = self.thickness if height is None else height
        return np.vstack([np.column_stack([v, np.full(len(v), z)]) for z in (0.0, height)])

    def at(self, x1, x2, lam):
        return self.twice(x1), self.twice(x2), self.twice(lam, 0.0)

    def residual(self, *at):
        out = np.concatenate([v.ravel() for v in self.interface.residual(*self.at(*at))])
        sums, known = np.zeros(4 * self.n[0] + 2 * self.n[1]), self.of >= 0
        np.add.at(sums, self.of[known], out[known])
        return sums

    def tangent(self, *at):
        rows, columns, values = self.interface.triplets(*self.at(*at))
        rows, columns = self.of[rows], self.of[columns]
        known, n = (rows >= 0) & (columns >= 0), 4 * self.n[0] + 2 * self.n[1]
        matrix = np.zeros((n, n))
        np.add.at(matrix, (rows[known], columns[known]), values[known])
        return matrix

    def states(self, *at):
        return {name: v[: self.n[0]] for name, v in self.interface.states(*self.at(*at)).items()}

    def commit(self, *at):
        self.interface.commit(*self.at(*at))


def thickness(body):
    return 0.0 if body.model == "ring" else body.thickness


class Host:
    """Two bodies: the first one has the non-mortar lines. `sides`: the names of the sides that meet."""

    def __init__(self, library, bodies, sides, kind=Lines, **options):
        self.bodies, self.sizes = bodies, [body.x.size for body in bodies]
        lines = [body.side(side) for body, side in zip(bodies, sides)]
        self.nodes = [np.unique(np.concatenate(of)) for of in lines]
        numbers = [{node: k for k, node in enumerate(of)} for of in self.nodes]
        local = [[[number[k] for k in line] for line in of] for number, of in zip(numbers, lines)]
        x1, x2 = (body.x[of] for body, of in zip(bodies, self.nodes))
        self.contact = kind(library, x1, local[0], x2, local[1], bodies[0], **options)
        n = sum(self.sizes)
        self.k = np.zeros((n, n))
        self.k[: self.sizes[0], : self.sizes[0]] = bodies[0].stiffness()
        self.k[self.sizes[0] :, self.sizes[0] :] = bodies[1].stiffness()
        self.u, self.lam = np.zeros(n), np.zeros_like(x1)
        # Where the unknowns of the contact stand among those of the host.
        dofs = [(2 * np.repeat(of, 2).reshape(-1, 2) + [0, 1]).ravel() for of in self.nodes]
        self.map = np.concatenate([dofs[0], self.sizes[0] + dofs[1], n + np.arange(x1.size)])
        self.rows = np.repeat(self.contact.has_row, 2)

    def at(self):
        u = np.split(self.u, [self.sizes[0]])
        return *(body.x[of] + v.reshape(-1, 2)[of] for body, of, v in zip(self.bodies, self.nodes, u)), self.lam

    def step(self, fixed, loads=None):
        """Solves a step: `fixed`, values by unknown; `loads`, forces. Gives the number of iterations."""
        n, m = len(self.u), self.lam.size
        loads = np.zeros(n) if loads is None else loads
        free = np.ones(n + m, bool)
        free[list(fixed)] = False
        free[n:] = self.rows
        self.u[list(fixed)] = list(fixed.values())
        for iteration in range(1, ITERATIONS + 1):
            inner, contact = self.k @ self.u, self.contact.residual(*self.at())
            r = np.concatenate([inner - loads, np.zeros(m)])
            np.add.at(r, self.map, contact)
            j = np.zeros((n + m, n + m))
            j[:n, :n] = self.k
            j[np.ix_(self.map, self.map)] += self.contact.tangent(*self.at())
            z, self.matrix = np.zeros(n + m), j[np.ix_(free, free)]
            z[free] = np.linalg.solve(self.matrix, -r[free])
            self.u += z[:n]
            self.lam += z[n:].reshape(-1, 2)
            if np.abs(z[:n]).max() <= TOLERANCE * np.abs(self.u).max():
                break
        else:
            raise NotConverged(f"no solution in {ITERATIONS} iterations; the last step is {np.abs(z[:n]).max():.1e}")
        self.states = self.contact.states(*self.at())
        self.contact.commit(*self.at())
        return iteration

    def dof(self, body, node, component):
        return (0, self.sizes[0])[body] + 2 * node + component

    def on(self, body, component, value, where):
        """Values of a component at nodes of a body."""
        return {self.dof(body, k, component): value for k, x in enumerate(self.bodies[body].x) if where(x)}
