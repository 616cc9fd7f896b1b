"""Pictures of a verification, as `percute verify --picture` draws them: errors, effectivity index and contact over the element size."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from percute import _percute
from percute.errors import InputError
from percute.pictures.canvas import Floats, axes_below, pyplot, root, save_figure, writable

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Values = Mapping[str, Any]
DASHED = (0, (3.3, 1.7))
ERRORS: tuple[tuple[str, str, int, Any], ...] = (
    ("estimate_mean", "estimate, mean", 0, "-"),
    ("estimate_sup", "estimate, sup", 1, "-"),
    ("error_mean", "true error against the finest mesh, mean", 0, DASHED),
    ("error_sup", "true error against the finest mesh, sup", 1, DASHED),
)
INDICES = (("effectivity_mean", "of the mean", 0, "-"), ("effectivity_sup", "of the sup", 1, "-"))
CONTACT = (("averaged_peak_force", "averaged peak force", 0, "-"), ("impulse", "impulse", 1, "-"), ("rebound", "rebound velocity", 2, "-"))
"""Quantities with their names, the numbers of their colours, and their lines."""
BAND = 2
"""The colour of the range that the verdict expects."""
BESIDE, AROUND, PADDING = 1.1, 1.25, 0.1
"""Room beside the first and the last mesh and around errors, as a factor; around other values, as a part of their range."""


def plot(
    sizes: Floats,
    values: Values,
    expected: tuple[float, float],
    per_metre: bool,
    axes: Sequence[Axes] | None,
    save: object,
    overwrite: object,
) -> list[Axes]:
    """Draw the three plots, one above the other; ``values`` are those of a `Verification`, by name."""
    file = writable("save", save, overwrite)
    if len(sizes) < 2 or not np.any(_finite(values, ERRORS) > 0.0):
        raise InputError("there is no picture without errors on two meshes")
    plots = axes_below(axes, 3, "three")
    errors, indices, contact = plots
    all_errors = _finite(values, ERRORS)
    positive = all_errors[all_errors > 0.0]
    errors.set(yscale="log", ylim=(positive.min() / AROUND, positive.max() * AROUND))
    errors.yaxis.set_minor_formatter(pyplot().matplotlib.ticker.LogFormatter(minor_thresholds=(1, 0.5)))
    indices.axhspan(*expected, color=_percute.SERIES[BAND], alpha=0.2, linewidth=0.0, label="expected by the verdict on the first mesh")
    below = _below(values)
    for each, quantities in ((errors, _of(values, ERRORS)), (indices, _of(values, INDICES)), (contact, below)):
        for shown, label, colour, line in quantities:
            if np.any(shown > 0.0 if each is errors else np.isfinite(shown)):
                each.plot(sizes, shown, marker="o", markersize=5, linestyle=line, color=_percute.SERIES[colour], label=label)
    _pad(indices, [*_finite(values, INDICES), *expected], "the error is zero to rounding")
    _pad(contact, [value for shown, *_ in below for value in shown], "nothing touches")
    for each, label, columns in zip(plots, (f"error ({_percute.unit('J^½', per_metre)})".replace("^½", "$^{1/2}$"), "effectivity index", "over the finest"), (2, 3, 3), strict=True):
        each.set(xscale="log", xlim=(sizes[-1] / BESIDE, BESIDE), ylabel=label)
        each.set_xticks(list(sizes), [f"1/{round(1 / size)}" if size < 1 else "1" for size in sizes])
        each.set_xticks([], minor=True)
        each.grid(alpha=0.3)
        _legend(each, columns)
    contact.set_xlabel("element size over that of the first mesh")
    save_figure(root(errors), file)
    return plots


def _finite(values: Values, quantities: Sequence[tuple[str, str, int, Any]]) -> Floats:
    """Give all values of some quantities that are numbers."""
    found: Floats = np.concatenate([values[name] for name, *_ in quantities])
    return found[np.isfinite(found)]


def _of(values: Values, quantities: Sequence[tuple[str, str, int, Any]]) -> list[tuple[Floats, str, int, Any]]:
    """Give the values of quantities in place of their names."""
    return [(values[name], label, colour, line) for name, label, colour, line in quantities]


def _below(values: Values) -> list[tuple[Floats, str, int, Any]]:
    """Give contact and probes over their values on the finest mesh; without that they are not drawn."""
    # Three colours are left; a fourth probe has the first of them, and a dashed line.
    probes = [(shown, name, len(CONTACT) + at % 3, DASHED if at // 3 % 2 else "-") for at, (name, shown) in enumerate(values["probes"].items())]
    over = [(shown / shown[-1] if shown[-1] != 0.0 else np.full_like(shown, np.nan), *look) for shown, *look in (*_of(values, CONTACT), *probes)]
    return [(np.asarray(shown), str(label), int(colour), line) for shown, label, colour, line in over]


def _pad(axes: Axes, values: Sequence[float], none: str) -> None:
    """Set limits around values and 1, and mark 1; without lines, say why."""
    finite = [1.0, *(value for value in values if np.isfinite(value))]
    low, high = min(finite), max(finite)
    room = PADDING * max(high - low, 0.05)
    axes.set_ylim(low - room, high + room)
    if not axes.lines:
        axes.text(0.5, 0.5, none, transform=axes.transAxes, ha="center", color="#6e6e78")
    axes.axhline(1.0, color="#6e6e78", linewidth=1.0, linestyle=(0, (4, 3)), zorder=1.5)


def _legend(axes: Axes, columns: int) -> None:
    """Put the legend above the axes, column by column, the shaded range last."""
    handles, labels = axes.get_legend_handles_labels()
    order = sorted(range(len(labels)), key=lambda k: labels[k].startswith("expected"))
    if order:
        entries = [handles[k] for k in order], [labels[k] for k in order]
        axes.legend(*entries, ncols=columns, loc="lower left", bbox_to_anchor=(0.0, 1.0), frameon=False, fontsize="small", borderpad=0.2)
