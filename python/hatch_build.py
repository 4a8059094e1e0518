"""The wheel's build: the shared library by cargo, the declarations from its header."""

import os
import shutil
import subprocess
import sys
import sysconfig
from pathlib import Path

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

HERE = Path(__file__).resolve().parent
CHECKOUT = HERE.parent


def shared_library(checkout: Path) -> Path:
    """The library of STICKSLIP_LIBRARY, or the one that cargo builds now."""
    given = os.environ.get("STICKSLIP_LIBRARY")
    if given:
        return Path(given).resolve(strict=True)
    # Panics name source files: those of crates by a path of this machine, if nothing is put in its place (cmake/library.cmake).
    cargo_home = os.environ.get("CARGO_HOME", Path.home() / ".cargo")
    remapped = f"build.rustflags=['--remap-path-prefix={cargo_home}=/cargo', '--remap-path-prefix={checkout}=/stickslip']"
    subprocess.run(["cargo", "--config", remapped, "build", "--locked", "--release", "--lib"], cwd=checkout, check=True)
    target = Path(os.environ.get("CARGO_TARGET_DIR", checkout / "target"))
    return (checkout / target / "release" / "libstickslip.so").resolve(strict=True)


class StickslipHook(BuildHookInterface):
    """Puts libstickslip.so, _abi.py, the header and the program's sources into the wheel, and names its platform."""

    def initialize(self, version, build_data):
        sys.path.insert(0, str(HERE / "src" / "stickslip"))
        import _declarations

        made = Path(self.directory) / "stickslip-made"
        made.mkdir(parents=True, exist_ok=True)
        library = made / "libstickslip.so"
        shutil.copyfile(shared_library(CHECKOUT), library)
        if shutil.which("strip"):
            subprocess.run(["strip", "--strip-unneeded", str(library)], check=True)
        _declarations.write(CHECKOUT / "include" / "stickslip.h", made / "_abi.py")
        build_data["force_include"][str(library)] = "stickslip/libstickslip.so"
        build_data["force_include"][str(made / "_abi.py")] = "stickslip/_abi.py"
        build_data["force_include"][str(CHECKOUT / "include" / "stickslip.h")] = "stickslip/stickslip.h"
        sources = CHECKOUT / "program"
        for path in sorted(sources.rglob("*.[ch]")):
            within = path.relative_to(sources)
            if "tests" not in within.parts:
                build_data["force_include"][str(path)] = f"stickslip/program/{within}"
        platform = sysconfig.get_platform().replace("-", "_").replace(".", "_")
        build_data["tag"] = f"py3-none-{platform}"
        build_data["pure_python"] = False
