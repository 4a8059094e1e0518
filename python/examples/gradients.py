"""How a tangential force follows friction, stiffness, load and the shape of a surface: exact gradients of a run that presses, slides and
returns, beside differences of whole runs."""

import numpy as np
import scipy.sparse as sp
import scipy.sparse.linalg as spl

import stickslip
from stickslip.gradients import Contact, State, backward


def block(nx, ny, lower, upper):
    """Nodes and quadrilaterals of a rectangle."""
    x, y = (np.linspace(lower[i], upper[i], n + 1) for i, n in enumerate((nx, ny)))
    nodes = np.array([(a, b) for b in y for a in x])
    return nodes, np.array([[k, k + 1, k + nx + 2, k + nx + 1] for j in range(ny) for k in range(j * (nx + 1), j * (nx + 1) + nx)])


def stiffness(nodes, cells, poisson=0.3):
    """Plane strain with E = 1."""
    c = np.array([[1 - poisson, poisson, 0], [poisson, 1 - poisson, 0], [0, 0, 0.5 - poisson]]) / ((1 + poisson) * (1 - 2 * poisson))
    rows, columns, values = [], [], []
    for cell in cells:
        k = np.zeros((8, 8))
        for s, t in [(a, b) for a in (-1, 1) for b in (-1, 1)] / np.sqrt(3):
            d = np.array([[-1 + t, 1 - t, 1 + t, -1 - t], [-1 + s, -1 - s, 1 + s, 1 - s]]) / 4
            jacobian = d @ nodes[cell]
            g, b = np.linalg.solve(jacobian, d), np.zeros((3, 8))
            b[0, ::2], b[1, 1::2], b[2, ::2], b[2, 1::2] = g[0], g[1], g[1], g[0]
            k += b.T @ c @ b * np.linalg.det(jacobian)
        at = np.repeat(2 * cell, 2) + np.tile([0, 1], 4)
        rows, columns, values = rows + [np.repeat(at, 8)], columns + [np.tile(at, 8)], values + [k.ravel()]
    return sp.coo_matrix((np.concatenate(values), (np.concatenate(rows), np.concatenate(columns)))).tocsr()


