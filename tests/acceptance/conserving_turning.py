"""Contact with friction that conserves, against closed forms: a wheel that rolls, a capstan that spins up, brakes in the plane and in space; and a ball that
hops with the masses of its surface spread. Minutes."""

import math

import numpy as np

from conserving import conserves, iterations
from conserving_scenes import BRAKE, CAPSTAN, GRAVITY, SLOPE, brake, capstan, disc_brake, hops, wheel
from dynamics import energy, run, total

# Closed forms.
CLOSED = 0.01
# A wheel of 24 facets that hits with its corners: of the first order in the facets and more, 48 are within CLOSED.
COARSE = 0.03
# Of Newton's method a step, in the mean over the scenes.
ITERATIONS = 3.5
# What spread masses leave of what a hop takes, in steps of a quarter of h / c. Of 2 and 3 cells from the centre of the ball to its surface so many hops, which it has
# made by such a time: the finer ones take minutes.
LAYER, HOPS = 0.2, {2: (20, 6.2), 3: (5, 2.0)}
# The wave speed of the ball, sqrt(E / rho).
SPEED = math.sqrt(2e4)


def conserving_turning(verdicts, driver):
    driver.output.mkdir(parents=True, exist_ok=True)
    counts = [*rolls(verdicts, driver), spins_up(verdicts, driver), *brakes(verdicts, driver)]
    verdicts.below("Newton iterations a step, mean over the scenes", np.mean(counts), ITERATIONS, f"of {len(counts)} scenes")
    hop(verdicts, driver)


def times(result):
    return np.array([step["t"] for step in result.steps])


def rolls(verdicts, driver):
    """g sin / (1 + I / m r^2), 2/3 g sin of a round wheel; the weight comes on within 0.2 s, so that it does not jump."""
    taken = []
    for n, bound in ((6, COARSE), (12, CLOSED)):
        result = run(driver, "wheel", wheel(n), label=f"wheel_{n}")
        conserves(verdicts, f"wheel of {4 * n} facets", result)
        t, x = times(result), np.array([step["probes"]["centre"][0] for step in result.steps])
        after = t > 0.25
        slope = 2 * np.polyfit(t[after], x[after], 2)[0]
        verdicts.near(f"wheel of {4 * n} facets: acceleration", slope / (GRAVITY * math.sin(SLOPE)), 2 / 3, bound, "2/3 g sin")
        taken.append(iterations(result))
    return taken


def spins_up(verdicts, driver):
    """The belt's tension grows by exp(mu pi) around the drum, and that holds back what the moment drives."""
    result = run(driver, "capstan", capstan())
    table = energy(result)
    verdicts.below("capstan: growth of energy by contact", table["contact_gain"][-1] / total(table).max(), 1e-10, "none")
    t, turn = times(result), np.array([step["rigid"]["drum"]["rotation"][2] for step in result.steps])
    ratio, steady = math.exp(CAPSTAN["friction"] * math.pi), t > 0.4
    held = -np.array([step["reactions"]["hold"][1] for step in result.steps])[steady].mean()
    verdicts.near("capstan: tension at the held end over the other", held / CAPSTAN["tension"] / ratio, 1, CLOSED, "exp(mu pi)")
    driven = (CAPSTAN["moment"] - CAPSTAN["tension"] * (ratio - 1)) / CAPSTAN["inertia"]
    verdicts.near("capstan: it spins up by", 2 * np.polyfit(t[steady], turn[steady], 2)[0] / driven, 1, CLOSED, "moment less the belt's, over inertia")
    return iterations(result)


def ring_arm(inner, outer, facets):
    """The mean distance from the centre in a ring of so many straight facets, over its area: where friction acts."""
    half = math.pi / facets
    secants = math.log((1 + math.sin(half)) / math.cos(half)) + math.sin(half) / math.cos(half) ** 2
    return math.cos(half) ** 3 * secants / 3 * (outer**3 - inner**3) / (math.sin(half) * math.cos(half) * (outer**2 - inner**2))


def brakes(verdicts, driver):
    """mu N r / I slow it down, and it stays where it stops."""
    taken = []
    facets = 24
    area = facets * math.sin(math.pi / facets) * math.cos(math.pi / facets) / math.pi  # the ring's over that of a round one
    for name, scene, body, torque in (("brake", brake(), "wheel", 1), ("disc_brake", disc_brake(), "disc", area * ring_arm(0.6, 1, facets))):
        result = run(driver, name, scene)
        table = energy(result)
        t, turn = times(result), np.abs([step["rigid"][body]["rotation"][2] for step in result.steps])
        while_it_spins = (t > 0.3) & (t < 0.8)
        closed = BRAKE["friction"] * BRAKE["press"] * torque / BRAKE["inertia"]
        verdicts.near(f"{name}: slows down by", -2 * np.polyfit(t[while_it_spins], turn[while_it_spins], 2)[0] / closed, 1, CLOSED, "mu N r / I")
        left = table["kinetic"][-1] + table["strain"][-1]
        verdicts.below(f"{name}: what is left in the end", left / table["kinetic"][0], CLOSED, "it stops, and stays")
        verdicts.near(f"{name}: what friction and damping have taken", table["friction_dissipation"][-1] + table["damping"][-1], table["kinetic"][0], CLOSED, "all of it", scale=table["kinetic"][0])
        taken.append(iterations(result))
    return taken


def hop(verdicts, driver):
    """A ball hops in space, coarse and finer: what contact takes in a hop with masses at its surface, and with these spread."""
    for n, (hops_made, end) in HOPS.items():
        taken = {}
        step = 0.25 / n / SPEED
        for spread in (False, True):
            result = run(driver, "hops", hops(n, spread, round(end / step), end), label=f"hops_{n}_{spread}")
            table = energy(result)
            pressed = np.abs([step["interfaces"]["c"]["force"][2] for step in result.steps]) > 0
            hopped = np.count_nonzero(np.diff(np.flatnonzero(pressed)) * step > 0.02)
            verdicts.at_least(f"ball, h = 1/{n}, spread {spread}: hops", hopped, hops_made, "they are counted by their flights")
            verdicts.below(f"ball, h = 1/{n}, spread {spread}: what a step gives", np.diff(total(table) - table["external_work"]).max() / total(table).max(), 1e-9, "nothing")
            taken[spread] = -table["contact_work"][-1] / hopped
        verdicts.below(f"ball, h = 1/{n}: what contact takes in a hop, over that with masses", taken[True] / taken[False], LAYER, f"{taken[True]:.2g} and {taken[False]:.2g}")
