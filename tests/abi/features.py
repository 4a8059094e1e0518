"""The library with some of the features that can be left out (docs/abi.md), built by CMake as it is installed."""

import subprocess
import sys
import tempfile
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
FEATURES = tomllib.loads((ROOT / "Cargo.toml").read_text())["features"]["default"]


def run(*command):
    """Ends the program where a command fails, or where cargo sums up warnings about the library."""
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True)
    if done.returncode or "warning: `stickslip`" in done.stderr:
        sys.exit(f"{' '.join(map(str, command))}: exit code {done.returncode}\n{done.stdout}{done.stderr}")


def library(build, features):
    """The shared library with these features."""
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
