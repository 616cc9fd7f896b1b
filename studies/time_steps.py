"""The paper's figure 10: the error and the length of the step, and the error that remains at small steps."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import percute as pc
from studies import figures, mass
from studies.block import Block, Impact
from studies.choices import RECONSTRUCTIONS as NAMES
from studies.page import Column, Figure, Section, Table, percent, short
from studies.parallel import Resolution, Stop

FRACTION = 0.3
"""The fraction of a step at which the impact falls."""
MOMENT = 2.0
"""The moment of impact ends so many critical steps after the arrival."""
DRAWN = (1.0, 0.7, 0.5, 0.2, 0.1)
"""The ratios of which figure (a) has a curve."""
FRACTIONS, IMPACT_RATIOS, PAST = (0.1, 0.3, 0.5, 0.7, 0.9), (0.8, 0.4, 0.2, 0.1), 1.2e-6
"""Fractions of a step, Δt/Δt_c, and the instant (s) past which runs end, for the impact itself."""

Run = tuple[str, float, Block]


def compute(section: Section, resolution: Resolution) -> None:
    """Compute the study."""
    _sweep(section, resolution)
    _impact(section, resolution)
    mass.add(section, resolution)


def _block(ratio: float, fraction: float, past: float = 12e-6) -> Block:
    """Give the block without friction, as the paper has it, on 640 elements."""
    return Block((20, 16), friction=0.0, courant=ratio, gap=0.2e-3, flight=fraction, past=past)


def _estimate(run: Run, stop: Stop) -> tuple[pc.Estimate, Impact]:
    impact = run[2].impact()
    return pc.estimate(impact.simulate(stop), every=1, reconstruction=run[0], threads=1, progress=stop), impact  # type: ignore[arg-type]


def _largest(estimate: pc.Estimate, keep: np.ndarray) -> tuple[float, float]:
    """Give the largest η at some samples (J), and its kinetic part (%)."""
    total = np.where(keep, estimate.over_time.total, 0.0)
    at = int(np.argmax(total))
    return float(total[at]), 100.0 * float(estimate.over_time.kinetic[at]) / float(total[at]) if total[at] else np.nan


def _sweep(section: Section, resolution: Resolution) -> None:
    """Add figures 10 (a) and (b): the error over time, and its largest value over the step."""
    ratios = resolution.either(mass.FEW, mass.RATIOS)
    runs = [(name, ratio, _block(ratio, FRACTION)) for name in NAMES for ratio in ratios]
    found = resolution.map(_estimate, runs, lambda run: 1.0 / run[1])
    first = [Column("reconstruction"), Column("Δt/Δt_c", digits=1)]
    over_time = Table(
        "time-steps-over-time",
        "The error over time for each step. With `consistent` and `published`, an instant at which the contact zone changes has two values.",
        [*first, Column("t − t_impact", "µs"), Column("√η", "J^½", "[14]")],
        on_page=False,
    )
    columns = [Column("e_sup", "J^½", "[15]"), Column("at t − t_impact", "µs", digits=3), Column("largest at impact", "J^½", "[14]")]
    columns += [Column("largest later", "J^½", "[14]"), Column("kinetic part of it", "%", digits=3), Column("e_mean", "J^½", "[16]")]
    caption = (
        f"The largest error over time, its instant, the largest within {MOMENT:g} critical steps of the arrival and the largest after that, "
        "with the kinetic part of η there, and the mean. Γ_DA is the default of each."
    )
    sup = Table("time-steps-sup", caption, [*first, *columns], on_page=False)
    for (name, ratio, _), (estimate, impact) in zip(runs, found, strict=True):
        time, total = estimate.over_time.time, estimate.over_time.total
        for t, eta in zip(time, total, strict=True):
            over_time.add(name, ratio, 1e6 * (float(t) - impact.arrival), float(eta) ** 0.5)
        end = impact.arrival + MOMENT * impact.step / ratio
        (at_impact, _), (later, kinetic) = _largest(estimate, time <= end), _largest(estimate, time > end)
        instant = 1e6 * (estimate.time_of_sup - impact.arrival)
        sup.add(name, ratio, estimate.sup, instant, at_impact**0.5, later**0.5, kinetic, estimate.mean)
    section.add(
        f"The block of the paper's table 1 without friction on {runs[0][2].mesh} squares, 640 elements, with steps from the critical one down to a "
        f"tenth of it. The gap is crossed in a whole number of steps and {FRACTION} of one, near 0.2 mm, so that the impact falls on the same place "
        "inside a step. Instants are counted from the arrival.",
        Figure(
            "figure-10a",
            "The paper's figure 10 (a): √η over time [14] (J^½), counted from the arrival at the plane, for several Δt/Δt_c and each "
            "reconstruction.",
            _draw_over_time(over_time, [ratio for ratio in DRAWN if ratio in ratios]),
        ),
        Figure(
            "figure-10b",
            "The paper's figure 10 (b): the largest error over time [15] (J^½) over Δt/Δt_c (logarithmic). Dashed: the largest √η later than "
            f"{MOMENT:g} critical steps after the arrival, without the moment of impact.",
            _draw_sup(sup, ratios),
        ),
        _conclusion(sup, ratios),
        sup,
        over_time,
    )


def _draw_over_time(table: Table, drawn: Sequence[float]) -> figures.Drawing:
    def curve(name: str, k: int, ratio: float) -> figures.Curve:
        of: dict[str, str | float] = {"reconstruction": name, "Δt/Δt_c": ratio}
        colour = figures.ordered(1.0 - k / (len(DRAWN) - 1))
        return figures.Curve(f"Δt/Δt_c = {ratio:g}", table.where("t − t_impact", of), table.where("√η", of), colour)

    panels = [(name, [curve(name, k, ratio) for k, ratio in enumerate(drawn)]) for name in NAMES]
    return figures.lines(panels, "t − t_impact (µs)", "√η (J^½)", columns=3, zero=True)


def _draw_sup(table: Table, ratios: Sequence[float]) -> figures.Drawing:
    curves = []
    for k, name in enumerate(NAMES):
        of = {"reconstruction": name}
        for label, column in (("e_sup", "e_sup"), ("without the impact", "largest later")):
            curves.append(figures.Curve(f"{name}, {label}", ratios, table.where(column, of), figures.own(k), label != "e_sup", True))
    return figures.lines([("", curves)], "Δt/Δt_c", "error (J^½)", log="x", xticks=(0.1, 0.2, 0.3, 0.5, 0.7, 1.0), zero=True)


def _conclusion(table: Table, ratios: Sequence[float]) -> str:
    """Say how the smallest steps change the error."""
    before, least = ratios[-2:]

    def at(name: str, column: str, ratio: float) -> float:
        return float(table.where(column, {"reconstruction": name, "Δt/Δt_c": ratio})[0])

    def change(name: str, column: str) -> str:
        now = at(name, column, least)
        return f"changes by {percent(abs(now / at(name, column, before) - 1.0))} and ends at {short(now, 4)} J^½"

    each = [
        f"with `{name}` the largest error later than the impact {change(name, 'largest later')}, the one at the impact "
        f"{change(name, 'largest at impact')}"
        for name in NAMES
    ]
    return (
        "The paper observes that the error falls more and more slowly, and names two causes that do not depend on the step: the moment of "
        f"impact and the lumped mass. Here, from Δt/Δt_c = {before:g} to {least:g}, {'; '.join(each)}."
    )


def _impact(section: Section, resolution: Resolution) -> None:
    """Add the first plateau: the moment of impact, and its place inside a step."""
    ratios = resolution.first(2, IMPACT_RATIOS)
    runs = [(name, ratio, _block(ratio, fraction, PAST)) for name in NAMES for fraction in FRACTIONS for ratio in ratios]
    found = resolution.map(_estimate, runs)
    columns = [Column("reconstruction"), Column("fraction", "steps", digits=1), Column("Δt/Δt_c", digits=1)]
    columns += [Column("largest error", "J^½", "[15]"), Column("at t − t_impact", "µs", digits=3)]
    caption = (
        f"The largest error of runs that end at {short(1e6 * PAST, 2)} µs, shortly after the impact, for several fractions of a step at which "
        "the impact falls."
    )
    table = Table("time-steps-impact", caption, columns, on_page=False)
    for (name, ratio, block), (estimate, impact) in zip(runs, found, strict=True):
        table.add(name, block.flight, ratio, estimate.sup, 1e6 * (estimate.time_of_sup - impact.arrival))

    def panel(name: str) -> tuple[str, list[figures.Curve]]:
        curves = []
        for k, fraction in enumerate(FRACTIONS):
            values = table.where("largest error", {"reconstruction": name, "fraction": fraction})
            colour = figures.ordered(k / (len(FRACTIONS) - 1))
            curves.append(figures.Curve(f"at {fraction:g} of a step", ratios, values, colour, marked=True))
        return name, curves

    ticks = (100.0, 150.0, 200.0, 300.0, 500.0, 800.0)
    drawing = figures.lines([panel(name) for name in NAMES], "Δt/Δt_c", "largest error (J^½)", log="xy", columns=3, xticks=ratios, yticks=ticks)
    section.add(
        "### The first cause: the moment of impact",
        _range(table, ratios),
        Figure(
            "figure-10-impact",
            "The largest error around the impact [15] (J^½) over Δt/Δt_c (both logarithmic), for each reconstruction, one curve for each "
            "fraction of a step at which the impact falls.",
            drawing,
        ),
        table,
    )


def _range(table: Table, ratios: Sequence[float]) -> str:
    def ends(name: str, ratio: float) -> str:
        values = table.where("largest error", {"reconstruction": name, "Δt/Δt_c": ratio})
        return f"{short(min(values), 3)} to {short(max(values), 3)} J^½"

    large, small = max(ratios), min(ratios)
    each = [f"with `{name}` {ends(name, large)} at Δt/Δt_c = {large:g} and {ends(name, small)} at {small:g}" for name in NAMES]
    return (
        "In the step before contact, nodes are decelerated so that they end on the plane. This force acts before contact and is not "
        "admissible. The velocity that it takes away does not shrink with the step, and its part before contact depends on the place of the "
        f"impact inside a step. Over the fractions {FRACTIONS[0]:g} to {FRACTIONS[-1]:g} the largest error around the impact is {'; '.join(each)}."
    )
