"""Pictures of an adaptation: the error over the best mesh, and over the cost of the runs."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from percute import _percute
from percute.errors import InputError
from percute.estimation import Estimate
from percute.iterations import Iterations
from percute.pictures.canvas import axes_below, pyplot, root, save_figure, writable

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def plot(
    best: tuple[Estimate, int] | None,
    runs: Iterations,
    measure: str,
    target: float,
    axes: Sequence[Axes] | None,
    save: object,
    overwrite: object,
) -> list[Axes]:
    """Draw the map and the errors; ``best`` is the estimate of the best run, with its number."""
    file = writable("save", save, overwrite)
    if best is None:
        raise InputError("there is no picture: no run is done")
    upper, lower = plots = axes_below(axes, 2, "two")
    estimate, number = best
    estimate.plot_map(axes=upper)
    # The map is titled with the largest error; the picture is about that of the target.
    error = f"{len(estimate.by_element)} elements: relative error ({measure}) {100 * runs.error[number]:.3g} %"
    upper.set_title("\n".join([f"{error}, target {100 * target:.3g} %", *upper.get_title().split("\n")[1:]]), fontsize="medium")
    cost = np.cumsum(runs.element_steps)
    lower.plot(cost, 100 * runs.error, marker="o", color=_percute.SERIES[0], label=f"relative error, {measure}")
    known = np.isfinite(runs.predicted)
    if np.any(known):
        lower.plot(cost[known], 100 * runs.predicted[known], marker="x", linestyle="none", color=_percute.SERIES[1], label="expected")
    lower.axhline(100 * target, color="#6e6e78", linewidth=1.0, linestyle=(0, (4, 3)), label="target")
    lower.set(xscale="log", yscale="log", xlabel="elements times steps, all runs so far", ylabel="relative error (%)")
    lower.yaxis.set_major_formatter(pyplot().matplotlib.ticker.ScalarFormatter())
    lower.yaxis.set_minor_formatter(pyplot().matplotlib.ticker.LogFormatter(minor_thresholds=(2, 1)))
    lower.grid(alpha=0.3)
    lower.legend(frameon=False, fontsize="small")
    save_figure(root(lower), file)
    return plots
