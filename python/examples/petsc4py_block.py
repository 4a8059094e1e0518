"""An elastic block is pressed on a rigid base and pushed along it, with friction: PETSc's SNES from Python.

The problem and the options are those of c_examples/petsc_block.c: -n, -steps, -friction, -load, -push, and PETSc's own; besides
-poisson, and -output FILE, which receives a row X Y Z ux uy uz for each node. It runs on any number of processes. Each has a share
of the cells and a part of the interface (docs/host_parallel.md):

    python petsc4py_block.py -n 6
    mpiexec -n 2 python petsc4py_block.py -n 6
"""

import sys

import petsc4py

# Full steps find the states of the nodes fastest. Multipliers of nodes that stick have no diagonal: the factorisation must
# pivot, and MUMPS needs more room for that than it expects. The command line overrides these.
DEFAULTS = ["-snes_linesearch_type", "basic", "-ksp_type", "preonly", "-pc_type", "lu",
            "-pc_factor_mat_solver_type", "mumps", "-mat_mumps_icntl_14", "200"]
petsc4py.init([sys.argv[0], *DEFAULTS, *sys.argv[1:]])

import numpy as np
from petsc4py import PETSc

import stickslip

SIZE, YOUNG = np.array([2.0, 2.0, 1.0]), 1000.0
# Newton's tolerance, and ten times it for the contact, over scales of its own.
RTOL, CONTACT_RTOL = 1e-11, 1e-10
OWN, ELSEWHERE = stickslip.constants["NODE_OWN"], stickslip.constants["NODE_ELSEWHERE"]
# Of the time, in which pressing takes 1 and pushing 1.
SHORTEST = 1e-3
# Rings of facets that a part has around its own nodes: docs/host_parallel.md.
RINGS = 3
STATES = tuple(stickslip.constants["STATE_" + name] for name in ("GAP", "STICK", "SLIP"))

options = PETSc.Options()
n, steps = options.getInt("n", 6), options.getInt("steps", 10)
poisson = options.getReal("poisson", 0.3)
friction, load, push = options.getReal("friction", 0.3), options.getReal("load", 40.0), options.getReal("push", 0.1)
comm = PETSc.COMM_WORLD
rank, ranks = comm.getRank(), comm.getSize()


def over_ranks(values, what):
    """The sums ("sum") or the maxima ("max") of some numbers over all processes."""
    vector = PETSc.Vec().createMPI((1, None), comm=comm)
    out = []
    for value in values:
        vector.array[:] = value
        out.append(vector.sum() if what == "sum" else vector.max()[1])
    vector.destroy()
    return np.array(out)


