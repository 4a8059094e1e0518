"""The augmentation over twelve decades: it may steer the iterations, never the answer."""

import host
from acceptance import AUGMENTATION_BOUND
from cell import series
from comparisons import difference

SCALES = tuple(f"1e{k}" for k in range(-6, 7))
SCENE = "block_bottom_mu02_current"
FEW = ("-steps_count", "6")  # press in three, then push until half of the bottom slips: gap, stick and slip all occur


def cells():
    def make(scale):
        def run(context):
            default = context.solve(SCENE, *FEW, name="default")
            run = context.solve(SCENE, *FEW, "-base_augmentation_scale", scale)
            result = host.outcome(run)
            if result.refusal is None:
                error = difference(run, default)
                result.below("displacements and forces", error, AUGMENTATION_BOUND, "the answer of the default")
                result.figures["default"] = scale == "1e0"
            return result

        return run

    refuse = lambda scale: r"not converged.*states" if float(scale) > 1e2 else None
    yield from series("augmentation, of its default", SCALES, make, quick=("1e-6", "1e0", "1e2"), may_refuse=refuse)
