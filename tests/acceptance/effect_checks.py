"""The effects of an interface in whole scenes: each against an exact answer or against the full machinery, and what it is
not to cost by the library's counters (never by time).
"""

import numpy as np

import comparisons
from comparisons import PatchCase, difference
from reference import fit_hertz

# The multiplier of a tied patch is uniform: what is left is the linear solver's round-off.
TIED_PATCH_BOUND = 1e-11
# Two programs' ways to one solution: what is left is Newton's tolerance, 1e-11.
SAME_ANSWER = 1e-10
# The turn is prescribed with 16 digits, and a step ends at 1e-11 of the forces that turned it.
TIED_TURN_BOUND = 1e-8
# Tied layers with matching meshes are one body: the same linear problem with other unknowns.
TIED_WHOLE_BOUND = 1e-9
# Meshes that do not match: layers of 47 and 60 elements against 60; bending stress is linear, an element's constant.
TIED_BEAM_BOUND = 0.01
# Beam theory: 8 elements over the height are too stiff by 1 / 8^2 = 1.6 %.
BEAM_THEORY_BOUND = 0.02
# Beside the punch's singular edge the pressure is wrong by O(h), h = 0.1, as if the punch were wider by a third of h.
PUNCH_BOUND = 0.03
# An O(h) method halves its error with the element size; some room for the far boundary, which stays.
PUNCH_REFINEMENT_BOUND = 0.7

# Work per key that plays, of 8 against 16: the last two are still down at the end, so their way back is not in it: 2 of 8 or 16
# keys lack one of two moves, a difference of 6 %.
PER_KEY = 0.1

# Four facets across the contact radius: the rim is known to a fraction of one; a body of ten times its radius.
BALL_BOUND = 0.03
# The stick zone ends between two nodes, 0.02 apart; Cattaneo and Mindlin leave out that friction changes the pressure.
STICK_FACET = 0.02
# Sliding: nodes that slipped across the pull before the ball slid still point a little aside.
SLIDING_BOUND = 0.01
# A plane and a flat mesh are one surface: what is left is Newton's tolerance.
FLAT_BOUND = 1e-9

KEYS = range(1, 25)
RESTING = [k for k in KEYS if k % 3 == 0]


def effects(verdicts, driver):
    tied(verdicts, driver)
    frictionless(verdicts, driver)
    rough(verdicts, driver)
    rigid(verdicts, driver)
    small_sliding(verdicts, driver)
    punch(verdicts, driver)
    keys(verdicts, driver)
    analytic(verdicts, driver)
    balls(verdicts, driver)


def counters(run, interface=comparisons.INTERFACE):
    return run.summary["interfaces"][interface]


def nothing(verdicts, label, run, names, interface=comparisons.INTERFACE):
    """These counters must be zero."""
    for name in names:
        verdicts.below(f"{label}: {name}", counters(run, interface)[name], 0, "not called for, not computed")


