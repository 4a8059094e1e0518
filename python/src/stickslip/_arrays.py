"""Arrays of Python as the library reads and writes them: checked, and used without a copy where they fit.

What is refused here is of the same family as what the library refuses: an :class:`Error`, and a ValueError or TypeError too.
"""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, DTypeLike, NDArray

from ._library import ffi
from .errors import InvalidSize, InvalidValue, NotFinite, WrongType

#: Of whatever numbers.
Array = NDArray[Any]
_KINDS = {np.dtype(np.float64): "double[]", np.dtype(np.int64): "int64_t[]", np.dtype(np.int32): "int32_t[]",
          np.dtype(np.uint8): "uint8_t[]"}


def converted(name: str, value: ArrayLike, dtype: DTypeLike = np.float64) -> Array:
    """An ndarray as it is, a list as an array: of integers only where integers are needed, so that nothing is cut off."""
    if isinstance(value, np.ndarray):
        return value
    integers = np.dtype(dtype).kind == "i"
    try:
        array = np.array(value)
    except ValueError as error:  # lists of unequal lengths
        raise InvalidSize(f"{name}: {error}") from None
    if array.size and array.dtype.kind not in ("iu" if integers else "iuf"):
        raise WrongType(f"{name}: {array.dtype}, {'integers' if integers else 'numbers'} are needed")
    return array.astype(dtype)


def coordinates(value: ArrayLike) -> Array:
    """Coordinates of nodes, which say by their shape how many there are, in space or in the plane."""
    value = converted("coordinates", value)
    if value.ndim != 2 or value.shape[1] not in (2, 3):
        raise InvalidSize(f"coordinates: shape {value.shape}, (n, 3) or (n, 2) is needed")
    return given("coordinates", value, value.shape)


def _check_shape(name: str, value: Array, shape: tuple[int, ...]) -> None:
    """Refuses what has neither this shape nor as many entries in one row."""
    row = (int(np.prod(shape)),)
    if value.shape not in (shape, row):
        allowed = f"{shape}" if shape == row else f"{shape} or {row}"
        raise InvalidSize(f"{name}: shape {value.shape}, {allowed} is needed")


def given(name: str, value: ArrayLike, shape: tuple[int, ...], dtype: DTypeLike = np.float64) -> Array:
    """An input of this shape, or with as many entries in one row.

    Lists are converted, and so are integers of another length, as those of 32 bits that PETSc numbers its unknowns with. An array in
    another order, such as the transpose of one, is copied into C's; one in C's order is used as it is. Reals are float64: of others
    digits are lost already.
    """
    value = converted(name, value, dtype)
    integers = np.dtype(dtype).kind == "i" and value.dtype.kind in "iu"
    if integers and value.dtype.isnative and np.can_cast(value.dtype, dtype):
        value = value.astype(dtype, copy=False)
    if value.dtype != dtype:
        raise WrongType(f"{name}: dtype {value.dtype}, {np.dtype(dtype)} is needed")
    _check_shape(name, value, shape)
    value = np.ascontiguousarray(value)
    if np.dtype(dtype).kind == "f" and not np.isfinite(value).all():
        raise NotFinite(f"{name}: entry {int(np.argmin(np.isfinite(value).ravel()))} is NaN or infinite")
    return value


def output(name: str, value: Any, shape: tuple[int, ...], dtype: DTypeLike = np.float64) -> Array:
    """An output: a new array, or the caller's, if it can be written."""
    if value is None:
        return np.empty(shape, dtype)
    if not isinstance(value, np.ndarray):
        raise WrongType(f"{name}: {type(value).__name__}, an ndarray is needed")
    if value.dtype != dtype or not value.flags.c_contiguous:
        raise WrongType(f"{name}: {np.dtype(dtype)} in C order is needed")
    _check_shape(name, value, shape)
    if not value.flags.writeable:
        raise InvalidValue(f"{name}: read-only, and the call writes to it")
    return value


def pointer(array: Array | None) -> Any:
    """The address of an array that stays alive during the call; NULL of None."""
    return ffi.NULL if array is None else ffi.from_buffer(_KINDS[array.dtype], array)
