"""The press fit: a soft slider pushed into a narrowing channel, 50 mm a step; its drop-off at the end; both sides
swapped; in three dimensions. Lengths mm, forces N.
"""

import numpy as np

# Sums of nodal forces against each other, over the contact force: Newton's tolerance is 1e-13 of larger forces.
BALANCE_BOUND = 1e-12
# Second differences that alternate in sign from node to node, over the mean pressure.
ALTERNATION_BOUND = 0.05
# Plateau, slider on the flat: R_x / R_z is Coulomb's mu, here 0.1, up to the slope of the elastic channel's surface
# under the slider, 0.1 % to 1 % (the slider's middle sinks more than its ends).
PLATEAU_BOUND = 0.02
# Plateau on the finer mesh, on half the mesh size: two per cent, of a slider of 18 x 3 elements.
MESH_BOUND = 0.03
# Mean dilatation instead of pointwise: what locking costs at nu = 0.47, smaller than the mesh's error.
DILATATION_BOUND = 0.01
# Steps of 50 against steps of 4: the state before differs where a step of two facets passes a corner, not on the
# plateau.
STEP_BOUND = 0.02
# With the sides swapped the slider's edges lie within facets, of 36 in a contact of 450. On the flat the pressure is
# even until the leading edge comes to the ramp, at 300.
SWAPPED_BOUND = 5e-3
# Mean over the travel with the slider round both corners of the ramp, with normals of the last step. The slider's
# turn as its facets pass a corner and so lag behind by a step; the channel's, with the sides swapped, stay. The
# difference falls as the step; of each step, and from one to the next one half as long.
LAG_BOUND, LAG_FALLS = {4: 0.03, 2: 0.015, 1: 0.0075}, 0.7
AROUND = (550, 950)
LAGGING = ("-method", "paper", "-contact_lag_max", 1)
# The leading edge comes on to the ramp: that differs by where in its facet it is, whatever the step. From one mesh to
# one of half its size.
ENTRY, ENTRY_FALLS = (350, 450), 0.5
# Drop-off: the force falls in every step, and nothing is left when the slider is off; off a rounded edge on every mesh.
# Off a sharp one finer sliders and smaller steps do not meet that: their facets leave the edge one by one, bent by 45
# degrees over it, and the force then rises by less than what the facets that a step passes carry (of_facets).
DROP_BOUND = 1e-10
# Smallest over largest singular value of the balanced tangent: rounding is 1e-16 times its size, 700; a singular one is
# there, or at 0. Measured 3e-4.
RANK_LIMIT = 1e-6
RANK_EVERY = 3
# Cosines of columns that balancing parts; and what is left of one beside the other when they are the same, to rounding.
# (The library lets a node go when less than 1e-8 of it is covered.)
NEARLY_PARALLEL, PARALLEL = 0.5, 1e-13

# With the sides swapped a step of 50 passes a corner within a facet; whether Newton finds it at the first attempt hangs
# on the last bit there (none to one seen).
FEW = 3

MU, LENGTH = 0.1, 450
SWAPPED = ("-contact_nonmortar", "channel.contact", "-contact_mortar", "slider.zmin")
SWAPPED_MESH = ("-channel_file", "../meshes/press_fit_swapped.msh")
SWAPPED_FINE = ("-channel_file", "../meshes/press_fit_swapped_fine.msh", "-slider_cells", "36,1,6")
QUIET = ("-output_csv", "none", "-output_vtu", "none")
ROUNDED = ("-channel_file", "../meshes/press_fit_rounded.msh")
# The slider's end is bent over the edge and springs back as it leaves it, by 22 to 32 degrees in however small a step:
# more than a step may turn unless the scene says so [rad].
SPRINGS = ("-contact_turn_max", "0.8")
FINE = ("-channel_file", "../meshes/press_fit_fine.msh", "-slider_cells", "36,1,6")
PLATEAU = slice(-5, None)  # of a run of 1300: the slider from 1100 to 1300, and 450 longer, on the flat


def slider(verdicts, driver):
    run = driver.run("press_fit", *travel(1300, 50), label="coarse")
    no_cutback(verdicts, "20 steps of 50 and six more", run)
    balance(verdicts, "press fit", run)
    work(verdicts, "press fit", run)
    alternation(verdicts, "press fit", run)
    plateau(verdicts, run, driver)
    drop_off(verdicts, driver, (12, 3), 25, DROP_BOUND)
    for cells in ((18, 3), (36, 6)):
        drop_off(verdicts, driver, cells, 25, DROP_BOUND, ROUNDED)
    swapped(verdicts, driver, run)
    three_dimensions(verdicts, driver)


