"""Checks of arguments: each returns the value in the required type, or raises an error that names the argument."""

from __future__ import annotations

import operator
import os
import reprlib
import sys
import warnings
from collections.abc import Iterable, Mapping
from typing import Any, TypeVar

import numpy as np

from percute.errors import InputError, InputWarning, MissingFileError, SimulationWarning

T = TypeVar("T")

PACKAGE = os.path.join(os.path.dirname(__file__), "")

LARGEST = 2**63 - 1
"""The largest whole number of the engine."""

MADE_BY = {
    "History": "percute.simulate, percute.run, percute.open or History.from_arrays",
    "Estimate": "percute.estimate, percute.run or percute.open",
    "TrueError": "percute.true_errors, History.error or an exact solution",
}
"""Functions that make the objects not made by their class."""

_short = reprlib.Repr()
_short.maxstring = _short.maxother = _short.maxlong = 80


def told(value: object) -> str:
    """Show a value in one short line."""
    try:
        return " ".join(_short.repr(value).split())
    except Exception:  # What a value says of itself may fail: whole numbers of more than 4300 digits do.
        return f"of the type {type(value).__name__}"


def wrong(name: str, value: object, allowed: str) -> InputError:
    """Make an error with the value of an argument and its allowed values."""
    return InputError(f"`{name}` is {told(value)}; it must be {allowed}")


def caller() -> int:
    """Give the level, from the caller of this function, of the line that called the public function."""
    level, frame = 1, sys._getframe(1)
    while frame.f_back is not None and frame.f_code.co_filename.startswith(PACKAGE):
        level, frame = level + 1, frame.f_back
    return level


def warn(messages: Iterable[str], kind: type[UserWarning] = InputWarning) -> None:
    """Issue warnings at the line that called the public function."""
    for message in messages:
        warnings.warn(message, kind, stacklevel=caller())


def warn_of_result(told: Iterable[tuple[str, bool]]) -> None:
    """Issue the warnings of a result, each with whether it concerns the result."""
    for message, concerns_result in told:
        warn([message], SimulationWarning if concerns_result else InputWarning)


def instance(name: str, value: object, kind: type[T]) -> T:
    """Give an object of a class."""
    if not isinstance(value, kind):
        given = f"{'an' if kind.__name__[0] in 'AEIOU' else 'a'} {kind.__name__}"
        raise wrong(name, value, f"{given}, made by {MADE_BY.get(kind.__name__, f'percute.{kind.__name__}')}")
    return value


def flag(name: str, value: object) -> bool:
    """Give a yes or no."""
    if not isinstance(value, bool | np.bool_):
        raise wrong(name, value, "True or False")
    return bool(value)


def text(name: str, value: object) -> str:
    """Give a text."""
    if not isinstance(value, str):
        raise wrong(name, value, "a text")
    try:
        value.encode()
    except UnicodeEncodeError:
        raise wrong(name, value, "a text without lone surrogates") from None
    return value


def one_of(name: str, value: object, known: Iterable[str]) -> str:
    """Give a text out of some."""
    names = list(known)
    if text(name, value) not in names:
        raise InputError(f"`{name}` is {value!r}; it must be one of {', '.join(names)}")
    return str(value)


def words(name: str, value: object) -> str | None:
    """Give a text with at least one word, or None."""
    if value is None:
        return None
    if not text(name, value).strip() or "\0" in str(value):
        raise wrong(name, value, "a text with a word, without NUL")
    return str(value)


def path(name: str, value: object) -> str:
    """Give the name of a file."""
    try:
        file = os.fspath(value)  # type: ignore[call-overload]
    except TypeError:
        file = None
    if not isinstance(file, str) or not file or "\0" in file:
        raise wrong(name, value, "the name of a file, as a text or a pathlib.Path")
    try:
        os.fsencode(file)
    except UnicodeEncodeError:
        raise wrong(name, value, "a name that this system can write") from None
    return file


def new_file(name: str, value: object) -> str:
    """Give the name of a file to come, in a folder that exists."""
    file = path(name, value)
    folder = os.path.dirname(file)
    if folder and not os.path.isdir(folder):
        shown = encodable(folder)
        raise MissingFileError(f"`{name}`: cannot write {encodable(file)}: there is no folder {shown}; create it first, or give another name")
    return file


