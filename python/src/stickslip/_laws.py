"""Laws of friction in place of Coulomb's: the library's, and one's own."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ._arrays import Array, given, pointer
from ._library import ffi, value_of

if TYPE_CHECKING:
    from numpy.typing import ArrayLike


@dataclass
class LawPoint:
    """What a law is asked about a closed node."""

    #: Which non-mortar node, from 0.
    node: int
    #: The trial traction along the normal, at most 0: the pressure with a minus [F/L^2].
    normal: float
    #: Slip of this step, and before it, (3,) [L].
    slip: Array
    slip_before: Array
    #: The unit vector along which the node would slip, or 0.
    direction: Array
    #: The node's Coulomb coefficient.
    mu: float
    #: What the law remembers of the node, a copy: what is left in it is remembered if the step ends here.
    states: Array


class Laws:
    """The part of an interface that is about its law."""

    n1: int
    _call: Callable[..., None]
    # The library holds its address.
    _kept_law: Any = None
    # What a law of Python has raised last.
    _law_error: Exception | None = None

    def set_law(self, kind: str = "coulomb", **numbers: float | Sequence[float]) -> None:
        """A law of the library: "coulomb", "cohesion", "weakening", "orthotropic" or "rate", with its numbers.

        cohesion: ``cohesion`` [F/L^2]. weakening: ``mu_after``, ``critical_slip`` [L]. orthotropic: ``mu_across``, ``direction``, (3,).
        rate: ``mu_after``, ``critical_rate`` [L/T], and ``time`` [T], what the step takes: set it again where that changes.
        The coefficient of the interface, ``mu``, is the one to begin with, or the one along the direction.
        """
        law = ffi.new("struct stickslip_law *", {"struct_size": ffi.sizeof("struct stickslip_law")})
        law.kind = value_of("kind", "LAW", kind)
        known = [name for name, _ in ffi.typeof("struct stickslip_law").fields if name not in ("struct_size", "kind", "reserved")]
        for name, value in numbers.items():
            if name not in known:
                raise TypeError(f"{name}: no number of a law; there are {', '.join(known)}")
            setattr(law, name, np.asarray(value, float).tolist())
        self._call("set_law", law)
        self._kept_law = None

    def set_threshold(self, law: Callable[[LawPoint], Sequence[Any]], n_states: int = 0) -> None:
        """A law of one's own: ``law(point)`` gives ``(k, dk_dnormal)`` or ``(k, dk_dnormal, dk_dslip)``.

        k is the shear traction below which the node of a :class:`LawPoint` sticks, not negative, and dk_dnormal, its derivative with
        respect to ``point.normal``, is not positive. ``dk_dslip``, (3,): with respect to ``point.slip``. Of each node ``n_states``
        numbers are remembered. An exception in ``law`` refuses the call that has asked, and is the cause of what is raised.
        """
        def ask(_: Any, point: Any, states: Any, answer: Any, after: Any) -> int:
            try:
                own = np.array(ffi.unpack(states, n_states) if n_states else [])
                slip, before, along = (np.array(list(v)) for v in (point.slip, point.slip_before, point.direction))
                k, dnormal, *slope = law(LawPoint(point.node, point.normal, slip, before, along, point.mu, own))
                answer.threshold, answer.dthreshold_dnormal = float(k), float(dnormal)
                if slope:
                    answer.dthreshold_dslip = [float(v) for v in slope[0]]
                for i, value in enumerate(own):
                    after[i] = value
            except Exception as error:  # no exception may pass through the library
                self._law_error = error
                return 1
            return 0

        function = ffi.callback("stickslip_threshold", ask)
        self._call("set_threshold", function, ffi.NULL, int(n_states))
        self._kept_law = function

    def set_layer(self, overclosure: ArrayLike | None = None, **numbers: float) -> None:
        """What lies between the surfaces, beside the law of friction; without arguments nothing.

        ``overclosure``, (n, 2): by how much the meshed surfaces overlap [L], and the pressure there [F/L^2], from 0 up. ``wear``: depth that is
        worn off a pressure and a slip [L^2/F]. A bond: ``bond_stiffness`` [F/L^3], ``bond_strength`` [F/L^2] in tension,
        ``bond_toughness`` [F/L], and ``bond_shear``, the strength in shear over that in tension.
        """
        layer = ffi.new("struct stickslip_layer *", {"struct_size": ffi.sizeof("struct stickslip_layer")})
        known = ("wear", "bond_stiffness", "bond_strength", "bond_toughness", "bond_shear")
        for name, value in numbers.items():
            if name not in known:
                raise TypeError(f"{name}: no number of a layer; there are {', '.join(known)}")
            setattr(layer, name, float(value))
        if overclosure is not None:
            points = given("overclosure", overclosure, (np.shape(overclosure)[0] if np.ndim(overclosure) else 0, 2))
            depth, pressure = np.ascontiguousarray(points[:, 0]), np.ascontiguousarray(points[:, 1])
            layer.n_overclosure, layer.overclosure, layer.pressure = len(points), pointer(depth), pointer(pressure)
        self._call("set_layer", layer)

    def law_states(self) -> Array:
        """What is remembered at the last commit by the law, then by what lies between the surfaces, (n1, states a node)."""
        count = ffi.new("int64_t *")
        self._call("law_states", 0, ffi.NULL, count)
        states = np.empty((self.n1, count[0] // self.n1))
        self._call("law_states", states.size, pointer(states), count)
        return states

    def set_law_states(self, states: ArrayLike) -> None:
        """Replaces that, as after ``set_committed``."""
        kept = given("states", states, np.shape(states))
        self._call("set_law_states", kept.size, pointer(kept))
