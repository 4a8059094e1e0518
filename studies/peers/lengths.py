"""Which length of a facet points take, where facets are longer one way: Hertz' line of `make compare`, whose facets are 0.1 along it and
0.136, 0.068 or 0.034 across. lengths.py --build DIR [--loads N] [--renew].

A length enters twice: r = 0.9 E* / h, and K over it, a third power. Here each has its own, by what the example driver has for them
(`augmentation` is r alone, `modulus` then K's), small displacements, against the fine mesh of the same theory. What has been run is kept in
DIR/compare. --renew: the table of docs/other_programs.md.
"""

import argparse
import sys
from pathlib import Path

import numpy as np

sys.path.append(str(Path(__file__).resolve().parents[1] / "common"))
import compare  # noqa: E402
import friction_checks as friction  # noqa: E402
import study_page  # noqa: E402
from documents import put_between  # noqa: E402
from scene import Driver  # noqa: E402

MARKS = ("<!-- lengths -->", "<!-- /lengths -->")
# Of the facets, along the line.
ALONG = 0.1
LAW = "stickslip, small displacements, points"


def choices(across):
    """{name: lengths of r and of K}"""
    root, least = np.sqrt(across * ALONG), min(across, ALONG)
    return {
        "the root of the area (the library's)": (root, root),
        "the smallest": (least, least),
        "r: the root, K: the length across": (root, across),
        "r: the smallest, K: the length across": (least, across),
    }


def options(across, of_r, of_k):
    """The driver makes K / rhat^0 of the root of the area and the modulus."""
    modulus = friction.LINE_MODULUS * (across * ALONG) ** 1.5 / of_k**3
    return (*compare.HERTZ_LAWS[LAW], "-contact_modulus", f"{modulus:.10g}",
            "-contact_augmentation", f"{0.9 * friction.LINE_MODULUS / of_r:.10g}")


def report(build, loads, renew):
    driver = Driver(build, build / "compare", keep=True)
    yardsticks, body = compare.Yardsticks(driver.output), []
    for facets in compare.FACETS:
        across = compare.HALF_WIDTH / facets
        laws = {name: options(across, *lengths) for name, lengths in choices(across).items()}
        errors = {name: [] for name in laws}
        places = compare.LOADS // loads * np.arange(loads)
        for k in places:
            travel = compare.TRAVEL * ((facets - 0.5 + k / compare.LOADS) / facets) ** 2
            case, runs = compare.hertz_case(driver, facets, travel, f"lengths_{facets}_{k}", laws)
            for name, run in runs.items():
                errors[name].append(100 * yardsticks.errors(case, run.mesh()[2], compare.THEORIES[LAW])[1])
        body.append([str(facets), *(f"{np.mean(e):.2f} ({max(e):.2f})" for e in errors.values())])
        print(" | ".join(body[-1]), flush=True)
    title = f"**Errors in per cent against a fine mesh of the same theory, mean and, in brackets, worst of {loads} loads; by h**"
    text = f"{title}\n\n{study_page.markdown((['facets', *laws], body))}"
    (driver.output / "lengths.md").write_text(text + "\n")
    if renew:
        put_between(compare.DOCUMENT, MARKS, f"\n\n{text}\n\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=Path, required=True, help="CMake's build tree")
    parser.add_argument("--loads", type=int, choices=(1, 2, 5, 10), default=10, help="of ten, those that are evenly apart")
    parser.add_argument("--renew", action="store_true", help="renew the table of docs/other_programs.md")
    arguments = parser.parse_args()
    report(arguments.build, arguments.loads, arguments.renew)
    return 0


if __name__ == "__main__":
    sys.exit(main())