def share(count):
    """The numbers that belong to this process, of 0 ... count - 1."""
    return np.arange(count * rank // ranks, count * (rank + 1) // ranks)


# ---- mesh: the first n1 nodes are those of the bottom, the last n1 those of the top -------------------------------
cells = np.array([n, n, (n + 1) // 2])
n1 = (n + 1) ** 2
number = np.arange(n1 * (cells[2] + 1)).reshape(cells[2] + 1, n + 1, n + 1)  # [z, y, x]
x_axis, y_axis, z_axis = (np.arange(c + 1) * length / c for c, length in zip(cells, SIZE))
X = np.array([(x, y, z) for z in z_axis for y in y_axis for x in x_axis])


def corners(layer):
    """Of each square of a layer of nodes: counter-clockwise from above."""
    return np.stack([layer[:-1, :-1], layer[:-1, 1:], layer[1:, 1:], layer[1:, :-1]], axis=-1).reshape(-1, 4)


hexahedra = np.vstack([np.hstack([corners(number[k]), corners(number[k + 1])]) for k in range(cells[2])])
top = number[-1].ravel()
n_displacements, n_unknowns = X.size, X.size + 3 * n1
prescribed = np.concatenate([3 * top, 3 * top + 1])  # of the top, z alone is free
mine = hexahedra[share(len(hexahedra))]
places = (3 * mine[:, :, None] + np.arange(3)).reshape(-1, 24).astype(PETSc.IntType)
loaded = mine[np.isin(mine[:, 4], top)][:, 4:]  # the squares on top


def element_stiffness():
    """K = int B^T C B dV of a box, 2 x 2 x 2 Gauss points; all are alike."""
    h = SIZE / cells
    signs = np.array([(x, y, z) for z in (-1, 1) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))])
    shear = YOUNG / (2 * (1 + poisson))
    lame = 2 * shear * poisson / (1 - 2 * poisson)
    out = np.zeros((8, 3, 8, 3))
    for point in signs / np.sqrt(3):
        factors = 1 + signs * point
        g = signs * factors[:, [1, 2, 0]] * factors[:, [2, 0, 1]] / (4 * h)  # dN/dX
        out += h.prod() / 8 * (lame * np.einsum("ai,bj->aibj", g, g) + shear * np.einsum("aj,bi->aibj", g, g)
                               + shear * np.einsum("ac,bc,ij->aibj", g, g, np.eye(3)))
    return out.reshape(24, 24)


K = element_stiffness()


class Part:
    """The interface around this process' own nodes of the bottom, over the base, which has no unknowns."""

    def __init__(self):
        own = share(n1)
        facets = corners(number[0])[:, ::-1]  # right-hand order from outside: the bottom is seen from below
        nodes = own
        for _ in range(RINGS):
            ring = facets[np.isin(facets, nodes).any(axis=1)]
            nodes = np.unique(ring)
        self.own = np.isin(nodes, own)
        self.displacements = 3 * nodes[:, None] + np.arange(3)
        self.multipliers = n_displacements + self.displacements
        left, right = min(-1.0, push - 0.5), max(3.0, push + 2.5)  # the block stays on it
        self.base = np.array([(left, -1, 0), (right, -1, 0), (right, 3, 0), (left, 3, 0)])
        block = stickslip.Surface(X[nodes], np.searchsorted(nodes, ring), self.displacements, self.multipliers,
                                  np.where(self.own, OWN, ELSEWHERE).astype(np.int32))
        self.X = X[nodes]
        # The modulus gives the augmentation its unit; the answer does not depend on it.
        self.face = stickslip.Interface(block, stickslip.Surface(self.base, [[0, 1, 2, 3]]), mu=friction, modulus=YOUNG)
        self.plan = stickslip.Plan(self.face, self.X, self.base, n_unknowns, pairs="skin")

    def point(self, u):
        """Positions of both sides, and the multipliers."""
        return self.X + u[self.displacements], self.base, u[self.multipliers]


part = Part()


class Block:
    """The callbacks of SNES. pressed, moved: the force on the top face and its way along x."""

    pressed = moved = 0.0

    def __init__(self):
        self.x = PETSc.Vec().createMPI(n_unknowns, comm=comm)
        self.to_all, self.all = PETSc.Scatter.toAll(self.x)

    def values(self, x):
        """All unknowns, on every process."""
        self.to_all.scatter(x, self.all, addv=PETSc.InsertMode.INSERT, mode=PETSc.ScatterMode.FORWARD)
        return self.all.array_r.copy()

    def function(self, snes, x, f):
        """Internal forces + contact - loads; where a displacement is prescribed, that; then the multiplier rows."""
        u = self.values(x)
        r = np.zeros(n_unknowns)
        np.add.at(r, places, u[places] @ K)
        np.add.at(r, 3 * loaded + 2, self.pressed / (4 * n * n))
        try:
            force1, _, rows = part.face.residual(*part.point(u))
        except stickslip.Error:  # the iterate has run away: all processes see a norm that is no number
            force1, rows = np.full(part.X.shape, np.nan), np.zeros(part.X.shape)
        np.add.at(r, part.displacements, force1)
        r[part.multipliers[part.own]] = rows[part.own]
        f.set(0)
        f.setValues(np.arange(n_unknowns, dtype=PETSc.IntType), r, addv=True)
        f.assemble()
        self.contact = -over_ranks(force1.sum(axis=0), "sum")
        first, end = f.getOwnershipRange()
        here = prescribed[(prescribed >= first) & (prescribed < end)]
        self.reaction = over_ranks([f.array_r[here[here % 3 == i] - first].sum() for i in range(3)], "sum")
        f.array[here - first] = K[0, 0] * (u[here] - np.where(here % 3 == 0, self.moved, 0.0))

    def jacobian(self, snes, x, J, P):
        """Rows of prescribed displacements are those of the identity times K_00; negative rows are left out."""
        P.zeroEntries()
        for place in places:
            P.setValues(np.where(np.isin(place, prescribed), -1, place).astype(PETSc.IntType), place, K, addv=True)
        for k in prescribed if rank == 0 else ():
            P.setValue(k, k, K[0, 0], addv=True)
        tangent = part.plan.values(*part.point(self.values(x)))
        rows = np.flatnonzero(np.diff(tangent.indptr)).astype(PETSc.IntType)
        offsets = np.append(tangent.indptr[rows], tangent.nnz).astype(PETSc.IntType)
        P.setValuesIJV(offsets, tangent.indices.astype(PETSc.IntType), tangent.data, addv=True, rowmap=rows)
        P.assemble()

    def converged(self, snes, iteration, norms):
        """SNES' own test, and then the library's: the multiplier rows are as small as the augmentation, and cannot tell."""
        norm = norms[2]
        if iteration == 0:
            self.first_norm = norm
        if not np.isfinite(norm):
            return PETSc.SNES.ConvergedReason.DIVERGED_FUNCTION_DOMAIN
        if norm > RTOL * self.first_norm:
            return PETSc.SNES.ConvergedReason.ITERATING
        e = part.face.equilibrium(*part.point(self.values(snes.getSolution())), modulus=YOUNG)
        found = over_ranks([e.gap, e.traction, e.slip], "max")
        scales = over_ranks([e.gap_scale, e.traction_scale, e.slip_scale], "max")
        reasons = PETSc.SNES.ConvergedReason
        return reasons.CONVERGED_FNORM_RELATIVE if (found <= CONTACT_RTOL * scales).all() else reasons.ITERATING


problem = Block()
matrix = PETSc.Mat().createAIJ([n_unknowns, n_unknowns], comm=comm)
matrix.setUp()
matrix.setOption(PETSc.Mat.Option.NEW_NONZERO_ALLOCATION_ERR, False)  # pairs of facets come while the block slides
snes = PETSc.SNES().create(comm=comm)
snes.setFunction(problem.function, problem.x.duplicate())
snes.setJacobian(problem.jacobian, matrix)
snes.setConvergenceTest(problem.converged)
snes.setTolerances(max_it=25)
snes.setFromOptions()
problem.x.setValues(part.multipliers[part.own].ravel().astype(PETSc.IntType),
                    part.face.initial_multipliers()[part.own].ravel())
problem.x.assemble()


def accepted(point):
    """Commits where every process' part would: all of them, or none."""
    refusal = ""
    try:
        part.face.commit_check(*point)
    except stickslip.Error as error:
        refusal = str(error)
        print(f"rank {rank}: {refusal}", file=sys.stderr)
    if over_ranks([bool(refusal)], "max")[0]:
        return False
    part.face.commit(*point)
    return True


def attempt(time):
    """Newton's method for the loads of this time, from what the step before has left, and the commit: whether both go."""
    problem.pressed, problem.moved = load * min(time, 1), push * max(time - 1, 0)
    snes.solve(None, problem.x)
    if snes.getConvergedReason() <= 0:
        return False
    problem.function(snes, problem.x, snes.getFunction()[0])  # the forces of the solution
    point = part.point(problem.values(problem.x))
    problem.states = part.face.states(*point).state[part.own]  # before the commit
    return accepted(point)


def advance(begin, end):
    """From one time to another, in halves where it does not go at once: the iterations of all that went."""
    problem.x.copy(before := problem.x.duplicate())
    if attempt(end):
        return snes.getIterationNumber()
    if end - begin < SHORTEST:
        raise SystemExit(f"time {begin:g}: no step is short enough (SNES' last reason: {snes.getConvergedReason()})")
    before.copy(problem.x)
    middle = (begin + end) / 2
    PETSc.Sys.Print(f"cut back to {middle:g}")
    return advance(begin, middle) + advance(middle, end)


for step in range(1, steps + 1):
    iterations = advance(2 * (step - 1) / steps, 2 * step / steps)
    pressed = problem.values(problem.x)[part.multipliers[part.own]][:, 2]
    least, most = over_ranks([-pressed.min(), pressed.max()], "max") * (-1, 1)
    gap, stick, slip = over_ranks([(problem.states == state).sum() for state in STATES], "sum").astype(int)
    PETSc.Sys.Print(f"step {step}: {iterations} iterations, {gap} gap {stick} stick {slip} slip, "
                    f"load {problem.pressed:.12g} contact {problem.contact[2]:.12g} {problem.contact[0]:.12g} "
                    f"reaction {problem.reaction[0]:.12g} multipliers along z {least:.16g} {most:.16g}")
if options.hasName("output"):
    u = problem.values(problem.x)
    if rank == 0:
        np.savetxt(options.getString("output"), np.hstack([X, u[:n_displacements].reshape(-1, 3)]), fmt="%.17g")
