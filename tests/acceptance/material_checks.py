"""The bulk at large strain: homogeneous deformations against closed forms, rigid rotation, locking, inverted cells.

(Points and single cells: `materials_test`, in C. The tangent of whole scenes: group `jacobian`.)
"""

import math

import numpy as np

# The discrete solution is the exact one: what is left is Newton's tolerance, 1e-11, and a few digits in the file.
HOMOGENEOUS_BOUND = 1e-10
# The .vtu has six digits of a stress; half of the last.
STRESS_DIGITS = 1e-5
# Reactions over E times a face's area: rounding of F^T F, as in materials_test.
ROTATION_BOUND = 1e-12
# Cook's membrane, 16 cells a side, nu = 0.4999, against 32: the clamped corners are singular, the error falls as h^1.5.
COOK_BOUND = 0.02
# Near incompressibility the answer has a limit: nu from 0.499 to 0.4999 may change it by some multiple of 1 - 2 nu.
LIMIT_BOUND = 5e-3
# h^1.5 would be 0.35.
REFINEMENT_BOUND = 0.5
# What locking is: the pointwise panel is stiffer by more than this on the same mesh. (It is measured to be 2.9 times.)
LOCKING = 2.0

YOUNG = 1000.0
LAWS = ("neo_hooke", "st_venant_kirchhoff")
DILATATIONS = ("pointwise", "mean")
AXIS, ANGLE = np.array([2.0, -1.0, 2.0]) / 3, 2.0


def materials(verdicts, driver):
    uniaxial(verdicts, driver)
    affine(verdicts, driver)
    rotation(verdicts, driver)
    locking(verdicts, driver)
    inverted(verdicts, driver)


def lame(young, poisson):
    shear = young / (2 * (1 + poisson))
    return shear, 2 * shear * poisson / (1 - 2 * poisson)


def first_piola(law, gradient, poisson):
    """P of u = gradient X, from the second Piola-Kirchhoff stress: another way than the driver's."""
    shear, volume = lame(YOUNG, poisson)
    F = np.eye(3) + gradient
    C = F.T @ F
    if law == "neo_hooke":
        S = shear * (np.eye(3) - np.linalg.inv(C)) + volume * np.log(np.linalg.det(F)) * np.linalg.inv(C)
    else:
        S = shear * (C - np.eye(3)) + volume / 2 * np.trace(C - np.eye(3)) * np.eye(3)
    return F @ S


def uniaxial(verdicts, driver):
    """Stretch by 1.7 with free sides: the lateral stretch is the root of P_yy = 0, found by bisection."""
    size, along = np.array([1.0, 2.0, 1.5]), 1.7
    for law in LAWS:
        for dilatation in DILATATIONS:
            options = ("-block_material", law, "-block_dilatation", dilatation)
            run = driver.run("large_strain_stretch", *options, label=f"stretch_{law}_{dilatation}")
            low, high = 0.1, 1.5
            for _ in range(200):
                middle = (low + high) / 2
                P = first_piola(law, np.diag([along, middle, middle]) - np.eye(3), 0.49)
                low, high = (middle, high) if P[1, 1] < 0 else (low, middle)
            label, step = f"{law}, {dilatation}: stretch", run.steps[-1]
            corner = np.array(step["probes"]["corner"]) / size + 1
            verdicts.near(f"{label}, lateral", corner[1], middle, HOMOGENEOUS_BOUND, "closed form")
            force = step["reactions"]["right"][0] / (size[1] * size[2])
            verdicts.near(f"{label}, force over area", force, P[0, 0], HOMOGENEOUS_BOUND, "closed form")


def affine(verdicts, driver):
    """Simple shear by 0.8 of a skew block: the inner vertices follow, and every cell has Cauchy's stress P F^T / J."""
    gradient = np.zeros((3, 3))
    gradient[0, 1] = 0.8
    F = np.eye(3) + gradient
    for law in LAWS:
        for label, options in (
            ("hex, pointwise", ()),
            ("hex, mean", ("-block_dilatation", "mean")),
            ("tet", ("-block_cell", "tet")),
        ):
            name = f"affine_{law}_{label.replace(', ', '_')}"
            run = driver.run("large_strain_affine", "-block_material", law, *options, label=name)
            points, _, displacement = run.mesh()
            error = np.abs(displacement - points @ gradient.T).max()
            verdicts.below(f"{law}, {label}: shear, displacements", error, HOMOGENEOUS_BOUND, "linear field")
            sigma = first_piola(law, gradient, 0.3) @ F.T / np.linalg.det(F)
            exact = np.array([sigma[i, j] for i, j in ((0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2))])
            error = np.abs(run.cell_stress() - exact).max() / np.abs(exact).max()
            verdicts.below(f"{law}, {label}: shear, Cauchy's stress", error, STRESS_DIGITS, "digits in the file")


