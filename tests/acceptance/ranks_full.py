"""Every scene in full length on two ranks against one: `make ranks-full`, an hour or two. Runs are kept while nothing that goes into
them is newer, so that one that was stopped goes on where it was. What each scene took is in table.md, beside the runs."""

from condensed import TIGHT
from ranks import QUIET, ROUNDED, both, measured
from scene import SCENES, SceneError, interfaces

# A run that two ranks do not repeat: its iterations lead to a singular matrix, which rounding decides the way to.
SINGULAR = ("two_floors",)
# The rounding of their forces is above 1e-13 of them.
ROUND = {"turned_shaft": ROUNDED}
# They take minutes each, and so come last.
LONG = ("ironing_3d", "shallow_ironing", "sliding_down", "mindlin", "cattaneo_line", "hertz_line_fine", "press_fit_3d", "two_bars", "turned_shaft")


def scenes():
    """Those with interfaces, the long ones last."""
    named = [path.stem for path in sorted(SCENES.glob("*.yaml")) if path.stem not in SINGULAR and interfaces(path.stem)]
    return sorted(named, key=lambda name: name in LONG)


def ranks_full(verdicts, driver):
    driver.keep = True
    rows = []
    for name in scenes():
        try:
            one, two = (driver.run(name, *ROUND.get(name, TIGHT), *QUIET, label=f"{name}_{n}", ranks=n) for n in (1, 2))
            rows.append(judge(verdicts, name, one, two))
        except SceneError as problem:
            verdicts.failed(f"{name}: stopped", str(problem))
            rows.append((name, "-", "-", "-", "-", "-"))
        (driver.output / "table.md").write_text(table(rows))


def judge(verdicts, name, one, two):
    if len(one.steps) != len(two.steps):
        raise SceneError(f"{name}: {len(one.steps)} steps on one rank, {len(two.steps)} on two")
    both(verdicts, name, name, one, two)
    taken, states, differs = measured(name, one, two)
    return name, len(one.steps), sum(taken[0]), sum(taken[1]), states, f"{differs:.1e}"


def table(rows):
    lines = ["| scene | steps | iterations on one rank | on two | states that differ | largest difference |", "|---|---|---|---|---|---|"]
    return "\n".join([*lines, *(f"| {' | '.join(map(str, row))} |" for row in rows)]) + "\n"
