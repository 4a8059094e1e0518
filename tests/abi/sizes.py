#!/usr/bin/env python3
"""Bytes of the stripped library as a whole, without one feature at a time, and without any (docs/abi.md).

    sizes.py --build DIR [--renew]    builds eleven libraries in DIR; --renew writes the table into docs/abi.md
"""

import argparse
import subprocess
import sys
import tempfile
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.append(str(ROOT / "studies" / "common"))
from documents import put_between  # noqa: E402

MARKS = ("<!-- sizes: written by tests/abi/sizes.py -->\n", "<!-- end of sizes -->")
FEATURES = tomllib.loads((ROOT / "Cargo.toml").read_text())["features"]["default"]


def run(*command):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"{' '.join(map(str, command))}: exit code {done.returncode}\n{done.stdout}{done.stderr}")


def library(build, features):
    """The shared library with these features, built by CMake as it is installed."""
    wanted = ";".join(features) or "none"
    run("cmake", "-S", ROOT, "-B", build, "-DSTICKSLIP_TESTS=OFF", "-DSTICKSLIP_EXAMPLES=OFF", f"-DSTICKSLIP_FEATURES={wanted}")
    run("cmake", "--build", build, "--target", "stickslip_cargo")
    return build / "lib" / "libstickslip.so"


def stripped(path):
    """Bytes of a library without its symbols."""
    with tempfile.TemporaryDirectory() as folder:
        small = Path(folder) / "stripped.so"
        run("strip", "-o", small, path)
        return small.stat().st_size


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
    sizes = {}
    for name, features in builds.items():
        sizes[name] = stripped(library(arguments.build.resolve(), features))
        print(f"{name:24} {sizes[name]:10}", flush=True)
    if arguments.renew:
        put_between(ROOT / "docs" / "abi.md", MARKS, table(sizes))


if __name__ == "__main__":
    main()
