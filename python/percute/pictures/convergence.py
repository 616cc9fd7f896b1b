"""Pictures of a verification: errors over the element size."""

from __future__ import annotations

from typing import TYPE_CHECKING

from percute.pictures.canvas import new_axes, root, save_figure, writable

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from percute.verifying import Verification

MEASURES = (("sup", "#2f79c8"), ("mean", "#da6228"))


def plot(verification: Verification, axes: Axes | None, save: object, overwrite: object) -> Axes:
    """Draw estimate and true error over the element size, both axes logarithmic."""
    file = writable("save", save, overwrite)
    axes = new_axes(axes)
    for name, colour in MEASURES:
        estimate, error = getattr(verification, f"estimate_{name}"), getattr(verification, f"error_{name}")
        axes.loglog(verification.size, estimate, "o-", color=colour, label=f"estimate, {name}")
        axes.loglog(verification.size, error, "s--", color=colour, label=f"true error against the finest, {name}")
    ticks = list(verification.size)
    axes.set_xticks(ticks, [f"1/{round(1 / size)}" if size < 1 else "1" for size in ticks])
    axes.minorticks_off()
    axes.set_xlabel("element size over that of the first mesh")
    axes.set_ylabel("error (J$^{1/2}$)")
    axes.grid(alpha=0.3)
    axes.legend(frameon=False)
    save_figure(root(axes), file)
    return axes
