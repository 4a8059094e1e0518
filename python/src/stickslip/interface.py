"""The handle of an interface: residual, tangent, states, history."""

from __future__ import annotations

import inspect
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from . import options as _options
from ._arrays import Array, given, output, pointer
from ._handle import Handle
from ._heat import Heats
from ._inspection import Inspection
from ._laws import Laws
from ._library import call, ffi, value_of
from ._sensitivity import Sensitivities
from .errors import Error
from .surface import Surface

if TYPE_CHECKING:
    import scipy.sparse
    from typing_extensions import Unpack


class Interface(Heats, Inspection, Laws, Sensitivities, Handle):
    """Two surfaces in contact.

    ``x1`` and ``x2`` are current positions of the non-mortar and the mortar nodes, (n1, d) and (n2, d) [L], with d = 3, or
    2 in plane and axisymmetric models. ``lam`` are the multipliers, (n1, d) or (n1,) without friction [F/L^2]:
    minus the Cauchy traction on the non-mortar body. ``sums`` is for hosts on several processes.

    Parameters
    ----------
    nonmortar, mortar : Surface
        The non-mortar side has the multipliers.
    **options
        :class:`stickslip.Options`: members of ``stickslip_options`` and of ``stickslip_method`` by name, for example
        ``mu=0.2, modulus=210e3, model="plane"``; ``method="paper"`` takes the paper's element.
        A choice is the end of the header's constant in small letters. What is left out has the library's default.
    """

    _kind = "interface"

    def __init__(self, nonmortar: Surface, mortar: Surface, **options: Unpack[_options.Options]):
        made, _method = _options.make(dict(options))
        first, kept_first = nonmortar._struct()
        second, kept_second = mortar._struct()
        self.dimension = 3 if made.model == value_of("model", "MODEL", "solid") else 2
        for name, surface in (("nonmortar", nonmortar), ("mortar", mortar)):
            if surface.dimension != self.dimension:
                raise ValueError(f"{name}: {surface.dimension} coordinates a node, the model has {self.dimension}")
        self._shape1, self._shape2 = nonmortar.coordinates.shape, mortar.coordinates.shape
        self.n1, self.n2 = nonmortar.n_nodes, mortar.n_nodes
        none = made.friction == value_of("friction", "FRICTION", "none")
        self._shape_multipliers = (self.n1,) if none else self._shape1
        # A longer array cannot be told from a pointer: the library would read the wrong numbers.
        numbers = nonmortar.multiplier_equations
        if numbers is None or numbers.size != int(np.prod(self._shape_multipliers)):
            found = None if numbers is None else numbers.shape
            raise ValueError(f"multiplier_equations of nonmortar: {found}, {self._shape_multipliers} is needed")
        self._bearing = np.any(numbers.reshape(self.n1, -1) >= 0, axis=1)
        slot = ffi.new("struct stickslip_interface **")
        call("interface_create", first, second, made, slot)
        del kept_first, kept_second
        self._handle = slot[0]
        law = _options.word("FRICTION", made.friction)
        self._text = f"{nonmortar} on {mortar}, {law}{f', mu {made.mu:g}' if made.mu else ''}"
        self._told = "no states yet"
        self.has_offsets = False

    def __repr__(self) -> str:
        return f"<Interface: {self._text}; {'closed' if self._handle == ffi.NULL else self._told}>"

    def _destroy(self, slot: Any) -> None:
        call("interface_destroy", slot)

    def _call(self, name: str, *arguments: Any) -> None:
        try:
            super()._call("interface_" + name, *arguments)
        except Error as refused:
            cause, self._law_error = self._law_error, None
            if cause is None:
                raise
            raise refused from cause

    def _positions(self, x1: ArrayLike, x2: ArrayLike) -> tuple[Any, Any]:
        return pointer(given("x1", x1, self._shape1)), pointer(given("x2", x2, self._shape2))

    def _sums(self, sums: ArrayLike | None) -> Any:
        from ._library import constants

        shape = (self.n1, constants["SUMS_PER_NODE"])
        return ffi.NULL if sums is None else pointer(given("sums", sums, shape))

    def _point(self, x1: ArrayLike, x2: ArrayLike, lam: ArrayLike, sums: ArrayLike | None) -> tuple[Any, ...]:
        multipliers = pointer(given("lam", lam, self._shape_multipliers))
        return (*self._positions(x1, x2), multipliers, self._sums(sums))

    def initial_multipliers(self, out: Array | None = None) -> Array:
        """Multipliers to start the first step with, not zero, so that a body that rests on contact is held."""
        out = output("out", out, self._shape_multipliers)
        self._call("initial_multipliers", pointer(out))
        return out

    def residual(self, x1: ArrayLike, x2: ArrayLike, lam: ArrayLike, *, sums: ArrayLike | None = None,
                 out: tuple[Array | None, Array | None, Array | None] = (None, None, None)) -> tuple[Array, Array, Array]:
        """``(force1, force2, rows)``: what to add to the host's internal forces [F], and the multiplier rows.

        The force on the non-mortar body is ``-force1``. ``out``: three arrays to write to.
        """
        shapes = self._shape1, self._shape2, self._shape_multipliers
        names = "force1", "force2", "rows"
        force1, force2, rows = (output(name, array, shape) for name, array, shape in zip(names, out, shapes))
        self._call("residual", *self._point(x1, x2, lam, sums), pointer(force1), pointer(force2), pointer(rows))
        return force1, force2, rows

    def tangent(self, x1: ArrayLike, x2: ArrayLike, lam: ArrayLike, size: int, *, sums: ArrayLike | None = None,
                form: str = "csr") -> scipy.sparse.spmatrix:
        """The derivative of the residual, a scipy sparse matrix of ``(size, size)`` in the host's equations."""
        import scipy.sparse

        point = self._point(x1, x2, lam, sums)
        count = ffi.new("int64_t *")
        self._call("tangent_coo", *point, 0, ffi.NULL, ffi.NULL, ffi.NULL, count)
        capacity = count[0]
        rows, columns = np.empty(capacity, np.int64), np.empty(capacity, np.int64)
        values = np.empty(capacity)
        self._call("tangent_coo", *point, capacity, pointer(rows), pointer(columns), pointer(values), count)
        n = count[0]
        matrix = scipy.sparse.coo_matrix((values[:n], (rows[:n], columns[:n])), shape=(size, size))
        return matrix if form == "coo" else matrix.asformat(form)

    def sums(self, x1: ArrayLike, x2: ArrayLike) -> Array:
        """What a host on several processes adds up over them, (n1, SUMS_PER_NODE)."""
        from ._library import constants

        out = np.empty((self.n1, constants["SUMS_PER_NODE"]))
        self._call("sums", *self._positions(x1, x2), pointer(out))
        return out

    def commit(self, x1: ArrayLike, x2: ArrayLike, lam: ArrayLike, *, sums: ArrayLike | None = None) -> None:
        """Accepts a converged step: it becomes t_n."""
        self._call("commit", *self._point(x1, x2, lam, sums))

    def commit_check(self, x1: ArrayLike, x2: ArrayLike, lam: ArrayLike, *, sums: ArrayLike | None = None) -> None:
        """Raises what :meth:`commit` would raise; nothing changes. For several interfaces or processes: all accept a step, or none."""
        self._call("commit_check", *self._point(x1, x2, lam, sums))

    def rollback(self) -> None:
        """Undoes the last commit."""
        self._call("rollback")

    def history(self) -> dict[str, Array]:
        """The committed history as arrays, to pickle."""
        integers, reals = ffi.new("int64_t *"), ffi.new("int64_t *")
        self._call("history_size", integers, reals)
        out = {"integers": np.empty(integers[0], np.int64), "reals": np.empty(reals[0])}
        self._call("history_export", integers[0], pointer(out["integers"]), reals[0], pointer(out["reals"]))
        return out

    def restore(self, history: dict[str, Array]) -> None:
        """Takes a history of an interface that was made in the same way."""
        integers, reals = history["integers"], history["reals"]
        integers = given("integers", integers, (len(integers),), np.int64)
        reals = given("reals", reals, (len(reals),))
        self._call("history_import", len(integers), pointer(integers), len(reals), pointer(reals))

    def step_limit(self, x1: ArrayLike, x2: ArrayLike, dx1: ArrayLike, dx2: ArrayLike, penetration: float = 0.0) -> float:
        """How much of a step (dx1, dx2) may be taken, at most 1."""
        out = ffi.new("double *")
        step = pointer(given("dx1", dx1, self._shape1)), pointer(given("dx2", dx2, self._shape2))
        self._call("step_limit", *self._positions(x1, x2), *step, penetration, out)
        return float(out[0])

    def set_friction(self, mu: ArrayLike) -> None:
        """Coulomb coefficients of the non-mortar nodes, (n1,) [-]."""
        self._call("set_friction", pointer(given("mu", mu, (self.n1,))))

    def set_augmentation(self, r: ArrayLike) -> None:
        """The augmentation of each node, (n1,), in the unit of the header's function."""
        self._call("set_augmentation", pointer(given("r", r, (self.n1,))))

    def set_normals(self, normals: ArrayLike) -> None:
        """Normals of the non-mortar nodes, like x1, into the non-mortar body."""
        self._call("set_normals", pointer(given("normals", normals, self._shape1)))

    def set_offsets(self, offsets1: ArrayLike | None = None, offsets2: ArrayLike | None = None) -> None:
        """Offsets of the non-mortar and the mortar nodes, (n1,) and (n2,); None: none. Positive ones open gaps."""
        offsets1 = None if offsets1 is None else given("offsets1", offsets1, (self.n1,))
        offsets2 = None if offsets2 is None else given("offsets2", offsets2, (self.n2,))
        self._call("set_offsets", pointer(offsets1), pointer(offsets2))
        self.has_offsets = offsets1 is not None or offsets2 is not None

    def shape_offsets(self, side: str, shape: str, radius: float, point: ArrayLike,
                      direction: ArrayLike = (0.0, 0.0, 1.0)) -> Array:
        """Offsets that give the facets of one side, "nonmortar" or "mortar", the "sphere" or "cylinder" back that they stand for.

        ``radius``: negative of a cavity; ``point``: the centre, or one of the axis, in the plane of two numbers; ``direction``: of the axis. See
        ``set_offsets``.
        """
        number = value_of("side", "SIDE", side)
        out = np.empty(self.n2 if number else self.n1)
        if self.dimension == 2 and np.shape(point) == (2,):
            point = [*np.asarray(point), 0.0]
        place = pointer(given("point", point, (3,))), pointer(given("direction", direction, (3,)))
        self._call("shape_offsets", number, value_of("shape", "SHAPE", shape), float(radius), *place, pointer(out))
        return out

    def adjust(self, tolerance: float) -> tuple[Array, Array, Array]:
        """``(coordinates, gaps, moved)``: the non-mortar nodes put onto the mortar side where they are within ``tolerance`` of it.

        ``coordinates`` like x1; ``gaps``, (n1,): the distance before; ``moved``, (n1,) int32: 0 nothing opposite, 1 left, 2 moved.
        Nothing changes in the interface: make it anew with the coordinates.
        """
        coordinates, gaps, moved = np.empty(self._shape1), np.empty(self.n1), np.empty(self.n1, np.int32)
        self._call("adjust", float(tolerance), pointer(coordinates), pointer(gaps), pointer(moved))
        return coordinates, gaps, moved

    def set_previous(self, x1: ArrayLike, x2: ArrayLike) -> None:
        """The positions at t_n of a host that starts elsewhere than at the first configuration."""
        self._call("set_previous", *self._positions(x1, x2))

    def set_committed(self, x1: ArrayLike, x2: ArrayLike, slip: ArrayLike | None = None, commits: int = 0) -> None:
        """The positions at t_n of other parts' last commit, the slip of each node then, like x1, and how many commits there were."""
        slip = None if slip is None else pointer(given("slip", slip, self._shape1))
        self._call("set_committed", *self._positions(x1, x2), pointer(None) if slip is None else slip, commits)

    def set_constraints(self, nodes: Sequence[int] | Array, directions: ArrayLike) -> None:
        """Directions, (k, d), in which nodes, (k,) int64, are held."""
        held = given("nodes", nodes, (len(nodes),), np.int64)
        along = given("directions", directions, (len(held), self.dimension))
        self._call("set_constraints", len(held), pointer(held), pointer(along))

    def use_normals(self, normals: str) -> None:
        """Normals of the step that follows: "committed" or "current"."""
        self._call("use_normals", value_of("normals", "NORMALS", normals))

    def turn_multipliers(self, x1: ArrayLike, lam: Array) -> None:
        """Turns multipliers with the normals, in place, at the start of a step."""
        if not isinstance(lam, np.ndarray):
            raise TypeError(f"lam: {type(lam).__name__}, an ndarray is needed, for the call writes to it")
        given("lam", output("lam", lam, self._shape_multipliers), self._shape_multipliers)
        self._call("turn_multipliers", pointer(given("x1", x1, self._shape1)), pointer(lam))


# For help, and for completion.
Interface.__signature__ = inspect.Signature(list(_options.with_options(Interface.__init__).parameters.values())[1:])  # type: ignore[attr-defined]
