"""Seeded histories: two small meshes, or a mesh and an analytic surface, with any options, moved for a few steps. What a
library gives for them on the way, in digests. Meshes are of linear facets, of some or only quadratic ones, or of lines; multipliers
standard or dual; nodes or points decide; friction by any law; some nodes are offset, some systems condensed."""

import ctypes
import functools
import hashlib
import sys
from pathlib import Path

import numpy as np

sys.path.append(str(Path(__file__).resolve().parents[1] / "stability"))
from library import COMMITTED, CURRENT, DUAL, OF_COMMIT, OF_NOW, REFERENCE, STANDARD, Interface, Law, Library, Refused, pointer  # noqa: E402  (needs the path)

RIGID, ANALYTIC = 1, 2  # STICKSLIP_MORTAR_RIGID, STICKSLIP_MORTAR_ANALYTIC
COULOMB, FRICTIONLESS, TRESCA = 0, 1, 4  # STICKSLIP_FRICTION_...
POINTS = 1  # STICKSLIP_DECISION_POINTS
NONE = -1.0  # STICKSLIP_WEAK_COVERAGE_NONE
FORCES, CONSTRAINTS = 0, 2  # STICKSLIP_CONDENSED_...
# What a mesh is of, as often as it stands here. "mixed": some facets are quadratic.
KINDS = ("linear", "linear", "linear", "quadratic", "mixed", "lines")
# STICKSLIP_LAW_...: cohesion, weakening, orthotropic.
LAWS = ({"kind": 1, "cohesion": 0.5}, {"kind": 2, "mu_after": 0.1, "critical_slip": 0.05}, {"kind": 3, "mu_across": 0.1})


def digest(*arrays):
    """Of the bits of arrays."""
    h = hashlib.blake2b(digest_size=6)
    for array in arrays:
        h.update(np.ascontiguousarray(array).tobytes())
    return h.hexdigest()


# The library of a file, loaded once a process.
loaded = functools.cache(Library)


def evaluate(interface, name, at):
    """The arrays of one evaluation: "residual", "tangent", "states"."""
    found = getattr(interface, {"tangent": "triplets"}.get(name, name))(*at)
    return list(found.values()) if isinstance(found, dict) else found


def mesh(random, down, curved):
    """A sheet of one to three by one to three quads, some of them cut into triangles, crooked; facing up or down."""
    n, m = random.integers(1, 4, 2)
    corner, size = random.uniform(-0.4, 0.4, 2), random.uniform(0.5, 1.5, 2)
    u, v = np.meshgrid(np.arange(m + 1) / m, np.arange(n + 1) / n)
    x = np.stack([corner[0] + size[0] * u, corner[1] + size[1] * v, np.zeros_like(u)], axis=-1).reshape(-1, 3)
    x[:, :2] += random.uniform(-0.15, 0.15, (len(x), 2)) * size / max(n, m) * random.integers(0, 2)
    x[:, 2] += curved * ((x[:, 0] - 0.3) ** 2 + (x[:, 1] - 0.2) ** 2) + 0.05 * random.integers(0, 2) * random.uniform(-1, 1, len(x))
    facets = []
    for i in range(n):
        for j in range(m):
            a, b = i * (m + 1) + j, (i + 1) * (m + 1) + j
            quad = [a, a + 1, b + 1, b]
            facets += [quad[:3], [quad[2], quad[3], quad[0]]] if random.random() < 0.3 else [quad]
    return x, [facet[::-1] for facet in facets] if down else facets


def quadratic(random, x, facets, part):
    """The mesh with some of its facets made quadratic, their mid nodes a little off."""
    x, made, middle = list(x), [], {}

    def between(nodes):
        key = tuple(sorted(nodes))
        if key not in middle:
            middle[key] = len(x)
            x.append(np.mean([x[node] for node in nodes], axis=0) + 0.01 * random.uniform(-1, 1, 3))
        return middle[key]

    for facet in facets:
        if random.random() < part:
            mids = [between(pair) for pair in zip(facet, np.roll(facet, -1))]
            centre = [between(facet)] if len(facet) == 4 and random.random() < 0.5 else []
            facet = [*facet, *mids, *centre]
        made.append(facet)
    return np.array(x), made


