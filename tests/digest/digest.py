"""What the library and the driver compute, to the last bit, as a file of digests: written before a change and after it,
and compared.

digest.py write --library FILE.so [--build DIR] --out FILE.json [--histories N] [--jobs N]
digest.py compare BEFORE.json AFTER.json [--libraries BEFORE.so AFTER.so]

`write` loads the library by its name, so that one that was kept can be asked later. It digests every golden pair and
interface; N seeded histories with all options, step by step: residual, tangent, states, exported history; and, with a
build tree, the driver's iterations, states and forces per step of every scene. `compare` lists what differs, and of
histories that differ, with the libraries at hand, by how much. It exits with 1 if anything differs.
"""

import argparse
import json
import multiprocessing
import sys
import time
from pathlib import Path

import golden
import histories
import scenes

CHUNK = 500  # histories a task: some two seconds
SHOWN = 10  # histories that differ and are looked into


def of_chunk(task):
    library, seeds = task
    return [histories.digests(histories.loaded(library), seed) for seed in seeds]


def write(arguments):
    start = time.monotonic()
    found = {"golden": golden.digests(arguments.library), "histories": [], "scenes": {}}
    print(f"{len(found['golden'])} golden cases", flush=True)
    chunks = [range(k, min(k + CHUNK, arguments.histories)) for k in range(0, arguments.histories, CHUNK)]
    with multiprocessing.Pool(arguments.jobs) as pool:
        for done in pool.imap(of_chunk, [(arguments.library, chunk) for chunk in chunks]):
            found["histories"] += done
            seconds = time.monotonic() - start
            print(f"\r{len(found['histories'])} of {arguments.histories} histories, {seconds:.0f} s", end="", flush=True)
        print()
        if arguments.build:
            folder = Path(arguments.build) / "digest" / "scenes"
            tasks = [(arguments.build, folder, path) for path in scenes.paths()]
            for name, scene in pool.imap(scenes.digest, tasks):
                found["scenes"][name] = scene
                print(f"{name}: {scenes.told(scene)}", flush=True)
    Path(arguments.out).parent.mkdir(parents=True, exist_ok=True)
    Path(arguments.out).write_text(json.dumps(found, indent=0))
    refused = sum(any(name == "status" for name, _ in history) for history in found["histories"])
    print(f"written: {arguments.out}; {refused} of {len(found['histories'])} histories were refused somewhere")
    return 0


def compare(arguments):
    before, after = (json.loads(Path(path).read_text()) for path in (arguments.before, arguments.after))
    differ = 0
    for name in sorted(before["golden"].keys() | after["golden"].keys()):
        if before["golden"].get(name) != after["golden"].get(name):
            differ += 1
            print(f"golden {name}: differs")
    pairs = list(zip(before["histories"], after["histories"]))
    if len(before["histories"]) != len(after["histories"]):
        print(f"of {len(before['histories'])} and {len(after['histories'])} histories the first {len(pairs)} are compared")
    others = [seed for seed, (a, b) in enumerate(pairs) if a != b]
    differ += len(others)
    for seed in others[:SHOWN]:
        a, b = pairs[seed]
        place = next((k for k, (x, y) in enumerate(zip(a, b)) if x != y), min(len(a), len(b)))
        text = f"history {seed}: first in {(a + b)[place][0] if place < len(a) else 'its length'}"
        if arguments.libraries:
            text += "; " + histories.difference(*arguments.libraries, seed)
        print(text)
    if others:
        computed = lambda history: [part for part in history if part[0] != "history"]
        alone = sum(computed(pairs[seed][0]) == computed(pairs[seed][1]) for seed in others)
        print(f"{len(others)} of {len(pairs)} histories differ, {alone} of them in nothing but what is exported (its layout)")
    for name in sorted(before["scenes"].keys() & after["scenes"].keys()):
        text = scenes.difference(before["scenes"][name], after["scenes"][name])
        if text:
            differ += 1
            print(f"scene {name}: {text}")
    print("nothing differs" if differ == 0 else f"{differ} differ")
    return int(differ > 0)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(required=True)
    one = commands.add_parser("write")
    one.add_argument("--library", required=True)
    one.add_argument("--build")
    one.add_argument("--out", required=True)
    one.add_argument("--histories", type=int, default=100_000)
    one.add_argument("--jobs", type=int, default=multiprocessing.cpu_count())
    one.set_defaults(run=write)
    two = commands.add_parser("compare")
    two.add_argument("before")
    two.add_argument("after")
    two.add_argument("--libraries", nargs=2)
    two.set_defaults(run=compare)
    arguments = parser.parse_args()
    return arguments.run(arguments)


if __name__ == "__main__":
    sys.exit(main())
