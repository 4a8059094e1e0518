"""The demonstration: solve the example scenes, compare with the references, draw the figures.

demo.py --build DIR [--renew-figures]; figures and results go to DIR/demo. Exits with 1 if a comparison fails.
"""

import argparse
import shutil
import sys
import time
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1] / "common"))
import folders  # noqa: E402  (puts the others on the path)
import comparisons  # noqa: E402
import figures  # noqa: E402
import friction_checks  # noqa: E402
import gallery_scenes  # noqa: E402
from scene import Driver, SceneError  # noqa: E402
from verdict import Verdicts  # noqa: E402

COMMITTED_FIGURE = folders.FIGURES / "block.png"


class Progress:
    """Runs scenes one after the other and says how far it is."""

    def __init__(self, driver, total):
        self.driver, self.total, self.done, self.start = driver, total, 0, time.monotonic()

    def run(self, scene, *options, label=None):
        self.done += 1
        print(f"[{self.done:2}/{self.total}] {label or scene:<34}", end="", flush=True)
        run = self.driver.run(scene, *options, label=label)
        steps = len(run.steps)
        print(
            f"{run.summary['unknowns']:>7} unknowns  {steps:>2} steps  {run.newton_iterations:>3} Newton iterations"
            f"  {run.seconds:5.1f} s  (since the start {time.monotonic() - self.start:.0f} s)"
        )
        return run


def demonstrate(build, renew_figures):
    output = build / "demo"
    patches = list(comparisons.patch_cases())
    progress, verdicts = Progress(Driver(build, output), total=len(patches) + 7), Verdicts()

    stick = progress.run("block_zone_mu2")
    comparisons.block_all_stick(verdicts, "block, zone 3.6, mu = 2", stick)
    comparisons.block_resultants(verdicts, "block, zone 3.6, mu = 2", stick)
    zone = progress.run("block_zone_mu05")
    comparisons.block_resultants(verdicts, "block, zone 3.6, mu = 0.5", zone)
    comparisons.block_inner_tractions(verdicts, "block, zone 3.6, mu = 0.5", zone)
    bottom = progress.run("block_bottom_mu02")
    comparisons.block_resultants(verdicts, "block, bottom, mu = 0.2", bottom)
    comparisons.block_slip(verdicts, "block, bottom, mu = 0.2", bottom)
    cylinders = progress.run("hertz_line_fine")
    measured = comparisons.hertz(verdicts, "Hertz", cylinders)
    _, drawn_lines, _ = friction_checks.cattaneo_line(verdicts, progress)
    belt = friction_checks.capstan(verdicts, progress)
    slider = progress.run("press_fit", "-output_vtu", "all")

    errors = {}
    for case in patches:
        run = progress.run(case.scene, *case.options, label=case.label)
        error = comparisons.patch_error(run, case)
        verdicts.below(f"{case.label}: multiplier error", error, comparisons.PATCH_BOUND, "exact solution")
        errors.setdefault(case.series, {})[case.short] = error

    print()
    verdicts.print()
    verdicts.write(output / "demo.json")

    drawn = [
        figures.traction(zone.line(comparisons.INTERFACE), bottom.line(comparisons.INTERFACE), output / "traction.png"),
        figures.block(bottom, comparisons.INTERFACE, output / "block.png"),
        figures.hertz(cylinders.line("contact"), measured, output / "hertz.png"),
        figures.patch(errors, comparisons.PATCH_BOUND, output / "patch.png"),
        gallery_scenes.cattaneo_profile(drawn_lines, output / "cattaneo.png"),
        *gallery_scenes.draw_capstan(belt, output),
        *gallery_scenes.draw_slider(slider, output),
    ]
    if renew_figures:
        shutil.copy(output / "block.png", COMMITTED_FIGURE)
        drawn.append(COMMITTED_FIGURE)
    print("\nFigures:")
    for path in drawn:
        print(f"  {path.resolve()}")
    return verdicts.passed


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=Path, required=True, help="CMake's build tree")
    parser.add_argument("--renew-figures", action="store_true", help="renew the README's figure too")
    arguments = parser.parse_args()
    try:
        return 0 if demonstrate(arguments.build, arguments.renew_figures) else 1
    except SceneError as problem:
        print(f"\n{problem}", file=sys.stderr)
        return 1


if __name__ == "__main__":
    sys.exit(main())
