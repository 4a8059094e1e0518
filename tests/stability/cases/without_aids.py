"""What each aid to convergence is worth: hard scenes without it. The answer is the same; the iterations tell."""

import host
from cell import series
from comparisons import difference

FAILS = r"not converged|refused by the library"  # an aid less may be one too few
SAME = 1e-9  # each run is known to 1e-11 of the forces, and nodes to 100 times that
# With the augmented form the path of iterates differs, with current weights the answer does not.
AIDS = {
    "all": (),
    "no predictor": ("-steps_predictor", "false"),
    "full steps": ("-snes_linesearch_type", "basic"),
    "cycles on": ("-steps_cycles", "false"),
    "raw rows": ("-base_row_scale", "none"),
    "zero start": ("-base_initial_contact", "false"),
    "backtracking": ("-snes_linesearch_type", "bt"),
    "augmented": ("-base_form", "augmented"),
    "no shortcuts": ("-base_shortcuts", "false"),
}
SCENES = {
    "aids, block with slip": ("block_bottom_mu02_current", ("-steps_count", "6")),
    "aids, augmentation 1e3 too large": (
        "block_bottom_mu02_current",
        ("-steps_count", "6", "-base_augmentation_scale", "1e3"),
    ),
    "aids, augmentation 1e5 too large": (
        "block_bottom_mu02_current",
        ("-steps_count", "6", "-base_augmentation_scale", "1e5"),
    ),
    "aids, whole load in two steps": ("block_bottom_mu02_current", ("-steps_count", "2")),
    "aids, stuck block": ("block_zone_mu2", ("-steps_count", "4")),
}


def without(scene, options):
    def make(aid):
        def run(context):
            solved = context.solve(scene, *options, *AIDS[aid])
            result = host.outcome(solved)
            if result.refusal is None:
                default = context.solve(scene, *options[:2], name="default")
                result.below(
                    "displacements and forces", difference(solved, default), SAME, "the answer with every aid"
                )
                result.figures["default"] = aid == "all"
            return result

        return run

    return make


def cells():
    for case, (scene, options) in SCENES.items():
        yield from series(
            case, AIDS, without(scene, options), may_refuse=FAILS, quick=("all",) if "1e3" in case else ()
        )
