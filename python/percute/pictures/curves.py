"""Curves over time that alternate from sample to sample: their range and their mean."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from percute.pictures.canvas import Floats, pyplot

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.patches import Patch

TURNS = 250
"""A curve that turns more often is a solid block as a line."""
PIECES = 300
"""The range and the mean are those of pieces of the samples, at most so many."""
SHORTEST = 4
"""Fewest samples of a piece: two periods of an alternation from sample to sample."""
LIGHT = 0.3
"""Opacity of a range."""


def draw_curve(axes: Axes, time: Floats, values: Floats, *, colour: str, width: float, label: str) -> bool:
    """Draw a line or, where it would be a solid block, a band from its least to its largest values and their mean; tell whether it is a band."""
    found = _range(time, values)
    if found is None:
        axes.plot(time, values, color=colour, linewidth=width, label=label)
        return False
    at, low, mean, high = found
    axes.fill_between(at, low, high, color=colour, alpha=LIGHT, linewidth=0.0)
    axes.plot(at, mean, color=colour, linewidth=width, label=label)
    return True


def mark_of_range() -> Patch:
    """Give the mark of a band in a legend."""
    made: Patch = pyplot().matplotlib.patches.Patch(facecolor="black", alpha=LIGHT, linewidth=0.0, label="range of the samples")
    return made


def _range(time: Floats, values: Floats) -> tuple[Floats, Floats, Floats, Floats] | None:
    """Give instants with the least value, the mean and the largest value of the samples around each; None for a curve with few turns."""
    slopes = np.diff(values)
    slopes = slopes[slopes != 0.0]
    if np.count_nonzero(slopes[1:] * slopes[:-1] < 0.0) <= TURNS:
        return None
    # An even number, so that a mean has as many samples from above as from below.
    length = max(SHORTEST, 2 * -(-len(values) // (2 * PIECES)))
    starts = np.arange(0, len(values) - length + 1, length)
    counts = np.diff(np.append(starts, len(values)))
    low, high = np.minimum.reduceat(values, starts), np.maximum.reduceat(values, starts)
    total = np.add.reduceat(values, starts)
    # Between two pieces, both count: the band then holds all samples, and neighbours share their ends.
    before, after = np.maximum(np.arange(len(starts) + 1) - 1, 0), np.minimum(np.arange(len(starts) + 1), len(starts) - 1)
    mean = (total[before] + total[after]) / (counts[before] + counts[after])
    at = np.append(time[starts], time[-1])
    return at, np.minimum(low[before], low[after]), mean, np.maximum(high[before], high[after])
