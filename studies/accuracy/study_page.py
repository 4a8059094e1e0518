"""The page of `make study`, read in five minutes, and its summary for docs/accuracy.md."""

import html
import textwrap

from documents import put_between
from gallery_page import STYLE
from study_problems import COMMITTED, DEFAULT, PAPER, PRESS_FINE, PRESS_STEP, PRESS_STEPS, STANDARD
from study_share import ASSEMBLY_BOUND, SHARE_BOUND

CELLS = "Linear and quadratic cells"
# On the page alone; the last one has a place of its own in the document.
LONG = ("What the next digit costs", "Each knob against the default", CELLS)
MARKS = ("<!-- study -->", "<!-- /study -->")  # what lies between them is written by FIGURES=1


# Beside it a ratio of errors says nothing.
EXACT = 1e-9
# Relative to one: a double has sixteen digits.
ROUNDING = 1e-15


def per_cent(value):
    if value < ROUNDING:
        return "0"
    return f"{100 * value:.2g} %" if value >= 1e-4 else f"{value:.0e}"


def goal_table(problems, rows, goals, wanted):
    """Per problem the cheapest setting for each goal, and what the next digit costs."""
    head = ["problem", "error in", *(f"{per_cent(g)}" for g in wanted), "default setting", "the next digit costs"]
    body = []
    for problem in problems:
        own = [r for r in rows if r["problem"] == problem.name]
        found = goals(own)
        cells = ["not reached" if r is None else f"{r['setting']}: {r['seconds']:.2f} s" for r in found]
        default = next((r for r in own if r["setting"] == DEFAULT and "error" in r), None)
        mine = "no answer" if default is None else f"{per_cent(default['error'])} in {default['seconds']:.2f} s"
        prices = [f"{b['seconds'] / a['seconds']:.2g} x" for a, b in zip(found, found[1:]) if a and b]
        body.append([problem.title, problem.measure, *cells, mine, ", ".join(prices) or "-"])
    return head, body


def digit_table(problems, rows, front):
    """Along each front: what each point costs over the one before, a digit."""
    head = ["problem", "setting", "error", "seconds", "spread", "Newton", "kB", "seconds over the cheapest"]
    body = []
    for problem in problems:
        best = front([r for r in rows if r["problem"] == problem.name])
        for row in best:
            body.append([problem.title, row["setting"], f"{row['error']:.1e}", f"{row['seconds']:.3f}",
                         f"{row['spread']:.0%}", str(row["newton"]), f"{row['bytes'] / 1e3:.0f}",
                         f"{row['seconds'] / best[0]['seconds']:.2f}"])
    return head, body


def library(row):
    return row["seconds_search"] + row["seconds_integration"] + row["seconds_contact_assembly"]


def against_default(problems, rows):
    """Each setting against the default of its problem: the ratios that justify the defaults."""
    head = ["problem", "setting", "error", "error over default's", "contact's time over default's", "Newton (default)"]
    body = []
    for problem in problems:
        own = [r for r in rows if r["problem"] == problem.name]
        default = next((r for r in own if r["setting"] == DEFAULT and "error" in r), None)
        for row in own if default else []:
            if row["knob"] in (DEFAULT, "steps") or row["setting"].startswith("mesh_"):
                continue
            if "error" not in row:
                body.append([problem.title, row["setting"], "no answer", "", "", ""])
                continue
            body.append([problem.title, row["setting"], f"{row['error']:.2e}", f"{row['error'] / default['error']:.3g}",
                         f"{library(row) / library(default):.2f}", f"{row['newton']} ({default['newton']})"])
    return head, body


# What the summary shows of the knobs, in this order.
SHOWN = ("cells_1", "cells_3", "cells_6", "cells_12", "cells_36", "elements_2", "elements_4", "elements_10", "hybrid_3",
         "frozen_normals", "frozen_weights", "rtol_1e-8", "rtol_1e-5", "rtol_1e-3", "weights_committed",
         "weights_reference", "augmented", COMMITTED, STANDARD, PAPER)


def matrix(problems, rows):
    """Settings by problems: error over the default's (the error itself where the default is exact), and Newton iterations over its."""
    at = {(r["problem"], r["setting"]): r for r in rows}
    head = ["setting", *(p.title for p in problems)]
    first = [at[p.name, DEFAULT] for p in problems]
    body = [["default", *(f"{per_cent(r['error'])}, {r['newton']} iterations" for r in first)]]
    for setting in SHOWN:
        line = [setting]
        for problem, default in zip(problems, first):
            row = at.get((problem.name, setting))
            if row is None:
                line.append("-")
            elif "error" not in row:
                line.append("no answer")
            else:
                newton = row["newton"] / default["newton"]
                error = per_cent(row["error"]) if default["error"] < EXACT else f"{row['error'] / default['error']:.2f}"
                line.append(f"{error}, {newton:.2f}")
        body.append(line)
    return head, body


