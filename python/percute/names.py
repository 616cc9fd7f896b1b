"""A call with a wrong name of an argument is answered with the name that was meant.

The public functions and constructors keep their signatures; a wrapper around each looks at calls that Python refuses.
"""

from __future__ import annotations

import enum
import functools
import inspect
import sys
from collections.abc import Callable, Iterable
from types import FunctionType
from typing import Any, TypeVar

from percute import _percute

T = TypeVar("T")


def _list(names: Iterable[str]) -> str:
    return ", ".join(f"`{name}`" for name in names)


def _refusal(function: Callable[..., Any], name: str, positional: int, keywords: Iterable[str]) -> str | None:
    """Say what is wrong with the names in a call; None if nothing is."""
    parameters = inspect.signature(function).parameters
    method = "." in function.__qualname__
    known = {p: parameter for i, (p, parameter) in enumerate(parameters.items()) if not (method and i == 0)}
    if any(parameter.kind in (parameter.VAR_POSITIONAL, parameter.VAR_KEYWORD) for parameter in known.values()):
        return None
    # Those that begin with an underscore are for the evidence only.
    public = [p for p in known if not p.startswith("_")]
    unknown = [keyword for keyword in keywords if keyword not in known]
    if unknown:
        hints = [_percute.hint(each, public) or f"; its arguments are {_list(public)}." for each in unknown]
        return " ".join(f"{name + '()' if i == 0 else 'It'} has no argument `{unknown[i]}`{hint}" for i, hint in enumerate(hints))
    by_position = [p for p in public if known[p].kind is not inspect.Parameter.KEYWORD_ONLY]
    if positional > len(by_position):
        others = _list(p for p in public if p not in by_position)
        if not by_position:
            return f"{name}() takes its arguments by their names: {others}" if others else f"{name}() takes no arguments"
        rest = f"and its other arguments by their names: {others}" if others else "and no other arguments"
        return f"{name}() takes {_list(by_position)} by position {rest}"
    given = {*by_position[:positional], *keywords}
    missing = [p for p in public if known[p].default is inspect.Parameter.empty and p not in given]
    return f"{name}() needs {_list(missing)}" if missing else None


def _label(function: Callable[..., Any], arguments: tuple[Any, ...]) -> str:
    """Give the name of a function; that of a method begins with the class of its object, which may inherit it."""
    if "." not in function.__qualname__ or not arguments:
        return function.__qualname__
    kind = arguments[0] if isinstance(arguments[0], type) else type(arguments[0])
    return kind.__name__ if function.__name__ == "__init__" else f"{kind.__name__}.{function.__name__}"


def _named(function: Callable[..., T]) -> Callable[..., T]:
    """Give the function with messages about the names of its arguments, and with its own signature."""
    hidden = 1 if "." in function.__qualname__ else 0

    @functools.wraps(function)
    def call(*arguments: Any, **named: Any) -> T:
        try:
            return function(*arguments, **named)
        except TypeError as error:
            # An error from within the function has a further frame.
            if error.__traceback__ is not None and error.__traceback__.tb_next is not None:
                raise
            told = _refusal(function, _label(function, arguments), len(arguments) - hidden, named)
            if told is None:
                raise
        raise TypeError(told)

    return call


def _name_members(kind: type) -> None:
    """Treat the constructor and the public methods of a class, those of its bases in percute included."""
    for base in kind.__mro__:
        for name, member in list(vars(base).items()) if base.__module__.startswith("percute") else ():
            function = member.__func__ if isinstance(member, classmethod | staticmethod) else member
            if (name.startswith("_") and name != "__init__") or not isinstance(function, FunctionType) or hasattr(function, "__wrapped__"):
                continue
            called = _named(function)
            setattr(base, name, called if function is member else type(member)(called))


def name_arguments(module: str) -> None:
    """Treat all public functions and classes of a module, where they are defined as well."""
    namespace = vars(sys.modules[module])
    for name in namespace["__all__"]:
        member = namespace[name]
        if isinstance(member, FunctionType):
            namespace[name] = vars(sys.modules[member.__module__])[name] = _named(member)
        elif isinstance(member, type) and member.__module__.startswith("percute") and not issubclass(member, BaseException | Warning | enum.Enum):
            _name_members(member)
