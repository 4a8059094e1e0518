"""Seeded histories: two small meshes, or a mesh and an analytic surface, with any options, moved for a few steps. What a
library gives for them on the way, in digests."""

import ctypes
import hashlib
import sys
from ctypes import byref, c_int64, c_uint64, c_void_p
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "stability"))
from library import Options, Pair, States, Surface, pointer  # noqa: E402  (needs the path)

ANALYTIC = 2  # STICKSLIP_MORTAR_ANALYTIC
FRICTIONLESS = 1  # STICKSLIP_FRICTION_NONE


def digest(*arrays):
    """Of the bits of arrays."""
    h = hashlib.blake2b(digest_size=6)
    for array in arrays:
        h.update(np.ascontiguousarray(array).tobytes())
    return h.hexdigest()


class Refused(Exception):
    """A call gave a status; no word of its message is digested, words may change."""


class Loaded:
    kept = {}

    def __init__(self, path):
        self.c = ctypes.CDLL(str(Path(path).resolve()))

    @classmethod
    def of(cls, path):
        """The library of a file, loaded once a process."""
        if path not in cls.kept:
            cls.kept[path] = cls(path)
        return cls.kept[path]

    def call(self, name, *arguments):
        status = getattr(self.c, f"stickslip_{name}")(*arguments)
        if status:
            raise Refused(name, status)

    def pair(self, x1, x2):
        """Weights and their derivatives, or the status."""
        x1, x2 = np.ascontiguousarray(x1, float), np.ascontiguousarray(x2, float)
        n1, n2 = len(x1), len(x2)
        pair = Pair(n1=n1, n2=n2, x1=pointer(x1), x2=pointer(x2))
        out = [np.zeros((n1, n1)), np.zeros((n1, n2))]
        out += [np.zeros((n1, n, 3 * (n1 + n2))) for n in (n1, n2)]
        try:
            self.call("pair_weights", byref(pair), *map(pointer, out))
        except Refused as refusal:
            return [np.array(refusal.args[1])]
        return out


class Handle:
    """Facets are lists of 3 or 4 nodes; `facets2` None: an analytic frame."""

    def __init__(self, library, x1, facets1, x2, facets2, components, rigid=False, **options):
        self.library, self.components = library, components
        self.n1, self.n2 = len(x1), len(x2)
        n1, n2 = self.n1, self.n2
        equations = np.arange(3 * n1 + 3 * n2 + components * n1, dtype=np.int64)
        one, two, multipliers = np.split(equations, [3 * n1, 3 * (n1 + n2)])
        two = np.full(3 * n2, -1, np.int64) if rigid or facets2 is None else two
        self.kept, sides = [multipliers], []
        for x, facets, of in ((x1, facets1, one), (x2, facets2 or [], two)):
            x, of = np.ascontiguousarray(x, float), np.ascontiguousarray(of)
            nodes = np.array([n for facet in facets for n in facet], np.int64)
            offsets = np.cumsum([0, *map(len, facets)]).astype(np.int64)
            self.kept += [x, of, nodes, offsets]
            sides.append(
                Surface(
                    n_nodes=len(x),
                    n_facets=len(facets),
                    coordinates=pointer(x),
                    facet_offsets=pointer(offsets) if facets else None,
                    facet_nodes=pointer(nodes) if facets else None,
                    equations=pointer(of),
                )
            )
        sides[0].multiplier_equations = pointer(multipliers)
        chosen = Options()
        library.call("options_init", byref(chosen), c_uint64(chosen.struct_size))
        for name, value in options.items():
            setattr(chosen, name, value)
        self.handle = c_void_p()
        library.call("interface_create", byref(sides[0]), byref(sides[1]), byref(chosen), byref(self.handle))

    def close(self):
        self.library.call("interface_destroy", byref(self.handle))

    def set(self, what, values):
        values = np.ascontiguousarray(values, float)
        self.library.call(f"interface_set_{what}", self.handle, pointer(values))

    def start(self):
        out = np.zeros((self.n1, self.components))
        self.library.call("interface_initial_multipliers", self.handle, pointer(out))
        return out

    def residual(self, at):
        out = [np.zeros((self.n1, 3)), np.zeros((self.n2, 3)), np.zeros((self.n1, self.components))]
        self.library.call("interface_residual", self.handle, *map(pointer, at), None, *map(pointer, out))
        return out

    def tangent(self, at):
        count, state = c_int64(), [*map(pointer, at)]
        self.library.call("interface_tangent_coo", self.handle, *state, None, c_int64(0), None, None, None, byref(count))
        out = [np.zeros(count.value, np.int64), np.zeros(count.value, np.int64), np.zeros(count.value)]
        self.library.call("interface_tangent_coo", self.handle, *state, None, count, *map(pointer, out), byref(count))
        return out

    def states(self, at):
        n = self.n1
        out = {"state": np.zeros(n, np.int32)}
        out |= {name: np.zeros((n, 3)) for name in ("normal", "traction", "slip")}
        out |= {name: np.zeros(n) for name in ("gap", "coverage", "area", "dissipation", "augmentation")}
        wanted = States(**{name: pointer(array) for name, array in out.items()})
        self.library.call("interface_states", self.handle, *map(pointer, at), None, byref(wanted))
        return list(out.values())

    def evaluate(self, at):
        return [*self.residual(at), *self.tangent(at), *self.states(at)]

    def commit(self, at):
        self.library.call("interface_commit", self.handle, *map(pointer, at), None)

    def rollback(self):
        self.library.call("interface_rollback", self.handle)

    def export(self):
        lengths = [c_int64(), c_int64()]
        self.library.call("interface_history_size", self.handle, *map(byref, lengths))
        out = [np.zeros(lengths[0].value, np.int64), np.zeros(lengths[1].value)]
        self.library.call("interface_history_export", self.handle, lengths[0], pointer(out[0]), lengths[1], pointer(out[1]))
        return out

    def take(self, history):
        integers, reals = history
        arguments = (c_int64(len(integers)), pointer(integers), c_int64(len(reals)), pointer(reals))
        self.library.call("interface_history_import", self.handle, *arguments)


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


