"""A second stage without more load: nothing may move, and nothing is to be iterated."""

import numpy as np

import host
from cell import series
from scenes import patch

# The normals are those of the last commit, so the first step without load still turns them by as much as the last one
# with load did: FIRST is what that may change, of displacements and forces over their largest. It dies out by a
# factor of about 1000 a step; the last one changes nothing but what Newton's tolerance (1e-11 of the forces) leaves.
FIRST, LAST = 0.05, 1e-9
ITERATIONS = 2  # of each step without load: one that finds it, one that confirms it
MORE = 4  # steps

ROUGH = patch(traction=(2, 0, -10))
ROUGH["base"] = {"nonmortar": "upper.zmin", "mortar": "lower.zmax", "law": "rough"}
ROUGH["press"]["curve"] = [0, 0, 1, 1]

# case: scene, its times, its interface, options. Curves stay at their last value after the scene's end.
CASES = {
    "stick": ("block_zone_mu2", (0.5, 1, 1.5, 2), "base", ()),
    "slip": ("block_bottom_mu02", (0.5, 1, 1.5, 2), "base", ()),
    "sliding": ("block_bottom_mu02_current", (0.5, 1, 1.5, 2), "base", ()),
    "frictionless": ("hertz_line_coarse", (0.5, 1), "contact", ("-press_curve", "0,0,1,1")),
    "tied": ("tied_beam", (0.5, 1), "middle", ("-tip_curve", "0,0,1,1")),
    "analytic": ("ball_on_plane", (0.5, 1), "contact", ("-press_curve", "0,0,1,1")),
    "slope": ("incline", (0.5, 1), "base", ("-press_curve", "0,0,1,1")),
    "rough": (ROUGH, (0.5, 1), "base", ()),
}


def state(run, interface, step):
    table = run.interface(interface, step)
    vectors = lambda *names: np.stack([table[name] for name in names], axis=1)
    return vectors("ux", "uy", "uz"), vectors("fx", "fy", "fz")


def run_case(name):
    scene, times, interface, options = CASES[name]

    def run(context):
        end, length = times[-1], times[-1] - times[-2]
        longer = [*times, *(end + k * length for k in range(1, MORE + 1))]
        steps = {"times": longer}
        adapted = context.adapted(scene, steps) if isinstance(scene, str) else scene | {"steps": steps}
        whole = context.solve(adapted, *options, "-output_vtu", "none", "-output_csv", "all")
        result = host.outcome(whole)
        if result.refusal is None:
            n = len(whole.steps)
            for bound, step, reason in ((FIRST, n - MORE + 1, "first step"), (LAST, n, "last step")):
                before, after = state(whole, interface, step - 1), state(whole, interface, step)
                for what, a, b in zip(("displacements", "forces"), before, after):
                    change = np.abs(a - b).max() / np.abs(a).max()
                    result.below(f"change of {what}, {reason}", change, bound, "no load was added")
            most = max(step["newton_iterations"] for step in whole.steps[n - MORE :])
            result.below("iterations of a step without load", most, ITERATIONS, "it starts at its answer")
        return result

    return run


def cells():
    yield from series("second stage without load", CASES, run_case, quick=("stick", "slip", "tied", "slope"))
