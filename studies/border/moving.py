"""Friction at points with weights that are made anew at each commit: the shear of Cattaneo and Mindlin in steps, at rest, while everything
turns, and after a slide over facets. moving.py --build DIR [--renew-figures]; results go to DIR/border. The laws are the library's."""

import argparse
import sys
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1] / "common"))
import folders  # noqa: E402  (puts the others on the path)

sys.path.append(str(folders.ROOT / "tests" / "stability"))
import numpy as np  # noqa: E402

import study_page  # noqa: E402
from documents import put_between  # noqa: E402
from laws import Nodal  # noqa: E402
from library import Library  # noqa: E402
from scenes import MU, PULL, Hertz, NoAnswer  # noqa: E402

DOCUMENT = folders.ROOT / "docs" / "points.md"
MARKS = ("<!-- moving -->", "<!-- /moving -->")
# Of a pull and of its return; steps in which nothing moves.
STEPS, REST = 10, 400
# Of a quarter turn.
TURNS = (9, 18, 45, 90)
# All sticks with this friction.
ROUGH = 10.0
# Nearly all slips; of a slide over so many facets, in steps a facet; how much of the pull is taken back, one after the other.
FULL, SLIDE, PER_FACET, BACK = 0.999, 3, (4, 10), (0.3, 0.6, 0.9, 1.2)
SIZES = (5, 10, 20)
DECISIONS = ("nodes", "points")


