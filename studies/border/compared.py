"""The laws that the study compares, by name."""

from frozen import FrozenPoints, Penalty
from laws import Nodal, Points

# E over a length that is the half-width here: what CalculiX' default of 50 E is on the meshes of `make compare`.
PENALTY = 34.0
# E / h
SCALED_PENALTY = 3.0
NAMES = ("nodes, standard", "nodes, dual", "penalty, fixed", "penalty, 3 E/h", "points", "points, lumped")


def frozen_laws(library, pair, facets, mu=0.0):
    """With the weights of the flat surfaces; `facets` over a length of 1."""
    at = pair.one.x, pair.two.x
    made = [Nodal(library, pair, *at, basis, mu=mu) for basis in ("standard", "dual")]
    made += [Penalty(pair, k, mu=mu) for k in (PENALTY, SCALED_PENALTY * facets)]
    return dict(zip(NAMES, [*made, FrozenPoints(pair, mu=mu), FrozenPoints(pair, mu=mu, lumped=True)]))


def current_laws(library, pair, at):
    """With weights of now; `at`: positions at rest."""
    made = [Nodal(library, pair, *at, basis, weights="current") for basis in ("standard", "dual")]
    return dict(zip(NAMES[:2] + NAMES[4:], [*made, Points(pair, *at), Points(pair, *at, lumped=True)]))
