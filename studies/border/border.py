"""Where the border of a contact is decided: at nodes, as the library does, or at points with stabilised multipliers: `make
border`. border.py --build DIR [--check] [--renew-figures]; results go to DIR/border.

Weights, points and dual gaps are the library's own, to rounding, which is checked before anything is measured. --check: a small
part, against bounds, for the tests. --renew-figures: tables and picture of docs/border.md. Ten minutes.
"""

import argparse
import shutil
import sys
import time
from dataclasses import dataclass
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1] / "common"))
import folders  # noqa: E402  (puts the others on the path)

sys.path.append(str(folders.ROOT / "tests" / "stability"))
import numpy as np  # noqa: E402

import border_check  # noqa: E402
import border_figure  # noqa: E402
import overlaps  # noqa: E402
import study_page  # noqa: E402
from compared import NAMES, current_laws, frozen_laws  # noqa: E402
from documents import put_between  # noqa: E402
from frozen import FrozenPoints, LastStep  # noqa: E402
from laws import Nodal  # noqa: E402
from library import Library  # noqa: E402
from scenes import MU, PULL, Answer, Corner, Hertz, NoAnswer, Patch  # noqa: E402

DOCUMENT = folders.ROOT / "docs" / "border.md"
MARKS = ("<!-- border -->", "<!-- /border -->")
# Of r over its default.
FACTORS = (0.01, 0.1, 1.0, 10.0, 100.0)
# The radius of both parabolas over the half-width, where weights are those of now: strains are 0.5 %.
ROUND = 100.0
SHIFTS = np.arange(10) / 10
# Of the pull, of its return; steps in which nothing moves.
STEPS, REST = 10, 100
BY_STEP = "points, slip since the last step"
# Multipliers to start from, at random between nothing and twice the largest pressure.
STARTS = 20


@dataclass
class Family:
    """Scenes of one kind. `cases` of a number of facets: pairs of laws by name and what an answer with one of them is worth,
    (error, iterations)."""

    title: str
    sizes: tuple
    cases: object


def hertz(library, within=np.inf, current=False, **kind):
    def cases(n):
        scene = Hertz(n, **({"radius": ROUND} if current else {}), **kind)
        pair = scene.scene.pair
        laws = current_laws(library, pair, scene.scene.start()) if current else frozen_laws(library, pair, n)
        for a in scene.loads():
            def worth(law):
                answer = scene.scene.solve(law, scene.prescribed(a))
                return scene.error(answer, within), answer.iterations
            yield laws, worth
    return cases


def shear(library):
    def cases(n):
        scene = Hertz(n)
        pressed, drawn = (frozen_laws(library, scene.scene.pair, n, mu) for mu in (0.0, MU))
        laws = {name: (pressed[name], drawn[name]) for name in NAMES}
        for a in scene.loads():
            def worth(pair):
                start = scene.scene.solve(pair[0], scene.prescribed(a))
                answer = scene.scene.solve(pair[1], scene.prescribed(a, PULL), start)
                return scene.error_of_shear(answer), answer.iterations
            yield laws, worth
    return cases


def corner(library, reference, wide):
    def cases(n):
        for shift in SHIFTS:
            scene = Corner(n, shift, wide)

            def worth(law):
                answer = scene.scene.solve(law, scene.scene.prescribed)
                return scene.error(answer, reference), answer.iterations
            yield frozen_laws(library, scene.scene.pair, n), worth
    return cases


def patch(library):
    def cases(n):
        for uneven in (False, True):
            scene = Patch((n, 5), uneven)

            def worth(law):
                answer = scene.scene.solve(law, scene.prescribed)
                return scene.error(answer), answer.iterations
            yield frozen_laws(library, scene.scene.pair, n), worth
    return cases


def families(library):
    reference = Corner.reference()
    return [
        Family("Patch test", (7,), patch(library)),
        Family("Hertz' line", (5, 10, 20, 40), hertz(library)),
        Family("the same, inside 0.8 of the half-width", (5, 10, 20, 40), hertz(library, 0.8)),
        Family("the same, weights of now", (5, 10, 20), hertz(library, current=True)),
        Family("the same, facets of 1 : 2 in turn", (5, 10, 20), hertz(library, uneven=True)),
        Family("the same, non-mortar side 100 x stiffer", (5, 10, 20), hertz(library, stiffer=100.0)),
        Family("the same, mortar facets 3 x larger", (5, 10), hertz(library, ratio=3.0)),
        Family("the same, mortar facets 3 x smaller", (5, 10), hertz(library, ratio=1 / 3)),
        Family("the same, mortar facets 3 x larger, non-mortar side 100 x stiffer", (10,),
               hertz(library, ratio=3.0, stiffer=100.0)),
        Family("Cattaneo and Mindlin: shear", (5, 10, 20), shear(library)),
        Family("Corner of a block", (10, 20, 40), corner(library, reference, False)),
        Family("the same, the wider block non-mortar", (10, 20, 40), corner(library, reference, True)),
        Family("Ball, rectangles", (5, 8), hertz(library, dimension=3)),
        Family("Ball, triangles", (5, 8), hertz(library, dimension=3, triangles=True)),
    ]


