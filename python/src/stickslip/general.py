"""General contact: the skin of all bodies in one handle. No pairs and no sides are named."""

from __future__ import annotations

import inspect
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from . import options as _options
from ._arrays import Array, given, output, pointer
from ._handle import Handle
from ._inspection import judge, new, room_for_equilibrium, room_for_states, scalars
from ._library import call, constants, ffi, value_of
from ._touching import told
from .errors import InvalidSize, InvalidValue, WrongType
from .meshes import split_creases
from .results import Equilibrium, SkinFacets, SkinReport, States
from .surface import Surface

if TYPE_CHECKING:
    from typing_extensions import Unpack


class Skin(Handle):
    """All outer facets of all bodies, each of which may touch every other one and itself.

    ``x`` are current positions of the surface's nodes, (n, d) [L], with d = 3, or 2 in plane and axisymmetric models. ``lam`` are the
    multipliers of the copies, (n_copies, d) [F/L^2]: minus the Cauchy traction on the body that has them in this step. At sharp edges a
    node has a copy for each face; node k is copy k, and further ones come behind.

    Parameters
    ----------
    surface : Surface
        The whole skin, but for cuts on planes of symmetry. It has no multiplier equations.
    bodies : (n_facets,) integers, optional
        Of each facet its body. Without it facets that hang together are one body, numbered from 0.
    first_multiplier : the equation of the first multiplier, which all others follow; without it the one behind those of displacements
    **options
        :class:`stickslip.Options`, as of :class:`stickslip.Interface`. ``search_distance`` is how far it looks for partners; without it
        half of a facet, and twice the largest motion of the last step.
    """

    _kind = "skin"

    def __init__(self, surface: Surface, bodies: ArrayLike | None = None, *, first_multiplier: int | None = None,
                 **options: Unpack[_options.Options]):
        made, _method = _options.make(dict(options))
        self.dimension = 3 if made.model == value_of("model", "MODEL", "solid") else 2
        if surface.dimension != self.dimension:
            raise InvalidSize(f"surface: {surface.dimension} coordinates a node, the model has {self.dimension}")
        self.n_facets, self._shape = len(surface.facet_offsets) - 1, surface.coordinates.shape
        numbers = None if bodies is None else given("bodies", bodies, (self.n_facets,), np.int64)
        if first_multiplier is None:
            first_multiplier = int(surface.equations.max(initial=-1)) + 1
        struct, kept = surface._struct()
        slot = ffi.new("struct stickslip_skin **")
        call("skin_create", struct, pointer(numbers), first_multiplier, made, slot)
        del kept
        self._handle = slot[0]
        count, multipliers = ffi.new("int64_t *"), ffi.new("int64_t *")
        self._call("skin_copies", 0, ffi.NULL, ffi.NULL, count, multipliers)
        self.n_copies, self.n_multipliers = int(count[0]), int(multipliers[0])
        #: Of each copy its node, and its multiplier equations; -1: none, as of mid nodes.
        self.originals, self.equations = np.empty(self.n_copies, np.int64), np.empty((self.n_copies, self.dimension), np.int64)
        self._call("skin_copies", self.n_copies, pointer(self.originals), pointer(self.equations), count, multipliers)
        #: Nodes of each facet, and its copies.
        self.facet_nodes: list[Array] = np.split(surface.facet_nodes, surface.facet_offsets[1:-1])
        self.facet_copies = split_creases(surface.coordinates, self.facet_nodes)[0]
        self._text = f"{surface}, {_options.word('FRICTION', made.friction)}{f', mu {made.mu:g}' if made.mu else ''}"

    def __repr__(self) -> str:
        return f"<Skin: {self._text}; {'closed' if self._handle == ffi.NULL else f'{self.n_copies} copies'}>"

    def _destroy(self, slot: Any) -> None:
        call("skin_destroy", slot)

    def _positions(self, x: ArrayLike, name: str = "x") -> Any:
        return pointer(given(name, x, self._shape))

    def _point(self, x: ArrayLike, lam: ArrayLike) -> tuple[Any, Any]:
        return self._positions(x), pointer(given("lam", lam, self.equations.shape))

    def _written(self, lam: Array) -> Any:
        """Multipliers that a call reads and writes."""
        if not isinstance(lam, np.ndarray):
            raise WrongType(f"lam: {type(lam).__name__}, an ndarray is needed, for the call writes to it")
        return pointer(given("lam", output("lam", lam, self.equations.shape), self.equations.shape))

    def set_pair(self, body1: int, body2: int, mu: float | None) -> None:
        """Friction between two bodies, or within one, from now on; None: they do not see each other."""
        self._call("skin_set_pair", body1, body2, constants["SKIN_APART"] if mu is None else float(mu))

    def set_constraints(self, nodes: Sequence[int] | Array, directions: ArrayLike) -> None:
        """Directions, (k, d), in which displacements of nodes, (k,) int64, are prescribed on both sides of a contact."""
        held = given("nodes", nodes, (len(nodes),), np.int64)
        along = given("directions", directions, (len(held), self.dimension))
        self._call("skin_set_constraints", len(held), pointer(held), pointer(along))

    def initial_multipliers(self, out: Array | None = None) -> Array:
        """Multipliers to start the first step with: a slight compression where facets touch."""
        out = output("out", out, self.equations.shape)
        self._call("skin_initial_multipliers", pointer(out))
        return out

    def residual(self, x: ArrayLike, lam: ArrayLike, *, out: tuple[Array | None, Array | None] = (None, None)) -> tuple[Array, Array]:
        """``(force, rows)``: what to add to the host's internal forces [F], and the multiplier rows. ``out``: arrays to write to."""
        force, rows = output("force", out[0], self._shape), output("rows", out[1], self.equations.shape)
        self._call("skin_residual", *self._point(x, lam), pointer(force), pointer(rows))
        return force, rows

    def plan(self, x: ArrayLike, pairs: str = "active") -> int:
        """Settles the entries of the tangent, "active" or "skin", and says how many there are. :class:`SkinPlan` does all this."""
        count = ffi.new("int64_t *")
        self._call("skin_plan", self._positions(x), value_of("pairs", "PLAN", pairs), count)
        return int(count[0])

    def plan_coo(self, count: int) -> tuple[Array, Array]:
        """``(rows, columns)`` of the plan's entries; some come more than once, and add up."""
        rows, columns = np.empty(count, np.int64), np.empty(count, np.int64)
        self._call("skin_plan_coo", count, pointer(rows), pointer(columns))
        return rows, columns

    def plan_values(self, x: ArrayLike, lam: ArrayLike, out: Array) -> Array:
        """The tangent in the order of the plan's entries. :class:`stickslip.errors.MissingEntry`: make the plan again."""
        self._call("skin_plan_values", *self._point(x, lam), len(out), pointer(output("out", out, out.shape)))
        return out

    def states(self, x: ArrayLike, lam: ArrayLike) -> States:
        """Of each copy what :meth:`stickslip.Interface.states` says; 0 where nothing can touch it. Call it before the commit."""
        out, arrays, _kept = room_for_states(self.equations.shape)
        self._call("skin_states", *self._point(x, lam), out)
        return States(**arrays, bearing=np.any(self.equations >= 0, axis=1))

    def equilibrium(self, x: ArrayLike, lam: ArrayLike, *, modulus: float = 0.0, least_traction: float = 0.0) -> Equilibrium:
        """How far the point is from equilibrium; its nodes are copies."""
        out = room_for_equilibrium(modulus, least_traction)
        self._call("skin_equilibrium", *self._point(x, lam), out)
        return Equilibrium(**scalars(out, "equilibrium"))

    def check_step(self, x: ArrayLike, lam: ArrayLike, *, modulus: float = 0.0, least_traction: float = 0.0,
                   tolerance: float = 1e-10) -> Equilibrium:
        """Asks whether a step may count, before its commit, as :meth:`stickslip.Interface.check_step`."""
        e = self.equilibrium(x, lam, modulus=modulus, least_traction=least_traction)
        judge(e, tolerance)
        return e

    def step_limit(self, x: ArrayLike, dx: ArrayLike, penetration: float = 0.0) -> float:
        """How much of a step dx may be taken, at most 1."""
        out = ffi.new("double *")
        self._call("skin_step_limit", self._positions(x), self._positions(dx, "dx"), penetration, out)
        return float(out[0])

    def use_normals(self, normals: str) -> None:
        """Normals of the step that follows: "committed" or "current"."""
        self._call("skin_use_normals", value_of("normals", "NORMALS", normals))

    def turn_multipliers(self, x: ArrayLike, lam: Array) -> None:
        """Turns multipliers with the normals, in place, at the start of a step."""
        self._call("skin_turn_multipliers", self._positions(x), self._written(lam))

    def commit(self, x: ArrayLike, lam: Array) -> None:
        """Accepts a converged step: it becomes t_n, and the library looks anew which facets may touch. It writes ``lam``.

        :class:`stickslip.errors.ContactLost`: facets have met that were out of reach. They are looked for now: solve the step again.
        """
        self._call("skin_commit", self._positions(x), self._written(lam))

    def rollback(self) -> None:
        """Undoes the last commit; the multipliers of then are the caller's."""
        self._call("skin_rollback")

    def exchange(self, lam: Array) -> None:
        """Exchanges the sides of all facets at t_n, for a step that fails however small it is. ``lam``: multipliers of t_n, in and out."""
        self._call("skin_exchange", self._written(lam))

    def history(self) -> dict[str, Array]:
        """The committed history as arrays, to pickle."""
        integers, reals = ffi.new("int64_t *"), ffi.new("int64_t *")
        self._call("skin_history_size", integers, reals)
        out = {"integers": np.empty(integers[0], np.int64), "reals": np.empty(reals[0])}
        self._call("skin_history_export", integers[0], pointer(out["integers"]), reals[0], pointer(out["reals"]))
        return out

    def restore(self, history: dict[str, Array]) -> None:
        """Takes a history of a skin that was made in the same way, with the same :meth:`set_pair` and :meth:`set_constraints`."""
        integers = given("integers", history["integers"], (len(history["integers"]),), np.int64)
        reals = given("reals", history["reals"], (len(history["reals"]),))
        self._call("skin_history_import", len(integers), pointer(integers), len(reals), pointer(reals))

    def facets(self) -> SkinFacets:
        """Of each facet its side in this step, its piece, what it may touch, how far away that is, and its body."""
        kinds = {"side": np.int32, "piece": np.int64, "partner": np.int64, "distance": np.float64, "body": np.int64}
        arrays: dict[str, Any] = {name: np.empty(self.n_facets, kind) for name, kind in kinds.items()}
        out = new("skin_sides")
        kept = {name: pointer(array) for name, array in arrays.items()}
        for name, address in kept.items():
            setattr(out, name, address)
        self._call("skin_facets", out)
        return SkinFacets(**arrays)

    def report(self, x: ArrayLike | None = None, lam: ArrayLike | None = None) -> SkinReport:
        """What it has found and done. With a point before its commit ``text`` says also who touches whom, and the forces of the bodies."""
        if (x is None) != (lam is None):
            raise InvalidValue("report: needs x and lam, or none of them")
        out = new("skin_summary")
        self._call("skin_report", out)
        found = scalars(out, "skin_summary")
        point = None if x is None or lam is None else (self.states(x, lam), -self.residual(x, lam)[0])
        return SkinReport(**found, text=told(found, self.facets(), point, (self.facet_nodes, self.facet_copies)))


# For help, and for completion.
Skin.__signature__ = inspect.Signature(list(_options.with_options(Skin.__init__).parameters.values())[1:])  # type: ignore[attr-defined]
