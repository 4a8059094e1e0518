"""What an interface tells about itself: states, equilibrium, report, diagnosis, counters."""

import warnings
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ._arrays import Array, pointer
from ._library import ffi
from .errors import StepRefused, StepWarning
from .results import Counters, Diagnosis, Equilibrium, Report, States

_TYPES = {"double": np.float64, "int32_t": np.int32, "int64_t": np.int64}
# No sentence of the library comes near it.
_TEXT = 1 << 16
# Parts of their scales from which overlaps and lags are told, and from which no step counts.
_OVERLAP, _LAG = (0.003, 0.1), (0.01, 0.1)


def _members(name: str) -> list[tuple[str, Any]]:
    return [(member, field.type) for member, field in ffi.typeof(f"struct stickslip_{name}").fields]


def scalars(struct: Any, name: str) -> dict[str, Any]:
    """The members that are numbers, and the short arrays among them."""
    out = {}
    for member, kind in _members(name):
        if member in ("struct_size", "reserved") or member.endswith("_capacity") or kind.kind == "pointer":
            continue
        value = getattr(struct, member)
        out[member] = tuple(value) if kind.kind == "array" else value
    return out


def new(name: str) -> Any:
    struct = ffi.new(f"struct stickslip_{name} *")
    struct.struct_size = ffi.sizeof(f"struct stickslip_{name}")
    return struct


def room_for_states(shape: tuple[int, ...]) -> tuple[Any, dict[str, Any], list[Any]]:
    """The C struct, the arrays that it fills, by name, and what has to live as long as it does."""
    vectors = ("normal", "traction", "slip")
    out, arrays = new("states"), {}
    for member, kind in _members("states"):
        if kind.kind == "pointer":
            arrays[member] = np.zeros(shape if member in vectors else shape[:1], _TYPES[kind.item.cname])
    kept = {member: pointer(array) for member, array in arrays.items()}
    for member, address in kept.items():
        setattr(out, member, address)
    return out, arrays, list(kept.values())


def room_for_equilibrium(modulus: float, least_traction: float) -> Any:
    """The C struct with what it reads."""
    out = new("equilibrium")
    out.modulus, out.least_traction = modulus, least_traction
    return out


def judge(e: Equilibrium, tolerance: float) -> None:
    """Refuses a step that must not count, and warns of one that counts and is off: docs/host_convergence.md."""
    scales = {"gap": e.gap_scale, "traction": e.traction_scale, "slip": e.slip_scale}
    for name, scale in scales.items():
        if not getattr(e, name) <= tolerance * scale:
            raise StepRefused(f"the contact is not in equilibrium: a {name} of {getattr(e, name):.3g} that the law forbids, of a "
                              f"scale of {scale:.3g}, at node {getattr(e, name + '_node')}")
    lags = (f"surfaces have turned within the step, and pressures lag by {e.lag:.3g} at node {e.lag_node}: take a smaller step, or "
            "normals of now")
    for amount, scale, (told, most), text in (
        (e.penetration, e.penetration_scale, _OVERLAP, f"bodies overlap by {e.penetration:.3g} at node {e.penetration_node}"),
        (e.apart, e.apart_scale, _OVERLAP, f"node {e.apart_node} presses although the bodies are {e.apart:.3g} apart"),
        (e.lag, e.traction_scale, _LAG, lags),
        (e.lag_force, e.lag_force_scale, _LAG, lags),
    ):
        if amount > most * scale:
            raise StepRefused(text)
        if amount > told * scale:
            warnings.warn(text, StepWarning, stacklevel=3)


