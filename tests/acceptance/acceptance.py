"""The acceptance checks, in groups: each function runs scenes and adds its comparisons to the Verdicts.

Every bound is a named constant with its reason, here or in comparisons.py.
"""

import math

import comparisons
from bad_scenes import BAD_SCENES, write_bad_scene, write_signed_mesh
from jacobian import jacobian

# Frozen weights make every step a piecewise linear problem: all splits of the load end in the same state, to round-off.
SPLIT_BOUND_FROZEN = 1e-10
# With current weights the path matters a little: weights and slip are taken at the end of each step.
SPLIT_BOUND_CURRENT = 1e-4
# On 20x10 the slip front is known to one of 20 facets.
COARSE_TRACTION_BOUND = 0.05
# An O(h) method halves its error with the element size; the slip front moves in whole facets, hence some room.
REFINEMENT_BOUND = 0.7
# Total of 10 + 10 steps; other codes take 65 to 69 for the same run.
NEWTON_LIMIT = 65
# The augmentation steers the iterations only; what is left is the Newton tolerance.
AUGMENTATION_BOUND = 1e-11
# Multiplying by powers of two is exact in floating point, so nothing may change; otherwise round-off may shift a step by one.
UNITS_BOUND = 1e-9
# Two ranks add the same numbers in another order.
PARALLEL_BOUND = 1e-9
# Between the last three residual norms of a step, where they are above round-off: order 2, with room for the constant.
ORDER_LIMIT = 1.7
ROUND_OFF = 1e-13  # relative to the forces of the step
ASYMPTOTIC = 0.1  # a residual that falls by less is still looking for the active set

# What the library refuses: its words speak of constants of C.
AUGMENTED_POINTS = ("-base_form", "augmented", "-base_decision", "points", "-base_basis", "dual")
FOUNDATIONS = {"mesh": "", "facet": "_facet"}
SPLITS = {"1+1": 2, "2+2": 4, "5+5": 10, "10+10": 20}
COLD, WARM = ("-steps_predictor", "false"), ("-steps_predictor", "true")


def patch(verdicts, driver):
    for case in comparisons.patch_cases():
        run = driver.run(case.scene, *case.options, label=case.label)
        verdicts.below(
            f"{case.label}: multiplier error",
            comparisons.patch_error(run, case),
            comparisons.PATCH_BOUND,
            "exact solution",
        )


def block(verdicts, driver):
    for kind, suffix in FOUNDATIONS.items():
        run = driver.run(f"block_zone_mu2{suffix}")
        comparisons.block_resultants(verdicts, f"mu = 2, {kind}", run)
        comparisons.block_all_stick(verdicts, f"mu = 2, {kind}", run)
        run = driver.run(f"block_zone_mu05{suffix}")
        comparisons.block_resultants(verdicts, f"mu = 0.5, {kind}", run)
        comparisons.block_inner_tractions(verdicts, f"mu = 0.5, {kind}", run)
        run = driver.run(f"block_bottom_mu02{suffix}")
        comparisons.block_resultants(verdicts, f"mu = 0.2, {kind}", run)
        comparisons.block_slip(verdicts, f"mu = 0.2, {kind}", run)

    meshes = ("20,1,10", "40,1,20", "80,1,40")
    errors = [
        comparisons.slip_traction_error(driver.run("block_bottom_mu02", "-block_cells", cells, label=f"cells_{cells}"))
        for cells in meshes
    ]
    verdicts.below(
        f"mu = 0.2: tractions, {meshes[0]}, against 320x160", errors[0], COARSE_TRACTION_BOUND, "coarse mesh"
    )
    for coarse, fine, cells in zip(errors, errors[1:], meshes[1:]):
        verdicts.below(
            f"mu = 0.2: their error, {cells} over the mesh before", fine / coarse, REFINEMENT_BOUND, "converges"
        )


