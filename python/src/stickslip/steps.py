"""Load steps: starts, attempts, cut-backs, commits, as docs/host_steps.md has them."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from numpy.typing import ArrayLike

from .contact import Contact
from .errors import Error, InvalidSize, StepRefused, WrongType
from .newton import Solver, solved
from .results import States
from .skin import Reals


Start = Callable[[Reals, float, float], None]


@dataclass
class Step:
    """A step that has converged and is committed."""

    #: Its end.
    time: float
    #: All unknowns then: those of the host, and multipliers where they are not condensed.
    x: Reals
    #: Newton iterations of all that went.
    iterations: int
    #: How often it was cut back.
    cuts: int
    #: What :meth:`Contact.states` said before the commit.
    states: list[States]

    def __str__(self) -> str:
        states = "; ".join(map(str, self.states))
        cut = f", cut back {self.cuts} times" if self.cuts else ""
        return f"time {self.time:g}: {self.iterations} iterations{cut}, {states}"


def steps(contact: Contact, residual: Callable[[Reals, float], ArrayLike], tangent: Callable[[Reals, float], Any],
          times: Sequence[float], x: Reals | None = None, *, begin: float = 0.0, fixed: ArrayLike = (),
          prescribed: Callable[[float], ArrayLike] | None = None, predictor: bool = True, start: Start | None = None, most: int = 25,
          shortest: float = 1 / 64, solve: Solver | None = None, accepted: Callable[[Reals, float], None] | None = None,
          progress: bool = False) -> Iterator[Step]:
    """Solves step after step and gives each once it is committed: ``for step in stickslip.steps(...)``.

    A step is tried from an extrapolation of the last two; from where it begins; from there with a line search; in two phases, with the
    normals of its start first; with steps that are cut where surfaces meet. Then it is cut into halves; and general contact takes the other
    sides once, where that does not help. Refusals, NaN and refused
    commits are failed attempts. A host that raises :class:`stickslip.StepRefused` says so of its own.

    Parameters
    ----------
    residual, tangent : as of :func:`newton`, called with the host's unknowns and the time
    times : the ends of the steps; the first one begins at ``begin``
    x : all unknowns at ``begin``; without it :meth:`Contact.start`. It is changed in place.
    fixed, prescribed : which of the host's unknowns are prescribed, and their values, or one, at a time; without it 0
    predictor : False: no extrapolation, for loads that jump
    start : ``start(x, begin, end)`` changes x in place to where Newton's method begins, such as a body moved or turned with its supports
        (then :meth:`Contact.turn_multipliers`); there is no extrapolation with it. Without it a step begins where the last one ended.
    most, solve : as of :func:`newton`
    shortest : the part of a step below which it is not cut: :class:`stickslip.StepRefused` is raised then
    accepted : ``accepted(x, time)`` is called after each commit, those of parts of a step, too: for a host that has a history of its own
    progress : True: a line is printed for each step, and for each cut-back
    """
    x = contact.start() if x is None else x
    run = _Steps(contact, residual, tangent, start, predictor and start is None,
                 fixed, prescribed or (lambda time: 0.0), {"most": most, "solve": solve})
    for end in times:
        step = run.advance(x, begin, float(end), shortest * (end - begin), accepted, progress)
        if progress:
            print(step, flush=True)
        yield step
        begin = float(end)


class _Steps:
    """What stays from step to step."""

    def __init__(self, contact: Contact, residual: Callable[[Reals, float], ArrayLike], tangent: Callable[[Reals, float], Any],
                 start: Start | None, predictor: bool, fixed: ArrayLike, prescribed: Callable[[float], ArrayLike], options: dict[str, Any]):
        self.contact, self.residual, self.tangent = contact, residual, tangent
        self.start, self.predictor, self.fixed, self.prescribed, self.options = start, predictor, fixed, prescribed, options
        #: The rate of all unknowns in the last step.
        self.rate: Reals | None = None
        #: Whether the last solution had steps that were cut where surfaces met.
        self.cut = False

    def advance(self, x: Reals, begin: float, end: float, shortest: float, accepted: Callable[[Reals, float], None] | None,
                progress: bool) -> Step:
        """From one time to another, in halves where it does not go at once."""
        ends, iterations, cuts, exchanged = [end], 0, 0, False
        while ends:
            before = x.copy()
            try:
                count, states = self._counted(x, begin, ends[-1])
            except (InvalidSize, WrongType):
                raise
            except Error as error:
                x[:] = before
                if not 0.5 * (ends[-1] - begin) >= shortest:
                    if not exchanged and self.contact.exchange(x):  # whether it converges may depend on the sides
                        ends, exchanged, self.rate = [end], True, None
                        continue
                    raise StepRefused(f"time {begin:g}: no step is short enough. The last attempt: {error}") from error
                ends.append(0.5 * (begin + ends[-1]))
                cuts += 1
                if progress:
                    print(f"time {begin:g}: cut back to {ends[-1]:g}: {error}", flush=True)
                continue
            self.rate = None if self.cut else (x - before) / (ends[-1] - begin)  # how a gap closes is no rate
            iterations, begin = iterations + count, ends.pop()
            if accepted is not None:
                accepted(x, begin)
        return Step(end, x.copy(), iterations, cuts, states)

    def _counted(self, x: Reals, begin: float, end: float) -> tuple[int, list[States]]:
        """One step; once more where general contact looks for facets that have met out of its reach."""
        before, missed = x.copy(), self.contact.missed
        try:
            return self._tried(x, begin, end)
        except Error:
            if self.contact.missed == missed:
                raise
        x[:] = before
        return self._tried(x, begin, end)

    def _tried(self, x: Reals, begin: float, end: float) -> tuple[int, list[States]]:
        """The first attempt that converges, checked and committed. Raises what the last one has."""
        started = x.copy()
        if self.start is not None:
            self.start(started, begin, end)
        attempts: list[tuple[Reals, dict[str, bool]]] = [(started, {}), (started, {"search": True})]
        if self.contact.use_normals("current"):
            attempts.append((started, {"phases": True}))
        attempts.append((started, {"closing": True}))
        if self.predictor and self.rate is not None:
            attempts.insert(0, (x + (end - begin) * self.rate, {}))
        for first, how in attempts:
            x[:] = first
            try:
                iterations = self._attempt(x, end, **how)
                break
            except (InvalidSize, WrongType):  # no shorter step helps
                raise
            except Error as error:
                failed = error
        else:
            raise failed
        self.contact.check(x)
        states = self.contact.states(x)
        self.contact.commit(x)
        return iterations, states

    def _attempt(self, x: Reals, time: float, search: bool = False, closing: bool = False, phases: bool = False) -> int:
        first = 0
        if phases:
            self.contact.use_normals("committed")
            try:
                first = self._attempt(x, time)
            finally:
                self.contact.use_normals("current")
        iterations, self.cut = solved(
            self.contact, lambda u: self.residual(u, time), lambda u: self.tangent(u, time), x, fixed=self.fixed,
            values=self.prescribed(time), search=search, closing=closing, **self.options)
        return first + iterations
