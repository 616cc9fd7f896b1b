"""Bars that strike each other, against their exact solution: the effectivity index, and how contact and rebound converge."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import percute as pc
from percute.exact import BarRow
from studies.page import Column, Section, Table, interval, short
from studies.parallel import Resolution, Stop

LENGTH, SECTION, SPEED = 0.1, 1e-4, 10.0
"""Of the first bar: length (m), section (m²), velocity (m/s)."""
ALUMINIUM, STEEL, PLASTIC = (70e9, 2700.0), (210e9, 7800.0), (3e9, 1200.0)
"""Young's modulus (Pa) and density (kg/m³)."""
FRACTIONS = (0.1, 0.3, 0.5, 0.7, 0.9)
"""The place of the first impact in a step, after a whole one."""
RATIOS, FEW = (0.5, 0.6, 0.7, 0.8, 0.9), (0.5, 0.9)
"""Δt/Δt_c."""
MESHES = (50, 100, 200, 400)
"""Elements of a bar in the runs whose order is measured."""
ORDER = "order 2/3"


@dataclass(frozen=True)
class Bar:
    """A bar of a row, relative to the first one."""

    length: float = 1.0
    section: float = 1.0
    material: tuple[float, float] = ALUMINIUM
    size: float = 1.0
    """Size of its elements, over length of the first bar and number of elements."""
    speed: float = 0.0
    """Over that of the first bar."""

    def law(self) -> pc.Elastic:
        """Give its material."""
        return pc.Elastic(young=self.material[0], density=self.material[1], section=self.section * SECTION)


@dataclass(frozen=True)
class Row:
    """Bars in a row, the first of which strikes the others, with one time step and one gap."""

    name: str
    bars: Sequence[Bar]
    passages: float
    """T - t_c over L/c of the first bar."""
    elements: int = 50
    ratio: float = 0.9
    fraction: float = 0.5
    short_gap: bool = False
    """Whether the gaps behind the first one are a thousandth of it: bars that all but touch."""

    @property
    def step(self) -> float:
        """Δt (s): the critical step is the least h/c of all bars."""
        return self.ratio * min(self._size(bar) / math.sqrt(bar.law().young / bar.law().density) for bar in self.bars)

    def _size(self, bar: Bar) -> float:
        return bar.size * LENGTH / self.elements

    @property
    def impact(self) -> float:
        """t_c (s)."""
        return (1.0 + self.fraction) * self.step

    @property
    def passage(self) -> float:
        """L/c of the first bar (s)."""
        law = self.bars[0].law()
        return LENGTH * math.sqrt(law.density / law.young)

    def bodies(self) -> list[pc.Body]:
        """Give the bars, one behind the other."""
        made, start = [], 0.0
        gap = self.impact * SPEED * (1.0 - self.bars[1].speed)
        for number, bar in enumerate(self.bars):
            length = bar.length * LENGTH
            mesh = pc.Mesh.bar(length, elements=round(length / self._size(bar)))
            velocity = SPEED * (bar.speed if number else 1.0)
            made.append(pc.Body(name=f"bar {number + 1}", mesh=mesh, material=bar.law(), origin=start, velocity=velocity))
            start += length + gap * (1e-3 if number and self.short_gap else 1.0)
        return made

    def simulate(self, stop: Stop | None = None, passages: float | None = None) -> tuple[pc.History, BarRow]:
        """Simulate, and give the exact solution."""
        bodies = self.bodies()
        contacts = [pc.Interface(groups=(f"{a.name}.end", f"{b.name}.start")) for a, b in zip(bodies, bodies[1:], strict=False)]
        # Where a whole number of steps is due, rounding must not add one.
        steps = math.ceil((self.impact + (passages or self.passages) * self.passage) / self.step - 1e-6)
        problem = pc.Problem(bodies=bodies, contacts=contacts)
        history = pc.simulate(problem, end=steps * self.step, step=self.step, progress=stop)
        return history, BarRow(bodies=bodies, end=(steps + 1) * self.step)

    def index(self, stop: Stop | None = None) -> pc.Effectivity:
        """Give the effectivity index."""
        history, exact = self.simulate(stop)
        return pc.estimate(history, every=1, threads=1, progress=stop).effectivity(exact.error(history))


def _rows() -> list[tuple[Row, Sequence[int], Sequence[float]]]:
    """Give the cases, each with its numbers of elements and its Δt/Δt_c."""
    one = Bar()
    equal = Row("equal, head-on", (one, replace(one, speed=-1.0)), 2.0)
    pairs = {
        "equal, the second at rest": one,
        "lengths 1:2": Bar(length=2.0),
        "lengths 1:½": Bar(length=0.5),
        "sections 1:¼": Bar(section=0.25),
        "sections 1:4": Bar(section=4.0),
        "aluminium on steel": Bar(material=STEEL),
        "element sizes 1:½": Bar(size=0.5),
        "element sizes 1:2": Bar(size=2.0),
    }
    specimen = Bar(length=0.1, section=0.5, material=PLASTIC, size=0.2)
    return [
        (equal, (10, 20), RATIOS),
        (equal, (50, 100, 200, 400), RATIOS),
        (equal, (10, 20, 50, 100, 200, 400), (1.0,)),
        *((Row(name, (one, second), 3.0), (50, 100), FEW) for name, second in pairs.items()),
        (Row("cradle L–2L–L", (one, Bar(length=2.0), one), 6.0), (50, 100), FEW),
        (Row("cradle L–2L–L, gaps of 1:1000", (one, Bar(length=2.0), one), 6.0, short_gap=True), (50, 100), FEW),
        (Row("split Hopkinson bar: striker, bar, specimen, bar", (one, Bar(length=3.0), specimen, Bar(length=3.0)), 8.0), (50, 100), FEW),
    ]


