"""The paper's figures 5 and 6: the error of a bar that strikes, and the effectivity, over mesh and step."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from itertools import product

import numpy as np

from studies import figures
from studies.bar import BAR, WHOLE, Outcome, Setting
from studies.choices import ACCELERATIONS, CHOICES, DEFAULT, RECONSTRUCTIONS, of_default
from studies.page import Column, Figure, Section, Table, short
from studies.parallel import Resolution

PAPER = (0.7, 1.8)
"""The range of the effectivity that the paper states (§7.1.6)."""
ELEMENTS, RATIOS = (10, 20, 40, 80, 160, 240, 400), (0.5, 0.6, 0.7, 0.8, 0.9, 1.0)
"""N_s and α of the paper's figures 5 and 6: from 10 to 400 and from 0.5 to 1."""
FRACTIONS, MIDDLE = (0.1, 0.3, 0.5, 0.7, 0.9), 0.5
"""Fractions of a step at which the impact falls, and that of the maps."""
ENDS = (2.0, 3.0)
"""(T − t_c)/(L/c): at the end of contact, and half of the time of contact later."""
FEW = 3
"""Meshes of a small study."""
MEASURES = ("sup", "mean")
SWEEP, SWEEP_RATIOS, TWENTIETHS = 80, (0.5, 0.9), 20
"""Elements and steps of the runs over the instant of impact, and the number of instants in a step."""
PLACE = "elements, Δt/Δt_c, fraction"

Value = tuple[float, Setting]
Wanted = Callable[[Setting], bool]


class Grid:
    """All runs over elements, step, fraction and end, with their results."""

    def __init__(self, elements: Sequence[int], resolution: Resolution) -> None:
        self.elements = elements
        self.settings = [Setting(*values) for values in product(elements, RATIOS, FRACTIONS, ENDS)]
        self.outcomes = _run(self.settings, CHOICES, resolution)

    def effectivities(self, choice: int, measure: int, wanted: Wanted) -> Iterator[Value]:
        """Give the effectivities of a choice in one measure, with their settings."""
        return ((o.effectivity(choice)[measure], s) for s, o in zip(self.settings, self.outcomes, strict=True) if wanted(s))

    def cells(self, values: Iterator[Value]) -> np.ndarray:
        """Give a value for each cell of a map; of several in a cell, the one farthest from 1 as a ratio."""
        found: dict[tuple[float, int], float] = {}
        for value, setting in values:
            at = setting.ratio, setting.elements
            if at not in found or abs(math.log(value)) > abs(math.log(found[at])):
                found[at] = value
        return np.array([[found.get((ratio, n), math.nan) for n in self.elements] for ratio in RATIOS])

    def map(self, colours: figures.Colours, values: Callable[[int], np.ndarray]) -> figures.Drawing:
        """Draw a map for each choice: a row for each reconstruction, a column for each Γ_DA."""
        maps = [(f"{choice['reconstruction']}, {choice['acceleration']}", values(c)) for c, choice in enumerate(CHOICES)]
        x, y = ("number of elements", [str(n) for n in self.elements]), ("Δt/Δt_c", [short(ratio, 1) for ratio in RATIOS])
        return figures.heat_maps(maps, x, y, colours, columns=len(ACCELERATIONS))

    def relative(self) -> figures.Drawing:
        """Draw figure 5: ε in per cent, from the lowest to the highest value."""

        def values(choice: int) -> np.ndarray:
            runs = zip(self.settings, self.outcomes, strict=True)
            return self.cells((100 * o.estimates[choice][2], s) for s, o in runs if _middle(s))

        every = np.stack([values(c) for c in range(len(CHOICES))])
        return self.map(figures.ratio("relative error (%)", every.min(), every.max()), values)

    def effectivity(self, measure: int, wanted: Wanted) -> figures.Drawing:
        """Draw figure 6: effectivities, those farthest from 1."""
        return self.map(figures.around_one("effectivity", 4.0), lambda c: self.cells(self.effectivities(c, measure, wanted)))

    def table(self) -> Table:
        """Give all numbers."""
        columns = [Column("reconstruction"), Column("Γ_DA"), Column("elements"), Column("Δt/Δt_c", digits=2)]
        columns += [Column("fraction", "steps", digits=2), Column("T − t_c", "L/c", digits=2)]
        columns += [Column("e sup", "J^½", "[15]"), Column("e mean", "J^½", "[16]"), Column("ε sup", "", "[22]"), Column("ε mean", "", "[22]")]
        columns += [Column(f"true error {measure}", "J^½", "[60]") for measure in MEASURES]
        caption = "Estimated, relative and true error of all runs of the maps. The effectivity is e over the true error."
        table = Table("bar-maps", caption, columns, on_page=False)
        for c, choice in enumerate(CHOICES):
            for s, outcome in zip(self.settings, self.outcomes, strict=True):
                place = s.elements, s.ratio, s.fraction, s.after_impact
                table.add(*choice.values(), *place, *outcome.estimates[c], *outcome.exact)
        return table