def vtkhdf(name: str, value: object) -> str:
    """Give the name of a history or an estimate file."""
    file = new_file(name, value)
    if not file.lower().endswith(".vtkhdf"):
        raise wrong(name, value, "a name that ends in .vtkhdf, from which ParaView recognises it; `History.export` writes .vtu")
    return file


def encodable(file: str) -> str:
    """Give the name of a file as it can be printed: on Linux it may be of any bytes."""
    return os.fsencode(file).decode(errors="replace")


def number(name: str, value: object, *, finite: bool = False, unit: str = "") -> float:
    """Give a number. Without ``finite``, the engine checks numbers that are not finite."""
    refuse_masked(name, value)
    allowed = ("a finite number" if finite else "a number") + (f" in {unit}" if unit else "")
    try:
        array = np.asarray(value)
        # Texts and truth values could be converted, but are probably mistakes.
        given = float(value) if array.ndim == 0 and array.dtype.kind in "fiuO" else None  # type: ignore[arg-type]
    except (TypeError, ValueError, OverflowError):
        given = None
    if given is None or (finite and not np.isfinite(given)):
        raise wrong(name, value, allowed)
    return given


def optional_number(name: str, value: object) -> float | None:
    """Give a number, or None."""
    return None if value is None else number(name, value)


def whole(name: str, value: object, *, least: int = 1, most: int = LARGEST) -> int:
    """Give a whole number in a range."""
    try:
        given = None if isinstance(value, bool | np.bool_) else operator.index(value)  # type: ignore[arg-type]
    except TypeError:
        given = None
    if given is None or (not least <= given <= most and most < LARGEST):
        raise wrong(name, value, f"a whole number from {least} to {most}" if most < LARGEST else "a whole number")
    if not least <= given <= most:
        raise wrong(name, value, f"at least {least}" if given < least else f"at most {most}")
    return given


def refuse_masked(name: str, value: object) -> None:
    """Refuse an array with missing values, or a list of such, which NumPy would fill."""
    if isinstance(value, np.ma.MaskedArray):
        raise InputError(f"`{name}` is a masked array; give an ordinary array, without missing values")
    if isinstance(value, list | tuple) and holds(value, (np.ma.MaskedArray,)):
        raise InputError(f"`{name}` holds masked arrays; give ordinary arrays, without missing values")


def holds(rows: list[Any] | tuple[Any, ...], wanted: tuple[type, ...]) -> bool:
    """Tell whether a list, or a list in it, holds an object of these types. One that holds itself has no end, and no such object."""
    lists: list[list[Any] | tuple[Any, ...]] = [rows]
    seen = set()
    while lists:
        rows = lists.pop()
        if id(rows) in seen:
            continue
        seen.add(id(rows))
        kinds = set(map(type, rows))
        if any(issubclass(kind, wanted) for kind in kinds):
            return True
        if any(issubclass(kind, list | tuple) for kind in kinds):
            lists += [row for row in rows if isinstance(row, list | tuple)]
    return False


def names(name: str, value: Iterable[str] | None, example: str) -> list[str] | None:
    """Give a list of names, or None."""
    if isinstance(value, str):
        raise wrong(name, value, f"a list of names, such as {example}")
    return None if value is None else [text(name, each) for each in value]


def items(name: str, value: object, kind: type[T]) -> list[T]:
    """Give a list of objects of a class."""
    if isinstance(value, kind):
        raise InputError(f"`{name}` is one {kind.__name__}; give a list of them")
    if not isinstance(value, Iterable):
        raise wrong(name, value, f"a list of {kind.__name__}")
    return [instance(f"{name}[{i}]", each, kind) for i, each in enumerate(value)]


def table(name: str, value: object, of: str) -> dict[str, Any]:
    """Give a dict that names groups."""
    if not isinstance(value, Mapping):
        raise wrong(name, value, f"a dict of group to {of}")
    for group in value:
        if not isinstance(group, str):
            raise InputError(f"`{name}` has the key {told(group)}; it must be the name of a group, a text")
        text(f"{name}[{group!r}]", group)
    return dict(value)