def attempt(law, worth):
    """(error, iterations), or None."""
    try:
        return worth(law)
    except (NoAnswer, np.linalg.LinAlgError):
        return None


def per_cent(values):
    """Mean and worst, of those that found an answer."""
    found = [v[0] for v in values if v is not None]
    if not found:
        return "no answer" if values else "-"
    missing = f", {len(values) - len(found)} without answer" if len(found) < len(values) else ""
    if max(found) < 1e-10:
        return f"{max(found):.0e}{missing}"
    return f"{100 * np.mean(found):.2g} ({100 * max(found):.2g}){missing}"


def accuracy(library):
    """Tables of errors and of iterations."""
    errors, iterations, sums = [], [], {}
    for family in families(library):
        for n in family.sizes:
            begin, found = time.monotonic(), {name: [] for name in NAMES}
            for laws, worth in family.cases(n):
                for name, law in laws.items():
                    found[name].append(attempt(law, worth))
            errors.append([family.title, str(n), *(per_cent(found[name]) for name in NAMES)])
            counts = {name: [v[1] for v in of if v] for name, of in found.items()}
            iterations.append([family.title, str(n), *(f"{np.mean(c):.1f}" if c else "-" for c in counts.values())])
            if all(len(counts[name]) == len(found[NAMES[1]]) for name in NAMES if counts[name]):
                for name, c in counts.items():
                    sums[name] = sums.get(name, 0) + sum(c)
            print(f"{' | '.join(errors[-1])} | {time.monotonic() - begin:.0f} s", flush=True)
    iterations.append(["all", "", *(str(sums[name]) if "penalty" not in name else "-" for name in NAMES)])
    head = ["scene", "facets", *NAMES]
    return (head, errors), (head, iterations)


def of_choices(sizes, kinds, choices):
    """A row for each kind of Hertz' line and number of facets, a column for each of `choices`, functions from a pair to a law."""
    body = []
    for title, kind in kinds:
        for n in sizes:
            scene = Hertz(n, **kind)

            def worth(law, a):
                answer = scene.scene.solve(law, scene.prescribed(a))
                return scene.error(answer), answer.iterations
            laws = [make(scene.scene.pair) for make in choices.values()]
            found = [[attempt(law, lambda law: worth(law, a)) for a in scene.loads()] for law in laws]
            body.append([title, str(n), *map(per_cent, found)])
    return ["scene", "facets", *choices], body


def augmentation(library):
    """Error over r."""
    dual = {"nodes, dual": lambda pair: Nodal(library, pair, pair.one.x, pair.two.x, "dual")}
    kinds = [("Hertz' line", {}), ("non-mortar side 100 x stiffer", {"stiffer": 100.0})]
    tables = []
    variants = {"K over rhat": {}, "K over r": {"apart": False}, "without K": {"stabilised": False}}
    for name, variant in variants.items():
        at = lambda f, variant=variant: lambda pair: FrozenPoints(pair, factor=f, **variant)
        head, body = of_choices((5, 10, 20), kinds, dual | {f"r x {f:g}": at(f) for f in FACTORS})
        tables += [[name, *row] for row in body]
    return ["points", *head], tables


def rules():
    """Error over the points of an overlap. One is too few: the mass matrix of a facet in one overlap is singular."""
    at = lambda rule: lambda pair: FrozenPoints(pair, rule=rule)
    return of_choices((5, 10, 20), [("Hertz' line", {})], {f"{rule} points": at(rule) for rule in (2, 3, 20)})


def starts(library):
    """Is there one answer, whatever Newton's method starts from?"""
    random, body = np.random.default_rng(1), []
    for n in (5, 10, 20):
        scene = Hertz(n)
        laws, a = frozen_laws(library, scene.scene.pair, n), scene.loads()[3]
        nothing, nodes = tuple(np.zeros_like(x) for x in scene.scene.start()), len(scene.scene.heights)
        for name in NAMES:
            if laws[name].components == 0:
                continue
            found = []
            for _ in range(STARTS):
                lam = -random.uniform(0, scene.modulus * a / scene.radius, (nodes, 1))
                start = Answer(None, lam, nothing, 0)
                found.append(attempt(laws[name], lambda law: scene.scene.solve(law, scene.prescribed(a), start)))
            answers = [f for f in found if f]
            spread = max(np.abs(f.force - answers[0].force).max() for f in answers) / np.abs(answers[0].force).max()
            body.append([str(n), name, f"{len(answers)} of {STARTS}", f"{spread:.0e}", str(max(f.iterations for f in answers))])
    return ["facets", "law", "answers", "largest difference of a nodal force", "most iterations"], body


