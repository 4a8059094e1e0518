"""How a pulling force follows friction, stiffness, pressing and the shape of a surface: exact gradients of a run that presses, slides and
returns, beside differences of whole runs. Plane strain, numpy and scipy alone."""

import numpy as np
import scipy.sparse as sp

import stickslip
from stickslip.gradients import backward


def block(nx, ny, lower, upper):
    """Nodes and quadrilaterals of a rectangle."""
    x, y = (np.linspace(lower[i], upper[i], n + 1) for i, n in enumerate((nx, ny)))
    nodes = np.array([(a, b) for b in y for a in x])
    return nodes, np.array([[k, k + 1, k + nx + 2, k + nx + 1] for j in range(ny) for k in range(j * (nx + 1), j * (nx + 1) + nx)])


def stiffness(nodes, cells, poisson=0.3):
    """Plane strain with E = 1, in all of the nodes' displacements."""
    c = np.array([[1 - poisson, poisson, 0], [poisson, 1 - poisson, 0], [0, 0, 0.5 - poisson]]) / ((1 + poisson) * (1 - 2 * poisson))
    total = sp.csr_matrix((nodes.size, nodes.size))
    for cell in cells:
        k, at = np.zeros((8, 8)), np.repeat(2 * cell, 2) + np.tile([0, 1], 4)
        for s, t in [(a, b) for a in (-1, 1) for b in (-1, 1)] / np.sqrt(3):
            d = np.array([[-1 + t, 1 - t, 1 + t, -1 - t], [-1 + s, -1 - s, 1 + s, 1 - s]]) / 4
            g, b = np.linalg.solve(d @ nodes[cell], d), np.zeros((3, 8))
            b[0, ::2], b[1, 1::2], b[2, ::2], b[2, 1::2] = g[0], g[1], g[1], g[0]
            k += b.T @ c @ b * np.linalg.det(d @ nodes[cell])
        total += sp.coo_matrix((k.ravel(), (np.repeat(at, 8), np.tile(at, 8))), total.shape)
    return total.tocsr()


class Run:
    """A block on another one: its top is pressed down, pulled along and back. Parameters: mu, modulus of the block, press, offset. The
    functional is the mean square of the pulling force, less ``target`` of each step."""

    def __init__(self, steps=20, target=0.0, **options):
        self.target = target
        (top, cells), (base, below) = block(6, 2, (0.3, 0.0), (1.7, 0.5)), block(9, 2, (0, -0.5), (2, 0.0))
        self.X, below = np.vstack([top, base]), below + len(top)
        self.parts = stiffness(self.X, cells), stiffness(self.X, below)
        faces = stickslip.skin(cells, self.X, lambda x: x[1] == 0), stickslip.skin(below, self.X, lambda x: x[1] == 0)
        self.contact = stickslip.Contact(self.X).add(*faces, modulus=1.0, mu=0.3, row_scale="none", **options)
        self.face, self.steps = self.contact.interfaces[0], steps
        self.driven, held = np.flatnonzero(self.X[:, 1] == 0.5), np.flatnonzero(np.abs(self.X[:, 1]) == 0.5)
        self.fixed = np.concatenate([2 * held, 2 * held + 1])
        self.outputs, self.ends = (steps,), (steps + 1, self.contact.size)
        self.shape = np.cos(np.arange(self.face.n1))
        self.along, self.down = np.zeros((2, self.X.size))
        self.along[2 * self.driven] = 1.0
        self.down[2 * self.driven + 1] = -1.0

    def prescribed(self, time, press):
        """The motion of the fixed unknowns."""
        return (0.04 * np.sin(1.6 * np.pi * time) * self.along + press * min(1, 4 * time) * self.down)[self.fixed]

    def begin(self, mu, offset):
        """The first configuration, with these parameters of the interface."""
        self.contact.set_committed(np.zeros(self.contact.size))
        self.face.set_friction(np.full(self.face.n1, mu))
        self.face.set_offsets(offset * self.shape, None)

    def solve(self, mu=0.3, modulus=1.0, press=0.03, offset=0.0):
        """All unknowns at first and at the end of each step."""
        k = modulus * self.parts[0] + self.parts[1]
        self.begin(mu, offset)
        ends = [np.zeros(self.contact.size)]
        times = np.arange(1, self.steps + 1) / self.steps
        for step in stickslip.steps(self.contact, lambda u, _: k @ u, lambda u, _: k, times, fixed=self.fixed,
                                    prescribed=lambda time: self.prescribed(time, press), predictor=False):
            ends.append(step.x.copy())
        return ends

    def forces(self, ends, modulus):
        """What pulls at the driven nodes at the end of each step."""
        return np.array([self.along @ (modulus * self.parts[0]) @ end[: self.X.size] for end in ends])

    def functional(self, ends, modulus=1.0):
        """Their mean square, less the target."""
        return np.mean(np.square(self.forces(ends[1:], modulus) - self.target))

    def forward(self, *parameters):
        """The pulling forces, and the ends of the steps."""
        ends = self.solve(*map(float, parameters))
        return self.forces(ends[1:], float(parameters[1])), np.array(ends)

    def pull(self, parameters, ends, weights):
        """The derivatives of sum of weights x forces by all parameters, in one run backwards."""
        mu, modulus, _, offset = map(float, parameters)
        self.begin(mu, offset)  # other runs may have been since
        n_host = self.X.size
        k = modulus * self.parts[0] + self.parts[1]
        slopes = np.zeros((len(ends), self.contact.size))
        slopes[1:, :n_host] = np.outer(weights, k @ self.along)
        mu = soft = press = offset = 0.0
        for n, a, (g,) in backward(self.contact, ends, lambda n: k, lambda n: slopes[n], ("friction", "offsets1"), fixed=self.fixed):
            mu += g.friction.sum()
            offset += g.offsets1 @ self.shape
            press += (slopes[n, :n_host] + k @ a[:n_host]) @ self.down * min(1, 4 * n / self.steps)
            soft += a[:n_host] @ self.parts[0] @ ends[n][:n_host] + slopes[n, :n_host] @ ends[n][:n_host] / modulus
        return mu, soft, press, offset

    def gradient(self, ends, mu=0.3, modulus=1.0, press=0.03, offset=0.0):
        """Of the functional, by name."""
        weights = 2 / self.steps * (self.forces(ends[1:], modulus) - self.target)
        return dict(zip(("mu", "modulus", "press", "offset"), self.pull((mu, modulus, press, offset), ends, weights)))


def differences(run, name, values, step):
    """By runs beside it, of fourth order."""
    def at(s):
        changed = {**values, name: values[name] + s}
        return run.functional(run.solve(**changed), changed["modulus"])

    return (8 * (at(step) - at(-step)) - (at(2 * step) - at(-2 * step))) / (12 * step)


if __name__ == "__main__":
    run, values = Run(), {"mu": 0.3, "modulus": 1.0, "press": 0.03, "offset": 0.001}
    exact = run.gradient(run.solve(**values), **values)
    for name, step in (("mu", 1e-4), ("modulus", 1e-4), ("press", 1e-6), ("offset", 1e-5)):
        near = differences(run, name, values, step)
        print(f"{name:8s} {exact[name]:+.10e}   differences of whole runs {near:+.10e}   apart by {abs(exact[name] / near - 1):.0e}")
