"""What an interface tells, by the names of the header's structs; a test holds them together. Units and signs: the header's."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum

import numpy as np
from numpy.typing import NDArray

from ._library import constants

Reals = NDArray[np.float64]


class State(IntEnum):
    """The state of a node, as in ``states.state == stickslip.State.SLIP``."""

    GAP = constants["STATE_GAP"]
    STICK = constants["STATE_STICK"]
    SLIP = constants["STATE_SLIP"]


@dataclass(eq=False)
class States:
    """Of each non-mortar node, (n1,) and (n1, d). Nodes that do not bear, as mid nodes, are in gap and carry nothing."""

    #: A :class:`State`.
    state: NDArray[np.int32]
    #: Into the non-mortar body, of length 1.
    normal: Reals
    #: Minus the Cauchy traction on the non-mortar body, as the law allows it [F/L^2].
    traction: Reals
    #: Weighted, above 0 where open [L^3].
    gap: Reals
    #: Since the first configuration [L].
    slip: Reals
    #: What of the node's area has something opposite, and all of it [L^2].
    coverage: Reals
    area: Reals
    #: Work of friction in this step [F L].
    dissipation: Reals
    #: [F/L^5].
    augmentation: Reals
    #: Which part of what is covered is closed.
    share: Reals
    #: Depth and volume that are worn off, this step's included [L], [L^3].
    worn: Reals
    worn_volume: Reals
    #: Damage of the bond, 0 to 1, and the work that it has lost an area [F/L].
    damage: Reals
    bond_loss: Reals
    #: Whether it has a multiplier.
    bearing: NDArray[np.bool_]

    @property
    def pressure(self) -> Reals:
        """What presses the node along its normal [F/L^2]."""
        out: Reals = -(self.traction * self.normal).sum(axis=1)
        return out

    def count(self, state: State) -> int:
        """How many of the nodes that have a multiplier are in a state."""
        return int((self.state[self.bearing] == state).sum())

    def __str__(self) -> str:
        return " ".join(f"{self.count(state)} {state.name.lower()}" for state in State)

    def __repr__(self) -> str:
        return f"<States of {self.bearing.sum()} nodes: {self}>"


@dataclass
class Equilibrium:
    """How far a point is from equilibrium: each amount, what to compare it with, and the node (docs/host_convergence.md)."""

    modulus: float
    least_traction: float
    gap: float
    gap_scale: float
    traction: float
    traction_scale: float
    slip: float
    slip_scale: float
    gap_node: int
    traction_node: int
    slip_node: int
    slide: float
    slide_scale: float
    slide_node: int
    turn: float
    turn_node: int
    lag: float
    lag_node: int
    lag_force: float
    lag_force_scale: float
    penetration: float
    penetration_scale: float
    penetration_node: int
    apart: float
    apart_scale: float
    apart_node: int


@dataclass(eq=False)
class Report:
    """Which nodes are covered, and what surfaces that do not meet look like. ``print(report)`` says it in sentences."""

    nodes_none: int
    nodes_part: int
    nodes_full: int
    nodes_several: int
    finding: int
    penetration: float
    #: Of each node: ``constants["COVER_..."]``, the covered part, how many layers.
    cover: NDArray[np.int32]
    fraction: Reals
    layers: NDArray[np.int32]
    text: str

    def __str__(self) -> str:
        return self.text


@dataclass
class Diagnosis:
    """The worst pairs, and where the matrix may be singular. ``print(diagnosis)`` says it in sentences."""

    suspects: int
    state_changes: int
    nodes_gap: int
    nodes_stick: int
    nodes_slip: int
    covered_node: int
    covered_fraction: float
    overlap: float
    overlap_facets: tuple[int, int]
    warp: float
    warp_facets: tuple[int, int]
    angle: float
    angle_facets: tuple[int, int]
    error: float
    error_facets: tuple[int, int]
    text: str

    def __str__(self) -> str:
        return self.text


@dataclass
class Counters:
    """What an interface has done since it was made."""

    pairs_tested: int
    pairs_clipped: int
    pairs_integrated: int
    pairs_linearised: int
    searches: int
    pairs_active: int
    bytes: int
    seconds_search: float
    seconds_integration: float
    seconds_assembly: float
    pairs_reused: int
    nodes_slipping: int
    evaluations_apart: int
    commits_apart: int
    multipliers: int
    nodes_evaluated: int
    nodes_frictional: int
    nodes_frictionless: int
    nodes_new: int
    nodes_tied: int
    nodes_uncovered: int
    nodes_left_out: int
    boxes_visited: int
    nodes_carried: int


@dataclass(eq=False)
class Crosspoints:
    """Nodes that several interfaces share in a way that matters, ascending."""

    nodes: NDArray[np.int64]
    #: Sums of ``constants["CROSSPOINT_..."]``.
    kinds: NDArray[np.int32]
    #: In how many interfaces each is non-mortar.
    claims: NDArray[np.int64]


@dataclass
class Gradient:
    """Products of an adjoint with the derivatives of a residual; None: not asked for."""

    #: By the positions at the last commit, (n1, d) and (n2, d).
    previous1: Reals | None = None
    previous2: Reals | None = None
    #: By the positions of now, likewise.
    now1: Reals | None = None
    now2: Reals | None = None
    #: By the coefficients of friction, (n1,).
    friction: Reals | None = None
    #: By the largest shear traction, (1,).
    shear_limit: Reals | None = None
    #: By the offsets, (n1,) and (n2,).
    offsets1: Reals | None = None
    offsets2: Reals | None = None


@dataclass(eq=False)
class SkinFacets:
    """Of each facet of a :class:`stickslip.Skin` who it may touch in this step."""

    #: ``constants["SKIN_NONE"]``, ``"SKIN_NONMORTAR"``: it has the multipliers, ``"SKIN_MORTAR"``.
    side: NDArray[np.int32]
    #: The piece of a non-mortar facet, from 0; -1 of others.
    piece: NDArray[np.int64]
    #: The nearest facet that it may touch; -1: none.
    partner: NDArray[np.int64]
    #: How far apart the two are at t_n, below 0 where they are in each other [L].
    distance: Reals
    body: NDArray[np.int64]


@dataclass
class SkinReport:
    """What a :class:`stickslip.Skin` has found in this step, and done since it was made. ``print(report)`` says it in sentences."""

    bodies: int
    #: Interfaces of this step, and pairs of facets that may touch.
    pieces: int
    pairs: int
    contradictions: int
    #: Since it was made: interfaces, facets in contact that have exchanged their side, steps refused since facets met out of reach.
    made: int
    exchanged: int
    missed: int
    text: str

    def __str__(self) -> str:
        return self.text
