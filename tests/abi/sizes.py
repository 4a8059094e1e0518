#!/usr/bin/env python3
"""Bytes of the stripped library as a whole, without one feature at a time, and without any (docs/abi.md). Each is built without
warnings, refuses by name what needs the features that it lacks, and takes and computes everything else as the whole one does.

    sizes.py --build DIR [--renew]    builds a library for each row in DIR; --renew writes the table into docs/abi.md
"""

import argparse
import shutil
import sys
from pathlib import Path

import lean
from features import FEATURES, ROOT, library, stripped

sys.path.append(str(ROOT / "studies" / "common"))
from documents import put_between  # noqa: E402  (needs the path)

MARKS = ("<!-- sizes: written by tests/abi/sizes.py -->\n", "<!-- end of sizes -->")


def table(sizes):
    whole = sizes["all"]
    lines = ["| built | bytes | what is left out adds |", "|---|---|---|"]
    for name, size in sizes.items():
        added = "" if name == "all" else f"{whole - size:,}".replace(",", " ")
        lines.append(f"| {name} | {size:,} | ".replace(",", " ") + f"{added} |")
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=Path, required=True, help="where to build")
    parser.add_argument("--renew", action="store_true", help="write the table into docs/abi.md")
    arguments = parser.parse_args()
    builds = {"all": FEATURES}
    builds |= {f"all but `{name}`": [other for other in FEATURES if other != name] for name in FEATURES}
    builds["none of them"] = []
    build, sizes, failed = arguments.build.resolve(), {}, []
    whole = build / "whole.so"  # the next build overwrites it
    for name, features in builds.items():
        made = library(build, features)
        if name == "all":
            shutil.copy(made, whole)
        sizes[name] = stripped(made)
        wrong = [what for what, holds in lean.checks(whole, made, features).items() if holds is not True]
        failed += wrong
        print(f"{name:24} {sizes[name]:10}  {'; '.join(f'FAILED {what}' for what in wrong)}", flush=True)
    if arguments.renew and not failed:
        put_between(ROOT / "docs" / "abi.md", MARKS, table(sizes))
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