def bases(problems, rows):
    """Standard and dual multipliers on every mesh."""
    head = ["problem", "mesh", "error in", "of nodal force over area", "of the multiplier", "states", "Newton",
            "seconds", "the library's"]
    at = {(r["problem"], r["setting"]): r for r in rows if "error" in r}
    body = []
    for problem in problems:
        for size in problem.sizes:
            middle = size == problem.sizes[problem.middle]
            names = (STANDARD, DEFAULT) if middle else (f"mesh_{size:g}_{STANDARD}", f"mesh_{size:g}")
            pair = [at.get((problem.name, name)) for name in names]
            if None in pair:
                continue
            both = lambda text, pair=pair: " / ".join(text(row) for row in pair)
            error_of = lambda name: lambda row: per_cent(row[f"error_{name}"])
            multiplier = both(error_of("multiplier")) if "error_multiplier" in pair[0] else "-"
            own = "error_multiplier" in pair[0] and pair[0]["error"] == pair[0]["error_multiplier"]
            forces = "-" if own else both(lambda row: per_cent(row["error"]))
            states = both(error_of(problem.states[0])) if problem.states else "-"
            body.append([problem.title, f"{size:g}", problem.measure, forces, multiplier, states,
                         both(lambda row: str(row["newton"])), both(lambda row: f"{row['seconds']:.2f}"),
                         both(lambda row: f"{library(row):.3f}")])
    return head, body


def steps(problems, rows):
    """Steps of every length with normals of t_n and of now."""
    head = ["problem", "step", "error: of t_n", "of now", "Newton", "cut-backs", "seconds"]
    at = {(r["problem"], r["setting"]): r for r in rows if "error" in r}
    body = []
    for problem in (p for p in problems if p.name == "press_fit"):
        for step in PRESS_STEPS:
            names = (COMMITTED, DEFAULT) if step == PRESS_STEP else (f"steps_{step}_{COMMITTED}", f"steps_{step}")
            pair = [at.get((problem.name, name)) for name in names]
            if None in pair:
                continue
            both = lambda text, pair=pair: " / ".join(text(row) for row in pair)
            body.append([problem.title, f"{step} mm", per_cent(pair[0]["error"]), f"{pair[1]['error']:.0e}",
                         both(lambda row: str(row["newton"])), both(lambda row: str(row["cutbacks"])),
                         both(lambda row: f"{row['seconds']:.2f}")])
    return head, body


def phases(problems, rows):
    head = ["problem", "search", "integration", "derivatives, assembly", "all of contact", "bulk assembly",
            "linear solve", "total [s]"]
    body = []
    for problem in problems:
        row = next((r for r in rows if r["problem"] == problem.name and r["setting"] == DEFAULT and "error" in r), None)
        if row:
            whole = row["seconds_contact_forces"] + row["seconds_contact_tangent"]
            parts = (row["seconds_search"], row["seconds_integration"], row["seconds_contact_assembly"], whole,
                     row["seconds_bulk_assembly"], row["seconds_linear_solve"])
            total = row["seconds_total"]
            body.append([problem.title, *(f"{p / total:.1%}" for p in parts), f"{total:.2f}"])
    return head, body


def share_table(shares):
    head = ["unknowns", "an iteration [s]", "library / iteration", "all of contact / iteration",
            "library / bulk assembly", "all of contact / bulk assembly"]
    return head, [[str(r["unknowns"]), f"{r['iteration']:.3f}", f"{r['library_share']:.2%}", f"{r['whole_share']:.2%}",
                   f"{r['library_over_bulk']:.1%}", f"{r['whole_over_bulk']:.1%}"] for r in shares]


def tail_table(tails):
    least = tails[0]["integration"] + tails[0]["tangent"]
    head = ["a triangle", "residuals of the last step", "integration [ms]", "tangent [ms]", "over the first"]
    return head, [[t["label"], " ".join(f"{n:.0e}" for n in t["norms"]), f"{1e3 * t['integration']:.1f}",
                   f"{1e3 * t['tangent']:.1f}", f"{(t['integration'] + t['tangent']) / least:.2f}"] for t in tails]


def markdown(table):
    head, body = table
    return "\n".join(["| " + " | ".join(line) + " |" for line in (head, ["---"] * len(head), *body)])


def as_html(table):
    head, body = table
    cells = lambda tag, line: "".join(f"<{tag}>{html.escape(c)}</{tag}>" for c in line)
    lines = "".join(f"<tr>{cells('td', line)}</tr>" for line in body)
    return f"<table><tr>{cells('th', head)}</tr>{lines}</table>"