def rotation(verdicts, driver):
    cross = np.cross(np.eye(3), AXIS)
    gradient = math.sin(ANGLE) * cross + (1 - math.cos(ANGLE)) * (cross @ cross)
    option = ",".join(f"{g:.17g}" for g in gradient.ravel())
    for law in LAWS:
        for dilatation in DILATATIONS:
            options = ("-block_material", law, "-block_dilatation", dilatation, "-grip_gradient", option)
            run = driver.run("large_strain_affine", *options, label=f"rotation_{law}_{dilatation}")
            points, _, displacement = run.mesh()
            error = np.abs(displacement - points @ gradient.T).max()
            verdicts.below(f"{law}, {dilatation}: rotation by 2, displacements", error, ROTATION_BOUND, "rigid")
            force = run.steps[-1]["reference_force"] / YOUNG
            verdicts.below(f"{law}, {dilatation}: rotation by 2, nodal forces over E", force, ROTATION_BOUND, "rigid")


    turned = ("-grip_gradient", ",".join("0" * 9), "-grip_rotate", ",".join(f"{w:.17g}" for w in ANGLE * AXIS))
    run = driver.run("large_strain_affine", *turned, label="rotate")
    points, _, displacement = run.mesh()
    error = np.abs(displacement - points @ gradient.T).max()
    verdicts.below("support with `rotate`, by 2: displacements", error, ROTATION_BOUND, "the same rotation")


def locking(verdicts, driver):
    def tip(cells, poisson, dilatation):
        label = f"cook_{cells}_{poisson}_{dilatation}"
        options = ("-panel_cells", f"{cells},{cells},1", "-panel_poisson", poisson, "-panel_dilatation", dilatation)
        return driver.run("cook", *options, label=label).steps[-1]["probes"]["tip"][1]

    coarse, middle, fine = (tip(n, 0.4999, "mean") for n in (8, 16, 32))
    verdicts.near("Cook, nu 0.4999, mean, 16 cells: tip", middle, fine, COOK_BOUND, "32 cells")
    ratio = (fine - middle) / (middle - coarse)
    verdicts.below("Cook, nu 0.4999, mean: change from 16 to 32 over 8 to 16", ratio, REFINEMENT_BOUND, "converges")
    verdicts.near("Cook, mean, 16 cells: nu 0.499, tip", tip(16, 0.499, "mean"), middle, LIMIT_BOUND, "has a limit")
    locked = tip(16, 0.4999, "pointwise")
    verdicts.at_least("Cook, nu 0.4999, 16 cells: tip, mean over pointwise", middle / locked, LOCKING, "that one locks")
    same = tip(32, 0.3, "mean") / tip(32, 0.3, "pointwise")
    verdicts.near("Cook, nu 0.3, 32 cells: tip, mean over pointwise", same, 1, COOK_BOUND, "both converge to one")


def inverted(verdicts, driver):
    """A face pushed through the opposite one, in one step: refused with the body's name, on one rank or two."""
    for ranks in (1, 2):
        run = driver.run(
            "large_strain_stretch",
            *("-right_value", "-1.5,0,0", "-steps_count", 1, "-steps_smallest", 1),
            label=f"inverted_{ranks}",
            ranks=ranks,
            expect=2,
        )
        named = "a cell of 'block' is turned inside out" in run.text
        verdicts.true(f"pushed through itself, {ranks} ranks: refused by name", named, "exit code 2, and the place")
    load = ("-shear_traction", "0,-50,0", "-steps_count", 1, "-panel_cells", "8,8,1", "-panel_poisson", 0.499)
    run = driver.run("cook", *load, label="cut_back")
    told = "turned inside out" in run.text
    verdicts.true("Cook, eight times the load in one step: an inverted cell on the way", told, "the message")
    verdicts.at_least("the same: cut-backs", run.summary["cutbacks"], 1, "and then it is solved")
