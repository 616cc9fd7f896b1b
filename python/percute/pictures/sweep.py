"""Pictures of a sweep: a result over one key or two."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from percute.checks import text, wrong
from percute.errors import InputError
from percute.pictures.canvas import FIELD, new_axes, root, save_figure, writable

if TYPE_CHECKING:
    from matplotlib.axes import Axes

MOST_NUMBERS = 200
"""Maps of at most so many cells show their numbers."""
WIDE_CELLS = 6
"""Rows of at most so many cells show numbers with three digits."""


Column = Callable[[str], NDArray[Any]]
"""Gives the column of a name."""


def plot(
    column: Column,
    parameters: Sequence[str],
    unit: str | None,
    quantity: str,
    over: object,
    where: object,
    axes: Axes | None,
    save: object,
    overwrite: object,
) -> Axes:
    """Draw a column over the keys ``over``."""
    file = writable("save", save, overwrite)
    values = column(text("quantity", quantity))
    if values.dtype == object:
        raise InputError(f"`quantity` is {quantity!r}, which has no numbers to draw")
    keys = _keys(column, parameters, over, where)
    chosen = _chosen(column, parameters, where)
    places = list(zip(*(column(key)[chosen] for key in keys), strict=True))
    if len(set(places)) < len(places):
        others = [key for key in parameters if key not in keys]
        raise InputError(f"several cases have the same {' and '.join(keys)}; choose some by `where`, with values of {', '.join(others)}")
    axes = new_axes(axes, (6.4, 4.4))
    label = quantity.replace("_", " ") + (f" ({unit})" if unit else "")
    if len(keys) == 1:
        _curve(axes, column(keys[0])[chosen], values[chosen])
        axes.set_ylabel(label)
    else:
        _map(axes, [column(key)[chosen] for key in keys], values[chosen], label)
        axes.set_ylabel(keys[1])
    axes.set_xlabel(keys[0])
    save_figure(root(axes), file)
    return axes


def _keys(column: Column, parameters: Sequence[str], over: object, where: object) -> list[str]:
    """Give one or two keys."""
    fixed = where if isinstance(where, Mapping) else {}
    varied = [key for key in parameters if len(set(column(key))) > 1 and key not in fixed] or list(parameters[:1])
    several = isinstance(over, Sequence) and not isinstance(over, str)
    given: list[Any] = varied if over is None else list(over) if several else [over]  # type: ignore[call-overload]
    keys = [str(key) for key in given]
    for key in keys:
        if key not in parameters:
            raise InputError(f"`over` names {key!r}; the keys that are varied are {', '.join(parameters)}")
    if len(keys) not in (1, 2) or len(set(keys)) < len(keys):
        raise InputError(f"`over` names {len(keys)} keys, {', '.join(keys)}; give one or two different ones, and values of the others by `where`")
    return keys


def _chosen(column: Column, parameters: Sequence[str], where: object) -> NDArray[np.bool_]:
    """Tell which cases have the values of ``where``."""
    chosen = np.ones(len(column("case")), bool)
    if where is None:
        return chosen
    if not isinstance(where, Mapping):
        raise wrong("where", where, "a dict with a value for each key")
    for key, value in where.items():
        if key not in parameters:
            raise InputError(f"`where` names {key!r}; the keys that are varied are {', '.join(parameters)}")
        chosen &= column(key) == value
    if not chosen.any():
        raise InputError(f"no case has the values in `where`: {dict(where)}")
    return chosen


def _curve(axes: Axes, places: NDArray[Any], values: NDArray[Any]) -> None:
    """Draw a curve over numbers, or points over texts."""
    order = np.arange(len(places)) if places.dtype == object else np.argsort(places)
    axes.plot(places[order], values[order], "o" if places.dtype == object else "o-")
    axes.grid(alpha=0.3)


def _map(axes: Axes, places: list[NDArray[Any]], values: NDArray[Any], label: str) -> None:
    """Draw a cell for each case, white where there is none."""
    # Texts keep their order.
    ticks = [list(dict.fromkeys(each)) if each.dtype == object else sorted(set(each)) for each in places]
    cells = np.full((len(ticks[1]), len(ticks[0])), np.nan)
    for x, y, value in zip(*places, values, strict=True):
        cells[ticks[1].index(y), ticks[0].index(x)] = value
    image = axes.imshow(cells, origin="lower", aspect="auto", cmap=FIELD)
    for axis, names in zip((axes.xaxis, axes.yaxis), ticks, strict=True):
        axis.set_ticks(range(len(names)), [name if isinstance(name, str) else f"{name:g}" for name in names])
    root(axes).colorbar(image, ax=axes, label=label)
    if cells.size <= MOST_NUMBERS:
        # Narrow cells have room for two digits.
        digits, size = (".3g", "small") if cells.shape[1] <= WIDE_CELLS else (".2g", "x-small")
        for (row, column), value in np.ndenumerate(cells):
            if np.isfinite(value):
                dark = float(np.asarray(image.norm(value))) < 0.6
                color = "white" if dark else "black"
                axes.text(column, row, f"{value:{digits}}", ha="center", va="center", fontsize=size, color=color)