def steps(verdicts, driver):
    """The load split into few or many steps, cold (no extrapolation), the block held by contact and friction alone."""
    for name, weights, bound in (
        ("frozen weights", "reference", SPLIT_BOUND_FROZEN),
        ("current weights", "current", SPLIT_BOUND_CURRENT),
    ):
        options = ("-base_weights", weights)
        runs = splits(verdicts, driver, name, "block_bottom_mu02", options, SPLITS, bound)
        cold = runs["10+10"].newton_iterations
        verdicts.below(f"{name}, 10+10: Newton iterations, cold", cold, NEWTON_LIMIT, "other codes: 65 to 69")
        warm = driver.run("block_bottom_mu02", *options, *WARM, label=f"{weights}_predictor").newton_iterations
        verdicts.below(f"{name}, 10+10: with the predictor", warm, cold - 1, "fewer than cold")
        if weights == "current":  # with frozen weights the last iteration goes to round-off at once
            order = newton_order(runs["1+1"])
            verdicts.at_least(f"{name}, 1+1: order of Newton's method", order, ORDER_LIMIT, "last three residual norms")

    ends = {split: SPLITS[split] for split in ("1+1", "10+10")}
    for scene in ("block_zone_mu2", "block_zone_mu05", "block_bottom_mu02_facet"):
        splits(verdicts, driver, scene, scene, (), ends, SPLIT_BOUND_FROZEN)

    default = driver.run("block_bottom_mu02")
    for cells in ("1,1,1", "5,2,1", "20,1,1", "37,4,1"):
        run = driver.run("block_bottom_mu02", *COLD, "-floor_cells", cells, label=f"floor_{cells}")
        no_cutback(verdicts, f"foundation {cells}", run)
        error = comparisons.difference(run, default)
        verdicts.below(f"foundation {cells}: difference", error, SPLIT_BOUND_FROZEN, "its flat mesh is irrelevant")


def splits(verdicts, driver, name, scene, options, counts, bound):
    """One scene in several numbers of steps; all must agree with the last."""
    runs = {
        split: driver.run(scene, *options, *COLD, "-steps_count", count, label=f"{name.replace(' ', '_')}_{split}")
        for split, count in counts.items()
    }
    *others, last = counts
    for split, run in runs.items():
        no_cutback(verdicts, f"{name}, {split}", run)
        if split in others:
            error = comparisons.difference(run, runs[last])
            verdicts.below(f"{name}, {split}: difference from {last}", error, bound, "same answer")
    return runs


def no_cutback(verdicts, label, run):
    verdicts.below(f"{label}: cut-backs", run.summary["cutbacks"], 0, "every step converges at the first attempt")


def newton_order(run):
    """Smallest order of convergence over the steps, each from its last three norms above round-off.

    Order means something only once the residual falls steeply. A step that goes to round-off at once when its last
    node has changed state (a piecewise linear problem) never gets there and is left out; if all are, the answer is not
    a number, which fails.
    """
    orders = []
    for step in run.steps:
        norms = [norm for norm in step["residual_norms"] if norm > ROUND_OFF * step["reference_force"]]
        if len(norms) >= 3:
            first, second, third = norms[-3:]
            if second < ASYMPTOTIC * first:
                orders.append(math.log(third / second) / math.log(second / first))
    return min(orders, default=math.nan)


def invariance(verdicts, driver):
    default = driver.run("block_bottom_mu02_current")
    for scale in ("1e-6", "1e-4", "1e-2", "1e1", "1e2"):
        run = driver.run("block_bottom_mu02_current", "-base_augmentation_scale", scale, label=f"augmentation_{scale}")
        verdicts.below(
            f"augmentation {scale} of its default: difference",
            comparisons.difference(run, default),
            AUGMENTATION_BOUND,
            "steers iterations only",
        )

    run = driver.run("block_bottom_mu02_current", "-base_form", "augmented", label="augmented_form")
    error = comparisons.difference(run, default)
    verdicts.below("augmented form: difference from the multiplier form", error, AUGMENTATION_BOUND, "same solutions")

    iterations = lambda run: [step["newton_iterations"] for step in run.steps]
    for label, length, stress, slack in (
        ("lengths x 2^10", 2.0**10, 1.0, 0),
        ("stresses x 2^20", 1.0, 2.0**20, 0),
        ("lengths x 2^-10, stresses x 2^20", 2.0**-10, 2.0**20, 0),
        ("lengths x 1e-3, stresses x 1e6", 1e-3, 1e6, 1),
    ):
        run = driver.run("block_bottom_mu02_current", *in_units(length, stress), label=label.replace(" ", "_"))
        change = max((abs(a - b) for a, b in zip(iterations(run), iterations(default), strict=True)))
        verdicts.below(
            f"{label}: change of the Newton iterations of a step", change, slack, "units carry no information"
        )
        difference = comparisons.difference(run, default, length=length, force=stress * length**2)
        verdicts.below(f"{label}: difference", difference, UNITS_BOUND, "units carry no information")