def tied(verdicts, driver):
    run = driver.run("patch_tied")
    error = comparisons.patch_error(run, PatchCase("patch_tied", (-2.5, 0, -10)), deformed=False)
    verdicts.below("tied patch, pulled and sheared: multiplier error", error, TIED_PATCH_BOUND, "exact solution")
    nothing(verdicts, "tied patch", run, ("pairs_linearised", "nodes_slipping"))
    found = counters(run)
    verdicts.near("tied patch: pairs integrated", found["pairs_integrated"], found["pairs_active"], 0, "once each")
    verdicts.near("tied patch: searches", found["searches"], 1, 0, "at creation")

    tip = lambda run: np.array([run.steps[-1]["probes"][name][2] for name in ("tip1", "tip2")])
    whole, matching = driver.run("tied_beam_whole"), driver.run("tied_beam", "-upper_cells", "60,1,4", label="matching")
    error = np.abs(tip(matching) / tip(whole) - 1).max()
    verdicts.below("tied layers, matching meshes: tip, against one body", error, TIED_WHOLE_BOUND, "the same problem")
    layers = driver.run("tied_beam")
    error = np.abs(tip(layers) / tip(whole) - 1).max()
    verdicts.below("tied layers, other meshes: tip, against one body", error, TIED_BEAM_BOUND, "discretisation")
    length, height, young, load = 10.0, 1.0, 1000.0, 0.1
    theory = 4 * load * (length / height) ** 3 / young + load * length / (5 / 6 * young / 2)  # nu = 0
    verdicts.near("tied layers, other meshes: tip, beam theory", -tip(layers)[0], theory, BEAM_THEORY_BOUND, "8 elements")

    # By 90 degrees about y: (x, y, z) goes to (z, y, -x).
    probes, places = driver.run("tied_gap").steps[-1]["probes"], {"top": (1, 1, 1.7), "corner": (0, 0, 1.2)}
    error = max(np.abs(np.add((x, y, z), probes[name]) - (z, y, -x)).max() for name, (x, y, z) in places.items())
    verdicts.below("tied over a gap of 0.2, turned by 90 degrees: shift", error, TIED_TURN_BOUND, "a rigid turn of both")


def frictionless(verdicts, driver):
    """One multiplier a node, chosen by the driver, against Coulomb's law with mu = 0, every shortcut forbidden."""
    for weights in ("reference", "current"):
        label = f"frictionless, {weights} weights"
        options = ("-contact_weights", weights)
        lean = driver.run("hertz_line_coarse", *options, label=f"lean_{weights}")
        full = driver.run(
            "hertz_line_coarse",
            *options,
            *("-contact_law", "coulomb", "-contact_friction", "0", "-contact_shortcuts", "false"),
            label=f"full_{weights}",
        )
        error = difference(lean, full, "contact")
        verdicts.below(f"{label}: difference from Coulomb, mu = 0", error, SAME_ANSWER, "same answer")
        nothing(verdicts, label, lean, ("nodes_slipping",), "contact")
        slipping = counters(full, "contact")["nodes_slipping"]
        verdicts.at_least(f"Coulomb, mu = 0, {weights} weights: nodes_slipping", slipping, 1, "the full machinery ran")
        n1 = len(lean.interface("contact"))
        verdicts.near(f"{label}: multipliers", counters(lean, "contact")["multipliers"], n1, 0, "one a node")
        less = counters(lean, "contact")["bytes"] / counters(full, "contact")["bytes"]
        verdicts.below(f"{label}: bytes, over those of Coulomb", less, 1, "no larger")


def rough(verdicts, driver):
    stick = driver.run("block_zone_mu2")  # friction so large that every node sticks
    run = driver.run("block_zone_mu2", "-base_law", "rough", "-base_friction", "0", label="rough")
    verdicts.below("rough: difference from mu = 2", difference(run, stick), SAME_ANSWER, "every node sticks")
    slipping = sum(step["interfaces"]["base"]["slip"] for step in run.steps)
    verdicts.below("rough: slip nodes", slipping, 0, "never slips")


def rigid(verdicts, driver):
    scene = "block_bottom_mu02_current"
    chosen = driver.run(scene, label="rigid_chosen")
    for name, options in (
        ("said", ("-base_mortar_side", "rigid")),
        ("forbidden", ("-base_mortar_side", "deformable")),
        ("no shortcuts", ("-base_shortcuts", "false")),
    ):
        run = driver.run(scene, *options, label=f"rigid_{name.replace(' ', '_')}")
        error = difference(run, chosen)
        verdicts.below(f"rigid mortar side, {name}: difference from the library's choice", error, SAME_ANSWER, "same")
        verdicts.near(
            f"rigid mortar side, {name}: Newton iterations",
            run.newton_iterations,
            chosen.newton_iterations,
            0,
            "the same tangent",
        )