def walk(scene, pressed, law, a, rest):
    """Answers of steps of a pull, of its return and of `rest` in which nothing moves, each committed; the first one starts
    without friction, and its law has no history yet."""
    way = [(PULL * k / STEPS, 0.0) for k in range(STEPS + 1)] + [(PULL, PULL * k / STEPS) for k in range(1, STEPS + 1)]
    answer, answers = scene.scene.solve(pressed, scene.prescribed(a)), []
    for pull, back in way + way[-1:] * rest:
        answer = scene.scene.solve(law, scene.prescribed(a, pull, back), answer)
        scene.scene.commit(law, answer)
        answers.append(answer)
    return answers


def history(library):
    """Shear in steps, and taken back: errors in per cent; at one load then nothing for REST steps, and the largest change of a
    nodal force over the largest."""
    body = []
    for n in (5, 10, 20):
        scene = Hertz(n)
        pair = scene.scene.pair
        for name in (*NAMES, BY_STEP):
            of_pull, of_return, counts, crept = [], [], [], "-"
            for k, a in enumerate(scene.loads()):
                laws = [LastStep(pair, mu) if name == BY_STEP else frozen_laws(library, pair, n, mu)[name] for mu in (0.0, MU)]
                try:
                    answers = walk(scene, *laws, a, 0 if k else REST)
                except NoAnswer:
                    of_pull.append(None), of_return.append(None)
                    continue
                most, back = answers[STEPS], answers[2 * STEPS]
                of_pull.append((scene.error_of_shear(most), 0))
                of_return.append((scene.error_of_shear(back, most), 0))
                counts += [answer.iterations for answer in answers[: 2 * STEPS + 1]]
                if not k:
                    change = np.abs((answers[-1].force - back.force)[:, 0]).max()
                    crept = f"{change / np.abs(back.force[:, 0]).max():.0e}"
            body.append([str(n), name, per_cent(of_pull), per_cent(of_return), crept, f"{np.mean(counts):.1f}" if counts else "-"])
    head = [f"{STEPS} steps", f"after {STEPS} steps back", f"change in {REST} steps of rest", "Newton iterations a step"]
    return ["facets", "law", *head], body


def weights(library):
    """The largest difference between the study's weights and the library's."""
    scenes = [Hertz(10).scene, Hertz(5, uneven=True).scene, Hertz(5, dimension=3).scene,
              Hertz(5, dimension=3, triangles=True).scene, Corner(10, 0.3, True).scene]
    pairs = [scene.pair for scene in scenes]
    return max(overlaps.worst_weight(library, p.one, p.two, overlaps.between(p.one, p.two, 3)) for p in pairs)


def report(build, library, renew):
    output = build / "border"
    output.mkdir(parents=True, exist_ok=True)
    worst = weights(library)
    print(f"weights: largest difference from the library's, over the largest: {worst:.0e}")
    if worst > border_check.SAME:
        raise SystemExit("these are not the library's weights")
    errors, iterations = accuracy(library)
    tables = [("Errors in per cent, mean and, in brackets, worst", errors), ("Newton iterations, mean", iterations),
              ("Over r", augmentation(library)), ("Over the points of an overlap", rules()),
              ("From starts at random", starts(library)), ("Shear in steps", history(library))]
    text = "\n\n".join(f"**{title}**\n\n{study_page.markdown(table)}" for title, table in tables)
    (output / "border.md").write_text(text + "\n")
    picture = border_figure.draw(library, output / "border.png")
    if renew:
        shutil.copy(picture, folders.FIGURES / picture.name)
        put_between(DOCUMENT, MARKS, f"\n\n{text}\n\n")
    print((output / "border.md").resolve(), picture.resolve(), sep="\n")
    return 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=Path, required=True, help="CMake's build tree")
    parser.add_argument("--check", action="store_true", help="a small part, against bounds: for the tests")
    parser.add_argument("--renew-figures", action="store_true", help="renew tables and picture of docs/border.md")
    arguments = parser.parse_args()
    library = Library(arguments.build / "lib" / "libstickslip.so")
    return border_check.check(library) if arguments.check else report(arguments.build, library, arguments.renew_figures)


if __name__ == "__main__":
    sys.exit(main())
