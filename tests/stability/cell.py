"""A cell of the matrix, what its run found, and the verdict on it.

A cell is one hard case at one severity. Its run returns an Outcome: errors against an exact or refined answer, each
with its bound, or a refusal with the sentence that a user would see. The verdict is made here and nowhere else:

    correct   every error is within its bound
    warning   the same, but the run said that something was hard (cut-backs, cycles, several solutions)
    refused   no answer, and the message says what the cell allows it to say
    wrong     anything else: an error beyond its bound or not a number, a refusal without a cause or where an answer is
              due, a crash, a hang. The matrix fails if there is one.
"""

import math
import re
from dataclasses import dataclass, field

CORRECT, WARNING, REFUSED, WRONG = "correct", "warning", "refused", "wrong"
VERDICTS = (CORRECT, WARNING, REFUSED, WRONG)

ELEMENT, SCENE = "element", "scene"  # what runs: calls of the library, or the driver on a scene


@dataclass
class Outcome:
    errors: list = field(default_factory=list)
    iterations: int | None = None  # of Newton's method, those of failed attempts included
    warnings: list = field(default_factory=list)
    refusal: str | None = None
    kappa: float | None = None  # of the last Newton matrix, rows and columns scaled
    figures: dict = field(default_factory=dict)  # numbers for the report and for comparisons between cells

    def below(self, quantity, error, bound, reason):
        """A figure whose ideal is zero must not exceed `bound`."""
        self.errors.append({"quantity": quantity, "error": float(error), "bound": float(bound), "reason": reason})

    def true(self, quantity, holds, reason):
        self.below(quantity, 0.0 if holds else math.inf, 0.0, reason)


@dataclass
class Cell:
    case: str  # the row of the heat map
    severity: str  # as it is printed
    level: int  # the column, from 0
    run: object  # function of a Context that returns an Outcome
    kind: str = SCENE
    may_refuse: str | None = None  # what a refusal may say, as a regular expression
    quick: bool = False  # part of the short run

    @property
    def label(self):
        return re.sub(r"[^\w.+-]+", "_", f"{self.case}.{self.level:02d}_{self.severity}").strip("_")


def verdict(cell, outcome):
    """(verdict, why)"""
    if outcome.refusal is not None:
        if cell.may_refuse and re.search(cell.may_refuse, outcome.refusal):
            return REFUSED, outcome.refusal
        due = "the cause that is expected is" if cell.may_refuse else "an answer is due"
        return WRONG, f"{due} {cell.may_refuse or ''}; refused with: {outcome.refusal or '(no message)'}"
    if not outcome.errors:
        return WRONG, "nothing was compared"
    for error in outcome.errors:
        if not error["error"] <= error["bound"]:  # a NaN is wrong, too
            return WRONG, f"{error['quantity']}: {error['error']:.3g}, bound {error['bound']:.3g} ({error['reason']})"
    if outcome.warnings:
        return WARNING, "; ".join(outcome.warnings)
    return CORRECT, ""


def series(case, severities, make, **more):
    """One row: a cell per severity, mildest first. `make(severity)` gives the cell's run, `quick` those of the short
    run, `may_refuse` a message, or a function of the severity that gives one or None."""
    quick, may_refuse = more.pop("quick", ()), more.pop("may_refuse", None)
    for level, severity in enumerate(severities):
        allowed = may_refuse(severity) if callable(may_refuse) else may_refuse
        text = severity if isinstance(severity, str) else f"{severity:g}"
        yield Cell(case, text, level, make(severity), may_refuse=allowed, quick=severity in quick, **more)
