"""Rigid bodies: a reference point with six unknowns, in the plane three, in place of those of its nodes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from . import _arrays
from ._arrays import Array, given, output, pointer
from ._library import call, ffi
from .plan import empty_csr

if TYPE_CHECKING:
    import scipy.sparse


# By STICKSLIP_RIGID_ARMS_...
_ARMS = ("end", "middle")


def _destroy(handle: Any) -> None:
    call("rigid_destroy", ffi.new("struct stickslip_rigid **", handle))


class RigidBody:
    """Nodes that move with a reference point P: x = P + u + exp[theta] R (X - P).

    Parameters
    ----------
    coordinates : (n, 3) float64, of plane and axisymmetric models (n, 2)
        All nodes of the body that interfaces have, in the first configuration [L].
    node_equations : like ``coordinates``, int64
        Those that the :class:`Surface` of the body was made with: numbers that no other unknown has, such as those from the
        number of the host's equations on; -1 is none.
    point : (3,) or (2,) float64
        P in the first configuration, anywhere [L]. Moments are about it as it is now.
    equations : (6,) or (3,) int64
        The host's equations of u and theta; -1 is prescribed.
    """

    def __init__(self, coordinates: ArrayLike, node_equations: ArrayLike, point: ArrayLike, equations: ArrayLike):
        self.coordinates = _arrays.coordinates(coordinates)
        self.n_nodes, self.dimension = self.coordinates.shape
        self.n_unknowns = 6 if self.dimension == 3 else 3
        self.node_equations = given("node_equations", node_equations, self.coordinates.shape, np.int64)
        self.point = given("point", point, (self.dimension,))
        self.equations = given("equations", equations, (self.n_unknowns,), np.int64)
        self._body = ffi.new("struct stickslip_rigid_body *")
        self._body.struct_size = ffi.sizeof("struct stickslip_rigid_body")
        self._body.dimension, self._body.n_nodes = self.dimension, self.n_nodes
        self._kept = {name: pointer(getattr(self, name)) for name in ("coordinates", "point", "node_equations", "equations")}
        for name, address in self._kept.items():
            setattr(self._body, name, address)
        self._motion = ffi.new("struct stickslip_rigid_motion *")
        self._motion.struct_size = ffi.sizeof("struct stickslip_rigid_motion")

    @property
    def unknowns(self) -> Array:
        """u [L] and theta [-], (6,) or (3,), in the order of ``equations``; set it to what the host has found.

        theta is the rotation vector since the last :meth:`turn`, at most pi long; in the plane an angle.
        """
        u, theta = self._motion.displacement, self._motion.rotation
        return np.array([*u, *theta] if self.dimension == 3 else [u[0], u[1], theta[2]])

    @unknowns.setter
    def unknowns(self, value: ArrayLike) -> None:
        value, d = given("unknowns", value, (self.n_unknowns,)), self.dimension
        self._motion.displacement[0:d] = value[:d].tolist()
        self._motion.rotation[3 - len(value[d:]) : 3] = value[d:].tolist()

    @property
    def turned(self) -> Array:
        """R, what the body had turned by at t_n, (3, 3) [-]. Keep it for a restart, and set it then."""
        turned = np.array(list(self._motion.turned)).reshape(3, 3)
        return turned if turned.any() else np.eye(3)

    @turned.setter
    def turned(self, value: ArrayLike) -> None:
        self._motion.turned[0:9] = given("turned", value, (3, 3)).ravel().tolist()

    @property
    def arms(self) -> str:
        """Of which place the arms of forces are, in :meth:`resultant` and :class:`RigidPlan`: "end", that of the unknowns (default), or
        "middle", the means of those and of the arms at t_n, for dynamics (docs/formulation 14.7)."""
        return _ARMS[self._motion.arms]

    @arms.setter
    def arms(self, value: str) -> None:
        if value not in _ARMS:
            raise ValueError(f"arms: {value!r}, 'end' or 'middle' is needed")
        self._motion.arms = _ARMS.index(value)

    def positions(self, out: Array | None = None) -> Array:
        """Where the nodes are, like ``coordinates`` [L]: x1 or x2 of an interface."""
        out = output("out", out, self.coordinates.shape)
        call("rigid_positions", self._body, self._motion, pointer(out))
        return out

    def resultant(self, forces: ArrayLike, out: Array | None = None) -> Array:
        """Force [F] and moment about the reference point [F L], (6,) or (3,), of forces on the nodes, like ``coordinates``.

        Of ``force1`` or ``force2`` of :meth:`Interface.residual` it is what to add to the host's internal forces in ``equations``.
        """
        out = output("out", out, (self.n_unknowns,))
        forces = given("forces", forces, self.coordinates.shape)
        call("rigid_resultant", self._body, self._motion, pointer(forces), pointer(out))
        return out

    def turn(self) -> None:
        """After a converged step: theta is taken into ``turned`` and is 0 then. The nodes stay where they are."""
        call("rigid_turn", self._motion)


class RigidPlan:
    """The matrix of the host's unknowns from that of all nodes: rows and columns of a rigid body's nodes become its own.

    ``matrix`` is a scipy CSR matrix of ``(size, size)``, refilled in place by :meth:`values`. Where the entries of the nodal matrix
    are others than before, it is another object, and ``renewals`` has grown by one.

    Parameters
    ----------
    bodies : each once, whatever interfaces it is in
    size : the number of the host's equations; the node equations of bodies are not among them
    """

    def __init__(self, bodies: Sequence[RigidBody], size: int):
        self.bodies = tuple(bodies)
        self.matrix: scipy.sparse.csr_matrix | None = None
        self.renewals = 0
        self._size = size
        self._entries: tuple[Array, ...] = ()
        self._handle = None

    def values(self, nodal: scipy.sparse.spmatrix, forces: Sequence[ArrayLike]) -> scipy.sparse.csr_matrix:
        """Fills the matrix and gives it.

        Parameters
        ----------
        nodal : a scipy matrix in COO, CSR or CSC with rows and columns of nodes: the tangent of an interface, or a sum of several
        forces : of each body those on its nodes, as for :meth:`RigidBody.resultant`: their arms turn with the body
        """
        if getattr(nodal, "format", None) not in ("coo", "csr", "csc"):
            raise TypeError(f"nodal: {type(nodal).__name__}, a scipy matrix in COO, CSR or CSC is needed")
        if len(forces) != len(self.bodies):
            raise ValueError(f"forces: {len(forces)} arrays, one of each of {len(self.bodies)} bodies is needed")
        together = np.concatenate([given(f"forces[{k}]", part, body.coordinates.shape).ravel()
                                   for k, (part, body) in enumerate(zip(forces, self.bodies))])
        data = given("nodal", nodal.data, (nodal.nnz,))
        matrix = self._matrix_of(nodal.tocoo(copy=False))
        motions = ffi.new("struct stickslip_rigid_motion[]", [body._motion[0] for body in self.bodies])
        call("rigid_values", self._handle, motions, pointer(together), pointer(data), pointer(matrix.data))
        return matrix

    def _matrix_of(self, coo: Any) -> scipy.sparse.csr_matrix:
        """The matrix as it is, or a new one if the entries are others. A refusal leaves everything as it was."""
        if self.matrix is not None and all(map(np.array_equal, self._entries, (coo.row, coo.col))):
            return self.matrix
        rows, columns = coo.row.astype(np.int64), coo.col.astype(np.int64)
        bodies = ffi.new("struct stickslip_rigid_body[]", [body._body[0] for body in self.bodies])
        slot, count = ffi.new("struct stickslip_rigid **"), ffi.new("int64_t *")
        call("rigid_create", len(bodies), bodies, 0, len(rows), pointer(rows), pointer(columns), slot, count)
        handle = ffi.gc(slot[0], _destroy)
        new_rows, new_columns = np.empty(count[0], np.int64), np.empty(count[0], np.int64)
        call("rigid_coo", handle, count[0], pointer(new_rows), pointer(new_columns))
        matrix = empty_csr(*np.unique(new_rows, return_counts=True), new_columns, self._size)
        self.renewals += self.matrix is not None
        self.matrix, self._handle, self._entries = matrix, handle, (rows, columns)
        return matrix
