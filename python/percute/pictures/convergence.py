"""Pictures of a verification: errors, effectivity index and contact over the element size."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from percute.checks import wrong
from percute.pictures.canvas import pyplot, root, save_figure, writable

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from percute.verifying import Verification

MEASURES = (("mean", "#2f79c8"), ("sup", "#da6228"))
CONTACT = (("peak_force", "peak force", "#2f79c8"), ("impulse", "impulse", "#da6228"), ("rebound", "rebound velocity", "#24966e"))


def plot(verification: Verification, axes: Sequence[Axes] | None, save: object, overwrite: object) -> list[Axes]:
    """Draw the three plots, one above the other."""
    file = writable("save", save, overwrite)
    plots = _axes(axes)
    errors, indices, contact = plots
    for name, colour in MEASURES:
        estimate, error = getattr(verification, f"estimate_{name}"), getattr(verification, f"error_{name}")
        errors.plot(verification.size, estimate, "o-", color=colour, label=f"estimate, {name}")
        errors.plot(verification.size, error, "s--", color=colour, label=f"true error against the finest, {name}")
        indices.plot(verification.size, getattr(verification, f"effectivity_{name}"), "o-", color=colour, label=name)
    if np.any(np.concatenate([verification.estimate_sup, verification.estimate_mean]) > 0.0):
        errors.set_yscale("log")
        errors.yaxis.set_minor_formatter(pyplot().matplotlib.ticker.LogFormatter(minor_thresholds=(1, 0.5)))
    indices.axhspan(*verification.expected, color="#24966e", alpha=0.15, label="expected on the first mesh")
    for name, label, colour in CONTACT:
        values = getattr(verification, name)
        if np.isfinite(values[-1]) and values[-1] != 0.0:
            contact.plot(verification.size, values / values[-1], "o-", color=colour, label=label)
    for each, label in zip(plots, ("error (J$^{1/2}$)", "effectivity index", "over the finest"), strict=True):
        each.set_xscale("log")
        ticks = list(verification.size)
        each.set_xticks(ticks, [f"1/{round(1 / size)}" if size < 1 else "1" for size in ticks])
        each.set_xticks([], minor=True)
        each.set_ylabel(label)
        each.grid(alpha=0.3)
        if each.lines:
            each.legend(frameon=False, fontsize="small")
    for each in plots[1:]:
        each.axhline(1.0, color="black", linewidth=0.8)
    contact.set_xlabel("element size over that of the first mesh")
    save_figure(root(errors), file)
    return plots


def _axes(axes: Sequence[Axes] | None) -> list[Axes]:
    """Give the axes of an argument, by default three new ones."""
    plt = pyplot()
    given = list(plt.subplots(3, 1, sharex=True, layout="constrained", figsize=(6.4, 8.4))[1]) if axes is None else list(np.ravel(axes))  # type: ignore[arg-type]
    if len(given) != 3 or not all(isinstance(each, plt.Axes) for each in given):
        raise wrong("axes", axes, "three axes of matplotlib, such as `plt.subplots(3)[1]`")
    return given
