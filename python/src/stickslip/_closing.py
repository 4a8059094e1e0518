"""Bodies that contact alone holds and that do not touch yet: docs/host_steps.md has the three additions to Newton's method.

None of them changes the residual, so that what converges is a solution of the problem as it is.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from .contact import Contact
from .errors import StepRefused
from .skin import Integers, Reals

if TYPE_CHECKING:
    import scipy.sparse

# The part of its diagonal that a matrix gains while a body is loose, how it shrinks after a step that meets nothing, and to what; and
# the least afterwards, where it is in proportion to the residual.
_LOOSE, _SHRINKAGE, _LEAST, _HELD = 1e-6, 1e-2, 1e-10, 1e-13
# So many whole steps follow the last one that was cut: the first one may end below the tolerance for its bad start.
_SETTLED = 2
# A step as long as this many times the model that meets nothing leads away from all there is.
_FAR = 10.0


class Closing:
    """Whether bodies are loose, and how much of a step they may take. ``bodies``: of each unknown of the host its body."""

    def __init__(self, contact: Contact, bodies: Integers, fixed: Integers):
        self.contact, self.n_bodies = contact, int(bodies.max()) + 1
        self.held = np.unique(bodies[fixed])
        self.bodies = bodies
        self.size = float(np.linalg.norm(np.ptp(contact.X, axis=0)))
        self.active, self.cut = False, False
        self.whole, self.shift, self.first = _SETTLED, _LOOSE, 0.0

    def loose(self, x: Reals) -> bool:
        """Whether there is a body that no support holds and no node in contact, through others or not."""
        import scipy.sparse
        from scipy.sparse.csgraph import connected_components

        ground = self.n_bodies
        # A surface without unknowns is the ground, which is behind the last body.
        bodies = np.append(self.bodies, ground)
        joints = [(int(bodies[one]), int(bodies[two]), touches) for one, two, touches in self.contact.touching(x)]
        edges = [joint[:2] for joint in joints if joint[2]] + [(int(body), ground) for body in self.held]
        rows, columns = zip(*edges) if edges else ((), ())
        graph = scipy.sparse.coo_matrix((np.ones(len(edges)), (rows, columns)), shape=(ground + 1, ground + 1))
        groups = connected_components(graph, directed=False)[1]
        return any(groups[body] != groups[ground] for joint in joints for body in joint[:2])

    def begin(self, x: Reals, force: bool) -> None:
        """Settles whether this step needs it."""
        # Where the host has left unknowns out, its matrix does not tell what holds a body.
        self.active = force or (not (self.contact._numbers < 0).any() and self.loose(x))
        self.whole = 0 if self.active else _SETTLED

    def shifted(self, A: scipy.sparse.csr_matrix, x: Reals, norm: float) -> scipy.sparse.csr_matrix:
        """The matrix with a little stiffness for motions that have none."""
        import scipy.sparse

        if not self.active:
            return A
        self.first = self.first or norm
        left = min(norm / self.first, 1.0) if self.first else 1.0  # nothing moves before the first step of what is prescribed
        shift = self.shift if self.loose(x) else max(_LOOSE * left, _HELD)
        diagonal = np.zeros(A.shape[0])
        own = np.abs(A.diagonal()[: self.contact.n_host])
        diagonal[: self.contact.n_host] = shift * np.maximum(own, own.max() * self.contact._rigid.stiffness(self.contact.n_host, self.size))
        return (A + scipy.sparse.diags(diagonal)).tocsr()

    def shortened(self, x: Reals, step: Reals) -> Reals:
        """As much of a step as surfaces that it closes allow."""
        if not self.active:
            return step
        part = self.contact.step_limit(x, step)
        if part < 1.0:
            self.cut, self.whole = True, 0
        elif self.loose(x):
            if np.abs(step[: self.contact.n_host]).max() > _FAR * self.size:
                raise StepRefused("a body that nothing holds meets nothing: its load moves it away")
            self.shift = max(self.shift * _SHRINKAGE, _LEAST)
        else:
            self.whole += 1
        return part * step

    @property
    def settled(self) -> bool:
        """Whether a small residual is one of a step that was not cut."""
        return self.whole >= _SETTLED
