"""Tests with exact answers that no mortar code shows: a table of each, and a figure. exact.py --build DIR [--only NAME ...] [--renew-figures].

The scenes are those of tests/acceptance. What has been run is kept in DIR/exact. --renew-figures: the tables and the figure of docs/exact.md,
those that were asked for.
"""

import argparse
import shutil
import sys
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1] / "common"))
import folders  # noqa: E402  (puts the others on the path)
import exact_figure  # noqa: E402
import others  # noqa: E402
import study_page  # noqa: E402
import waves  # noqa: E402
from documents import put_between  # noqa: E402
from scene import Driver, SceneError  # noqa: E402

DOCUMENT = folders.ROOT / "docs" / "exact.md"


def wave(driver, drawn):
    drawn["wave"] = found = waves.all_of(driver)
    return {"digits": waves.digits(found), "wave": waves.table(found), "graded": waves.graded(driver), "closing": waves.closing(driver)}


def spence(driver, drawn):
    drawn["spence"] = found = others.spence_runs(driver)
    return {"spence": others.spence(found)}


def gear(driver, drawn):
    drawn["gears"] = runs = list(others.gear_runs(driver))
    return {"gears": others.gear_table(runs)}


TESTS = {
    "wave": wave,
    "sliding": lambda driver, drawn: {"sliding": others.sliding(driver)},
    "rounded": lambda driver, drawn: {"rounded": others.rounded(driver)},
    "nafems": lambda driver, drawn: {"nafems": others.nafems(driver)},
    "spence": spence,
    "rolling": lambda driver, drawn: {"rolling": others.rolling(driver)},
    "gears": gear,
}


def report(build, only, renew):
    drawn = {}
    for name in only:
        driver = Driver(build, build / "exact" / name, keep=True)
        driver.output.mkdir(parents=True, exist_ok=True)
        for title, table in TESTS[name](driver, drawn).items():
            text = study_page.markdown(table)
            (driver.output.parent / f"{title}.md").write_text(text + "\n")
            print(f"{title}\n{text}\n", flush=True)
            if renew:
                put_between(DOCUMENT, (f"<!-- {title} -->", f"<!-- /{title} -->"), f"\n\n{text}\n\n")
    if set(drawn) == {"wave", "spence", "gears"}:
        path = exact_figure.draw(drawn, build / "exact" / "exact.png")
        print(path.resolve())
        if renew:
            shutil.copy(path, folders.FIGURES / path.name)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=Path, required=True, help="CMake's build tree")
    parser.add_argument("--only", nargs="+", choices=TESTS, default=list(TESTS), metavar="NAME", help=", ".join(TESTS))
    parser.add_argument("--renew-figures", action="store_true", help="renew the tables of docs/exact.md and its figure, too")
    arguments = parser.parse_args()
    try:
        report(arguments.build, arguments.only, arguments.renew_figures)
    except SceneError as problem:
        print(f"\n{problem}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