def in_units(length, stress):
    """Options that write block_bottom_mu02 in other units."""
    vector = lambda factor, *values: ",".join(repr(factor * value) for value in values)
    return (
        *("-block_upper", vector(length, 4, 1, 2), "-block_young", repr(1000 * stress)),
        *(
            "-floor_lower",
            vector(length, -0.5, -0.5, -1),
            "-floor_upper",
            vector(length, 4.5, 1.5, 0),
            "-floor_young",
            repr(1000 * stress),
        ),
        *("-press_traction", vector(stress, 0, 0, -200), "-push_traction", vector(stress, 60, 0, 0)),
        *("-topleft_point", vector(length, 0, 0, 2), "-topright_point", vector(length, 4, 0, 2)),
    )


def hertz(verdicts, driver):
    run = driver.run("hertz_line_coarse")
    comparisons.hertz(verdicts, "Hertz, coarse mesh", run)
    no_cutback(verdicts, "Hertz, coarse mesh", run)
    large = driver.run("hertz_line_coarse", "-contact_weights", "current", label="current_weights")
    order = newton_order(large)
    verdicts.at_least(
        "Hertz, current weights: order of Newton's method", order, ORDER_LIMIT, "last three residual norms"
    )


def parallel(verdicts, driver):
    for scene in ("block_bottom_mu02_current", "patch_flat_5_7", "hertz_line_coarse"):
        one, two = driver.run(scene), driver.run(scene, ranks=2, label=f"{scene}_two_ranks")
        interface = next(iter(one.steps[-1]["interfaces"]))
        verdicts.below(
            f"{scene} on two ranks: difference",
            comparisons.difference(two, one, interface),
            PARALLEL_BOUND,
            "other order of summation",
        )


def errors(verdicts, driver):
    driver.output.mkdir(parents=True, exist_ok=True)
    for bad in BAD_SCENES:
        path = write_bad_scene(bad, driver.output)
        run = driver.run(path, *bad.options, label=f"bad_{bad.name}", expect=1)
        verdicts.true(
            f"{bad.name}: exit code 1, message names {bad.names}",
            f"{bad.names}:" in run.text and bad.says in run.text,
            "the key at fault is named",
        )
        verdicts.true(
            f"{bad.name}: a sentence, no traceback",
            "PETSC ERROR" not in run.text,
            "errors of the user are explained, not dumped",
        )
    plain = driver.run("patch_gmsh", label="unsigned_surface")
    run = driver.run("patch_gmsh", "-upper_file", write_signed_mesh(driver.output), label="signed_surface")
    same = [s["interfaces"] for s in run.steps] == [s["interfaces"] for s in plain.steps]
    verdicts.true("a physical surface with a negative tag: as without the sign", same, "faces look out of their body")
    run = driver.run("block_zone_mu05", "-push_curve", "1000,0,2000,1", label="late_curve")
    verdicts.true("curve in other units: a note", "note: push.curve" in run.text, "not an error: a run may end early")
    run = driver.run("klarbring", "-floor_lower", "20,-1,-1", "-floor_upper", "30,2,0", label="no_overlap")
    said = "contact: Of 4 non-mortar nodes 0 are covered" in run.text and "No facets lie over each other" in run.text
    verdicts.true("surfaces that do not meet: told at the start", said, "not an error: they may meet later")
    run = driver.run("block_bottom_mu02", *AUGMENTED_POINTS, label="keys", expect=3)
    said = "(`decision: points`) with the augmented form (`form: augmented`)" in run.text and "STICKSLIP" not in run.text
    verdicts.true("a refusal by the library: keys, no names of C", said, "a scene has keys")
    for options, code, reason in (
        (("-snes_max_it", 1), 2, "not converged"),
        (("-base_augmentation_scale", 1e308), 3, "refused by the library: an infinite augmentation"),
    ):
        run = driver.run("block_bottom_mu02", *options, label=f"exit_code_{code}", expect=code)
        verdicts.true(f"{' '.join(map(str, options))}: exit code {code}", run.exit_code == code, reason)


GROUPS = {f.__name__: f for f in (patch, block, steps, invariance, hertz, parallel, errors, jacobian)}
