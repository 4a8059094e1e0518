#!/usr/bin/env python3
"""Writes the packages' files: the templates of this folder with the version and what placeholders.env says.

    fill.py OUT      writes OUT/debian, OUT/spack, OUT/conda
"""

import datetime
import re
import shutil
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent


def values():
    """The value of each @NAME@."""
    lines = (HERE / "placeholders.env").read_text()
    found = dict(re.findall(r'^([A-Z0-9_]+)="(.*)"$', lines, re.M))
    cargo = (ROOT / "Cargo.toml").read_text()
    found["VERSION"] = re.search(r'^version = "(.*)"', cargo, re.M)[1]
    major, minor, _ = found["VERSION"].split(".")
    # The number in the soname (build.rs) is the one in the name of Debian's package.
    found["SOVERSION"] = f"0.{minor}" if major == "0" else major
    found["RUST_VERSION"] = re.search(r'^rust-version = "(.*)"', cargo, re.M)[1]
    git = ("git", "-C", str(ROOT), "log", "-1", "--format=%ct %H")
    said = subprocess.run(git, capture_output=True, text=True).stdout.split() or ["0", "unknown"]
    # The commit's time, not that of the build: the same commit gives the same package.
    time = datetime.datetime.fromtimestamp(int(said[0]), datetime.timezone.utc)
    found["DATE"], found["COMMIT"] = time.strftime("%a, %d %b %Y %H:%M:%S +0000"), said[1]
    return found


def filled(text, known):
    """The text with each @NAME@ replaced, twice, for a value may hold another one."""
    for _ in range(2):
        text = re.sub(r"@([A-Z0-9_]+)@", lambda match: known[match[1]], text)
    return text


def main():
    known, out = values(), Path(sys.argv[1])
    for folder in ("debian", "spack", "conda"):
        shutil.rmtree(out / folder, ignore_errors=True)
        for source in (p for p in (HERE / folder).rglob("*") if p.is_file() and "__pycache__" not in p.parts):
            name = filled(str(source.relative_to(HERE)).removesuffix(".in"), known)
            (out / name).parent.mkdir(parents=True, exist_ok=True)
            text = source.read_text()
            (out / name).write_text(filled(text, known) if source.suffix == ".in" else text)
            shutil.copymode(source, out / name)


if __name__ == "__main__":
    main()
