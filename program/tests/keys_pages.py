#!/usr/bin/env python3
"""The tables of keys in the pages of scenes are those of the program's table of keys (program/scene/keys), and `-keys` prints them.

    keys_pages.py PROGRAM [--renew]

A page has them between `<!-- keys NAME -->` and `<!-- /keys NAME -->`. `make keys` renews them.
"""

import argparse
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
HEAD = re.compile(r"^(\S+\.md) keys (\S+)$")


def tables(program):
    """(page, name) -> the lines of each table, as the program prints them."""
    printed = subprocess.run([program, "-keys", "markdown"], check=True, capture_output=True, text=True).stdout
    found = {}
    for line in printed.splitlines(keepends=True):
        head = HEAD.match(line)
        if head:
            text = found[head[1], head[2]] = []
        else:
            text.append(line)
    return {where: "".join(lines) for where, lines in found.items()}


def with_table(page, name, table):
    """The page's text with the table in its place; None: it has no place for it."""
    first, last = f"<!-- keys {name} -->\n", f"<!-- /keys {name} -->\n"
    if page.count(first) != 1 or page.count(last) != 1:
        return None
    before, rest = page.split(first)
    return before + first + "\n" + table + "\n" + last + rest.split(last)[1]


def for_people(program, made):
    """What is wrong with `-keys`, with an item and with one that there is not."""
    everything = subprocess.run([program, "-keys"], check=True, capture_output=True, text=True).stdout
    keys = {key for table in made.values() for key in re.findall(r"^\| `(\w+)` \|", table, flags=re.M)}
    wrong = [f"-keys does not print {key}" for key in sorted(keys - set(re.findall(r"^  (\w+) ", everything, flags=re.M)))]
    steps = subprocess.run([program, "-keys", "steps"], check=True, capture_output=True, text=True).stdout
    if "lever" not in steps or "nonmortar" in steps:
        wrong.append("-keys steps does not print the keys of steps alone")
    unknown = subprocess.run([program, "-keys", "stpes"], capture_output=True, text=True)
    if unknown.returncode != 1 or "there are: scene, bodies" not in unknown.stderr:
        wrong.append("-keys of no item does not say which there are")
    return wrong


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program", type=Path)
    parser.add_argument("--renew", action="store_true")
    arguments = parser.parse_args()
    made, failed = tables(arguments.program.resolve()), []
    for page, name in made:
        path = ROOT / page
        text = path.read_text()
        new = with_table(text, name, made[page, name])
        if new is None:
            failed.append(f"{page} has no place for the table {name}: <!-- keys {name} -->, <!-- /keys {name} -->")
        elif new != text and arguments.renew:
            path.write_text(new)
            print(f"{page}: {name}")
        elif new != text:
            failed.append(f"{page}: the table {name} is not that of program/scene/keys: `make keys` renews it")
    marked = {(page, name) for page, _ in made for name in re.findall(r"<!-- keys (\S+) -->", (ROOT / page).read_text())}
    failed += [f"{page}: no table is called {name}" for page, name in sorted(marked - set(made))]
    failed += for_people(arguments.program.resolve(), made)
    print("\n".join(failed) or f"{len(made)} tables of keys are as the program has them")
    sys.exit(bool(failed))


if __name__ == "__main__":
    main()