def frame(shape, random):
    """p0, the axis, and two across it: a plane at 0 that faces up, a ball or a roller below."""
    p = np.array([0.3, 0.2, 0.0 if shape == 0 else -1.0])
    rows = np.array([[0, 0, 1], [1, 0, 0], [0, 1, 0]]) if shape == 0 else np.array([[0, 1, 0], [0, 0, 1], [1, 0, 0]])
    return np.vstack([p, p + rows])


def choose(random):
    """Options: any of them."""
    pick = lambda *values: values[random.integers(len(values))]
    options = {
        "form": pick(0, 0, 1),
        "slip": pick(0, 0, 1, 2),
        "weights": pick(0, 0, 0, 1, 2),
        "friction": pick(0, 0, 0, 1, 2, 3),
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
    if options["integration"]:
        options["element_points"] = pick(0, 3, 5)
    if options["mortar_side"] == ANALYTIC:
        options["shape"] = pick(0, 1, 2)
        options["radius"] = 1.0 if options["shape"] else 0.0
    return options


def play(library, seed):
    """(name, arrays) of all that is computed on the way; a refusal ends what it is part of."""
    random = np.random.default_rng([seed, 20260])
    options = choose(random)
    components = 1 if options["friction"] == FRICTIONLESS else 3
    x1, facets1 = mesh(random, down=True, curved=random.choice([0.0, 0.2]))
    if options["mortar_side"] == ANALYTIC:
        x2, facets2 = frame(options["shape"], random), None
    else:
        x2, facets2 = mesh(random, down=False, curved=random.choice([0.0, -0.2]))
    x1[:, 2] += random.choice([0.0, 0.0, 0.02, -0.02, 1.5])
    move = random.normal(size=(3, 3)) * [0.08, 0.08, 0.02]
    strain, steps = random.choice([0.0, 0.02]), int(random.integers(1, 4))
    made = []
    try:
        made.append(Handle(library, x1, facets1, x2, facets2, components, options["mortar_side"] == 1, **options))
        handle = made[0]
        yield "start", [handle.start()]
        if random.random() < 0.2 and options["friction"] == 0:
            handle.set("friction", random.uniform(0, 1, len(x1)))
        if random.random() < 0.2:
            handle.set("augmentation", random.uniform(1, 20, len(x1)))
        for step in range(steps):
            one = x1 + move[step] + strain * random.normal(size=x1.shape)
            two = x2 + 0.3 * move[step - 1] + (0.0 if facets2 is None else strain * random.normal(size=x2.shape))
            lam = random.normal(size=(len(x1), components)) * 5
            if components == 3:
                lam[:, 2] -= 5 * random.integers(0, 3)  # a pressure: nu points up
            at = [np.ascontiguousarray(v) for v in (one, two, lam)]
            order = random.permutation(3)
            for which in order[: 2 + random.integers(2)]:
                name = ("residual", "tangent", "states")[which]
                yield name, getattr(handle, name)(at)
            handle.commit(at)
            if random.random() < 0.1:
                handle.rollback()
            history = handle.export()
            yield "history", history
            x1, x2 = (one, two) if random.random() < 0.7 else (x1, x2)
        if random.random() < 0.2:
            made.append(Handle(library, *initial_of(handle), components, options["mortar_side"] == 1, **options))
            made[1].take(history)
            yield "again", made[1].residual(at)
    except Refused as refusal:
        yield "status", [np.array([refusal.args[1]]), np.frombuffer(refusal.args[0].encode(), np.uint8)]
    finally:
        for handle in made:
            handle.close()


def initial_of(handle):
    """The meshes that a handle was made of."""
    x1, _, nodes1, offsets1, x2, _, nodes2, offsets2 = handle.kept[1:]
    split = lambda nodes, offsets: [list(map(int, nodes[a:b])) for a, b in zip(offsets, offsets[1:])]
    return x1, split(nodes1, offsets1), x2, split(nodes2, offsets2) or None


def digests(library, seed):
    return [[name, digest(*arrays)] for name, arrays in play(library, seed)]


def difference(one, two, seed):
    """By how much a history differs between two libraries, at the first place where it does, over the largest number
    there."""
    for (name, a), (other, b) in zip(play(Loaded.of(one), seed), play(Loaded.of(two), seed)):
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