def small_sliding(verdicts, driver):
    """Weights of the reference configuration: integrated at creation, then used again in every evaluation."""
    few, many = (driver.run("block_bottom_mu02", "-steps_count", n, label=f"steps_{n}") for n in (2, 20))
    for name in ("searches", "pairs_integrated", "pairs_tested"):
        verdicts.near(
            f"small sliding: {name}, 20 steps against 2", counters(many)[name], counters(few)[name], 0, "creation's only"
        )
    nothing(verdicts, "small sliding", many, ("pairs_linearised",))
    more = counters(many)["pairs_reused"] - counters(few)["pairs_reused"]
    verdicts.at_least("small sliding: pairs reused, 20 steps more than 2", more, 1, "frozen weights serve again")


def punch(verdicts, driver):
    """Pressure under the middle of the punch, P / pi on a half-space; then on a mesh twice as fine."""
    coarse = punch_error(driver.run("rigid_punch"))
    verdicts.below("rigid punch: pressure in the middle", coarse, PUNCH_BOUND, "half-space; singular edge")
    across = [0, *np.round(np.arange(0.05, 1.11, 0.05), 9), 1.175, 1.25, 1.375, 1.5, 1.75, 2, 2.5, 3, 4.5, 7, 10, 14, 20]
    down = [-20, -14, -10, -7, -4.5, -3, -2, -1.5, -1.1, -0.9, -0.7, *np.round(np.arange(-0.6, 0.01, 0.05), 9)]
    planes = lambda values: ",".join(f"{v:g}" for v in values)
    fine = driver.run("rigid_punch", "-block_x", planes(across), "-block_z", planes(down), label="punch_fine")
    verdicts.below("rigid punch: its error, h / 2 over h", punch_error(fine) / coarse, PUNCH_REFINEMENT_BOUND, "converges")


def punch_error(run):
    line = run.line("contact")
    pressure = -line.traction[0, 2]  # at x = 0: half a tributary length, and half a force
    force = -2 * line.force[:, 2].sum()
    return abs(pressure * np.pi / force - 1)


def keys(verdicts, driver):
    """24 interfaces, at any time two of them touching, eight at rest throughout. None of their nodes is carried: who carries whom is
    found anew at each commit."""
    alone = [word for k in KEYS for word in (f"-contact{k}_weak_coverage", -1)]
    run = driver.run("keys", *alone)
    for k in RESTING:
        name = f"contact{k}"
        nothing(verdicts, f"keys: {name}, at rest", run, ("pairs_tested", "pairs_integrated", "searches"), name)
    touching = [k for k in KEYS if counters(run, f"contact{k}")["pairs_integrated"]]
    playing = [k for k in KEYS if k not in RESTING]
    verdicts.true("keys: those that play, and only those, integrate", touching == playing, f"{touching}")
    together = max(sum(i["stick"] + i["slip"] > 0 for i in step["interfaces"].values()) for step in run.steps)
    verdicts.near("keys: touching at a time", together, 2, 0, "as the scene says")

    # Work in proportion to the keys that touch: half the run, half the keys that play.
    half = driver.run("keys", *alone, "-steps_end", 4, "-steps_count", 4, label="keys_half")
    total = lambda run: sum(counters(run, f"contact{k}")["pairs_integrated"] for k in KEYS)
    per_key = lambda run: total(run) / sum(counters(run, f"contact{k}")["pairs_integrated"] > 0 for k in KEYS)
    verdicts.near("keys: pairs integrated per key that played, 8 against 16", per_key(half), per_key(run), PER_KEY, "constant")

    names = [f"contact{k}" for k in KEYS]
    full = driver.run("keys", *alone, *(w for n in names for w in (f"-{n}_shortcuts", "false")), label="keys_full")
    error = max(difference(run, full, name) for name in names if name in touching_last(run))
    verdicts.below("keys: difference from every search made", error, SAME_ANSWER, "same answer")
    ratio = total(full) / total(run)
    verdicts.at_least("keys: pairs integrated, every search made, over the library's choice", ratio, 1, "work left out")