def chain(random, down, curved):
    """One to four lines of two or three nodes, at r > 0; the body above or below them."""
    n, three = int(random.integers(1, 5)), random.random() < 0.4
    u = random.uniform(0.5, 0.9) + random.uniform(0.5, 1.5) * np.arange(n + 1) / n
    x = np.stack([u, curved * (u - 1.0) ** 2], axis=1)
    x[:, 1] += 0.03 * random.integers(0, 2) * random.uniform(-1, 1, n + 1)
    lines = [[a, a + 1] for a in range(n)]
    if three:
        x = np.vstack([x, (x[1:] + x[:-1]) / 2 + 0.01 * random.uniform(-1, 1, (n, 2))])
        lines = [[*line, n + 1 + a] for a, line in enumerate(lines)]
    return x, lines if down else [[line[1], line[0], *line[2:]] for line in lines]


def side(random, kind, down, curved):
    if kind == "lines":
        return chain(random, down, curved)
    x, facets = mesh(random, down, curved)
    return (x, facets) if kind == "linear" else quadratic(random, x, facets, 1.0 if kind == "quadratic" else 0.3)


def frame(shape, random, kind):
    """p0, the axis, and two across it: a plane at 0 that faces up, a ball or a roller below; of lines a point less."""
    if kind == "lines":
        p = np.array([1.0, 0.0 if shape == 0 else -1.0])
        return np.vstack([p, p + [[0, 1], [1, 0]]])
    p = np.array([0.3, 0.2, 0.0 if shape == 0 else -1.0])
    rows = np.array([[0, 0, 1], [1, 0, 0], [0, 1, 0]]) if shape == 0 else np.array([[0, 1, 0], [0, 0, 1], [1, 0, 0]])
    return np.vstack([p, p + rows])


def choose(random, kind):
    """Options: any of them, but for most of those that are refused."""
    pick = lambda *values: values[random.integers(len(values))]
    options = {
        "form": pick(0, 0, 1),
        "slip": pick(0, 0, 1, 2),
        "weights": pick(CURRENT, CURRENT, CURRENT, COMMITTED, REFERENCE),
        "friction": pick(0, 0, 0, 1, 2, 3, TRESCA),
        "mortar_side": pick(0, 0, 0, 1, 2),
        "quadrature": pick(0, 0, 1, 2, 3, 4, 5),
        "row_scale": pick(0, 1),
        "new_contact": pick(0, 1),
        "mu": pick(0.0, 0.2, 0.5, 2.0),
        "augmentation": pick(0.0, 1.0, 50.0),
        "modulus": 100.0,
        "coverage_min": pick(0.0, 0.0, 1e-3),
        "search_distance": pick(0.0, 0.0, 0.3, 2.0),
        "no_shortcuts": pick(0, 0, 15, int(random.integers(16))),
        "integration": pick(0, 0, 0, 1, 2),
        "tangent": pick(0, 0, 1, 2),
        "weak_coverage": pick(0.0, 0.0, 0.5, 1.0),
        "turn_max": pick(0.0, 3.0),
    }
    if options["friction"]:
        options["mu"] = 0.0
    # Normals of now go with weights of now.
    options["normals"] = pick(OF_COMMIT, OF_COMMIT, OF_NOW) if options["weights"] == CURRENT else OF_COMMIT
    options["basis"] = pick(STANDARD, STANDARD, DUAL)
    if kind != "linear":
        options["multiplier_space"] = 0 if options["basis"] == DUAL else pick(0, 1)
        options["form"] = options["integration"] = 0
        options["normals"] = OF_COMMIT
    if kind == "lines":
        options |= {"model": pick(1, 2), "tangent": pick(0, 0, 2)}
        options["thickness"] = 0.7 if options["model"] == 1 else 0.0
    elif random.random() < 0.1 and kind == "linear" and options["mortar_side"] != ANALYTIC:
        options |= {"decision": POINTS, "basis": DUAL, "form": 0, "normals": OF_COMMIT, "integration": 0, "weak_coverage": NONE}
        options["friction"] = pick(COULOMB, FRICTIONLESS)
        if options["friction"] == COULOMB:
            options |= {"mu": pick(0.2, 0.5), "weights": pick(COMMITTED, REFERENCE), "slip": pick(0, 1)}
        else:
            options["mu"] = 0.0
    if options["friction"] == TRESCA:
        options["shear_limit"] = 2.0
    if options["integration"]:
        options["element_points"] = pick(0, 3, 5)
    if options["mortar_side"] == ANALYTIC:
        options["shape"] = pick(0, 1, 2)
        options["radius"] = 1.0 if options["shape"] else 0.0
    return options


