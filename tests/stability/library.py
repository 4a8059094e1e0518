"""The library's C calls that the matrix makes without the driver, through ctypes on the shared library.

Only what the cells use. A refusal is raised as Refused, with the status and the library's message.
"""

import ctypes
from ctypes import byref, c_char_p, c_double, c_int32, c_int64, c_uint64, c_void_p

import numpy as np

DEGREE_5, DEGREE_10 = 0, 1
GAP, STICK, SLIP = 0, 1, 2
STATES = ("gap", "stick", "slip")


class Refused(Exception):
    pass


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
Options = struct(
    "Options",
    *(
        (name, c_int32)
        for name in (
            "form",
            "slip",
            "weights",
            "friction",
            "mortar_side",
            "basis",
            "quadrature",
            "row_scale",
            "new_contact",
            "index_base",
        )
    ),
    ("mu", c_double),
    ("augmentation", c_double),
    ("modulus", c_double),
    ("coverage_min", c_double),
    ("search_distance", c_double),
    ("no_shortcuts", c_int32),
    ("shape", c_int32),
    ("radius", c_double),
    ("integration", c_int32),
    ("tangent", c_int32),
    ("element_points", c_int64),
    ("weak_coverage", c_double),
    ("turn_max", c_double),
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


class Library:
    def __init__(self, build):
        self.c = ctypes.CDLL(str(build / "lib" / "libstickslip.so"))
        self.c.stickslip_last_error_message.restype = c_char_p
        self.c.stickslip_status_string.restype = c_char_p

    def call(self, name, *arguments):
        status = getattr(self.c, f"stickslip_{name}")(*arguments)
        if status:
            words = self.c.stickslip_status_string(status).decode()
            raise Refused(f"status {status} ({words}): {self.c.stickslip_last_error_message().decode()}")

    def weights(self, x1, x2, derivatives=False, quadrature=DEGREE_5):
        """n_ab, n_ac of a pair, and with `derivatives` dn_ab, dn_ac behind them."""
        x1, x2 = (np.ascontiguousarray(x, float) for x in (x1, x2))
        n1, n2 = len(x1), len(x2)
        pair = Pair(n1=n1, n2=n2, x1=pointer(x1), x2=pointer(x2), quadrature=quadrature)
        out = [np.empty((n1, n1)), np.empty((n1, n2))]
        if derivatives:
            out += [np.empty((n1, n, 3 * (n1 + n2))) for n in (n1, n2)]
        self.call("pair_weights", byref(pair), *map(pointer, out), *([None, None] if not derivatives else []))
        return out

    def respond(self, **node):
        """The law's answer for one node; vectors as sequences."""
        values = {k: (c_double * len(v))(*v) if np.ndim(v) else v for k, v in node.items()}
        response = Response()
        self.call("node_respond", byref(Node(**values)), byref(response))
        return response


class Interface:
    """Two surfaces of facets of one kind: x (n, 3), facets (m, 3 or 4). Equations are counted through x1, x2,
    lambda."""

    def __init__(self, library, x1, facets1, x2, facets2, **options):
        self.library, self.n1, self.n2 = library, len(x1), len(x2)
        self.unknowns = 6 * self.n1 + 3 * self.n2
        numbers = np.arange(self.unknowns, dtype=np.int64)
        split = np.split(numbers, [3 * self.n1, 3 * (self.n1 + self.n2)])
        self.kept, sides = [], []
        for x, facets, equations in ((x1, facets1, split[0]), (x2, facets2, split[1])):
            facets = np.ascontiguousarray(facets, np.int64)
            offsets = np.arange(len(facets) + 1, dtype=np.int64) * facets.shape[1]
            x, equations = np.ascontiguousarray(x, float), np.ascontiguousarray(equations)
            self.kept += [x, facets, offsets, equations]
            sides.append(
                Surface(
                    n_nodes=len(x),
                    n_facets=len(facets),
                    coordinates=pointer(x),
                    facet_offsets=pointer(offsets),
                    facet_nodes=pointer(facets),
                    equations=pointer(equations),
                )
            )
        multipliers = np.ascontiguousarray(split[2])
        sides[0].multiplier_equations = pointer(multipliers)
        chosen = Options()
        library.call("options_init", byref(chosen), c_uint64(chosen.struct_size))
        for name, value in options.items():
            setattr(chosen, name, value)
        self.handle = c_void_p()
        library.call("interface_create", byref(sides[0]), byref(sides[1]), byref(chosen), byref(self.handle))

    def close(self):
        self.library.call("interface_destroy", byref(self.handle))

    def residual(self, x1, x2, lam):
        """f1, f2, rows"""
        x1, x2, lam = (np.ascontiguousarray(v, float) for v in (x1, x2, lam))
        out = [np.empty((self.n1, 3)), np.empty((self.n2, 3)), np.empty((self.n1, 3))]
        self.library.call("interface_residual", self.handle, *map(pointer, (x1, x2, lam)), None, *map(pointer, out))
        return out

    def tangent(self, x1, x2, lam):
        """Dense, rows and columns x1, x2, lambda."""
        state = [np.ascontiguousarray(v, float) for v in (x1, x2, lam)]
        count = c_int64()
        self.library.call(
            "interface_tangent_coo",
            self.handle,
            *map(pointer, state),
            None,
            c_int64(0),
            None,
            None,
            None,
            byref(count),
        )
        rows, columns = (np.empty(count.value, np.int64) for _ in range(2))
        values = np.empty(count.value)
        self.library.call(
            "interface_tangent_coo",
            self.handle,
            *map(pointer, state),
            None,
            count,
            pointer(rows),
            pointer(columns),
            pointer(values),
            byref(count),
        )
        matrix = np.zeros((self.unknowns, self.unknowns))
        np.add.at(matrix, (rows, columns), values)
        return matrix

    def states(self, x1, x2, lam):
        """state, gap, coverage, area of the nodes"""
        state = [np.ascontiguousarray(v, float) for v in (x1, x2, lam)]
        out = {"state": np.empty(self.n1, np.int32)}
        out |= {name: np.empty(self.n1) for name in ("gap", "coverage", "area")}
        wanted = States(**{name: pointer(array) for name, array in out.items()})
        self.library.call("interface_states", self.handle, *map(pointer, state), None, byref(wanted))
        return out

    def start(self):
        lam = np.empty((self.n1, 3))
        self.library.call("interface_initial_multipliers", self.handle, pointer(lam))
        return lam

    def commit(self, x1, x2, lam):
        state = [np.ascontiguousarray(v, float) for v in (x1, x2, lam)]
        self.library.call("interface_commit", self.handle, *map(pointer, state), None)
