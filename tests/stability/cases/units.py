"""Unit systems: the same problem written in other units must take the same iterations and give the same answer."""

import host
from acceptance import in_units
from cell import series
from comparisons import difference

# Powers of two are exact in floating point: the same bits, so the same iterations. In other units every number of the
# scene is rounded once; then a node on the cone's border may settle one iteration earlier or later.
SAME, ROUNDED = 0, 1
ANSWER = 1e-9  # of an answer that is known to 1e-11; the acceptance check's bound

# name: (length, stress) of the new unit in the old one, slack of the iterations of a step
SYSTEMS = {
    "inch_psi": (1 / 25.4, 145.04, ROUNDED),
    "2^10_2^0": (2.0**10, 1.0, SAME),
    "2^-10_2^20": (2.0**-10, 2.0**20, SAME),
    "m_Pa": (1e-3, 1e6, ROUNDED),
    "um_GPa": (1e3, 1e-3, ROUNDED),
    "2^-60_2^70": (2.0**-60, 2.0**70, SAME),
    "1e-9_1e20": (1e-9, 1e20, ROUNDED),
    "1e12_1e-15": (1e12, 1e-15, ROUNDED),
}
SCENE = "block_bottom_mu02_current"
FEW = ("-steps_count", "6")  # press in three, then push until half of the bottom slips: gap, stick, slip


def cells():
    def make(name):
        length, stress, slack = SYSTEMS[name]

        def run(context):
            default = context.solve(SCENE, *FEW, name="default")
            other = context.solve(SCENE, *FEW, *in_units(length, stress))
            result = host.outcome(other)
            if result.refusal is None:
                pairs = zip(other.steps, default.steps, strict=True)
                change = max(abs(a["newton_iterations"] - b["newton_iterations"]) for a, b in pairs)
                result.below("change of the iterations of a step", change, slack, "units carry no information")
                error = difference(other, default, length=length, force=stress * length**2)
                result.below("displacements and forces", error, ANSWER, "units carry no information")
                result.figures |= {"change": change, "exact": slack == SAME}
            return result

        return run

    yield from series("units", SYSTEMS, make, quick=("2^-10_2^20", "m_Pa", "1e-9_1e20"))