def travel(distance, step):
    """Ten steps of pressing, then the travel."""
    times = [0.1 * k for k in range(1, 11)] + [1 + 0.001 * step * k for k in range(1, round(distance / step) + 1)]
    return "-steps_times", ",".join(f"{t:.10g}" for t in times)


def no_cutback(verdicts, label, run):
    verdicts.below(f"{label}: cut-backs", run.summary["cutbacks"], 0, "every step converges at the first attempt")


def few_cutbacks(verdicts, label, run):
    verdicts.below(f"{label}: cut-backs", run.summary["cutbacks"], FEW, "at the corners")


def reaction(step):
    """(R_x that pushes, R_z that presses)."""
    return np.array([step["reactions"]["push"][0], -step["reactions"]["symmetry"][2]])


def after(distance, run):
    """The step that ends there."""
    return next(step for step in run.steps if abs(step["t"] - 1 - 0.001 * distance) < 1e-9)


def balance(verdicts, label, run, least=1e-6):
    """Supports against each other and the contact, over the reaction of that step or `least` of the largest."""

    def error(step):
        reactions, contact = step["reactions"], np.array(step["interfaces"]["contact"]["force"])
        body = np.array([reactions["push"][0], reactions["symmetry"][2]])
        ground = np.array(reactions["ground"])[[0, 2]]
        largest = max(np.abs(body).max(), reference)
        to_contact = min(np.abs(contact[[0, 2]] + s * body).max() for s in (1, -1))  # it may carry the multipliers or not
        return max(np.abs(body + ground).max(), to_contact) / largest

    reference = least * max(np.abs(reaction(step)).max() for step in run.steps)
    worst = max(error(step) for step in run.steps)
    verdicts.below(f"{label}: forces out of balance, worst step", worst, BALANCE_BOUND, "statics")


def work(verdicts, label, run):
    total = np.array([0] + [step["friction_work"] for step in run.steps])
    verdicts.at_least(f"{label}: least friction work of a step", np.diff(total).min(), 0, "friction dissipates")


def alternation(verdicts, label, run):
    steps = [k for k in range(10, len(run.steps) + 1) if flat(run.steps[k - 1]["t"])]
    worst = max(alternating(run.interface("contact", k)) for k in steps)
    label = f"{label}: alternating pressure on the flats, {len(steps)} steps"
    verdicts.below(label, worst, ALTERNATION_BOUND, "second differences, over mean")


def flat(t):
    """Is the whole slider (to 50 longer than 450 when compressed) on one of the flat parts?"""
    return 1000 * (t - 1) <= 300 or 1000 * (t - 1) >= 1050


def alternating(table):
    row = np.sort(table[table["Y"] == table["Y"].min()], order="X")
    second = np.diff(row["p_lumped"], 2)
    pairs = [min(abs(a), abs(b)) for a, b in zip(second, second[1:]) if a * b < 0]
    return max(pairs, default=0.0) / row["p_lumped"].mean()


def plateau(verdicts, run, driver):
    def mean(run):
        return np.mean([reaction(step) for step in run.steps[PLATEAU]], axis=0)

    coarse = mean(run)
    verdicts.near("plateau: R_x / R_z", coarse[0] / coarse[1], MU, PLATEAU_BOUND, "Coulomb; the channel's own slope")
    fine = driver.run("press_fit", *travel(1300, 50), *FINE, label="fine")
    no_cutback(verdicts, "finer mesh", fine)
    alternation(verdicts, "finer mesh", fine)
    compare(verdicts, "plateau: coarse against the finer mesh", coarse, mean(fine), MESH_BOUND, "discretisation")
    soft = driver.run("press_fit", *travel(1300, 50), "-slider_dilatation", "mean", label="mean_dilatation")
    compare(verdicts, "plateau: pointwise against mean dilatation", coarse, mean(soft), DILATATION_BOUND, "no locking")
    small = driver.run("press_fit", *travel(1300, 4), *QUIET, label="steps_of_4")
    no_cutback(verdicts, "steps of 4", small)
    at = {round(step["t"], 6): reaction(step) for step in small.steps}
    same = np.mean([at[round(step["t"], 6)] for step in run.steps[PLATEAU] if round(step["t"], 6) in at], axis=0)
    compare(verdicts, "plateau: steps of 50 against steps of 4", coarse, same, STEP_BOUND, "large steps")


