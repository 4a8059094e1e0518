"""The library's C calls that Python tests make without the driver, through ctypes on the shared library.

Only what they use. A refusal is raised as Refused, with the call, the status and the library's message.
"""

import ctypes
import os
from ctypes import byref, c_char_p, c_double, c_int32, c_int64, c_uint64, c_void_p
from pathlib import Path

import numpy as np

DEGREE_5, DEGREE_10 = 0, 1
GAP, STICK, SLIP = 0, 1, 2
STATES = ("gap", "stick", "slip")
SPACES = ("corner", "sub")  # where the multipliers of quadratic facets stand, in the header's order
CORNERS = {3: 3, 4: 4, 6: 3, 8: 4, 9: 4}  # of a facet, by its number of nodes
ENDS = {2: 2, 3: 2}  # the same of a line


class Refused(Exception):
    def __init__(self, call, status, text):
        super().__init__(text)
        self.call, self.status = call, status


def pointer(array):
    return None if array is None else array.ctypes.data_as(c_void_p)


def struct(name, *members):
    """A struct of the header: struct_size first."""
    fields = [("struct_size", c_uint64), *members]
    made = type(name, (ctypes.Structure,), {"_fields_": fields})
    original = made.__init__

    def initialise(self, **values):
        original(self, struct_size=ctypes.sizeof(made), **values)

    made.__init__ = initialise
    return made


Pair = struct(
    "Pair",
    ("n1", c_int32),
    ("n2", c_int32),
    ("x1", c_void_p),
    ("x2", c_void_p),
    ("quadrature", c_int32),
    ("layout", c_int32),
    ("element_points", c_int64),
    ("neighbour_normals", c_void_p),
    ("multiplier_space", c_int32),
    ("model", c_int32),
    ("thickness", c_double),
)
Node = struct(
    "Node",
    ("slip", c_int32),
    ("n_directions", c_int32),
    ("lambda_", c_double * 3),
    ("normal", c_double * 3),
    ("augmentation", c_double),
    ("mu", c_double),
    ("coverage", c_double),
    ("coverage_previous", c_double),
    ("coverage_min", c_double),
    ("gap_now", c_double * 3),
    ("gap_previous", c_double * 3),
    ("gap_committed", c_double * 3),
    ("directions", c_double * 6),
    ("friction", c_int32),
    ("reserved", c_int32),
    ("shear_limit", c_double),
)
Response = struct(
    "Response",
    ("state", c_int32),
    ("reserved", c_int32),
    ("traction", c_double * 3),
    ("row", c_double * 3),
    ("gap_normal", c_double),
    ("slip", c_double * 3),
    ("sigma", c_double * 3),
    ("dp_dlambda", c_double * 9),
    ("drow_dlambda", c_double * 9),
    ("drow_dnow", c_double * 9),
    ("drow_dprevious", c_double * 9),
)
INTEGERS = ("form", "slip", "weights", "basis", "normals", "multiplier_space", "decision", "quadrature", "row_scale",
            "new_contact", "integration", "tangent", "no_shortcuts", "threads")
Method = struct(
    "Method",
    *((name, c_int32) for name in INTEGERS),
    ("element_points", c_int64),
    ("augmentation", c_double),
    ("coverage_min", c_double),
    ("weak_coverage", c_double),
    ("turn_max", c_double),
)
Options = struct(
    "Options",
    ("method", ctypes.POINTER(Method)),
    *((name, c_int32) for name in ("friction", "mortar_side", "shape", "model", "small_displacements", "index_base")),
    *((name, c_double) for name in ("mu", "shear_limit", "thickness", "radius", "modulus", "search_distance")),
)
Surface = struct(
    "Surface",
    ("n_nodes", c_int64),
    ("n_facets", c_int64),
    ("coordinates", c_void_p),
    ("facet_offsets", c_void_p),
    ("facet_nodes", c_void_p),
    ("equations", c_void_p),
    ("multiplier_equations", c_void_p),
    ("owned", c_void_p),
)
States = struct(
    "States",
    *(
        (name, c_void_p)
        for name in ("state", "normal", "traction", "gap", "slip", "coverage", "area", "dissipation", "augmentation")
    ),
)

Law = struct(
    "Law",
    ("kind", c_int32),
    ("reserved", c_int32),
    ("cohesion", c_double),
    ("mu_after", c_double),
    ("critical_slip", c_double),
    ("mu_across", c_double),
    ("direction", c_double * 3),
)
SUMS = 11  # numbers a node of stickslip_interface_sums

# What the library chooses by the other options.
AUTO = 0
# STICKSLIP_BASIS_..., STICKSLIP_NORMALS_..., STICKSLIP_WEIGHTS_...
STANDARD, DUAL = 1, 2
OF_COMMIT, OF_NOW = 1, 2
CURRENT, COMMITTED, REFERENCE = 1, 2, 3

# The variable of the environment that says which multipliers the matrix is about, where they are not the library's choice, and the
# library's numbers of them.
BASIS = "STABILITY_BASIS"
BASES = {"standard": STANDARD, "dual": DUAL}
# The same of the normals. Where weights are frozen, normals are committed whatever it says.
NORMALS = "STABILITY_NORMALS"
NORMALS_OF = {"committed": OF_COMMIT, "current": OF_NOW}


