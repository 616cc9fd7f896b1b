"""The effectivity index as steps become short."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from studies import figures
from studies.bar import Setting
from studies.impacts import CORNER, FEW, FLAT, GOOD, RECONSTRUCTION_OPTIONS, Case, cases, holds, inside
from studies.page import Column, Figure, Section, Table, interval
from studies.parallel import Resolution, Stop

RATIOS = (0.9, 0.5, 0.2, 0.1, 0.05, 0.02)
"""Δt/Δt_c."""
ELEMENTS, FRACTIONS = 40, (0.1, 0.3, 0.5, 0.7, 0.9)
"""The bar, and the fractions of a step at which its impact falls."""
ATTEMPTS: dict[str, dict[str, Any]] = {options["reconstruction"]: options for options in RECONSTRUCTION_OPTIONS}
ATTEMPTS["corrected, not spread"] = {"ablation": "impulse smoothing"}
"""The reconstructions, and the default with reactions that are not spread in time."""
KNOWN = len(RECONSTRUCTION_OPTIONS)
"""Attempts that have verdicts."""
MEASURES = ("sup", "mean")
ENDS = tuple(f"{end}, {measure}" for measure in MEASURES for end in ("lowest", "highest"))

Subject = Case | None
"""A plane body, or the bar."""


def _name(subject: Subject) -> str:
    return f"bar, {ELEMENTS} elements" if subject is None else subject.name


def _ranges(run: tuple[Subject, float], stop: Stop) -> tuple[list[list[float]], list[bool]]:
    """Give lowest and highest of sup and mean for each attempt at one ratio, and whether verdicts hold, of each reconstruction."""
    (subject, ratio), choices = run, list(ATTEMPTS.values())
    if subject is None:
        outcomes = [Setting(ELEMENTS, ratio, fraction, 2.0).run(choices, stop) for fraction in FRACTIONS]
        found = [[outcome.effectivity(r) for outcome in outcomes] for r in range(len(choices))]
        held = [kept for outcome in outcomes for kept in outcome.held[:KNOWN]]
    else:
        finest = subject.at(ratio=ratio).finest(choices, stop)
        found = [[finest.effectivity(r)] for r in range(len(choices))]
        held = [holds(finest.estimates[r], finest.effectivity(r)) for r in range(KNOWN)]
    ranges = [[pick(pair[m] for pair in pairs) for m in range(2) for pick in (min, max)] for pairs in found]
    return ranges, held


def add(section: Section, resolution: Resolution) -> None:
    """Compute the runs and add text, figure and tables."""
    bodies = [next(case for case in cases() if case.kind == kind and case.friction > 0.0) for kind in (FLAT, CORNER)]
    subjects = resolution.first(1, [None, *(case.few() for case in bodies)])
    runs = [(subject, ratio) for subject in subjects for ratio in RATIOS]
    found = resolution.map(_ranges, runs, lambda run: (0.0 if run[0] is None else 1.0) + 1.0 / run[1])
    columns = [Column("body"), Column("reconstruction"), Column("Δt/Δt_c", digits=2), *(Column(end, digits=3) for end in ENDS)]
    caption = "Effectivity index over Δt/Δt_c: for the bar the lowest and the highest over the fractions of a step, for a plane body one value."
    table = Table("effectivity-steps", caption, columns, on_page=False)
    for (subject, ratio), (ranges, _) in zip(runs, found, strict=True):
        for attempt, values in zip(ATTEMPTS, ranges, strict=True):
            table.add(_name(subject), attempt, ratio, *values)
    section.add(
        "### Short steps",
        "The simulation brings the mass of an arriving node to rest within a step: the shorter the step, the larger the force. The estimate "
        "must not follow it, and `corrected` spreads its impulses in time for this reason. The bar of the paper's figure 5, with impacts at "
        f"{len(FRACTIONS)} fractions of a step and until t_c + 2L/c, is compared with the exact solution, plane bodies on mesh {FEW} with the "
        "first reference. A force that is spread over the time of a wave through the depth of the node begins with twice the exact one: on "
        "the flat block the largest error of `corrected` is then that of the impact and rises to a limit with shorter steps. The mean does not. "
        f"{inside(kept for _, held in found for kept in held)}",
        Figure(
            "effectivity-steps",
            "Effectivity index over Δt/Δt_c (both axes logarithmic), a panel for each body: the largest error [15] as lines, the mean [16] "
            f"dashed, the largest over the fractions of a step. The band is from {GOOD[0]} to {GOOD[1]}.",
            _draw(table, subjects),
        ),
        _summary(table, subjects),
        table,
    )


def _summary(table: Table, subjects: Sequence[Subject]) -> Table:
    """Give one row for each body: the ranges of both measures with each attempt."""
    columns = [Column("body"), *(Column(f"{attempt}: {measure}") for attempt in ATTEMPTS for measure in MEASURES)]
    summary = Table("effectivity-steps-range", f"The range of the effectivity index over Δt/Δt_c from {RATIOS[-1]} to {RATIOS[0]}.", columns)
    for subject in subjects:
        of = [{"body": _name(subject), "reconstruction": attempt} for attempt in ATTEMPTS]
        summary.add(
            _name(subject),
            *(interval(min(table.where(f"lowest, {m}", each)), max(table.where(f"highest, {m}", each))) for each in of for m in MEASURES),
        )
    return summary


def _draw(table: Table, subjects: Sequence[Subject]) -> figures.Drawing:
    def curve(subject: Subject, k: int, attempt: str, measure: str) -> figures.Curve:
        of = {"body": _name(subject), "reconstruction": attempt}
        values, dashed = table.where(f"highest, {measure}", of), measure == "mean"
        return figures.Curve(f"{attempt}, {measure}", RATIOS, values, figures.own(k), dashed=dashed, marked=True)

    order = list(enumerate(ATTEMPTS))
    panels = [(_name(subject).split(",")[0], [curve(subject, k, a, m) for k, a in order for m in MEASURES]) for subject in subjects]
    ticks = (0.5, 0.7, 1.0, 1.5, 2.0, 3.0, 5.0, 10.0)
    return figures.lines(panels, "Δt/Δt_c", "e/e_ref", log="xy", columns=3, band=GOOD, xticks=(0.02, 0.05, 0.1, 0.2, 0.5), yticks=ticks)