def play(library, seed):
    """(name, arrays) of all that is computed on the way; a refusal ends what it is part of."""
    random = np.random.default_rng([seed, 20260])
    kind = KINDS[random.integers(len(KINDS))]
    options, up = choose(random, kind), 1 if kind == "lines" else 2
    components = 1 if options["friction"] == FRICTIONLESS else 1 + up
    x1, facets1 = side(random, kind, down=True, curved=random.choice([0.0, 0.2]))
    if options["mortar_side"] == ANALYTIC:
        x2, facets2 = frame(options["shape"], random, kind), None
    else:
        x2, facets2 = side(random, kind, down=False, curved=random.choice([0.0, -0.2]))
    x1[:, up] += random.choice([0.0, 0.0, 0.02, -0.02, 1.5])
    move = (random.normal(size=(3, 3)) * [0.08, 0.08, 0.02])[:, -1 - up :]
    strain, steps = random.choice([0.0, 0.02]), int(random.integers(1, 4))
    rigid = options["mortar_side"] == RIGID
    create = functools.partial(Interface, library, x1, facets1, x2, facets2, components, rigid, **options)
    made = []
    try:
        made.append(create())
        interface = made[0]
        yield "start", [interface.start()]
        if random.random() < 0.2 and options["friction"] == 0:
            interface.set("friction", random.uniform(0, 1, len(x1)))
        if random.random() < 0.2:
            interface.set("augmentation", random.uniform(1, 20, len(x1)))
        if random.random() < 0.2 and options["friction"] == COULOMB and not options.get("decision"):
            law = LAWS[random.integers(len(LAWS))] | {"direction": (ctypes.c_double * 3)(2.0, -1.0, 0.0)}
            library.call("interface_set_law", interface.handle, ctypes.byref(Law(**law)))
        if random.random() < 0.2:
            sides = [0.02 * random.uniform(-1, 1, len(x)) for x in (x1, x2)]
            library.call("interface_set_offsets", interface.handle, pointer(sides[0]), None if facets2 is None else pointer(sides[1]))
        condenses = random.random() < 0.3 and options["basis"] == DUAL and not rigid and facets2 is not None
        for step in range(steps):
            one = x1 + move[step] + strain * random.normal(size=x1.shape)
            two = x2 + 0.3 * move[step - 1] + (0.0 if facets2 is None else strain * random.normal(size=x2.shape))
            lam = random.normal(size=(len(x1), components)) * 5
            if components == 1 + up:
                lam[:, up] -= 5 * random.integers(0, 3)  # a pressure: nu points up
            at = one, two, lam
            order = random.permutation(3)
            for which in order[: 2 + random.integers(2)]:
                name = ("residual", "tangent", "states")[which]
                yield name, evaluate(interface, name, at)
            if condenses and not options.get("decision") and options["form"] == 0:
                yield "condensed", [interface.piece(piece, *at) for piece in (FORCES, CONSTRAINTS)]
            interface.commit(*at)
            if random.random() < 0.1:
                interface.rollback()
            history = interface.history()
            yield "history", history
            x1, x2 = (one, two) if random.random() < 0.7 else (x1, x2)
        if random.random() < 0.2:
            made.append(create())
            made[1].restore(history)
            yield "again", made[1].residual(*at)
    except Refused as refusal:
        # No word of the message: words may change.
        yield "status", [np.array([refusal.status]), np.frombuffer(refusal.call.encode(), np.uint8)]
    finally:
        for interface in made:
            interface.close()


def digests(library, seed):
    return [[name, digest(*arrays)] for name, arrays in play(library, seed)]


def difference(one, two, seed):
    """By how much a history differs between two libraries, at the first place where it does, over the largest number
    there."""
    for (name, a), (other, b) in zip(play(loaded(one), seed), play(loaded(two), seed)):
        if name != other:
            return f"{name} -> {other}"
        if digest(*a) == digest(*b):
            continue
        if any(x.shape != y.shape for x, y in zip(a, b)):
            return f"{name}: other lengths"
        reals = [(x, y) for x, y in zip(a, b) if x.dtype.kind == "f"]
        largest = max((np.abs(x).max(initial=0.0) for x, _ in reals), default=0.0)
        off = max((np.abs(x - y).max(initial=0.0) for x, y in reals), default=0.0)
        whole = all(np.array_equal(x, y) for x, y in zip(a, b) if x.dtype.kind != "f")
        return f"{name}: {off:.1e} of {largest:.1e}" + ("" if whole else ", and integers")
    return "nothing here"