def basis_in_question():
    """Which multipliers nodes at corners have."""
    return os.environ.get(BASIS, "dual")


def spaces_in_question():
    """Where they may stand: at all nodes not where they are asked to be dual."""
    return SPACES[:1] if os.environ.get(BASIS) == "dual" else SPACES


def normals_in_question():
    """Where weights are those of now."""
    return os.environ.get(NORMALS, "current")


def fade(c, space="corner"):
    """phi: facets of which less than a hundredth is covered fade out with dual multipliers (docs/formulation 10.5)."""
    s = min(max((c - 1e-4) / (1e-2 - 1e-4), 0.0), 1.0)
    return s**2 * (3 - 2 * s) if space == "corner" and basis_in_question() == "dual" else 1.0


class Library:
    def __init__(self, path):
        self.c = ctypes.CDLL(str(Path(path).resolve()))
        self.c.stickslip_last_error_message.restype = c_char_p
        self.c.stickslip_status_string.restype = c_char_p

    def call(self, name, *arguments):
        status = getattr(self.c, f"stickslip_{name}")(*arguments)
        if status:
            words = self.c.stickslip_status_string(status).decode()
            text = f"status {status} ({words}): {self.c.stickslip_last_error_message().decode()}"
            raise Refused(name, status, text)

    def weights(self, x1, x2, derivatives=False, quadrature=DEGREE_5, space="corner", **model):
        """n_ab, n_ac of a pair, and with `derivatives` dn_ab, dn_ac behind them. Lines: with a model, and its thickness."""
        x1, x2 = (np.ascontiguousarray(x, float) for x in (x1, x2))
        (n1, dimension), n2 = x1.shape, len(x2)
        pair = Pair(n1=n1, n2=n2, x1=pointer(x1), x2=pointer(x2), quadrature=quadrature, **model)
        pair.multiplier_space = SPACES.index(space)
        rows = (ENDS if model else CORNERS)[n1] if space == "corner" else n1
        out = [np.zeros((rows, n1)), np.zeros((rows, n2))]
        if derivatives:
            out += [np.zeros((rows, n, dimension * (n1 + n2))) for n in (n1, n2)]
        self.call("pair_weights", byref(pair), *map(pointer, out), *([None, None] if not derivatives else []))
        return out

    def respond(self, **node):
        """The law's answer for one node; vectors as sequences."""
        values = {k: (c_double * len(v))(*v) if np.ndim(v) else v for k, v in node.items()}
        response = Response()
        self.call("node_respond", byref(Node(**values)), byref(response))
        return response


def mid_nodes(n_nodes, facets, corners=CORNERS):
    """Which nodes are no facet's corner."""
    found = np.ones(n_nodes, bool)
    for f in facets:
        found[f[: corners[len(f)]]] = False
    return found


