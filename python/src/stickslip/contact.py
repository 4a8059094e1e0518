"""Contact on the host's own vectors: surfaces out of its nodes, multipliers behind its unknowns."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from . import _arrays
from ._arrays import given, output
from ._pair import Pair, elimination_order
from ._rigid_nodes import RigidNodes
from ._told import Part, Point, Told
from ._whole import Whole
from .errors import InvalidSize, InvalidValue
from .options import Options, with_options
from .results import Gradient
from .rigid import RigidBody
from .skin import Facets, Integers, Reals
from .surface import Surface

if TYPE_CHECKING:
    import scipy.sparse
    from typing_extensions import Unpack


class Contact(Told):
    """All interfaces of a host. Its vectors have the host's unknowns, then the multipliers.

        contact = stickslip.Contact(X, dofs).add(bottom_of_the_block, top_of_the_table, mu=0.3, modulus=210e3)
        x = contact.start()                     # the host's unknowns, at 0, and multipliers to start with
        contact.add_residual(x, r)              # r has the host's internal minus external forces
        matrix = contact.tangent(x, K)          # K is the host's; sparse, all unknowns
        if contact.balanced(x): contact.commit(x)

    Parameters
    ----------
    X : (n, 3) or (n, 2)
        The nodes of the host in the first configuration [L].
    dofs : like X, integers, or a scipy sparse matrix
        Which entry of the host's vector is which displacement; -1: the node does not move that way. Without it they follow node by
        node. A matrix of (X.size, size) gives the displacements of the nodes in this order, for elements whose unknowns are no
        values at nodes.
    size : how many unknowns the host has; without it as many as ``dofs`` says
    condensed : True: no multipliers among the unknowns. Vectors have the host's unknowns alone, and :meth:`tangent` changes the rows of
        the host. The unknowns of the first side's nodes must all be free: what is prescribed there has dofs -1. A node has multipliers in
        one interface at most.
    """

    def __init__(self, X: ArrayLike, dofs: Any = None, size: int | None = None, *, condensed: bool = False):
        import scipy.sparse

        self.X: Reals = _arrays.coordinates(X)
        self._map: scipy.sparse.csr_matrix | None = None
        if scipy.sparse.issparse(dofs):
            if dofs.shape[0] != self.X.size:
                raise InvalidSize(f"dofs: {dofs.shape[0]} rows, {self.X.size} are needed, one a displacement of a node")
            if condensed:
                raise InvalidValue("condensed: needs dofs that are displacements of nodes, not a matrix")
            self._map, size = dofs.tocsr(), dofs.shape[1]
            dofs = None
        numbers = np.arange(self.X.size).reshape(self.X.shape) if dofs is None else dofs
        self.dofs: Integers = given("dofs", numbers, self.X.shape, np.int64).reshape(self.X.shape)
        self._n_inner = int(self.dofs.max()) + 1 if size is None or self._map is not None else size
        #: How many unknowns the host has.
        self.n_host: int = self._n_inner if self._map is None else self._map.shape[1]
        if self.dofs.max() >= self._n_inner:
            raise InvalidValue(f"size: {size}, and dofs has {self.dofs.max()}; at least {self.dofs.max() + 1} is needed")
        self.condensed = condensed
        # Of each node's displacements: those of the host, or behind them those of nodes without unknowns of their own.
        self._numbers: Integers = self.dofs.copy() if self._map is None else np.arange(self.X.size).reshape(self.X.shape)
        self._rigid = RigidNodes()
        self._parts: list[Part] = []
        self._order: list[int] = []
        self._start: Reals | None = None
        self._at: Reals | None = None
        self._commits = 0

    def add(self, facets1: Facets, facets2: Facets | Surface | None = None, *, held: ArrayLike = (), crease: float | None = None,
            bodies: ArrayLike | None = None, **options: Unpack[Options]) -> Contact:
        """Adds an interface, and gives itself, so that more can be added. With ``facets1`` alone it is general contact: the whole skin
        of all bodies, ``stickslip.skin(cells, X)``, each of which may touch every other one and itself.

        Parameters
        ----------
        facets1, facets2 : node numbers as :func:`stickslip.skin` gives them. The first side has the multipliers: the smaller one, the
            softer one, the finer one. The second may be a :class:`stickslip.Surface` without unknowns, rigid or analytic; what is
            written to its ``coordinates`` moves it.
        held : dofs of nodes of the first side that are prescribed on *both* sides, as on a plane of symmetry: no multiplier there.
            Where dofs is a matrix, rows of it.
        crease : nodes on edges of the first side that are sharper than this angle get multipliers a face [rad]: docs/host_edges.md.
            General contact has them anyhow.
        bodies : of general contact, of each facet the number of its body; without it what hangs together is one. Friction between two of
            them is ``contact.interfaces[0].set_pair(body1, body2, mu)``.
        **options : :class:`stickslip.Options`, as of :class:`stickslip.Interface`
        """
        if self._start is not None:
            raise InvalidValue("add: all interfaces are needed before start")
        first, known = self._n_inner + self.n_multipliers, np.asarray(held, dtype=np.int64).ravel()
        if facets2 is None:
            self._refuse_whole(crease)
            self._parts.append(Whole(self.X, self._numbers, first, facets1, bodies=bodies, held=known, options=dict(options)))
        elif bodies is not None:
            raise InvalidValue("bodies: two sides are named; bodies are for general contact, with facets1 alone")
        else:
            self._parts.append(Pair(self.X, self._numbers, first, (facets1, facets2), crease=crease, held=known, condensed=self.condensed,
                                    options=dict(options)))
        return self

    def _refuse_whole(self, crease: float | None) -> None:
        """What does not go with general contact."""
        if crease is not None:
            raise InvalidValue("crease: general contact cuts the skin at edges sharper than 40 degrees by itself; facets2 is missing")
        if self.condensed:
            raise InvalidValue("condensed: general contact has multipliers among the unknowns; facets2 is missing")
        if any(isinstance(part, Whole) for part in self._parts):
            raise InvalidValue("add: there is a whole skin already; hand over all facets in one")

    def rigid(self, nodes: ArrayLike, point: ArrayLike, unknowns: ArrayLike) -> RigidBody:
        """Nodes that move as one body, before any interface is added: :meth:`add` takes facets of them as of others.

        Loads of the body are the host's: forces and moments in the rows of its unknowns. A rotation is a rotation vector, at most
        pi long since the last :meth:`turn`.

        Parameters
        ----------
        nodes : their numbers; ``dofs`` has -1 for all their displacements
        point : (3,) or (2,), the body's reference point in the first configuration, anywhere [L]. Moments are about it.
        unknowns : (6,) or (3,), which of the host's unknowns are the point's displacement and the body's rotation. All are unknowns:
            prescribe them by ``fixed`` of :func:`stickslip.newton`.
        """
        if self._parts or self._map is not None or self.condensed:
            raise InvalidValue("rigid: needs dofs that are displacements of nodes, multipliers among the unknowns, and comes before add")
        body = self._rigid.add(self.X, self._numbers, nodes, point, unknowns, (self.n_host, self._n_inner))
        self._n_inner += body.coordinates.size
        return body

    def turn(self, x: Reals) -> None:
        """After a commit: takes the rotations of rigid bodies into the bodies, and sets them to 0 in x. For bodies that turn on and on."""
        self._displacements(x)
        for body in self._rigid.bodies:
            body.turn()
            x[body.equations] = body.unknowns

    @property
    def interfaces(self) -> list[Any]:
        """The handles, in the order in which they were added: :class:`stickslip.Interface`, or :class:`stickslip.Skin`."""
        return [part.face for part in self._parts]

    def __repr__(self) -> str:
        kind = "condensed" if self.condensed else "behind them"
        return f"<Contact: {self.n_host} unknowns of the host, {self.n_multipliers} multipliers {kind}; {self.interfaces}>"

    def start(self, u: ArrayLike | None = None) -> Reals:
        """A vector to start the first step with: the host's unknowns ``u``, without it 0, and multipliers that hold what touches."""
        if not self._parts:
            raise InvalidValue("start: there is no interface; add one")
        x = np.zeros(self.size)
        if u is not None:
            x[: self.n_host] = given("u", u, (self.n_host,))
        if self.condensed:
            self._order = elimination_order(self._pairs)
            for pair, (x1, x2, _) in self._condensed(self._evaluated(x)):
                pair.system.multipliers(x1, x2, np.zeros(x1.shape))  # refuses here what has no condensed form, not in a step
        else:
            x[self.n_host :] = np.concatenate([part.face.initial_multipliers()[part.mask] for part in self._parts])
        self._start, self._at = x.copy(), None
        return x

    def add_residual(self, x: Reals, r: Reals) -> None:
        """Adds the forces of contact and the rows of multipliers to r, which has the host's internal minus external forces."""
        output("r", r, (self.size,))
        self._at = None
        inner, rows = np.zeros(self._n_inner), []
        own, points = r.copy(), self._evaluated(x)
        if self.condensed and not self._order:
            self._order = elimination_order(self._pairs)
        condensed = self._condensed(points)
        for pair, (x1, x2, _) in [condensed[k] for k in self._order]:
            host1 = np.where(pair.equations1 < 0, 0.0, own[pair.equations1])
            fresh = not self._commits and self._start is not None and np.array_equal(x, self._start)
            pair.lam = pair.face.initial_multipliers() if fresh else pair.system.multipliers(x1, x2, host1)
            pair.scaled = not fresh
            rows1, force2 = pair.system.residual(x1, x2, pair.lam, host1)
            for vector in (inner, own):  # to those that come after they are forces of the host
                pair.add_forces(vector, rows1 - host1, force2)
        for part, point in () if self.condensed else points:
            *forces, row = part.face.residual(*point)
            part.add_forces(inner, *forces)
            rows.append(row[part.mask])
        r[: self.n_host] += inner[: self.n_host] if self._map is None else self._map.T @ inner
        self._rigid.resultants(inner, r)
        if not self.condensed:
            r[self.n_host :] += np.concatenate(rows)
        self._at = x.copy()

    def tangent(self, x: Reals, K: Any = None) -> scipy.sparse.csr_matrix:
        """The matrix of all unknowns: ``K`` of the host's, and the share of contact; without ``K`` that share alone.

        A condensed one needs ``K``, and :meth:`add_residual` at the same x before.
        """
        import scipy.sparse

        if self.condensed:
            return self._condense(self._condensed(self._points(x)), K)
        size = self._n_inner + self.n_multipliers
        points = self._points(x)
        total = sum((part.tangent(point, size) for part, point in points), scipy.sparse.csr_matrix((size, size)))
        if self._rigid.bodies:
            inner = np.zeros(self._n_inner)
            for part, point in points:
                part.add_forces(inner, *part.face.residual(*point)[:-1])
            total = self._rigid.reduced(total, inner, self.n_host, self._n_inner)
        if self._map is not None:
            wide = scipy.sparse.block_diag([self._map, scipy.sparse.identity(self.n_multipliers)], "csr")
            total = wide.T @ total @ wide
        if K is not None:
            total = total + _grown(scipy.sparse.csr_matrix(K), self.n_host, self.size)
        return total.tocsr()

    def add_to(self, matrix: Any, x: Reals, numbers: ArrayLike | None = None) -> None:
        """Adds the share of contact to a matrix of petsc4py, which is assembled afterwards: ``matrix.assemble()``.

        The places are those of a plan, the same in each call until surfaces slide on: give the matrix room for them, or
        ``matrix.setOption(PETSc.Mat.Option.NEW_NONZERO_ALLOCATION_ERR, False)``.

        Parameters
        ----------
        matrix : petsc4py.PETSc.Mat
        numbers : (size,), the row of the matrix of each unknown; -1: none, as of prescribed ones. Without it they are the same. On several
            processes those of this process or others: PETSc sends entries where they belong.
        """
        from ._petsc import added

        added(matrix, self.tangent(x), np.arange(self.size) if numbers is None else given("numbers", numbers, (self.size,), np.int64))

    def _condense(self, points: list[tuple[Pair, Point]], K: Any) -> scipy.sparse.csr_matrix:
        if K is None:
            raise InvalidValue("K: the host's matrix is needed, as contact is condensed")
        pieces = [pair.pieces(point, self.n_host) for pair, point in points]
        inner = K + sum(forces for forces, _, _ in pieces)
        for k in self._order:
            _, elimination, constraints = pieces[k]
            inner = inner + elimination @ inner + constraints
        return inner.tocsr()

    def commit(self, x: Reals) -> None:
        """Accepts a converged step: all interfaces do, or none. General contact changes multipliers of x, where it takes other sides.

        :class:`stickslip.errors.ContactLost` of general contact: facets have met that were out of reach; solve the step again.
        """
        points, last = [], self.n_host
        for part, point in self._points(x):
            states, first, last = part.face.states(*point), last, last + part.count
            lam = point[-1]
            if self.condensed:  # or the rounding of the host's forces decides who sticks at first in the next step
                traction = states.traction
                lam = np.where(part.mask, (traction * states.normal).sum(axis=1) if lam.ndim == 1 else traction, 0.0)
            part.commit_check((*point[:-1], lam))
            points.append((part, (*point[:-1], lam), slice(first, last), np.linalg.norm(states.traction, axis=1).max(initial=0.0)))
        points.sort(key=lambda entry: isinstance(entry[0], Pair))  # what can refuse still comes first
        for part, point, place, traction in points:
            lam = part.commit(point)
            if not self.condensed:
                x[place] = lam[part.mask]
            part.largest = max(part.largest, float(traction))
        self._commits += 1

    def exchange(self, x: Reals) -> bool:
        """Exchanges the sides of general contact at the start of a step, x, for one that fails however small it is; False: there is none."""
        last, done = self.n_host, False
        for part, (*_, lam) in self._evaluated(x):
            first, last = last, last + part.count
            if part.exchange(lam):
                x[first:last], done = lam[part.mask], True
        return done

    @property
    def missed(self) -> int:
        """How many commits of general contact were refused since facets had met out of reach. It looks for them since then."""
        return sum(part.missed for part in self._parts)

    def rollback(self) -> None:
        """Undoes the last commit."""
        for part in self._parts:
            part.face.rollback()
        self._commits -= 1

    def set_committed(self, x: Reals, commits: int = 0) -> None:
        """What x ended becomes the step before, whatever was committed; ``commits``: how many there were then. Slip so far is 0 again,
        which nothing depends on."""
        u = self._displacements(x)
        for part in self._parts:
            part.set_committed(u, commits)
        self._commits = commits

    def adjoint(self, x: Reals, a: Reals, wanted: tuple[str, ...]) -> tuple[list[Gradient], Reals]:
        """Products of a vector with the derivatives of the contacts' residual: :meth:`stickslip.Interface.adjoint` of each interface with
        the members ``wanted``; and previous1 and previous2, where both are among them, in a vector of the host's: B^T a."""
        if self.condensed or self._rigid.bodies:
            raise InvalidValue("adjoint: needs multipliers among the unknowns, not condensed, and no rigid bodies")
        inner = a[: self.n_host] if self._map is None else self._map @ a[: self.n_host]
        behind, last, products = np.zeros(self._n_inner), self.n_host, []
        for part, point in self._points(x):
            first, last = last, last + part.count
            product = part.adjoint(point, inner, a[first:last], wanted)
            products.append(product)
            if product.previous1 is not None and product.previous2 is not None:
                part.add_forces(behind, product.previous1, product.previous2)
        whole = np.zeros(self.size)
        whole[: self.n_host] = behind if self._map is None else self._map.T @ behind
        return products, whole

    def use_normals(self, normals: str) -> bool:
        """Normals of the step that follows, "committed" or "current", where they follow the surface; False: nowhere.

        See :meth:`stickslip.Interface.use_normals`.
        """
        return any([part.use_normals(normals) for part in self._parts])

    def turn_multipliers(self, x: Reals) -> None:
        """Turns multipliers in place with the surfaces, where a step starts from positions that are turned already."""
        last = self.n_host
        for part, (*positions, lam) in self._evaluated(x):
            first, last = last, last + part.count
            part.face.turn_multipliers(positions[0], lam)
            if not self.condensed:
                x[first:last] = lam[part.mask]

    def _displacements(self, x: Reals) -> Reals:
        x = given("x", x, (self.size,))
        if self._map is not None:
            out: Reals = (self._map @ x[: self.n_host]).reshape(self.X.shape)
            return out
        placed: Reals = np.where(self.dofs < 0, 0.0, x[self.dofs])
        self._rigid.place(x, self.X, placed)
        return placed

    def _points(self, x: Reals) -> list[tuple[Part, Point]]:
        """Each interface with positions and multipliers. Condensed ones are those of the last residual, at this x."""
        if self.condensed and (self._at is None or not np.array_equal(x, self._at)):
            raise InvalidValue("x: condensed multipliers follow from the host's forces: add_residual at this x is needed before")
        return self._evaluated(x)

    def _evaluated(self, x: Reals) -> list[tuple[Part, Point]]:
        u, last, out = self._displacements(x), self.n_host, []
        for part in self._parts:
            first, last = last, last + part.count
            lam = part.lam if self.condensed and isinstance(part, Pair) else part.multipliers(x[first:last])
            out.append((part, (*part.positions(u), lam)))
        return out

    def _condensed(self, points: list[tuple[Part, Point]]) -> list[tuple[Pair, Point]]:
        """Those whose multipliers are no unknowns."""
        return [(part, point) for part, point in points if isinstance(part, Pair)] if self.condensed else []


def _grown(K: scipy.sparse.csr_matrix, n_host: int, size: int) -> scipy.sparse.csr_matrix:
    """The host's matrix among all unknowns, without a copy of its entries."""
    import scipy.sparse

    if K.shape not in ((n_host, n_host), (size, size)):
        raise InvalidSize(f"K: shape {K.shape}, {(n_host, n_host)} or {(size, size)} is needed")
    offsets = np.concatenate([K.indptr, np.full(size - K.shape[0], K.indptr[-1], K.indptr.dtype)])
    return scipy.sparse.csr_matrix((K.data, K.indices, offsets), shape=(size, size), copy=False)


Contact.add.__signature__ = with_options(Contact.add)  # type: ignore[attr-defined]
