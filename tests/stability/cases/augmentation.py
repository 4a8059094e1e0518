"""The augmentation over twelve decades: it may steer the iterations, never the answer."""

import host
from acceptance import AUGMENTATION_BOUND
from cell import series
from comparisons import difference

SCALES = tuple(f"1e{k}" for k in range(-6, 7))
SCENE = "block_bottom_mu02_current"
FEW = ("-steps_count", "6")  # press in three, then push until half of the bottom slips: gap, stick and slip all occur
# Beyond this the rounding of gaps, times r, is what tractions are known to: 3e-11 at 1e6.
STEERS, AMPLIFIED = 1e3, 1e-9


def cells():
    def make(scale):
        def run(context):
            default = context.solve(SCENE, *FEW, name="default")
            run = context.solve(SCENE, *FEW, "-base_augmentation_scale", scale)
            result = host.outcome(run)
            if result.refusal is None:
                error = difference(run, default)
                bound = AUGMENTATION_BOUND if float(scale) <= STEERS else AMPLIFIED
                result.below("displacements and forces", error, bound, "the answer of the default")
                result.figures["default"] = scale == "1e0"
            return result

        return run

    refuse = lambda scale: r"not converged.*states" if float(scale) > 1e2 else None
    yield from series("augmentation, of its default", SCALES, make, quick=("1e-6", "1e0", "1e2"), may_refuse=refuse)