class Summary:
    """The range of some effectivities, and how many are in the paper's range."""

    def __init__(self, values: Iterator[Value]) -> None:
        found = list(values)
        self.count = len(found)
        self.low, self.low_at = min(found, key=lambda value: value[0])
        self.high, self.high_at = max(found, key=lambda value: value[0])
        self.within = sum(PAPER[0] <= value <= PAPER[1] for value, _ in found) / len(found)
        self.ratio = self.high / self.low

    COLUMNS = (
        Column("lowest", digits=3), Column("lowest at", PLACE), Column("highest", digits=3), Column("highest at", PLACE),
        Column(f"within {PAPER[0]} to {PAPER[1]}", "%", digits=3), Column("highest/lowest", digits=3),
    )  # fmt: skip

    def cells(self) -> tuple[float | str, ...]:
        """Give the cells of these columns."""
        return self.low, _at(self.low_at), self.high, _at(self.high_at), 100 * self.within, self.ratio


def _at(setting: Setting) -> str:
    return f"{setting.elements} elements, {setting.ratio:g}, {setting.fraction:g}"


def _middle(setting: Setting) -> bool:
    """Pick the runs of the maps: impact in the middle of a step, end well after the release."""
    return setting.fraction == MIDDLE and setting.after_impact == ENDS[1]


def _until(end: float) -> Wanted:
    return lambda setting: setting.after_impact == end


def _run(settings: Sequence[Setting], choices: Sequence[dict[str, str]], resolution: Resolution) -> list[Outcome]:
    return resolution.map(lambda setting, stop: setting.run(choices, stop), settings, lambda s: s.elements**2 / s.ratio)


def compute(section: Section, resolution: Resolution) -> None:
    """Compute the study."""
    grid = Grid(resolution.first(FEW, ELEMENTS), resolution)
    sweep = _sweep(resolution)
    section.add(INTRODUCTION, Figure("figure-5", FIGURE_5, grid.relative()), _ranges(grid))
    for m, what in enumerate(("largest error [15]", "mean error [16]")):
        section.add(Figure(f"figure-6-{MEASURES[m]}", f"The paper's figure 6: effectivity e/e_Ex of the {what} [60]{MAPS}", grid.effectivity(m, _middle)))
    # A summary needs all runs.
    summaries = [] if resolution.small else [_by_choice(grid), _by_fraction(grid)]
    section.add(*summaries[:1], INSTANTS, Figure("figure-6-worst", WORST, grid.effectivity(0, _until(ENDS[1]))))
    section.add(Figure("figure-6-instants", SWEPT, _draw_sweep(sweep)), *summaries[1:], _effectivities(grid), sweep, grid.table())