def compute(section: Section, resolution: Resolution) -> None:
    """Compute the study."""
    cases = resolution.first(1, _rows())
    runs = [replace(row, elements=n, ratio=r, fraction=f) for row, meshes, ratios in cases for n in meshes for r in ratios for f in FRACTIONS]
    found = resolution.map(Row.index, runs, lambda run: run.elements**2 * sum(bar.length / bar.size for bar in run.bars) / run.ratio)
    indices = dict(zip(runs, found, strict=True))
    caption = (
        "Effectivity index e/e_Ex of the largest error ([15]) and of the mean ([16]): the range over numbers of elements, steps and the places of "
        "the impact in a step."
    )
    columns = [Column(name) for name in ("case", "T − t_c (L/c)", "elements of the first bar", "Δt/Δt_c", "runs", "sup", "mean")]
    table = Table("bar-rows", caption, columns)
    for row, meshes, ratios in cases:
        own = [indices[replace(row, elements=n, ratio=r, fraction=f)] for n in meshes for r in ratios for f in FRACTIONS]
        ranges = [interval(min(values), max(values)) for values in ([each.sup for each in own], [each.mean for each in own])]
        ends = [f"{values[0]:g}–{values[-1]:g}" if len(values) > 1 else f"{values[0]:g}" for values in (meshes, ratios)]
        table.add(row.name, short(row.passages, 1), *ends, len(own), *ranges)
    headings = ("case", "elements", "step over critical step", "place of the impact in a step", "sup", "mean")
    every = Table("bar-rows-runs", "All of these runs.", [Column(name) for name in headings], on_page=False)
    for run in runs:
        every.add(run.name, run.elements, run.ratio, run.fraction, indices[run].sup, indices[run].mean)
    section.add(INTRODUCTION, table, _convergence(resolution), every)


INTRODUCTION = (
    "Bars of 0.1 m and more in a row, free at both ends: the first flies at 10 m/s against the others. The exact solution follows the waves from "
    "bar to bar (`percute.exact.BarRow`). All gaps are the way of the first bar in 1 + f steps, f = 0.1, 0.3, 0.5, 0.7, 0.9, unless stated. Bars are "
    "of aluminium and of one section unless stated; the specimen is of plastic (3 GPa, 1200 kg/m³) with half of the section and a tenth of the length."
)


def _measured(elements: int, stop: Stop | None = None) -> list[float]:
    """Of all places of the impact in a step, give the value farthest from the exact one of each quantity."""
    values = []
    for fraction in FRACTIONS:
        run = Row("", (Bar(), Bar()), 3.0, elements, fraction=fraction)
        history, _ = run.simulate(stop)
        force = history.contact.obstacles[0].normal_force
        masses = history.problem.mass[: elements + 1]
        mean = [float(masses @ history.velocity[-1][k : k + elements + 1, 0] / masses.sum()) for k in (0, elements + 1)]
        touching = history.time[force > 0]
        middle = (history.time > run.impact + 0.5 * run.passage) & (history.time < run.impact + 1.5 * run.passage)
        values.append([float(np.count_nonzero(force > 0)) * run.step, *mean, float(force[middle].mean()), float(touching[0]) + run.step / 2 - run.impact])
    return [max(column, key=lambda value: abs(value - exact)) for column, exact in zip(zip(*values, strict=True), _exact(), strict=True)]


def _exact() -> list[float]:
    """Give contact 2L/c, exchanged velocities, the force ρcSv/2 and the delay of the contact."""
    young, density = ALUMINIUM
    return [2 * LENGTH * math.sqrt(density / young), 0.0, SPEED, math.sqrt(young * density) * SECTION * SPEED / 2, 0.0]


def _convergence(resolution: Resolution) -> Table:
    """Measure the orders of convergence of a bar that strikes an equal one at rest."""
    found = resolution.map(_measured, MESHES)
    caption = (
        f"A bar strikes an equal one at rest, steps of 0.9 Δt_c, on {', '.join(map(str, MESHES))} elements; the value farthest from the exact one of five "
        "places of the impact in a step. A front is smeared over h^(2/3), so that contact ends that much too late or too early."
    )
    names = ("quantity", "unit")
    numbers = [Column("exact", digits=5), *(Column(f"on {n}", digits=5) for n in MESHES), Column("order", digits=2), Column("expected")]
    table = Table("bar-rows-convergence", caption, [*(Column(name) for name in names), *numbers])
    quantities = (
        ("duration of contact, 2L/c", "s", ORDER),
        ("velocity of the first bar after contact", "m/s", ORDER),
        ("velocity of the second bar after contact", "m/s", ORDER),
        ("contact force, middle half", "N", "within a thousandth"),
        ("first contact, late by", "s", "within half a step"),
    )
    for k, ((name, unit, expected), exact) in enumerate(zip(quantities, _exact(), strict=True)):
        values = [each[k] for each in found]
        order = math.log2(abs((values[0] - exact) / (values[-1] - exact))) / (len(MESHES) - 1) if expected == ORDER else None
        table.add(name, unit, exact, *values, order, expected)
    return table