class Run:
    """A block on another one: its top is pressed down, pulled along and back. Parameters: mu, modulus, press, offset."""

    def __init__(self, steps=20, **options):
        (top, cells), (base, base_cells) = block(6, 2, (0.3, 0.0), (1.7, 0.5)), block(9, 2, (0, -0.5), (2, 0.0))
        self.nodes, n = np.vstack([top, base]), 2 * len(top)
        self.parts = [stiffness(top, cells), stiffness(base, base_cells)]
        self.lower, self.upper = np.arange(7), len(top) + np.arange(20, 30)
        lines = np.array([(k, k + 1) for k in range(6)]), np.array([(k + 1, k) for k in range(9)])
        held = np.abs(self.nodes[:, 1]) == 0.5
        self.held, self.size = np.flatnonzero(np.repeat(held, 2)), n + 2 * len(base) + 14
        self.driven = np.flatnonzero(self.nodes[:, 1] == 0.5)
        numbers = np.arange(2 * len(self.nodes)).reshape(-1, 2)
        self.first = self.size - 14
        sides = [stickslip.Surface(self.nodes[self.lower], lines[0], numbers[self.lower], self.first + np.arange(14).reshape(-1, 2)),
                 stickslip.Surface(self.nodes[self.upper], lines[1], numbers[self.upper])]
        self.interface = stickslip.Interface(*sides, model="plane", modulus=1.0, mu=0.3, row_scale="none", **options)
        self.contact = Contact(self.interface, numbers[self.lower], numbers[self.upper], self.first + np.arange(14).reshape(-1, 2))
        s = np.linspace(0, 1, steps + 1)
        self.way = np.column_stack([0.04 * np.sin(1.6 * np.pi * s), -np.minimum(1, 4 * s)])

    def bulk(self, modulus):
        """The stiffness of both blocks, of which the upper one has this modulus."""
        return sp.block_diag([modulus * self.parts[0], self.parts[1], sp.csr_matrix((14, 14))]).tocsr()

    def point(self, y):
        x = self.nodes + y[:self.first].reshape(-1, 2)
        return x[self.lower], x[self.upper], y[self.first:].reshape(-1, 2)

    def prescribe(self, y, n, press):
        y[self.held] = 0.0
        y[2 * self.driven], y[2 * self.driven + 1] = self.way[n, 0], press * self.way[n, 1]

    def solve(self, mu=0.3, modulus=1.0, press=0.03, offset=0.0):
        """What each step ended with."""
        contact, bulk = self.interface, self.bulk(modulus)
        contact.set_committed(self.nodes[self.lower], self.nodes[self.upper], commits=0)
        contact.set_friction(np.full(7, mu))
        contact.set_offsets(offset * np.cos(np.arange(7.0)), None)
        free = np.setdiff1d(np.arange(self.size), self.held)
        y = np.zeros(self.size)
        y[self.first:] = contact.initial_multipliers().ravel()
        ends = [np.zeros(self.size)]
        for n in range(1, len(self.way)):
            self.prescribe(y, n, press)
            for _ in range(40):
                r = self.residual(y, bulk)
                if np.abs(r[free]).max() < 1e-15:
                    break
                k = (bulk + contact.tangent(*self.point(y), self.size))[free][:, free].tocsc()
                y[free] -= spl.splu(k).solve(r[free])
            contact.commit(*self.point(y))
            ends.append(y.copy())
        return ends

    def residual(self, y, bulk):
        r = bulk @ y
        forces = self.interface.residual(*self.point(y))
        for at, values in zip((self.contact.equations1, self.contact.equations2, self.contact.multipliers), forces):
            np.add.at(r, at, values)
        return r

    def functional(self, ends, modulus=1.0):
        """The mean square of the force along, at the driven nodes."""
        return np.mean([(self.bulk(modulus) @ y)[2 * self.driven].sum() ** 2 for y in ends[1:]])

    def gradient(self, ends, mu=0.3, modulus=1.0, press=0.03, offset=0.0):
        """By one run backwards."""
        bulk, steps = self.bulk(modulus), len(ends) - 1
        soft = sp.block_diag([self.parts[0], 0 * self.parts[1], sp.csr_matrix((14, 14))]).tocsr()
        along = np.zeros(self.size)
        along[2 * self.driven] = 1.0
        force = [along @ (bulk @ y) for y in ends]
        slope = [2 / steps * f * (bulk.T @ along) for f in force]
        fixed = sp.diags(np.isin(np.arange(self.size), self.held).astype(float))

        def matrix(n):
            k = bulk + self.interface.tangent(*self.point(ends[n]), self.size)
            return (sp.eye(self.size) - fixed) @ k @ (sp.eye(self.size) - fixed) + fixed

        states = [State([self.point(y)]) for y in ends]
        d = dict.fromkeys(("mu", "modulus", "press", "offset"), 0.0)
        keep = 1.0 - fixed.diagonal()
        for n, a, (g,) in backward([self.contact], states, matrix, lambda n: keep * slope[n], ("friction", "offsets1"),
                                   lambda k, right: stickslip.gradients.lu(k, keep * right)):
            down = np.zeros(self.size)
            down[2 * self.driven + 1] = self.way[n, 1]
            d["mu"] += g.friction.sum()
            d["offset"] += g.offsets1 @ np.cos(np.arange(7.0))
            d["press"] += (slope[n] + bulk.T @ a) @ down
            d["modulus"] += a @ (soft @ ends[n]) + 2 / steps * force[n] * (along @ (soft @ ends[n]))
        return d


def differences(run, name, values, step):
    """By runs beside it, of fourth order."""
    at = lambda s: run.functional(run.solve(**{**values, name: values[name] + s}), **({"modulus": values["modulus"] + s} if name == "modulus" else {}))
    return (8 * (at(step) - at(-step)) - (at(2 * step) - at(-2 * step))) / (12 * step)


if __name__ == "__main__":
    run, values = Run(), {"mu": 0.3, "modulus": 1.0, "press": 0.03, "offset": 0.001}
    exact = run.gradient(run.solve(**values), **values)
    for name, step in (("mu", 1e-4), ("modulus", 1e-4), ("press", 1e-6), ("offset", 1e-5)):
        near = differences(run, name, values, step)
        print(f"{name:8s} {exact[name]:+.10e}   differences of whole runs {near:+.10e}   apart by {abs(exact[name] / near - 1):.0e}")
