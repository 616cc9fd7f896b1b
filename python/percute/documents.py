"""Records from JSON documents."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import is_dataclass
from types import UnionType
from typing import Any, TypeVar, get_args, get_origin, get_type_hints

import numpy as np

T = TypeVar("T")


def record(kind: type[T], found: Mapping[str, Any]) -> T:
    """Make a data class of its JSON object, whose other keys are left out; arrays, tuples and records in it by their types."""
    hints = get_type_hints(kind)
    return kind(**{name: _value(hints[name], value) for name, value in found.items() if name in hints})


def optional(kind: type[T], found: Mapping[str, Any] | None) -> T | None:
    """Make it unless it is missing."""
    return None if found is None else record(kind, found)


def records(kind: type[T], found: Iterable[Mapping[str, Any]]) -> tuple[T, ...]:
    """Make data classes of their JSON objects."""
    return tuple(record(kind, each) for each in found)


def _value(hint: Any, value: Any) -> Any:
    if value is None:
        return None
    # Of a union, only None is another type.
    hint = get_args(hint)[0] if isinstance(hint, UnionType) else hint
    if is_dataclass(hint):
        return record(hint, value)  # type: ignore[arg-type]
    if get_origin(hint) is np.ndarray:
        return np.array(value)
    return tuple(_value(get_args(hint)[0], each) for each in value) if get_origin(hint) is tuple else value