INTRODUCTION = (
    f"An aluminium bar (E = {1e-9 * BAR['young']:g} GPa, L = {BAR['length']} m, S = {BAR['section']} m², ρ = {BAR['density']:g} kg/m³) flies at "
    f"{BAR['speed']:g} m/s against a rigid plane. The exact solution is known: contact lasts 2L/c, and then the bar flies back. The true error e_Ex "
    "[60] is measured against it at the instants t_n. The effectivity is the estimate over it, of the largest values over time (`sup`) or of the "
    "means (`mean`). Steps are fractions of the critical one, Δt_c = h/c [33]. The paper states neither the gap nor the end of its runs. Here the "
    f"impact falls {WHOLE:g} + f steps after the start, for several fractions f. Runs end {ENDS[0]:g} L/c after the impact t_c, when contact ends, "
    f"or {ENDS[1]:g} L/c after it, in the flight back; up to a step is added, so that the number of steps is whole."
)
FIGURE_5 = (
    "The paper's figure 5: relative error ε of the largest values [22] (%, colours logarithmic) over the number of elements and Δt/Δt_c, for each "
    f"reconstruction (rows) and each Γ_DA (columns); impact at {MIDDLE} of a step, T = t_c + {ENDS[1]:g} L/c. As the paper states, smaller "
    "steps hardly improve the solution; a finer mesh does."
)
MAPS = (
    f" over the number of elements and Δt/Δt_c, for each reconstruction (rows) and each Γ_DA (columns); impact at {MIDDLE} of a step, "
    f"T = t_c + {ENDS[1]:g} L/c. Pale is 1, blue too small, red too large; colours are in equal ratios from 1/4 to 4."
)
INSTANTS = (
    "The scheme stops the node that touches at the end of a step, wherever inside the step the bar arrives. The loss, and the part of it that the "
    "estimate contains, depend on the fraction of the step that is left."
)
WORST = (
    f"The same maps as for the paper's figure 6, of the largest error [15], T = t_c + {ENDS[1]:g} L/c, but each value is the one farthest from 1 (as "
    f"a ratio) over the fractions {', '.join(map(str, FRACTIONS))} of a step at which the impact falls."
)
SWEPT = (
    f"Effectivity e/e_Ex of the largest error (`sup`, [15]) and of the mean ([16]) on {SWEEP} elements over the fraction of a step at which the impact "
    f"falls, at two lengths of the step, with Γ_DA `{DEFAULT}`: one curve for each reconstruction. At a fraction of 1 the bar arrives at an instant "
    "of the scheme. The band is the range that the paper states."
)


def _ranges(grid: Grid) -> str:
    """State the ranges of the effectivities with the default Γ_DA."""
    of = {(name, m, end): Summary(grid.effectivities(of_default(name), m, _until(end))) for name in RECONSTRUCTIONS for m in (0, 1) for end in ENDS}
    whole = {name: [s for (other, *_), s in of.items() if other == name] for name in RECONSTRUCTIONS}
    spans = [f"{short(min(s.low for s in each), 2)} to {short(max(s.high for s in each), 3)} with `{name}`" for name, each in whole.items()]
    wider = []
    for m, end in product((0, 1), ENDS):
        own, least = of["corrected", m, end].ratio, min(of[name, m, end].ratio for name in RECONSTRUCTIONS[1:])
        if own > 0.5 * least:
            wider.append(f"`{MEASURES[m]}` with T = t_c + {end:g} L/c: {short(own, 3)} against {short(least, 3)} with the better of the two")
    verb = "s are" if len(wider) > 1 else " is"
    exception = f" The exception{verb} {'; '.join(wider)}, because of the runs at Δt = Δt_c." if wider else ""
    below = [Summary(grid.effectivities(of_default("corrected"), m, lambda s: s.after_impact == ENDS[1] and s.ratio < 1)) for m in (0, 1)]
    ranges = " and ".join(f"{short(s.low, 3)} to {short(s.high, 3)} (`{name}`)" for s, name in zip(below, MEASURES, strict=True))
    return (
        f"The paper finds effectivities from {PAPER[0]} to {PAPER[1]} and does not state of which measure. Over all runs and both measures, with "
        f"Γ_DA `{DEFAULT}`, they are {', '.join(spans)}. The highest means are of runs that stop with the contact, at Δt = Δt_c: there the solution "
        "is exact except in the step of the impact. The low ends of `consistent` and `published` come from fine meshes and small steps, where "
        "dispersion adds up behind the front: a measure whose balance is that of the simulation's own displacements does not contain the "
        "accumulated error. `corrected` balances an auxiliary solution with less dispersion instead, and its values come near 1 just there. Its own "
        "low end is at Δt = Δt_c in the runs that go on beyond the contact. There the simulation is at its limit of stability, and its shortest "
        "wave, once the release has excited it, grows with time. That of the auxiliary solution does not grow, but the release excites it as well, "
        "and about half of that is missing in the estimate. With `corrected`, the ratio of the highest to the lowest value is at most half of that "
        f"with either other reconstruction.{exception} With all shorter steps, `corrected` is {ranges} until t_c + {ENDS[1]:g} L/c."
    )