class Inspection:
    """The part of :class:`stickslip.Interface` that changes nothing. What it needs of the rest:"""

    n1: int
    _shape1: tuple[int, ...]
    _bearing: Array
    _told: str
    _call: Callable[..., None]
    _point: Callable[..., tuple[Any, ...]]
    _positions: Callable[..., tuple[Any, ...]]

    def states(self, x1: ArrayLike, x2: ArrayLike, lam: ArrayLike, *, sums: ArrayLike | None = None) -> States:
        """Arrays by the names of ``stickslip_states``: state, normal, traction, gap, slip, coverage, area, ...

        Call it before the commit.
        """
        out, arrays, _kept = room_for_states(self._shape1)
        self._call("states", *self._point(x1, x2, lam, sums), out)
        states = States(**arrays, bearing=self._bearing)
        self._told = f"last seen: {states}"
        return states

    def equilibrium(self, x1: ArrayLike, x2: ArrayLike, lam: ArrayLike, *, modulus: float = 0.0,
                    least_traction: float = 0.0, sums: ArrayLike | None = None) -> Equilibrium:
        """How far the point is from equilibrium, by the names of ``stickslip_equilibrium``."""
        out = room_for_equilibrium(modulus, least_traction)
        self._call("equilibrium", *self._point(x1, x2, lam, sums), out)
        return Equilibrium(**scalars(out, "equilibrium"))

    def check_step(self, x1: ArrayLike, x2: ArrayLike, lam: ArrayLike, *, modulus: float = 0.0, least_traction: float = 0.0,
                   tolerance: float = 1e-10, sums: ArrayLike | None = None) -> Equilibrium:
        """Asks whether a step may count, before its commit: :meth:`equilibrium`, judged as docs/host_convergence.md says.

        Raises :class:`stickslip.StepRefused` where the contact is not in equilibrium to ``tolerance``, bodies really overlap or are apart
        where they press, or normals of the step's start are too far off; warns with :class:`stickslip.StepWarning` of the last
        three where they begin. With ``sums`` each process speaks of its own part.
        """
        e = self.equilibrium(x1, x2, lam, modulus=modulus, least_traction=least_traction, sums=sums)
        judge(e, tolerance)
        return e

    def report(self, x1: ArrayLike, x2: ArrayLike) -> Report:
        """Which nodes are covered, and what surfaces that do not meet look like; ``text`` says it in sentences."""
        out = new("report")
        arrays: dict[str, Any] = {"cover": np.zeros(self.n1, np.int32), "fraction": np.zeros(self.n1),
                                         "layers": np.zeros(self.n1, np.int32)}
        kept = {member: pointer(array) for member, array in arrays.items()}
        for member, address in kept.items():
            setattr(out, member, address)
        buffer = ffi.new("char[]", _TEXT)
        out.text, out.text_capacity = buffer, _TEXT
        self._call("report", *self._positions(x1, x2), out)
        return Report(**scalars(out, "report"), **arrays, text=ffi.string(buffer).decode())

    def diagnose(self, x1: ArrayLike, x2: ArrayLike, lam: ArrayLike, *, sums: ArrayLike | None = None) -> Diagnosis:
        """The worst pairs and where the matrix may be singular; ``text`` says it in sentences."""
        out = new("diagnosis")
        buffer = ffi.new("char[]", _TEXT)
        out.text, out.text_capacity = buffer, _TEXT
        self._call("diagnose", *self._point(x1, x2, lam, sums), out)
        return Diagnosis(**scalars(out, "diagnosis"), text=ffi.string(buffer).decode())

    def effects(self) -> str:
        """What the interface computes and why, in sentences."""
        buffer = ffi.new("char[]", _TEXT)
        self._call("effects", buffer, _TEXT)
        return str(ffi.string(buffer).decode())

    def counters(self) -> Counters:
        """What the interface has done, by the names of ``stickslip_counters``."""
        out = new("counters")
        self._call("counters", out)
        return Counters(**scalars(out, "counters"))

    def carriers(self) -> tuple[Array, Array, Array]:
        """``(nodes, carriers, weights)``: which nodes carry weakly covered ones in this step, lam[A] = sum of w_AB lam[B].

        Read it after a commit.
        """
        count = ffi.new("int64_t *")
        self._call("carriers", 0, ffi.NULL, ffi.NULL, ffi.NULL, count)
        nodes, carriers, weights = np.empty(count[0], np.int64), np.empty(count[0], np.int64), np.empty(count[0])
        self._call("carriers", count[0], pointer(nodes), pointer(carriers), pointer(weights), count)
        return nodes, carriers, weights
