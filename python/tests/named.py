"""Named pairs with the sides that general contact has taken in a run, to compare with."""

import numpy as np

# As the library cuts the skin.
RINGS = 2


class Sides:
    """The sides that facets had in any step of a run; a piece that grows or moves is one pair of surfaces for the whole run."""

    def __init__(self, skin):
        self.skin, self.seen = skin, []

    def look(self):
        self.seen.append(self.skin.facets())

    @property
    def nonmortar(self):
        return np.any([facets.side == 1 for facets in self.seen], axis=0)

    @property
    def mortar(self):
        return np.any([facets.side == 2 for facets in self.seen], axis=0)

    def groups(self):
        """(nonmortar facets, mortar facets) of each pair, by their numbers."""
        assert not (self.nonmortar & self.mortar).any(), "a facet has had both sides"
        neighbours, touched = self._neighbours(), {}
        parent = list(range(self.skin.n_facets))

        def root(f):
            while parent[f] != f:
                f = parent[f]
            return f

        for facets in self.seen:
            for piece in range(facets.piece.max() + 1):
                own = np.flatnonzero(facets.piece == piece)
                for f in own[1:]:
                    parent[root(f)] = root(own[0])
        for facets in self.seen:
            for f in np.flatnonzero((facets.piece >= 0) & (facets.partner >= 0)):
                touched.setdefault(f, set()).add(int(facets.partner[f]))
        groups = {}
        for f in np.flatnonzero(self.nonmortar):
            groups.setdefault(root(f), []).append(f)
        out = []
        for own in groups.values():
            mortar = set().union(*(touched.get(f, set()) for f in own))
            for _ in range(RINGS):
                mortar |= {g for f in mortar for g in neighbours[f]} - set(own)
            ring = {g for f in own for g in neighbours[f]} - set(own) - set(np.flatnonzero(self.mortar))
            out.append((sorted({*own, *ring}), sorted(mortar)))
        return out

    def _neighbours(self):
        """Of each facet those that share a copy with it."""
        at = {}
        for f, copies in enumerate(self.skin.facet_copies):
            for a in copies:
                at.setdefault(int(a), []).append(f)
        return [{g for a in copies for g in at[int(a)]} - {f} for f, copies in enumerate(self.skin.facet_copies)]


def contact(solids, groups, mu=0.0, **options):
    """The same by named pairs. Nodes that have multipliers in two of them are without friction, as those of general contact are."""
    facets, made = solids.skin(), solids.contacts()
    for own, mortar in groups:
        # The root of a fold is a node of both sides: it has no multiplier.
        roots = np.intersect1d(facets[own], facets[mortar])
        made.add(facets[own], facets[mortar], crease=0.7, held=solids.dofs[roots], mu=mu, **{"modulus": solids.least, **options})
    claims = np.zeros(len(solids.X), int)
    for part in made._parts:
        np.add.at(claims, np.unique(part.nodes1), 1)
    for part in made._parts:
        part.face.set_friction(np.where(claims[part.nodes1] > 1, 0.0, mu))
    return made
