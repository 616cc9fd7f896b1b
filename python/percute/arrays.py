"""Checks of arguments that are arrays."""

from __future__ import annotations

from typing import Any, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from percute.checks import LARGEST, holds, refuse_masked, told, wrong
from percute.errors import InputError


def flags(name: str, value: object, count: int, of: str) -> list[bool]:
    """Give an array of ``count`` truth values, one of each thing named by ``of``."""
    refuse_masked(name, value)
    try:
        array = np.asarray(value)
    except (TypeError, ValueError):
        array = np.empty(0)
    if array.dtype != np.bool_ or array.shape != (count,):
        raise wrong(name, value, f"an array of {count} truth values, one for each {of}")
    return cast("list[bool]", array.tolist())


def _array(name: str, value: object) -> NDArray[Any]:
    refuse_masked(name, value)
    try:
        # Among numbers a truth value would become 0 or 1, but is probably a mistake.
        return np.asarray(None if _has_truth(value) else value)
    except (TypeError, ValueError, OverflowError, RecursionError):
        return np.asarray(None)


def _no_truth(value: object) -> str:
    return ", not True or False" if _has_truth(value) else ""


def _has_truth(value: object) -> bool:
    return isinstance(value, list | tuple) and holds(value, (bool, np.bool_))


_CONVERT = {
    "c": "; if all imaginary parts are zero, give its real part, array.real",
    "O": "; if all are numbers, convert them with astype(float)",
    "U": "; if all are numbers, convert them with astype(float)",
}
"""Ways out for arrays of other types, by the kinds of their elements."""


def numbers(name: str, value: object, *, most: int, finite: bool = False) -> NDArray[np.float64]:
    """Give an array of numbers with a maximum number of dimensions."""
    array = _array(name, value)
    if array.dtype.kind not in "fiu":
        allowed = f"numbers in rows of equal length{_no_truth(value)}"
        if hasattr(value, "dtype"):
            raise InputError(f"`{name}` is an array of {array.dtype}; it must be {allowed}{_CONVERT.get(array.dtype.kind, '')}")
        raise wrong(name, value, allowed)
    if array.ndim > most:
        raise InputError(f"`{name}` has the shape {array.shape}; it must have at most {most} dimensions")
    if finite and not np.all(np.isfinite(array)):
        raise wrong(name, value, "finite numbers")
    return np.ascontiguousarray(array, dtype=np.float64)


def times(name: str, value: object, otherwise: str = "") -> list[float]:
    """Give times (s)."""
    given = np.atleast_1d(numbers(name, value, most=1))
    if len(given) == 0 or not np.all(np.isfinite(given) & (given >= 0)):
        raise wrong(name, value, f"{otherwise}at least one time (s), finite and not negative")
    return cast("list[float]", given.tolist())


def broadcast(**given: ArrayLike) -> tuple[NDArray[np.float64], ...]:
    """Give arrays of numbers, broadcast against each other."""
    arrays = {name: numbers(name, value, most=32, finite=True).reshape(np.shape(value)) for name, value in given.items()}
    try:
        return tuple(np.broadcast_arrays(*arrays.values()))
    except ValueError:
        shapes = ", ".join(f"`{name}` has the shape {array.shape}" for name, array in arrays.items())
        raise InputError(f"{shapes}; they cannot be broadcast") from None


def transposed(name: str, array: NDArray[Any], *columns: int | None) -> str:
    """Say that rows and columns of an array are exchanged, if it has as many rows as it should have columns."""
    if array.ndim == 2 and array.shape[0] in columns and array.shape[1] not in columns:
        return f": it is transposed, give `{name}.T`"
    return ""


def integers(name: str, value: object, columns: int | None) -> NDArray[np.int64]:
    """Give whole numbers in rows of some columns; without columns, in one row."""
    array = _array(name, value)
    if array.size == 0 and array.dtype.kind == "f":
        array = array.astype(np.int64)
    if array.dtype.kind not in "iu" or (array.dtype.kind == "u" and array.max(initial=0) > LARGEST):
        kind = f"an array of {array.dtype}" if array.dtype.kind in "fcbu" or hasattr(value, "dtype") else told(value)
        whole = "; convert floating-point numbers with astype(int)" if array.dtype.kind == "f" else ""
        raise InputError(f"`{name}` is {kind}; it must be whole numbers in rows of equal length, counted from 0{whole}{_no_truth(value)}")
    if columns == 1 and array.ndim == 1:
        array = array[:, None]
    shape = (-1,) if columns is None else (-1, columns)
    if array.ndim != len(shape) or (columns is not None and array.shape[1] != columns):
        needed = "(n,)" if columns is None else f"(n, {columns})"
        raise InputError(f"`{name}` has the shape {array.shape}; it must have {needed}{transposed(name, array, columns)}")
    return np.ascontiguousarray(array, dtype=np.int64)