def compare(verdicts, label, ours, theirs, bound, reason):
    for name, a, b in zip(("R_x", "R_z"), ours, theirs):
        verdicts.near(f"{label}, {name}", a, b, bound, reason)


def drop_off(verdicts, driver, cells, step, bound, edge=(), output=QUIET):
    """Off the end of the channel at x = 1900, `step` mm a step, until nothing touches."""
    across, high = cells
    name = "rounded" if edge else "sharp"
    label = f"drop-off, {name} edge, {across} x {high}, steps of {step}"
    options = ("-slider_cells", f"{across},1,{high}", *edge, *SPRINGS, *output)
    run = driver.run("press_fit", *travel(2100, step), *options, label=f"drop_off_{name}_{across}_{step}")
    force = np.array([reaction(step)[1] for step in run.steps])
    peak = force.argmax()
    rise = max(0.0, np.diff(force[peak:]).max()) / force[peak]
    reason = f"{run.summary['cutbacks']} cut-backs"
    verdicts.below(f"{label}: largest rise of R_z after its peak", rise, bound, reason)
    left = abs(force[-1]) / force[peak]
    verdicts.below(f"{label}: R_z at the end, over the peak", left, DROP_BOUND, "nothing touches")
    balance(verdicts, label, run, least=1)  # nothing is left when it has dropped off
    return run


def of_facets(across, step):
    """Part of the slider's facets that a step passes, at least one."""
    return max(1, step / (LENGTH / across)) / across


def slider_fine(verdicts, driver):
    """Minutes: the drop-off of finer sliders and in small steps, which off a sharp edge rises by some per cent on its
    way down; sides swapped all the way in small steps."""
    for across, high in ((18, 3), (36, 6)):
        drop_off(verdicts, driver, (across, high), 25, of_facets(across, 25))
    for across, high in ((12, 3), (18, 3), (36, 6)):
        drop_off(verdicts, driver, (across, high), 5, of_facets(across, 5))
        drop_off(verdicts, driver, (across, high), 5, DROP_BOUND, ROUNDED)
    swapped_fine(verdicts, driver)


def swapped_fine(verdicts, driver):
    """Sides swapped against the other way round on the same two meshes: with smaller steps, and on finer meshes."""
    lags, entries = [], []
    for step, mesh, name in ((4, SWAPPED_MESH, "18 x 3"), (2, SWAPPED_MESH, "18 x 3"), (1, SWAPPED_MESH, "18 x 3"),
                             (1, SWAPPED_FINE, "36 x 6")):
        options, label = (*travel(1000, step), *mesh, *QUIET, *LAGGING), f"{name.replace(' ', '')}_{step}"
        ours = driver.run("press_fit", *options, *SWAPPED, label=f"swapped_{label}")
        theirs = driver.run("press_fit", *options, label=f"unswapped_{label}")
        label = f"sides swapped, {name}, steps of {step}"
        few_cutbacks(verdicts, label, ours)
        forces = [mean_reaction(run, *AROUND) for run in (ours, theirs)]
        compare(verdicts, f"{label}: mean from {AROUND[0]} to {AROUND[1]}", *forces, LAG_BOUND[step], "lag of normals")
        lags.append(np.abs(forces[0] / forces[1] - 1))
        forces = [mean_reaction(run, *ENTRY) for run in (ours, theirs)]
        entries.append(np.abs(forces[0] / forces[1] - 1))
    for k, name in enumerate(("R_x", "R_z")):
        for step, lag, less in zip((4, 2), lags, lags[1:]):
            label = f"sides swapped: difference of {name}, steps of {step // 2} over steps of {step}"
            verdicts.below(label, less[k] / lag[k], LAG_FALLS, f"{lag[k]:.4f}, {less[k]:.4f}")
        label = f"sides swapped: difference of {name} as the edge comes to the ramp, 36 x 6 over 18 x 3"
        coarse, fine = entries[2:]
        verdicts.below(label, fine[k] / coarse[k], ENTRY_FALLS, f"{coarse[k]:.4f}, {fine[k]:.4f}")