def _effectivities(grid: Grid) -> Table:
    columns = [Column("reconstruction"), Column("measure"), Column("elements"), *(Column(f"Δt/Δt_c = {short(ratio, 1)}", digits=3) for ratio in RATIOS)]
    table = Table("bar-maps-effectivity", f"The effectivities of the paper's figure 6 with Γ_DA `{DEFAULT}`.", columns, on_page=False)
    for name, (m, measure) in product(RECONSTRUCTIONS, enumerate(MEASURES)):
        cells = grid.cells(grid.effectivities(of_default(name), m, _middle))
        for n, elements in enumerate(grid.elements):
            table.add(name, measure, elements, *(float(value) for value in cells[:, n]))
    return table


def _by_choice(grid: Grid) -> Table:
    caption = (
        f"Effectivity e/e_Ex over {ELEMENTS[0]} to {ELEMENTS[-1]} elements, Δt/Δt_c from {RATIOS[0]} to {RATIOS[-1]:g} and the fractions "
        f"{', '.join(map(str, FRACTIONS))} of a step: its range, the places of its ends, and the part of it in the range that the paper states; on the "
        f"page until the end of contact with Γ_DA `{DEFAULT}`."
    )
    columns = [Column("reconstruction"), Column("Γ_DA"), Column("measure"), Column("T − t_c", "L/c", digits=2), Column("runs"), *Summary.COLUMNS]
    table = Table("bar-maps-summary", caption, columns, on_page={"Γ_DA": DEFAULT, "T − t_c": ENDS[0]})
    for (c, choice), (m, measure), end in product(enumerate(CHOICES), enumerate(MEASURES), ENDS):
        summary = Summary(grid.effectivities(c, m, _until(end)))
        table.add(*choice.values(), measure, end, summary.count, *summary.cells())
    return table


def _by_fraction(grid: Grid) -> Table:
    caption = (
        f"Range of the effectivity of the largest error with Γ_DA `{DEFAULT}` and runs until t_c + {ENDS[1]:g} L/c, for each fraction of a step at "
        "which the impact falls."
    )
    columns = [Column("reconstruction"), Column("fraction", "steps", digits=1), *Summary.COLUMNS]
    table = Table("bar-maps-fractions", caption, columns, on_page=False)
    for name, fraction in product(RECONSTRUCTIONS, FRACTIONS):
        wanted = grid.effectivities(of_default(name), 0, lambda s, f=fraction: s.fraction == f and s.after_impact == ENDS[1])  # type: ignore[misc]
        table.add(name, fraction, *Summary(wanted).cells())
    return table


def _sweep(resolution: Resolution) -> Table:
    """Run over the fraction of a step at which the impact falls, with the default Γ_DA."""
    settings = [Setting(SWEEP, ratio, k / TWENTIETHS, ENDS[1]) for ratio in SWEEP_RATIOS for k in range(1, TWENTIETHS + 1)]
    outcomes = _run(settings, [CHOICES[of_default(name)] for name in RECONSTRUCTIONS], resolution)
    columns = [Column("reconstruction"), Column("Δt/Δt_c"), Column("fraction", "steps", digits=2), *(Column(name, digits=3) for name in MEASURES)]
    caption = f"Effectivity on {SWEEP} elements over the fraction of a step at which the impact falls."
    table = Table("bar-maps-instants", caption, columns, on_page=False)
    for r, name in enumerate(RECONSTRUCTIONS):
        for setting, outcome in zip(settings, outcomes, strict=True):
            table.add(name, setting.ratio, setting.fraction, *outcome.effectivity(r))
    return table


def _draw_sweep(table: Table) -> figures.Drawing:
    """Draw a panel for each measure and step, with a curve for each reconstruction."""

    def curve(k: int, name: str, measure: str, ratio: float) -> figures.Curve:
        of: dict[str, str | float | int | None] = {"reconstruction": name, "Δt/Δt_c": ratio}
        return figures.Curve(name, table.where("fraction", of), table.where(measure, of), figures.own(k), marked=True)

    panels = [
        (f"{measure}, Δt/Δt_c = {ratio}", [curve(k, name, measure, ratio) for k, name in enumerate(RECONSTRUCTIONS)])
        for measure, ratio in product(MEASURES, SWEEP_RATIOS)
    ]
    return figures.lines(panels, "fraction of a step at which the impact falls", "effectivity", columns=2, band=PAPER, zero=True)
