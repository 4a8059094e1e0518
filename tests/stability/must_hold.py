"""What must hold across cells: lines with the figures that the report prints. A line of which no cell was run is left
out."""

from dataclasses import dataclass

from cell import REFUSED, WRONG


@dataclass
class Line:
    text: str
    figure: str
    holds: bool


def answered(results, case):
    """The cells of a case (or of all cases that start so) that gave an answer, mildest first."""
    found = [r for r in results if r["case"].startswith(case) and r["verdict"] not in (REFUSED, WRONG)]
    return sorted(found, key=lambda r: (r["case"], r["level"]))


def worst(cells, key):
    return max(cell["figures"][key] for cell in cells)


def no_wrong(results):
    wrong = sum(r["verdict"] == WRONG for r in results)
    return Line("No cell is wrong", f"{wrong} of {len(results)}", wrong == 0)


def units(results):
    cells = answered(results, "units")
    for exact, slack, text in ((True, 0, "powers of two"), (False, 1, "other units")):
        these = [c for c in cells if c["figures"]["exact"] == exact]
        if these:
            change = worst(these, "change")
            yield Line(f"Iterations of a step, {text}: change at most {slack}", f"{change:g}", change <= slack)


# Relative to the mildest cell of each case.
def ratio_of_iterations(results, case, text, keep=lambda cell: True, bound=2.0):
    worst_ratio, found = 1.0, False
    for name in sorted({c["case"] for c in answered(results, case)}):
        cells = [c for c in answered(results, name) if c["case"] == name and keep(c) and c["iterations"]]
        if len(cells) > 1:
            found = True
            base = next((c for c in cells if c["figures"].get("default")), cells[0])["iterations"]
            worst_ratio = max(worst_ratio, *(max(c["iterations"] / base, base / c["iterations"]) for c in cells))
    if found:
        yield Line(text, f"{worst_ratio:.2f}", worst_ratio <= bound)


def patches(results):
    cells = [r for r in results if "patch_error" in r["figures"]]
    if cells:
        kappa = max((c["kappa"] or 0 for c in cells if not c["warnings"]), default=0)
        yield Line(
            "Patch error of every affine cell below max(1e-10, 100 eps kappa); far away, the rounding of positions",
            f"{len(cells)} cells; largest error {worst(cells, 'patch_error'):.1e}, largest kappa {kappa:.1e}",
            all(c["figures"]["patch_error"] <= c["figures"]["patch_bound"] for c in cells),
        )


def figure(results, key, text, bound):
    """The largest figure of this name over all cells that have it."""
    cells = [r for r in results if key in r["figures"] and r["verdict"] != WRONG]
    if cells:
        value = worst(cells, key)
        yield Line(text, f"{value:.1e}", value <= bound)


def lines(results):
    found = [no_wrong(results), *units(results)]
    found += ratio_of_iterations(
        results,
        "patch, offset",
        "Iterations over offsets to 1e6 facets: within a factor of 1",
        lambda c: float(c["severity"]) <= 1e6,
        1.0,
    )
    found += ratio_of_iterations(
        results,
        "augmentation",
        "Iterations, augmentation 1e-6 to 1e2 of its default: within 2x",
        lambda c: 1e-6 <= float(c["severity"]) <= 1e2,
    )
    found += ratio_of_iterations(results, "patch, 1 facet on N", "Iterations, mesh ratio 1:1 to 1:1000: within 2x")
    found += ratio_of_iterations(results, "patch, N facets on 1", "Iterations, mesh ratio 1:1 to 1000:1: within 2x")
    found += patches(results)
    found += figure(
        results,
        "derivative_error",
        "Derivatives of a pair's weights, crossing angles to 1e-15 and strips to 1e-14, anywhere in space",
        1e-10,
    )
    found += figure(
        results, "summed_error", "The same summed over the pairs of a facet, crossing angles to 1e-15", 1e-10
    )
    found += figure(
        results, "noise_error", "Assembled tangent of noisy matching meshes, to 1e-9 of the clean one", 1e-9
    )
    return found
