#!/usr/bin/env python3
"""Looks at the recipes with what PyPI has of their programs: lint.py OUT, after fill.py OUT.

conda-forge's recipe is read and rendered by rattler-build's library, Spack's is looked at by flake8 with Spack's own exceptions,
CITATION.cff is compared with its schema. Exit code 1 if one of them complains. Needs py-rattler-build, flake8, cffconvert.
"""

import subprocess
import sys
from pathlib import Path

import rattler_build

ROOT = Path(__file__).resolve().parent.parent
# What Spack's style check leaves out of recipes: names from `import *`.
EXCEPTIONS = ["--max-line-length", "130", "--ignore", "F403,F405"]
# conda-forge's own configuration has these.
VARIANTS = "c_compiler: [gcc]\nc_stdlib: [sysroot]\nrust_compiler: [rust]\n"


def main():
    out = Path(sys.argv[1])
    recipe = rattler_build.Stage0Recipe.from_yaml((out / "conda" / "recipe.yaml").read_text())
    rendered = list(recipe.render(rattler_build.VariantConfig.from_yaml(VARIANTS)))
    package = rendered[0].recipe.package
    print(f"conda's recipe: {package.name} {package.version}, {len(rendered)} package")
    commands = ([sys.executable, "-m", "flake8", *EXCEPTIONS, str(out / "spack" / "package.py")],
                [str(Path(sys.executable).parent / "cffconvert"), "--validate", "-i", str(ROOT / "CITATION.cff")])
    return int(len(rendered) != 1 or any([subprocess.run(command).returncode for command in commands]))


if __name__ == "__main__":
    sys.exit(main())
