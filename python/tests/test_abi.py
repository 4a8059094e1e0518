"""Nothing of the header is forgotten, and what is wrong is refused by name."""

import dataclasses
import inspect
import re
from pathlib import Path
from types import SimpleNamespace
from typing import get_args

import numpy as np
import pytest
import scene
import stickslip
from stickslip import _library, errors, options

BAD_INPUT = Path(__file__).resolve().parents[2] / "tests" / "capi" / "bad_input.txt"
SOURCES = Path(stickslip.__file__).parent
# Functions of the header that the package does not wrap, and why.
NOT_WRAPPED = {
    "last_error_padded": "for Fortran",
    "options_method": "Interface.effects says the same of an interface",
    "status_string": "exceptions have names and messages",
    "interface_tangent_csr": "interface_plan has the same in place",
    "interface_pattern_coo": "interface_plan has the entries",
    "interface_plan_coo": "interface_plan_csr has the same",
    "interface_plan_coo32": "interface_plan_csr has the same",
    "interface_plan_csr32": "interface_plan_csr has the same",
    "skin_plan_coo32": "skin_plan_coo has the same",
    "interface_condensed_csr": "pieces of the condensed matrix and scipy's products",
    "interface_condensed_pattern": "scipy finds the pattern",
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
        bases = ", ".join(base.__name__ for base in made.__bases__)
        assert f"    class {made.__name__}({bases}): ...\n" in (SOURCES / "errors.py").read_text()  # for editors and type checkers
        assert made("why", status).status == status
    assert issubclass(errors.OutOfMemory, MemoryError) and issubclass(errors.IndexOutOfRange, IndexError)


def test_every_option_is_taken_by_its_name():
    for name in options.members():
        made, method = options.make({})
        if name not in ("index_base", "no_shortcuts"):
            prefix = options._PREFIX.get(name, name.upper())
            number = max(_library.words(prefix).values(), default=3)
            made, method = options.make({name: number if name != "weak_coverage" else 0.5})
            of = made if hasattr(made, name) else method
            assert getattr(of, name) == (number if name != "weak_coverage" else 0.5)


def test_options_are_spelt_out_with_their_words_and_defaults():
    spelt = stickslip.Options.__annotations__
    assert set(spelt) == {*options.members(), "basis", "method"} - {"index_base"}
    for name, kind in spelt.items():
        words = _library.words(options._PREFIX.get(options._SHORT.get(name, name), options._SHORT.get(name, name).upper()))
        if name not in ("method", "no_shortcuts", "weak_coverage") and words:
            assert set(get_args(kind)) == set(words), name
    for function in (stickslip.Interface, stickslip.Contact.add):
        parameters = inspect.signature(function).parameters
        assert set(spelt) <= set(parameters)
        assert (parameters["friction"].default, parameters["mu"].default, parameters["basis"].default) == ("coulomb", 0.0, "auto")


@pytest.mark.parametrize("name", ["states", "equilibrium", "report", "diagnosis", "counters"])
def test_results_have_the_names_of_the_header(name):
    # Lists that a caller has to make room for beforehand are not given.
    left_out = {"struct_size", "reserved", "text_capacity", "facets"} if name != "diagnosis" else \
        {"struct_size", "state", "text_capacity", *(f"suspect_{what}" for what in ("nodes", "directions", "ratios", "causes", "capacity"))}
    members = {member for member, _ in _library.ffi.typeof(f"struct stickslip_{name}").fields}
    own = {"bearing"} if name == "states" else set()
    assert {field.name for field in dataclasses.fields(getattr(stickslip, name.capitalize()))} == members - left_out | own


@pytest.mark.parametrize("name, made, own", [("skin_summary", stickslip.SkinReport, {"text"}), ("skin_sides", stickslip.SkinFacets, set())])
def test_results_of_a_skin_have_the_names_of_the_header(name, made, own):
    members = {member for member, _ in _library.ffi.typeof(f"struct stickslip_{name}").fields}
    assert {field.name for field in dataclasses.fields(made)} == members - {"struct_size"} | own


def test_what_is_shown(lines):
    assert repr(lines.interface) == "<Interface: 4 lines of 5 nodes on 3 lines of 4 nodes, coulomb, mu 0.3; no states yet>"
    states = lines.interface.states(*lines.pressed())
    assert str(states) == f"{(states.state == stickslip.State.GAP).sum()} gap 5 stick 0 slip" and repr(states) in repr([states])
    assert "last seen: 0 gap 5 stick 0 slip" in repr(lines.interface)
    lines.interface.close()
    assert "closed" in repr(lines.interface) and repr(lines.arguments[0]) == "<Surface: 4 lines of 5 nodes>"
    assert set(stickslip.__all__) <= set(dir(stickslip)) and not [name for name in dir(stickslip) if name[0] == "_" != name[1]]


def test_a_misspelt_word_lists_what_is_allowed(lines):
    with pytest.raises(ValueError, match="'auto', 'standard', 'dual'"):
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


def test_every_refusal_of_the_abi_is_raised(monkeypatch):
    """What tests/capi/bad_input.txt makes the library answer, and every status beside: through the one function that calls it."""
    rows = [line.split() for line in BAD_INPUT.read_text().splitlines() if line[:2] in ("C ", "CF")]
    answered = {word for row in rows for word in row if word in errors.statuses}
    assert len(rows) > 400 and len(answered) > 10
    for name, status in errors.statuses.items():
        answers = SimpleNamespace(stickslip_any=lambda status=status: status,
                                  stickslip_last_error_message=lambda: _library.ffi.new("char[]", b"why"))
        monkeypatch.setattr(_library, "lib", answers)
        with pytest.raises(stickslip.Error, match="^why$") as caught:
            _library.call("any")
        assert type(caught.value).__name__.lower() == name.replace("_", "").lower()
        assert caught.value.status == status
    # Nothing else calls the library, but for what cannot refuse.
    texts = "".join(path.read_text() for path in SOURCES.glob("*.py") if path.name != "_abi.py")
    assert set(re.findall(r"\blib\.stickslip_(\w+)", texts)) == {"version", "build", "last_error_message"}


# How an array is spoilt, and what is raised. Of an array of integers the last two mean nothing.
SPOILT = {
    "dtype": (lambda x: x.astype(np.float32), TypeError),
    "byte order": (lambda x: x.astype(x.dtype.newbyteorder()), TypeError),
    "shape": (lambda x: x[:-1].copy(), ValueError),
    "NaN": (lambda x: np.where(np.arange(x.size).reshape(x.shape) == 1, np.nan, x), ValueError),
    "infinite": (lambda x: np.where(np.arange(x.size).reshape(x.shape) == 0, -np.inf, x), ValueError),
}


def calls(made):
    """Every method that takes arrays: (method, good arrays by name)."""
    face, n1, d = made.interface, len(made.x1), made.x1.shape[1]
    x1, x2, lam = made.pressed()
    positions, point = {"x1": x1, "x2": x2}, {"x1": x1, "x2": x2, "lam": lam}
    host = {**point, "host1": np.zeros_like(x1)}
    condensed = stickslip.Condensed(face)
    plan = stickslip.Plan(face, x1, x2, made.size)
    sums = {} if made.options.get("basis") == "dual" else {"sums": face.sums(x1, x2)}
    history = face.history()
    m = 6 if d == 3 else 3
    parts = {"coordinates": made.x2, "node_equations": np.arange(made.x2.size).reshape(made.x2.shape) + 10,
             "point": np.zeros(d), "equations": np.arange(m)}
    body = stickslip.RigidBody(**parts)
    found = [
        (face.residual, {**point, **sums}), (face.states, {**point, **sums}), (face.equilibrium, {**point, **sums}),
        (lambda **given: face.tangent(**given, size=made.size), point), (plan.values, point), (face.diagnose, point),
        (face.report, positions), (face.sums, positions), (face.set_previous, positions),
        (lambda **given: stickslip.Plan(face, **given, size=made.size), positions),
        (face.step_limit, {**positions, "dx1": np.zeros_like(x1), "dx2": np.zeros_like(x2)}),
        (face.set_friction, {"mu": np.full(n1, 0.2)}), (face.set_augmentation, {"r": np.ones(n1)}),
        (face.set_normals, {"normals": np.tile(made.nu, (n1, 1))}),
        (face.set_committed, {**positions, "slip": np.zeros_like(x1)}),
        (face.turn_multipliers, {"x1": x1, "lam": lam}), (face.commit, {**point, **sums}),
        (stickslip.RigidBody, parts), (body.resultant, {"forces": np.zeros_like(made.x2)}),
        (lambda unknowns: setattr(body, "unknowns", unknowns), {"unknowns": np.zeros(m)}),
        (lambda turned: setattr(body, "turned", turned), {"turned": np.eye(3)}),
        (lambda **given: face.restore({**history, **given}), {"integers": history["integers"], "reals": history["reals"]}),
        (stickslip.Surface, {"coordinates": made.x1, "equations": np.arange(n1 * d).reshape(n1, d),
                             "multiplier_equations": np.arange(n1 * d).reshape(n1, d), "owned": np.ones(n1, np.int32)}),
    ]
    found[-1] = (lambda **given: stickslip.Surface(facets=[[0, 1]], **given), found[-1][1])
    if made.options.get("basis") == "dual":
        found += [(condensed.residual, host), (lambda **given: condensed.piece(**given, size=made.size, piece="forces"), point),
                  (condensed.multipliers, {**positions, "host1": host["host1"]}),
                  (lambda **given: stickslip.CondensedPlan(face, x1, x2, made.size).values(**given), point)]
    return found


@pytest.mark.parametrize("basis", ["standard", "dual"])
@pytest.mark.parametrize("how", SPOILT)
def test_bad_arrays_are_refused_by_name(basis, how):
    spoil, kind = SPOILT[how]
    tried = 0
    with scene.Plane(basis=basis) as made:
        for method, good in calls(made):
            for name, array in good.items():
                if how in ("NaN", "infinite") and array.dtype.kind != "f" or name in ("integers", "reals", "coordinates") \
                        and how == "shape":
                    continue  # a history and coordinates say their own length
                with pytest.raises(stickslip.Error, match=f"^{name}:") as caught:
                    method(**{**good, name: spoil(array)})
                assert isinstance(caught.value, kind)
                tried += 1
    assert tried > 40


@pytest.mark.parametrize("other", [np.asfortranarray, lambda x: np.repeat(x, 2, axis=0)[::2]])
def test_arrays_in_any_order_are_taken(lines, other):
    point = lines.pressed()
    assert not any(other(part).flags.c_contiguous for part in point)
    for ours, theirs in zip(lines.interface.residual(*map(other, point)), lines.interface.residual(*point)):
        np.testing.assert_array_equal(ours, theirs)
    first, second = (stickslip.Surface(other(side.coordinates), other(side.facet_nodes.reshape(-1, 2)), other(side.equations),
                                       None if side.multiplier_equations is None else other(side.multiplier_equations))
                     for side in lines.arguments)
    with stickslip.Interface(first, second, **lines.options) as face:
        assert (face.tangent(*point, lines.size) != lines.interface.tangent(*point, lines.size)).nnz == 0
    with pytest.raises(TypeError, match="^lam: .* in C order"):  # it is written to
        lines.interface.turn_multipliers(point[0], other(point[2]))


def test_what_a_call_writes_to_must_be_writable(lines):
    x1, _, lam = lines.pressed()
    with pytest.raises(TypeError, match="^lam: list"):
        lines.interface.turn_multipliers(x1, lam.tolist())
    lam.flags.writeable = False
    with pytest.raises(ValueError, match="^lam: read-only"):
        lines.interface.turn_multipliers(x1, lam)
    with pytest.raises(ValueError, match="^out: read-only"):
        lines.interface.initial_multipliers(out=lam)
    # What is read may be read-only.
    lines.interface.residual(x1, lines.x2, lam)


def test_outputs(lines):
    point = lines.pressed()
    out = tuple(np.empty_like(part) for part in (point[0], point[1], point[2]))
    got = lines.interface.residual(*point, out=out)
    assert all(a is b for a, b in zip(got, out))
    out[1].flags.writeable = False
    with pytest.raises(ValueError, match="^force2: read-only"):
        lines.interface.residual(*point, out=out)


def test_lists_are_not_cut_off(lines):
    with pytest.raises(TypeError, match="^equations: float64, integers"):
        stickslip.Surface(lines.x1, [[0, 1]], (np.arange(10).reshape(5, 2) + 0.5).tolist())
    with pytest.raises(TypeError, match="^x1: complex128, numbers"):
        lines.interface.report((lines.x1 + 1j).tolist(), lines.x2)
    with pytest.raises(ValueError, match="^x1: "):
        lines.interface.report([[0.0, 0.0], [1.0]], lines.x2)
    with pytest.raises(TypeError, match="^threads: 2.5, an integer"):
        stickslip.Interface(*lines.arguments, modulus=1.0, model="plane", threads=2.5)
    with pytest.raises(TypeError, match="^mu: None, a number"):
        stickslip.Interface(*lines.arguments, modulus=1.0, model="plane", mu=None)
    with pytest.raises(ValueError, match=r"^size: 3, and there is an equation \d+; at least"):
        stickslip.Plan(lines.interface, lines.x1, lines.x2, 3)


def test_integers_of_32_bits_are_taken(lines):
    first, second = lines.arguments
    taken = stickslip.Surface(first.coordinates, first.facet_nodes.reshape(-1, 2), first.equations.astype(np.int32),
                              first.multiplier_equations.astype(np.int32))
    with stickslip.Interface(taken, second, **lines.options) as face:
        point = lines.pressed()
        assert (face.tangent(*point, lines.size) != lines.interface.tangent(*point, lines.size)).nnz == 0


def test_a_closed_interface_refuses_in_the_same_family(lines):
    lines.interface.close()
    with pytest.raises(stickslip.Error, match="closed"):
        lines.interface.rollback()


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
