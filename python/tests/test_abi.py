"""Nothing of the header is forgotten, and what is wrong is refused by name."""

import re
from pathlib import Path

import numpy as np
import pytest
import scene
import stickslip
from stickslip import _library, errors, options

SOURCES = Path(stickslip.__file__).parent
# Functions of the header that the package does not wrap, and why.
NOT_WRAPPED = {
    "last_error_padded": "for Fortran",
    "status_string": "exceptions have names and messages",
    "interface_tangent_csr": "interface_plan has the same in place",
    "interface_pattern_coo": "interface_plan has the entries",
    "interface_plan_coo": "interface_plan_csr has the same",
    "interface_plan_coo32": "interface_plan_csr has the same",
    "interface_plan_csr32": "interface_plan_csr has the same",
    "interface_condensed_csr": "pieces of the condensed matrix and scipy's products",
    "interface_condensed_pattern": "scipy finds the pattern",
    "interface_condensed_plan": "not yet",
    "interface_condensed_values": "not yet",
    "interface_carriers": "not yet",
    "surface_split_creases": "not yet",
    "crosspoints_find": "not yet",
}
# The stateless stages are for codes that assemble pair by pair.
NOT_WRAPPED_PREFIXES = ("pair_", "facet_", "node_")


def declared():
    return [name.removeprefix("stickslip_") for name in dir(_library.lib) if name.startswith("stickslip_")]


def called(name):
    text = "".join(path.read_text() for path in SOURCES.glob("*.py") if path.name != "_abi.py")
    short = name.removeprefix("interface_")
    return re.search(rf'_?call\(\s*"({name}|{short})"|lib\.stickslip_{name}\b', text) is not None


def test_every_function_is_wrapped_or_named():
    names = declared()
    assert len(names) > 60
    for name in names:
        listed = name in NOT_WRAPPED or name.startswith(NOT_WRAPPED_PREFIXES)
        assert called(name) != listed, name


def test_every_status_has_a_class_of_its_own():
    known = {number for number in range(-100, 1000)
             if number and _library.text(_library.lib.stickslip_status_string(number))
             != _library.text(_library.lib.stickslip_status_string(10_000))}
    assert known == set(errors.by_status) and len(known) >= 20
    assert len({made.__name__ for made in errors.by_status.values()}) == len(known)
    for status, made in errors.by_status.items():
        assert issubclass(made, stickslip.Error) and made.status == status
        assert made("why", status).status == status
    assert issubclass(errors.OutOfMemory, MemoryError) and issubclass(errors.IndexOutOfRange, IndexError)


def test_every_option_is_taken_by_its_name():
    for name in options.members():
        made = options.make({})
        if name not in ("index_base", "no_shortcuts"):
            prefix = options._PREFIX.get(name, name.upper())
            number = max(_library.words(prefix).values(), default=3)
            made = options.make({name: number if name != "weak_coverage" else 0.5})
            assert getattr(made, name) == (number if name != "weak_coverage" else 0.5)


def test_a_misspelt_word_lists_what_is_allowed(lines):
    with pytest.raises(ValueError, match="'standard', 'dual'"):
        stickslip.Interface(*lines.arguments, modulus=1.0, model="plane", basis="daul")
    with pytest.raises(TypeError, match="modulos"):
        stickslip.Interface(*lines.arguments, modulos=1.0)
    with pytest.raises(ValueError, match="multiplier_equations"):
        stickslip.Interface(*lines.arguments, modulus=1.0, model="plane", friction="none")


def test_statuses_of_the_library_are_raised(lines):
    with pytest.raises(errors.MissingStiffness) as caught:
        stickslip.Interface(*lines.arguments, model="plane")
    assert caught.value.status == _library.constants["MISSING_STIFFNESS"]
    surface = stickslip.Surface(lines.x1, [[0, 99]], multiplier_equations=np.arange(10).reshape(5, 2))
    with pytest.raises(IndexError):
        stickslip.Interface(surface, lines.arguments[1], model="plane", modulus=1.0)


@pytest.mark.parametrize("spoil, kind", [
    (lambda x: x.astype(np.float32), TypeError),
    (lambda x: np.asfortranarray(x), ValueError),
    (lambda x: x[:-1].copy(), ValueError),
    (lambda x: np.where(np.arange(x.size).reshape(x.shape) == 3, np.nan, x), ValueError),
])
def test_bad_arrays_are_refused_by_name(lines, spoil, kind):
    point = list(lines.pressed())
    for place, name in enumerate(("x1", "x2", "lam")):
        bad = list(point)
        bad[place] = spoil(point[place])
        with pytest.raises(kind, match=f"^{name}:"):
            lines.interface.residual(*bad)


def test_outputs(lines):
    point = lines.pressed()
    out = tuple(np.empty_like(part) for part in (point[0], point[1], point[2]))
    got = lines.interface.residual(*point, out=out)
    assert all(a is b for a, b in zip(got, out))
    out[1].flags.writeable = False
    with pytest.raises(ValueError, match="^force2: read-only"):
        lines.interface.residual(*point, out=out)


def test_lists_are_converted(lines):
    point = lines.pressed()
    lists = [part.tolist() for part in point]
    for ours, theirs in zip(lines.interface.residual(*lists), lines.interface.residual(*point)):
        np.testing.assert_array_equal(ours, theirs)


def test_mixed_facets_and_a_closed_interface():
    x, _ = scene.grid(2, 0, 1, 0, True)
    surface = stickslip.Surface(x, [[0, 1, 4, 3], [1, 2, 5, 4], [3, 4, 7, 6], [4, 5, 8], [4, 8, 7]],
                                multiplier_equations=np.arange(27))
    below, facets = scene.grid(2, 0, 1, 0, False)
    face = stickslip.Interface(surface, stickslip.Surface(below, facets), modulus=1.0)
    face.close()
    face.close()
    with pytest.raises(ValueError, match="closed"):
        face.rollback()
