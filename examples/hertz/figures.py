"""The figures of docs/hertz.md."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import matplotlib.pyplot as plt
import numpy as np
from hertz import CUT, DISC, SPEED, excess
from impact import FLIGHT, profile

if TYPE_CHECKING:
    from hertz import Study
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

FE, THEORY, SLOW, CONSISTENT = "tab:blue", "black", "tab:orange", "tab:green"


def draw(done: Study, folder: Path) -> None:
    """Draw the figures into a folder."""
    with plt.rc_context({"font.size": 9}):
        for name, figure in (("force", _force(done)), ("contact", _contact(done)), ("error", _error(done))):
            figure.savefig(folder / f"hertz-{name}.png", dpi=110)
            plt.close(figure)


def _force(done: Study) -> Figure:
    """Resultant over time, and the peak force of each theory over the speed."""
    figure, (over_time, over_speed) = plt.subplots(1, 2, figsize=(9.0, 3.3), layout="constrained")
    main, slow, waves = done.main, DISC.impact(SPEED), DISC.impact(SPEED, CUT)
    over_time.plot(main.time[::8] * 1e6, main.force[::8] / 1e6, color=FE, linewidth=2.5, alpha=0.6, label="finite elements")
    over_time.plot(slow.time[::40] * 1e6, slow.force[::40] / 1e6, color=SLOW, linestyle="--", label="Hertz, quasi-static")
    over_time.plot(waves.time[::40] * 1e6, waves.force[::40] / 1e6, color=THEORY, linewidth=1, label="Hertz, vibrating disc")
    _label(over_time, "time since first touch (µs)", "contact force (MN per metre)", legend="lower center")
    speeds = [run.speed for run in done.speeds]
    for cut, colour, label in ((0.0, SLOW, "quasi-static"), (CUT, THEORY, "vibrating disc")):
        values = [100.0 * excess(run, DISC.impact(run.speed, cut)) for run in done.speeds]
        over_speed.plot(speeds, values, "o-", color=colour, label=label)
    over_speed.set_xscale("log", base=2)
    over_speed.set_xticks(speeds, [f"{speed:g}" for speed in speeds])
    _label(over_speed, "speed of impact (m/s)", "peak force, theory over\nfinite elements, less 1 (%)", legend="best")
    return figure


def _contact(done: Study) -> Figure:
    """Width and pressure over time, and the pressure at the peak, with Hertz for the force of the same instant."""
    figure, (width, middle, ellipse) = plt.subplots(1, 3, figsize=(11.0, 3.3), layout="constrained")
    main, time = done.main, done.main.time * 1e6
    some = slice(None, None, 8)
    width.plot(time[some], main.touching_half_width[some] * 1e3, color="tab:green", linewidth=1, label="nodes that touch")
    width.plot(time[some], main.half_width[some] * 1e3, color=FE, linewidth=2.5, alpha=0.6, label="from the pressure")
    width.plot(time[some], main.hertz_half_width[some] * 1e3, color=THEORY, linewidth=1, label="Hertz")
    _label(width, "time since first touch (µs)", "half-width of contact (mm)", legend="lower center")
    middle.plot(time[some], main.pressure_in_the_middle[some] / 1e9, color=FE, linewidth=2.5, alpha=0.6, label="finite elements")
    middle.plot(time[some], main.hertz_pressure[some] / 1e9, color=THEORY, linewidth=1, label="Hertz")
    _label(middle, "time since first touch (µs)", "pressure in the middle (GPa)", legend="lower center")
    place, pressure, _ = profile(main)
    near, smooth = np.abs(place) < 1.3, np.linspace(-1.0, 1.0, 201)
    ellipse.plot(place[near], pressure[near], "o", color=FE, markersize=4, label="finite elements, nodes")
    ellipse.plot(smooth, np.sqrt(1.0 - smooth**2), color=THEORY, linewidth=1, label="Hertz")
    _label(ellipse, "position, $x/b$", "pressure at the largest force, $p/p_0$", legend="lower center")
    return figure


def _error(done: Study) -> Figure:
    """The constitutive relation error over time of all reconstructions, and its map with the default."""
    figure, (over_time, near) = plt.subplots(1, 2, figsize=(9.0, 3.3), layout="constrained", width_ratios=(1, 1.2))
    for name, colour in (("published", SLOW), ("consistent", CONSISTENT), ("corrected", FE)):
        over = done.estimates[name].over_time
        time = (over.time - FLIGHT) * 1e6
        over_time.plot(time, np.sqrt(over.total), color=colour, label=f"{name}, error √η")
        over_time.plot(time, np.sqrt(over.elastic), color=colour, linestyle=":", label=f"{name}, elastic part")
    _label(over_time, "time since first touch (µs)", "error (J$^{1/2}$)")
    over_time.set(yscale="log", ylim=(0.02, 100.0))
    over_time.set_xlim(left=0.0)
    over_time.legend(loc="lower right", ncols=2, fontsize="x-small", handlelength=1.4, columnspacing=1.0)
    done.estimates["corrected"].plot_map(outline=False, axes=near)
    near.set(xlim=(-1.5, 1.5), ylim=(-10.1, -8.6), title="corrected, near the contact")
    return figure


def _label(axes: Axes, x: str, y: str, legend: str | None = None) -> None:
    axes.set(xlabel=x, ylabel=y)
    axes.set_ylim(bottom=min(0.0, axes.get_ylim()[0]))
    axes.grid(alpha=0.3)
    if legend is not None:
        axes.legend(loc=legend)