class Interface:
    """Two surfaces: x (n, 3), facets of 3, 4, 6, 8 or 9 nodes each; `facets2` None: an analytic surface, of which x2 is the frame.
    `components`: multipliers a node has, 1 without friction. Equations are counted through x1, x2, lambda; a mortar side
    that is analytic or `rigid` has none, unless its `frame` has. A point is given as x1, x2, lambda. With lines (`model`) x is (n, 2)."""

    def __init__(self, library, x1, facets1, x2, facets2, components=None, rigid=False, frame=False, **options):
        self.dimension = dimension = 2 if options.get("model") else 3
        self.library, self.components = library, components or dimension
        components = self.components
        self.n1, self.n2 = len(x1), len(x2)
        self.unknowns = (dimension + components) * self.n1 + dimension * self.n2
        numbers = np.arange(self.unknowns, dtype=np.int64)
        one, two, multipliers = np.split(numbers, [dimension * self.n1, dimension * (self.n1 + self.n2)])
        if rigid or (facets2 is None and not frame):
            two = np.full_like(two, -1)
        self.kept = []
        sides = [self.surface(x1, facets1, one), self.surface(x2, facets2, two)]
        if options.get("multiplier_space", 0) == 0:
            multipliers.reshape(-1, components)[mid_nodes(len(x1), facets1, CORNERS if dimension == 3 else ENDS)] = -1
        sides[0].multiplier_equations = self.keep(multipliers, np.int64)
        chosen, method = Options(), Method()
        library.call("options_init", byref(chosen), c_uint64(chosen.struct_size))
        chosen.method = ctypes.pointer(method)
        method.basis = BASES.get(os.environ.get(BASIS), AUTO)
        if options.get("weights", CURRENT) == CURRENT:
            method.normals = NORMALS_OF.get(os.environ.get(NORMALS), AUTO)
        for name, value in options.items():
            setattr(chosen if hasattr(chosen, name) else method, name, value)
        self.handle = c_void_p()
        library.call("interface_create", byref(sides[0]), byref(sides[1]), byref(chosen), byref(self.handle))

    def keep(self, values, kind=float):
        """A pointer to a copy that lives as long as this object."""
        self.kept.append(np.ascontiguousarray(values, kind))
        return pointer(self.kept[-1])

    def surface(self, x, facets, equations):
        made = Surface(n_nodes=len(x), coordinates=self.keep(x), equations=self.keep(equations, np.int64))
        if facets is not None:
            made.n_facets = len(facets)
            made.facet_offsets = self.keep(np.cumsum([0, *map(len, facets)]), np.int64)
            made.facet_nodes = self.keep(np.concatenate(list(facets)), np.int64)
        return made

    def call(self, name, at, *arguments, sums=None):
        """A call of the interface at a point; `sums`: those of several handles."""
        x1, x2, lam = (np.ascontiguousarray(v, float) for v in at)
        self.library.call(f"interface_{name}", self.handle, *map(pointer, (x1, x2, lam, sums)), *arguments)

    def close(self):
        self.library.call("interface_destroy", byref(self.handle))

    def set(self, what, values):
        """A value a node: "friction", "augmentation", "normals"."""
        values = np.ascontiguousarray(values, float)
        self.library.call(f"interface_set_{what}", self.handle, pointer(values))

    def start(self):
        """The multipliers to start with."""
        out = np.zeros((self.n1, self.components))
        self.library.call("interface_initial_multipliers", self.handle, pointer(out))
        return out

    def sums(self, x1, x2):
        """This handle's share of what the nodes assemble."""
        x1, x2 = (np.ascontiguousarray(x, float) for x in (x1, x2))
        out = np.zeros((self.n1, SUMS))
        self.library.call("interface_sums", self.handle, *map(pointer, (x1, x2, out)))
        return out

    def residual(self, *at, sums=None):
        """f1, f2, rows"""
        out = [np.zeros((self.n1, self.dimension)), np.zeros((self.n2, self.dimension)), np.zeros((self.n1, self.components))]
        self.call("residual", at, *map(pointer, out), sums=sums)
        return out

    def triplets(self, *at):
        """The tangent's rows, columns, values."""
        count = c_int64()
        self.call("tangent_coo", at, c_int64(0), None, None, None, byref(count))
        out = [np.zeros(count.value, np.int64), np.zeros(count.value, np.int64), np.zeros(count.value)]
        self.call("tangent_coo", at, count, *map(pointer, out), byref(count))
        return out

    def tangent(self, *at):
        """Dense, rows and columns x1, x2, lambda."""
        rows, columns, values = self.triplets(*at)
        matrix = np.zeros((self.unknowns, self.unknowns))
        np.add.at(matrix, (rows, columns), values)
        return matrix

    def piece(self, piece, *at):
        """A piece of the system without multipliers, dense, by the displacements."""
        at = [np.ascontiguousarray(v, float) for v in at]
        count, n = c_int64(), self.dimension * (self.n1 + self.n2)
        call = lambda capacity, out: self.library.call(
            "interface_condensed_coo", self.handle, *map(pointer, at), c_int32(piece), capacity, *out, byref(count)
        )
        call(c_int64(0), (None, None, None))
        out = [np.zeros(count.value, np.int64), np.zeros(count.value, np.int64), np.zeros(count.value)]
        call(count, map(pointer, out))
        matrix = np.zeros((n, n))
        np.add.at(matrix, (out[0], out[1]), out[2])
        return matrix

    def condensed(self, x1, x2, host1):
        """The multipliers that balance the host's own forces at the non-mortar nodes, the rows in their place, and the forces at the
        mortar nodes."""
        x1, x2, host1 = (np.ascontiguousarray(v, float) for v in (x1, x2, host1))
        lam, rows, forces = np.zeros((self.n1, self.components)), np.zeros_like(x1), np.zeros_like(x2)
        self.library.call("interface_condensed_multipliers", self.handle, *map(pointer, (x1, x2, host1, lam)))
        self.library.call("interface_condensed_residual", self.handle, *map(pointer, (x1, x2, lam, host1, rows, forces)))
        return lam, rows, forces

    def states(self, *at):
        """What the nodes do, by the names of the header's struct."""
        out = {"state": np.zeros(self.n1, np.int32)}
        out |= {name: np.zeros((self.n1, self.dimension)) for name in ("normal", "traction", "slip")}
        out |= {name: np.zeros(self.n1) for name in ("gap", "coverage", "area", "dissipation", "augmentation")}
        wanted = States(**{name: pointer(array) for name, array in out.items()})
        self.call("states", at, byref(wanted))
        return out

    def commit(self, *at):
        self.call("commit", at)

    def rollback(self):
        self.library.call("interface_rollback", self.handle)

    def history(self):
        """The history, as integers and reals."""
        lengths = [c_int64(), c_int64()]
        self.library.call("interface_history_size", self.handle, *map(byref, lengths))
        out = [np.zeros(lengths[0].value, np.int64), np.zeros(lengths[1].value)]
        self.library.call("interface_history_export", self.handle, lengths[0], pointer(out[0]), lengths[1], pointer(out[1]))
        return out

    def restore(self, history):
        integers, reals = history
        arguments = (c_int64(len(integers)), pointer(integers), c_int64(len(reals)), pointer(reals))
        self.library.call("interface_history_import", self.handle, *arguments)
