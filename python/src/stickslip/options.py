"""Options by their names in the header, choices as words of its constants."""

import inspect
import operator
from collections.abc import Callable, Sequence
from typing import Any, Literal, TypedDict

from ._library import call, constants, ffi, value_of, words

# A member's name is the constants' prefix, but for these.
_PREFIX = {"multiplier_basis": "BASIS", "mortar_side": "MORTAR", "no_shortcuts": "SHORTCUT", "multiplier_space": "SPACE"}
# Short names of the interface's arguments.
_SHORT = {"basis": "multiplier_basis"}
_INTEGERS = ("index_base", "threads", "element_points", "small_displacements")


class Options(TypedDict, total=False):
    """Options of an interface. A test holds them together with the header, which explains each. What is left out has the default."""

    #: Young's modulus of the softer body [F/L^2]: it or ``augmentation`` is needed.
    modulus: float
    friction: Literal["coulomb", "none", "tied", "rough", "tresca"]
    #: The coefficient of friction, 0.
    mu: float
    #: Of "tresca" [F/L^2].
    shear_limit: float
    model: Literal["solid", "plane", "axisymmetric"]
    #: Of plane models, 1 [L].
    thickness: float
    mortar_side: Literal["deformable", "rigid", "analytic"]
    #: Of an analytic mortar side, with its radius [L], below 0 of a cavity.
    shape: Literal["plane", "sphere", "cylinder"]
    radius: float
    #: 1: weights and normals stay those of the first configuration.
    small_displacements: int
    #: Facets farther apart than this are no pair [L].
    search_distance: float
    #: "paper": the paper's element; else as below.
    method: Literal["default", "paper"]
    basis: Literal["auto", "standard", "dual"]
    multiplier_basis: Literal["auto", "standard", "dual"]
    #: "sub": mid nodes of quadratic facets have multipliers, too.
    multiplier_space: Literal["corner", "sub"]
    weights: Literal["auto", "current", "committed", "reference", "conserving"]
    normals: Literal["auto", "committed", "current"]
    #: A number, or "none".
    weak_coverage: float | Literal["none"]
    #: How far a surface may turn in a step where that counts, pi / 9.
    turn_max: float
    form: Literal["multiplier", "augmented"]
    slip: Literal["objective", "increment", "paper"]
    decision: Literal["nodes", "points"]
    quadrature: Literal["degree_5", "degree_10", "degree_1", "degree_2", "degree_4", "degree_6"]
    row_scale: Literal["force", "none"]
    new_contact: Literal["frictionless", "keep"]
    integration: Literal["segments", "elements", "hybrid"]
    tangent: Literal["exact", "frozen_weights", "frozen_normals"]
    no_shortcuts: int | str | Sequence[str]
    threads: int
    element_points: int
    augmentation: float
    coverage_min: float


def with_options(function: Any) -> inspect.Signature:
    """The signature of a function with ``**options`` spelt out, for help and completion."""
    named = inspect.signature(function).parameters.values()
    options = [inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=_default(name), annotation=kind)
               for name, kind in Options.__annotations__.items()]
    return inspect.Signature([p for p in named if p.kind is not p.VAR_KEYWORD] + options)


def _default(name: str) -> Any:
    """What an option is where it is left out."""
    if name == "method":
        return "default"
    name = _SHORT.get(name, name)
    made, method = make({})
    number = getattr(made if name in _fields(_OPTIONS) else method, name)
    allowed = words(_PREFIX.get(name, name.upper()))
    return next((word for word, value in allowed.items() if value == number and name != "no_shortcuts"), number)


_OPTIONS, _METHOD = "struct stickslip_options", "struct stickslip_method"


def members() -> list[str]:
    """Every option and every member of the method that the header has."""
    return [*_fields(_OPTIONS), *_fields(_METHOD)]


def _fields(struct: str) -> dict[str, str]:
    fields = ffi.typeof(struct).fields
    return {name: field.type.cname for name, field in fields if name not in ("struct_size", "method")}


def make(given: dict[str, Any]) -> tuple[Any, Any]:
    """The C struct: the library's defaults, or the paper's element (``method="paper"``), then what was given. What it points to
    comes second, and has to live as long."""
    out, method = ffi.new(f"{_OPTIONS} *"), ffi.new(f"{_METHOD} *")
    call("options_init", out, ffi.sizeof(_OPTIONS))
    method.struct_size = ffi.sizeof(_METHOD)
    given = dict(given)
    kind = given.pop("method", "default")
    if kind not in ("default", "paper"):
        raise ValueError(f"method: {kind!r}; 'default' and 'paper' are possible")
    if kind == "paper":
        call("options_paper", out)
        method[0] = out.method[0]
    out.method = method
    of = {**dict.fromkeys(_fields(_OPTIONS), out), **dict.fromkeys(_fields(_METHOD), method)}
    for name, value in given.items():
        name = _SHORT.get(name, name)
        if name not in of:
            raise TypeError(f"{name}: no option; there are method, {', '.join(of)}")
        setattr(of[name], name, _number(name, value))
    if out.index_base != 0:
        raise ValueError("index_base: 0 is needed, as arrays of Python count from 0")
    return out, method


def _number(name: str, value: Any) -> Any:
    kind = {**_fields(_OPTIONS), **_fields(_METHOD)}[name]
    if kind == "double":
        if name == "weak_coverage" and value == "none":
            return constants["WEAK_COVERAGE_NONE"]
        return _taken(name, value, float, "a number")
    if name in _INTEGERS:
        return _taken(name, value, operator.index, "an integer")
    prefix = _PREFIX.get(name, name.upper())
    if name == "no_shortcuts":
        return _sum(value, prefix)
    return value_of(name, prefix, value)


def _taken(name: str, value: Any, take: Callable[[Any], Any], what: str) -> Any:
    try:
        if isinstance(value, str):
            raise TypeError
        return take(value)
    except (TypeError, ValueError):
        raise TypeError(f"{name}: {value!r}, {what} is needed") from None


def _sum(value: Any, prefix: str) -> int:
    """Shortcuts add up: a number, or words in a list."""
    if isinstance(value, int):
        return value
    listed = [value] if isinstance(value, str) else value
    return sum(value_of("no_shortcuts", prefix, word) for word in set(listed))


def word(prefix: str, number: int) -> str:
    """The word of a number, as in ``word("STATE", 1) == "stick"``."""
    return next(name for name, value in words(prefix).items() if value == number)
