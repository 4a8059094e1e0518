"""The law of one node at its margins, against the formula in exact arithmetic: states, tractions, rows."""

from fractions import Fraction

import numpy as np

from cell import ELEMENT, Outcome, series
from library import GAP, SLIP, STICK

MARGINS = ("1e-2", "1e-4", "1e-6", "1e-8", "1e-10", "1e-11", "1e-13", "0")
TIPS = ("1e0", "1e-10", "1e-50", "1e-100", "1e-150", "1e-200", "1e-300")
FRICTIONS = ("0", "1e-300", "1e-12", "1e-3", "1", "1e3", "1e6", "1e300")
EXACT = 4e-15  # some roundings of numbers of order one
# On the cone within this counts as slip (design: every step starts with slip nodes exactly on it).
TIE = 1e-12

NODE = {
    "normal": (0.0, 0.0, 1.0),
    "augmentation": 1.0,
    "coverage": 1.0,
    "coverage_previous": 1.0,
    "coverage_min": 1e-8,
}


def node(library, sigma_n, sigma_t, mu, **more):
    """A node whose augmented traction is (sigma_t, 0, sigma_n), with no gap and no slip: its multiplier."""
    zero = (0.0, 0.0, 0.0)
    return library.respond(
        **(NODE | dict(lambda_=(sigma_t, 0.0, sigma_n), mu=mu, gap_now=zero, gap_previous=zero) | more)
    )


def expected(sigma_n, sigma_t, mu):
    """State and traction, in fractions."""
    n, t, m = Fraction(sigma_n), Fraction(sigma_t), Fraction(mu)
    if n >= 0:
        return GAP, (0.0, 0.0)
    limit = -m * n
    if abs(t) >= limit * (1 - Fraction(TIE)):
        return SLIP, (float(min(limit, abs(t)) * (1 if t >= 0 else -1)), float(n))
    return STICK, (float(t), float(n))


def check(outcome, library, name, sigma_n, sigma_t, mu, scale=1.0):
    response = node(library, sigma_n, sigma_t, mu)
    state, (tangential, normal) = expected(sigma_n, sigma_t, mu)
    outcome.true(f"{name}: state", response.state == state, "paper (17), (22), (24)")
    error = max(abs(response.traction[0] - tangential), abs(response.traction[1]), abs(response.traction[2] - normal))
    outcome.below(f"{name}: traction", error, EXACT * scale, "projection on the cone, in fractions")
    numbers = [*response.traction, *response.row, *response.dp_dlambda, *response.drow_dnow, *response.drow_dprevious]
    outcome.true(f"{name}: finite", np.isfinite(numbers).all(), "no 0/0 at a margin")
    return response


def margin(text):
    """On both sides of the cone's border and of the border to the gap; traction and row are continuous across them."""
    d = float(text)

    def run(context):
        outcome, library = Outcome(), context.library
        for mu in (0.3, 1.0, 1e3):
            inside = check(outcome, library, f"mu {mu:g}, inside the cone", -1.0, mu * (1 - d), mu, max(1, mu))
            outside = check(outcome, library, f"mu {mu:g}, outside", -1.0, mu * (1 + d), mu, max(1, mu))
            jump = np.abs(np.subtract(inside.traction, outside.traction)).max()
            outcome.below(f"mu {mu:g}: jump of the traction", jump, 2.1 * mu * d + EXACT * max(1, mu), "continuous")
            closed = check(outcome, library, f"mu {mu:g}, closed", -d if d else -0.0, 0.5, mu)
            open_ = check(outcome, library, f"mu {mu:g}, open", d, 0.5, mu)
            jump = np.abs(np.subtract(closed.traction, open_.traction)).max()
            outcome.below(f"mu {mu:g}: jump at the gap", jump, 1.1 * max(1, mu) * d + EXACT, "continuous")
        return outcome

    return run


def tip(text):
    """Tractions of this size: at the tip of the cone, and as good as nothing."""
    s = float(text)

    def run(context):
        outcome, library = Outcome(), context.library
        for name, n, t in (
            ("stick", -s, 0.1 * s),
            ("slip", -s, s),
            ("tip", -s, 0.0),
            ("open", s, s),
            ("nothing", 0.0, s),
        ):
            check(outcome, library, name, n, t, 0.3, s)
        return outcome

    return run


def friction(text):
    mu = float(text)

    def run(context):
        outcome, library = Outcome(), context.library
        for name, t in (("no shear", 0.0), ("little shear", 1e-8), ("shear", 0.7), ("much shear", 1e5)):
            check(outcome, library, name, -1.0, t, mu, max(1.0, t))
        return outcome

    return run


def cells():
    yield from series("node, distance to the margins", MARGINS, margin, kind=ELEMENT, quick=("1e-6", "1e-13", "0"))
    yield from series("node, size of the traction", TIPS, tip, kind=ELEMENT, quick=("1e-150", "1e-300"))
    yield from series("node, friction", FRICTIONS, friction, kind=ELEMENT, quick=("0", "1e-12", "1e6"))
