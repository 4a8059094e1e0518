"""A small host at finite strain: compressible neo-Hooke in plane strain (quadrilaterals) or in space (hexahedra)."""

import numpy as np
import scipy.sparse
import stickslip
from numpy_blocks import CORNERS

SQUARE = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)])
YOUNG, POISSON = 1.0, 0.3


def block(lower, upper, cells, shape=None):
    """Nodes and cells of a box in any dimension; ``shape`` maps its nodes (n, d) to others."""
    axes = [np.linspace(a, b, n + 1) for a, b, n in zip(lower, upper, cells)]
    X = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, len(axes))
    number = np.arange(len(X)).reshape([n + 1 for n in cells])
    signs = CORNERS if len(axes) == 3 else SQUARE
    places = [tuple(slice(i, i + n) for i, n in zip(corner, cells)) for corner in (signs + 1) // 2]
    cells = np.column_stack([number[place].ravel() for place in places])
    return (X if shape is None else shape(X)), cells


class Solids:
    """Bodies of ``block``s, or of other (nodes, cells), each with its own modulus."""

    def __init__(self, *bodies, young=YOUNG):
        young = np.broadcast_to(young, len(bodies))
        starts = np.cumsum([0, *(len(X) for X, _ in bodies)])
        self.X = np.vstack([X for X, _ in bodies])
        self.nodes = [np.arange(a, b) for a, b in zip(starts, starts[1:])]
        self.cells = np.vstack([cells + start for (_, cells), start in zip(bodies, starts)])
        self.dofs = np.arange(self.X.size).reshape(self.X.shape)
        self.dimension = self.X.shape[1]
        modulus = np.repeat(young, [len(cells) for _, cells in bodies])
        self.shear, self.lame = modulus / (2 * (1 + POISSON)), modulus * POISSON / ((1 + POISSON) * (1 - 2 * POISSON))
        self.least, self.cut, self.rigid = float(np.min(young)), np.empty(0, int), np.empty(0, int)
        signs = CORNERS if self.dimension == 3 else SQUARE
        self.gradients, self.volumes = [], []
        for point in signs / np.sqrt(3):
            factors = (1 + signs * point) / 2
            local = np.stack([signs[:, k] / 2 * np.delete(factors, k, axis=1).prod(axis=1) for k in range(self.dimension)], axis=1)
            J = np.einsum("eai,aj->eij", self.X[self.cells], local)
            self.gradients.append(np.einsum("aj,eji->eai", local, np.linalg.inv(J)))
            self.volumes.append(np.linalg.det(J))
        own = self.dofs[self.cells].reshape(len(self.cells), -1)
        self.rows, self.columns, self.own = own.repeat(own.shape[1]), np.tile(own, own.shape[1]).ravel(), own

    def skin(self):
        """All outer facets, without cuts on planes of symmetry."""
        facets = stickslip.skin(self.cells, self.X)
        return facets[~np.isin(facets, self.cut).all(axis=1)]

    def bodies(self):
        """Of each facet of the skin its body."""
        return np.searchsorted([nodes[-1] for nodes in self.nodes], self.skin()[:, 0])

    def evaluate(self, u, tangent):
        """Forces or stiffnesses of the cells. Stresses come from the gradient of u, so that their rounding is in proportion to it."""
        u = u.reshape(self.X.shape)[self.cells]
        eye, total = np.eye(self.dimension), 0.0
        for grad, volume in zip(self.gradients, self.volumes):
            H = np.einsum("eai,eaj->eij", u, grad)
            growth = np.trace(H, axis1=1, axis2=2) + np.linalg.det(H)
            if self.dimension == 3:
                growth += (np.trace(H, axis1=1, axis2=2) ** 2 - np.einsum("eij,eji->e", H, H)) / 2
            if not (growth > -1).all():
                raise stickslip.StepRefused("a cell is turned inside out")
            inverse, log = np.linalg.inv(eye + H), np.log1p(growth)
            if not tangent:
                back = inverse.transpose(0, 2, 1)
                P = self.shear[:, None, None] * (H + back @ H.transpose(0, 2, 1)) + (self.lame * log)[:, None, None] * back
                total = total + np.einsum("eij,eaj,e->eai", P, grad, volume)
                continue
            now = np.einsum("eaj,eji->eai", grad, inverse)
            direct = np.einsum("eaj,ebj->eab", grad, grad)
            K = np.einsum("e,eab,ik->eaibk", volume * self.shear, direct, eye)
            K += np.einsum("e,eak,ebi->eaibk", volume * (self.shear - self.lame * log), now, now)
            K += np.einsum("e,eai,ebk->eaibk", volume * self.lame, now, now)
            total = total + K
        return total

    def residual(self, u, time=1.0):
        return np.bincount(self.own.ravel(), self.evaluate(u, False).ravel(), self.X.size)

    def tangent(self, u, time=1.0):
        values = self.evaluate(u, True).ravel()
        return scipy.sparse.coo_matrix((values, (self.rows, self.columns)), shape=(self.X.size,) * 2).tocsr()

    def contact(self, **options):
        """General contact of the whole skin. Cuts leave the walls of a body without a connection, so the bodies are named."""
        return self.contacts().add(self.skin(), bodies=self.bodies(), **{"modulus": self.least, **options})

    def contacts(self):
        """A Contact without interfaces; rigid nodes have no unknowns there."""
        dofs = self.dofs.copy()
        dofs[self.rigid] = -1
        return stickslip.Contact(self.X, dofs, self.X.size)


class Run:
    """Steps of a scene: ``prescribe(time)`` gives (nodes, displacements) pairs, NaN where a component is free."""

    def __init__(self, solids, contact, prescribe, load=None):
        self.solids, self.contact, self.prescribe, self.load = solids, contact, prescribe, load
        self.x, self.iterations, self.ends, self.states = contact.start(), [], [], []

    def held(self, time):
        fixed, values = [], []
        for nodes, displacement in self.prescribe(time):
            wanted = np.broadcast_to(displacement, (len(nodes), self.solids.dimension))
            fixed.append(self.solids.dofs[nodes][~np.isnan(wanted)])
            values.append(wanted[~np.isnan(wanted)])
        fixed, first = np.unique(np.concatenate(fixed), return_index=True)
        return fixed, np.concatenate(values)[first]

    def solve(self, time, **how):
        fixed, values = self.held(time)
        load = 0.0 if self.load is None else self.load(time)
        return stickslip.newton(self.contact, lambda u: self.solids.residual(u) - load, self.solids.tangent, self.x, fixed=fixed, values=values,
                                **how)

    def step(self, time, **how):
        before = self.x.copy()
        try:
            self.iterations.append(self.solve(time, **how))
        except stickslip.StepRefused:  # as stickslip.steps goes on
            self.x[:] = before
            self.iterations.append(self.solve(time, search=True))
        self.states = self.contact.states(self.x)
        self.contact.check(self.x)
        self.ends.append(self.x.copy())
        self.contact.commit(self.x)

    def go(self, times, **how):
        for time in times:
            self.step(time, **how)
        return self

    @property
    def u(self):
        return self.ends[-1][: self.solids.X.size].reshape(self.solids.X.shape)

    def displacements(self):
        return np.array([x[: self.solids.X.size] for x in self.ends])