def touching_last(run):
    return [name for name, i in run.steps[-1]["interfaces"].items() if i["stick"] + i["slip"] > 0]


def analytic(verdicts, driver):
    """The analytic plane of effects.yaml against the rigid floor with a flat mesh, while the block lies flat on it. (Where
    its rim lifts, current weights differ by the square of its slope: a facet looks along its own normal, the plane along
    the plane's.)"""
    both = ("reference", "current")
    for law, options, weights_of in (
        ("none", (), both),
        ("Coulomb", ("-contact_friction", "0.2"), both),
        # With dual multipliers a node of the rim that pulls where it sticks overlaps where it is open: this law has no answer then.
        ("rough", ("-contact_law", "rough", "-contact_basis", "standard"), both[:1]),
    ):
        for weights in weights_of:
            label, name = f"analytic plane, {law}, {weights} weights", f"{law}_{weights}"
            chosen = (*options, "-contact_weights", weights)
            plane = driver.run("effects", *chosen, label=f"plane_{name}")
            floor = driver.run("effects", *chosen, "-contact_mortar", "floor.zmax", label=f"floor_{name}")
            error = difference(plane, floor, "contact")
            verdicts.below(f"{label}: difference from flat facets", error, FLAT_BOUND, "the same plane")
            # Not those integrated: a commit keeps what an evaluation has found between facets, and begins anew here.
            fewer = counters(plane, "contact")["pairs_active"] / counters(floor, "contact")["pairs_active"]
            verdicts.below(f"{label}: pairs, over those of facets", fewer, 0.5, "one a facet, no overlaps")


def balls(verdicts, driver):
    """Hertz' point contact, the ball elastic or rigid; then friction."""
    for scene, parts in (("ball_on_plane", 4), ("ball_in_block", 4)):
        table = driver.run(scene).interface("contact")
        force = parts * abs(table["fz"].sum())
        radius, peak = point_contact(force)
        r, pressure = np.hypot(table["X"], table["Y"]), np.abs(table["fz"]) / table["area_full"]
        verdicts.near(f"{scene}: peak pressure, largest nodal value", pressure.max(), peak, BALL_BOUND, "Hertz")
        verdicts.near(f"{scene}: contact radius, ellipse", fit_hertz(r, pressure)[1], radius, BALL_BOUND, "Hertz")

    run = driver.run("ball_on_plane_friction")
    mu = 0.3
    force = lambda step: 2 * np.array(run.steps[step]["interfaces"]["contact"]["force"])
    for number in (5, 6):  # drawn, not yet sliding
        normal, pull = force(number - 1)[2], -force(number - 1)[0]
        stick = point_contact(normal)[0] * np.cbrt(1 - pull / (mu * normal))
        table = run.interface("contact", number)
        inner = np.hypot(table["X"], table["Y"])[table["state"] == "stick"].max()
        verdicts.near(
            f"ball drawn by {pull / (mu * normal):.2f} of what slides: radius of the stick zone (error in facets)",
            inner,
            stick,
            1,
            "Cattaneo, Mindlin; in facets",
            scale=STICK_FACET,
        )
    sliding = force(-1)
    verdicts.near("ball that slides: pull over mu P", -sliding[0] / (mu * sliding[2]), 1, SLIDING_BOUND, "Coulomb")
    verdicts.below("ball that slides: stick nodes", run.steps[-1]["interfaces"]["contact"]["stick"], 0, "it slides")


def point_contact(force, young=1000.0, poisson=0.3, radius=1.0):
    """Hertz: (contact radius, peak pressure) of an elastic against a rigid body."""
    modulus = young / (1 - poisson**2)
    contact = np.cbrt(0.75 * force * radius / modulus)
    return contact, 1.5 * force / (np.pi * contact**2)