class Turned:
    """A law seen from a frame that has turned by `angle`: bodies are linear in it."""

    def __init__(self, law):
        self.law, self.angle, self.components = law, 0.0, law.components

    def turn(self):
        c, s = np.cos(self.angle), np.sin(self.angle)
        return np.array([[c, -s], [s, c]])

    def outside(self, *at):
        return [v.reshape(-1, 2) @ self.turn().T for v in at]

    def residual(self, *at):
        return (self.law.residual(*self.outside(*at)).reshape(-1, 2) @ self.turn()).ravel()

    def tangent(self, *at):
        matrix = self.law.tangent(*self.outside(*at))
        all_turned = np.kron(np.eye(len(matrix) // 2), self.turn())
        return all_turned.T @ matrix @ all_turned

    def commit(self, *at):
        self.law.commit(*self.outside(*at))


class Walk:
    """Steps of a scene, each committed: pressed without friction first."""

    def __init__(self, library, scene, decision, a, mu=MU):
        pair = scene.scene.pair
        make = lambda mu: Nodal(library, pair, pair.one.x, pair.two.x, "dual", mu=mu, weights="committed", decision=decision)
        self.scene, self.a, self.shift, self.law = scene, a, 0.0, Turned(make(mu))
        self.answer = scene.scene.solve(make(0.0), scene.prescribed(a))
        self.go(0.0)

    def go(self, pull, back=0.0):
        prescribed = self.scene.prescribed(self.a, pull, back)
        prescribed[0] = prescribed[0] + np.where(self.scene.outer[0][:, None], [self.shift, 0.0], 0.0)
        self.answer = self.scene.scene.solve(self.law, prescribed, self.answer)
        self.scene.scene.commit(self.law, self.answer)
        return self.answer


def per_cent(values):
    found = [v for v in values if v is not None]
    missing = f", {len(values) - len(found)} without answer" if len(found) < len(values) else ""
    return f"{100 * np.mean(found):.2g} ({100 * np.max(found):.2g}){missing}" if found else "no answer"


def attempt(what):
    try:
        return what()
    except (NoAnswer, np.linalg.LinAlgError):
        return None


def difference(one, two):
    """Of forces along the surface, over the largest of the second."""
    return np.abs(one.force - two.force)[:, 0].max() / np.abs(two.force[:, 0]).max()


def steps(library):
    body = []
    for n, decision in ((n, d) for n in SIZES for d in DECISIONS):
        scene, once, pulled, back, rest = Hertz(n), [], [], [], "-"
        for k, a in enumerate(scene.loads()):
            once.append(attempt(lambda: scene.error_of_shear(Walk(library, scene, decision, a).go(PULL))))
            walk = Walk(library, scene, decision, a)
            most = [walk.go(PULL * i / STEPS) for i in range(1, STEPS + 1)][-1]
            pulled.append(scene.error_of_shear(most))
            end = [walk.go(PULL, PULL * i / STEPS) for i in range(1, STEPS + 1)][-1]
            back.append(scene.error_of_shear(end, most))
            if not k:
                first = walk.go(PULL, PULL)
                last = [walk.go(PULL, PULL) for _ in range(REST - 1)][-1]
                rest = f"{difference(first, end):.0e}, {difference(last, first):.0e}"
        body.append([str(n), decision, per_cent(once), per_cent(pulled), per_cent(back), rest])
    head = ["one step", f"{STEPS} steps", f"after {STEPS} steps back", f"change in the first step of rest, in {REST - 1} more"]
    return ["facets", "decided at", *head], body


def turns(library):
    """The largest change of a nodal force after a quarter turn and two steps of rest, over the largest force, in per cent."""
    body = []
    for n, decision, mu in ((n, d, mu) for n in SIZES[:2] for mu in (ROUGH, MU) for d in DECISIONS):
        scene, row = Hertz(n), []
        for count in TURNS:
            def turned():
                walk = Walk(library, scene, decision, scene.loads()[3], mu)
                before = [walk.go(PULL) for _ in range(2)][-1]
                for k in range(1, count + 1):
                    walk.law.angle = np.pi / 2 * k / count
                    walk.go(PULL)
                after = [walk.go(PULL) for _ in range(2)][-1]
                return np.abs(after.force - before.force).max() / np.abs(before.force).max()
            change = attempt(turned)
            row.append("no answer" if change is None else f"{100 * change:.2g}")
        body.append([str(n), "sticks" if mu == ROUGH else "slips in part", decision, *row])
    return ["facets", "the contact", "decided at", *(f"steps of {90 / count:g}°" for count in TURNS)], body


def slides(library):
    """Errors after a slide at the limit and a return by a part, and by how much the force leaves mu N on the way."""
    body = []
    for n, decision, per in ((n, d, p) for n in SIZES[:2] for d in DECISIONS for p in PER_FACET):
        scene, errors, worst = Hertz(n), [], 0.0
        for a in scene.loads()[::3]:
            def slid():
                walk = Walk(library, scene, decision, a)
                sign = -np.sign([walk.go(pull) for pull in (0.5, FULL)][-1].force[:, 0].sum())
                apart = 0.0
                for k in range(1, per * SLIDE + 1):
                    walk.shift = sign * k / (per * n)
                    along, across = walk.go(FULL).force.sum(axis=0)
                    apart = max(apart, abs(abs(along / across) / MU - 1))
                most = walk.answer
                return scene.error_of_shear([walk.go(FULL, back) for back in BACK][-1], most), apart
            found = attempt(slid)
            errors.append(found and found[0])
            worst = max(worst, found[1] if found else 0.0)
        body.append([str(n), decision, str(per), per_cent(errors), f"{worst:.0e}"])
    return ["facets", "decided at", "steps a facet", "error after slide and return", "force over mu N - 1"], body


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=Path, required=True, help="CMake's build tree")
    parser.add_argument("--renew-figures", action="store_true", help="renew the tables of docs/points.md")
    arguments = parser.parse_args()
    library = Library(arguments.build / "lib" / "libstickslip.so")
    tables = [("Errors in per cent, mean and, in brackets, worst of ten loads", steps(library)),
              ("A quarter turn: the largest change of a nodal force over the largest force, in per cent", turns(library)),
              (f"A slide over {SLIDE} facets and a return: errors in per cent of four loads", slides(library))]
    text = "\n\n".join(f"**{title}**\n\n{study_page.markdown(table)}" for title, table in tables)
    output = arguments.build / "border"
    output.mkdir(parents=True, exist_ok=True)
    (output / "moving.md").write_text(text + "\n")
    if arguments.renew_figures:
        put_between(DOCUMENT, MARKS, f"\n\n{text}\n\n")
    print((output / "moving.md").resolve())
    return 0


if __name__ == "__main__":
    sys.exit(main())