def mean_reaction(run, start, end):
    """Over the steps that end in this part of the travel."""
    within = lambda step: start < 1000 * (step["t"] - 1) <= end + 1e-6
    return np.mean([reaction(step) for step in run.steps if within(step)], axis=0)


def swapped(verdicts, driver, run):
    """The channel carries the multipliers, of nodes that become covered as the slider comes."""
    label = "sides swapped, steps of 50"
    matrices = driver.output / "swapped.mat"
    matrices.unlink(missing_ok=True)
    dump = ("-ksp_view_mat", f"binary:{matrices}::append")
    large = driver.run("press_fit", *travel(1000, 50), *SWAPPED, *SWAPPED_MESH, *dump, label="swapped")
    few_cutbacks(verdicts, f"{label}, all of the way", large)
    balance(verdicts, label, large)
    for at in (100, 200, 300):
        forces = (reaction(after(at, r)) for r in (large, run))
        compare(verdicts, f"{label}: against the slider's multipliers at {at}", *forces, SWAPPED_BOUND, "cut facets")
    states = [sum(step["interfaces"]["contact"][s] for s in ("stick", "slip")) for step in large.steps]
    changes = np.count_nonzero(np.diff(states))
    verdicts.at_least(f"{label}: steps in which nodes come and go", changes, 1, "it moves on")
    conditions = [smallest_singular_value(matrix) for matrix in petsc_matrices(matrices, RANK_EVERY)]
    looked_at = large.newton_iterations // RANK_EVERY
    verdicts.at_least(f"{label}: tangents looked at", len(conditions), looked_at, f"one in {RANK_EVERY}, to 1000")
    verdicts.at_least(f"{label}: smallest singular value", min(conditions), RANK_LIMIT, "full rank")
    matrices.unlink()


def petsc_matrices(path, every):
    """Every so many of sparse matrices one after the other in PETSc's binary format: id, rows, columns, entries, row
    lengths, ..."""
    data = path.read_bytes()
    path.with_name(path.name + ".info").unlink(missing_ok=True)
    at = number = 0
    while at < len(data):
        _, n, m, entries = np.frombuffer(data, ">i4", 4, at)
        lengths = np.frombuffer(data, ">i4", n, at + 16)
        columns = np.frombuffer(data, ">i4", entries, at + 16 + 4 * n)
        values = np.frombuffer(data, ">f8", entries, at + 16 + 4 * (n + entries))
        at += 16 + 4 * (n + entries) + 8 * entries
        number += 1
        if number % every:
            continue
        matrix = np.zeros((n, m))
        matrix[np.repeat(np.arange(n), lengths), columns] = values
        yield matrix


def smallest_singular_value(matrix):
    """Over the largest, once units and slivers do not count: rows and columns have the length 1, and neighbours that
    are nearly parallel are made orthogonal first. These are the components of a multiplier of which a sliver is
    covered: the tangential part of its rows is as large as ever, the normal part is as small as the sliver, and its
    normal is no axis.
    """
    for _ in range(3):
        for turned in (False, True):
            matrix = orthogonal_neighbours(matrix.T if turned else matrix)
            matrix = matrix.T if turned else matrix
    values = np.linalg.svd(matrix, compute_uv=False)
    return values[-1] / values[0]


def orthogonal_neighbours(matrix):
    """Columns of length 1, the second of a nearly parallel pair without its part along the first; 0 if none is left."""
    columns = matrix / np.linalg.norm(matrix, axis=0)
    parallel = np.einsum("ij,ij->j", columns[:, :-1], columns[:, 1:])
    used = -1
    for j in np.flatnonzero(np.abs(parallel) > NEARLY_PARALLEL):
        if j == used:
            continue
        rest = columns[:, j + 1] - (columns[:, j] @ columns[:, j + 1]) * columns[:, j]
        length = np.linalg.norm(rest)
        columns[:, j + 1] = rest / length if length > PARALLEL else 0
        used = j + 1
    return columns


def three_dimensions(verdicts, driver):
    run = driver.run("press_fit_3d", "-output_vtu", "last")
    no_cutback(verdicts, "three dimensions, 20 steps of 50", run)
    balance(verdicts, "three dimensions", run)
    work(verdicts, "three dimensions", run)