def noise(rows):
    """Median and largest spread of the repetitions."""
    spreads = sorted(r["spread"] for r in rows if "spread" in r)
    return (spreads[len(spreads) // 2], spreads[-1]) if spreads else (float("nan"), float("nan"))


def states_in_words(problems):
    """What the column of states is, by the problems' titles."""
    found = {}
    for problem in problems:
        if problem.states:
            found.setdefault(problem.states[1], []).append(problem.title)
    return {words: ", ".join(titles) for words, titles in found.items()}


def sections(problems, rows, measured, choice):
    """(title, sentence, table), in the order in which they are to be read."""
    (shares, tails, cells), (front, goals, wanted) = measured, choice
    bound = f"Aimed at: at most {SHARE_BOUND:.0%} of an iteration and {ASSEMBLY_BOUND:.0%} of the bulk's assembly."
    return [
        ("Which settings", "The cheapest setting that reaches each error, with its processor time. A mesh goes by "
         "the size of its facets (of the patch test and the block by their number along a side); `cheap` is 2 x 2 points on each "
         "facet and a tolerance of 1e-5.", goal_table(problems, rows, goals, wanted)),
        ("What the next digit costs", "The settings that no other one beats in both error and time.",
         digit_table(problems, rows, front)),
        ("What each knob changes", "On one mesh: error over the default's, or the error itself where the default is exact; Newton iterations over the default's. The "
         "rules with 1 and 3 points (cells_1, cells_3) with weights frozen within a step, for with current ones they "
         "find no answer; that with 1 point with standard multipliers, for it cannot make dual ones. `paper`: standard "
         "multipliers, normals of the last step.",
         matrix(problems, rows)),
        ("Standard and dual multipliers", "Both bases on the same meshes, standard / dual, with normals of now. Nodal forces over areas hide how "
         "the standard multiplier oscillates, so both errors are given, of the same field. States: "
         + "; ".join(f"{words} ({titles})" for words, titles in states_in_words(problems).items()) + ".",
         bases(problems, rows)),
        ("Steps, with normals of t_n and of now", "Both on the same steps, t_n / now. The reference has steps of "
         f"{PRESS_FINE} mm, dual multipliers, normals of now and the finest rule: what is left with normals of now is the default rule's error.",
         steps(problems, rows)),
        ("Each knob against the default", "On one mesh: what a knob changes in the error, in contact's time (search, "
         "integration, derivatives) and in the number of Newton iterations.", against_default(problems, rows)),
        ("Where the time goes", "Parts of the default's time.", phases(problems, rows)),
        ("Contact's share against size", f"Two blocks, MUMPS. {bound}", share_table(shares)),
        ("Newton's last iterations on warped facets", "The derivative is that of the exact integral, not of the rule's "
         "sum; whether that can be seen, beside what frozen tangents do.", tail_table(tails)),
        (CELLS, "Processor time for each error, between the meshes. Where the solution is smooth, quadratic cells make a "
         "digit cheaper; in the pressure of a contact, which ends in a steep rim, they do not.", cells),
    ]


def write(output, problems, rows, measured, choice, summary, figures, circumstances):
    """index.html and accuracy.md, the summary for the documents; returns the former's path."""
    seconds, jobs = circumstances
    median, worst = noise(rows)
    runs = max(r.get("runs", 0) for r in rows)
    stated = (f"Each setting ran {runs} times, all of them in turn, {jobs} at a time; the least processor time counts. "
              f"The slowest run of a setting took {median:.0%} more than its fastest (median; at worst {worst:.0%}): "
              "differences below that are the machine's.")
    every = sections(problems, rows, measured, choice)
    parts = [f"<!doctype html><meta charset='utf-8'><title>stickslip: accuracy and time</title><style>{STYLE}</style>",
             "<h1>What accuracy costs in time</h1>", f"<p>{stated}</p>",
             f'<p><img src="{summary.name}" alt="work-precision diagrams"></p>']
    for title, sentence, table in every:
        parts.append(f"<h2>{html.escape(title)}</h2><p>{html.escape(sentence)}</p>{as_html(table)}")
    parts.append("<h2>Diagrams</h2>")
    parts += [f'<p><img src="{path.name}" alt="{path.stem}"></p>' for path in figures]
    page = output / "index.html"
    page.write_text("\n".join(parts) + "\n")
    chosen = [section for section in every if section[0] not in LONG]
    text = [textwrap.fill(stated, 120), ""]
    for title, sentence, table in chosen:
        text += [f"### {title}", "", textwrap.fill(sentence, 120, break_on_hyphens=False), "", markdown(table), ""]
    (output / "accuracy.md").write_text("\n".join(text))
    return page


def renew(document, summary):
    """Puts the summary between its marks in the document."""
    put_between(document, MARKS, f"\n\n{summary.read_text()}\n")
