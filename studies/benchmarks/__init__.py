"""Exact and published cases: each runs several times and is compared with its exact solution.

The case files are in ``cases``; `bars`, `vibrations` and `blocks` state the exact solutions and the quantities.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from studies import figures
from studies.benchmarks import bars, blocks, vibrations
from studies.benchmarks.trial import Curve, Outcome
from studies.page import Column, Figure, Section, Table, short
from studies.parallel import Resolution, Stop


@dataclass(frozen=True)
class Benchmark:
    """A case and its comparison."""

    key: str
    """The name of its case file."""
    title: str
    source: str
    """The source of the solution."""
    run: Callable[[Stop], Outcome]
    refined: str = "element size and step"
    """What is halved from run to run."""


GIBERT, COULOMB, UNIFORM = "Louf, Gallimard and Pelle, §7.1; Gibert (1988)", "Coulomb's law for a rigid block", "linear displacement, uniform stress"
DOYEN = "Doyen, Ern and Piperno (2011), SIAM J. Sci. Comput. 33, 223–249; d'Alembert"
DABAGHI = "Dabaghi, Petrov, Pousin and Renard, HAL hal-00917450; d'Alembert"
TIMOSHENKO, GRAFF = "Timoshenko, Vibration Problems in Engineering", "Graff, Wave Motion in Elastic Solids, §5.1"
STIFFER, ONCE = "1/c of the block", "nothing, one run"

BENCHMARKS = (
    Benchmark("bar_impact", "A bar strikes a wall, for five places of the impact in a step", GIBERT, bars.bar_impact),
    Benchmark("bouncing_bar", "A bar bounces on the ground", DOYEN, bars.bouncing_bar),
    Benchmark("clamped_rod", "A clamped rod springs back against an obstacle", DABAGHI, bars.clamped_rod),
    Benchmark("steel_bar", "A steel bar creeps against a wall", GIBERT, bars.steel_bar),
    Benchmark("bar_mode", "A clamped bar swings in its second mode", TIMOSHENKO, vibrations.bar_mode),
    Benchmark("block_mode", "A block between rollers swings in a mode", GRAFF, vibrations.block_mode),
    Benchmark("bar_ramp", "A clamped bar is pulled by a traction that grows linearly", f"{TIMOSHENKO}; d'Alembert", vibrations.bar_ramp),
    Benchmark("tilted_plane", "A stiff block on a plane tilted by 30° slides with μ = 0.3 and sticks with 0.7", COULOMB, blocks.tilted_plane, STIFFER),
    Benchmark("stick_slip", "A stiff block is pushed to and fro, sticks and slips", COULOMB, blocks.stick_slip, STIFFER),
    Benchmark("oblique", "A block strikes the ground, straight and sliding with μ = 0.2", "balance of momentum and energy, Coulomb's law", blocks.oblique),
    Benchmark("patch", "The patch test: a uniform stress in a body that flies", UNIFORM, blocks.patch, ONCE),
    Benchmark("patch_contact", "The patch test in contact: a uniform stress, pressed and sheared on the ground", UNIFORM, blocks.patch_contact, ONCE),
)
POINTS = 400
"""Points of a curve in the figure and in its table."""


def compute(section: Section, resolution: Resolution) -> None:
    """Run all cases, also in a small study: it takes seconds."""
    outcomes = resolution.map(lambda case, stop: case.run(stop), BENCHMARKS)
    cases, rows, runs, curves = _tables()
    panels = []
    for case, outcome in zip(BENCHMARKS, outcomes, strict=True):
        orders, within = [], []
        for each in outcome.quantities:
            numbers = each.exact, each.computed[-1], each.difference, each.observed, each.order, each.bound
            rows.add(case.key, each.name, each.unit, *numbers, each.reason)
            for run, computed in enumerate(each.computed):
                runs.add(case.key, each.name, run + 1, computed, computed - each.exact)
            if each.observed is not None and each.order is not None:
                orders.append(f"{short(each.observed, 2)} ({short(each.order, 2)})")
            elif each.bound is not None:
                within.append(abs(each.difference) <= each.bound)
        bounded = f"{sum(within)} of {len(within)}" if within else None
        cases.add(case.key, case.title, case.refined, case.source, ", ".join(orders) or None, bounded)
        if outcome.curve is not None:
            panels.append((case.key, outcome.curve))
            _thin(curves, case.key, outcome.curve)
    section.add(INTRODUCTION, cases, Figure("benchmarks", CAPTION, _draw(panels)), rows, runs, curves)


INTRODUCTION = (
    "Each case is a file in `studies/benchmarks/cases`. It is run several times, and each run halves the quantity in the "
    "third column. Where velocities jump, central differences smear the front over a width of h^(2/3): errors of order 1/3 in the energy norm and "
    "of order 2/3 in all quantities that depend on the arrival of the front are those of the scheme, not of contact."
)
CAPTION = (
    "Exact (dashed) and computed curves of the first run, the coarsest: contact force of `bar_impact`, gap of `bouncing_bar` and `clamped_rod`, "
    "velocity of the pulled end of `bar_ramp`, distance of `stick_slip`, tangential impulse of `oblique`."
)


def _tables() -> tuple[Table, Table, Table, Table]:
    """Give the tables of cases, quantities, runs and curves, without rows."""
    caption = (
        "The cases, the sources of their solutions, and the results: the mean order of each quantity over all runs, beside the order that "
        "theory predicts, and how many of the quantities without an order are within their bound."
    )
    names = ("case", "subject", "halved from run to run", "source", "observed orders (expected)", "quantities within their bound")
    cases = Table("benchmarks-cases", caption, [Column(name) for name in names])
    first = [Column("case"), Column("quantity")]
    exact, computed = Column("exact", digits=6), Column("computed", digits=6)
    columns = [*first, Column("unit"), exact, computed, *(Column(name, digits=2) for name in ("difference", "order", "expected order", "bound"))]
    caption = "All quantities: exact, computed by the last run, the difference and its order or bound, with the reason."
    rows = Table("benchmarks", caption, [*columns, Column("reason")], on_page=False)
    columns = [*first, Column("run"), computed, Column("difference", digits=3)]
    runs = Table("benchmarks-runs", "The same of all runs.", columns, on_page=False)
    columns = [*first, Column("unit"), Column("time", digits=6), Column("time unit"), exact, computed]
    return cases, rows, runs, Table("benchmarks-curves", "The curves of the figure.", columns, on_page=False)


def _thin(table: Table, key: str, curve: Curve) -> None:
    every = -(-len(curve.time) // POINTS)
    for t, exact, computed in zip(curve.time[::every], curve.exact[::every], curve.computed[::every], strict=True):
        table.add(key, curve.name, curve.unit, float(t), curve.time_unit, float(exact), float(computed))


def _draw(panels: list[tuple[str, Curve]]) -> figures.Drawing:
    """Draw a panel for each curve, with axes of its own."""
    curves = [
        (key.replace("_", " "), [figures.Curve("exact", c.time, c.exact, dashed=True), figures.Curve("computed", c.time, c.computed, figures.own(0))])
        for key, c in panels
    ]
    x, y = [f"time ({c.time_unit})" for _, c in panels], [f"{c.name} ({c.unit})" for _, c in panels]
    return figures.lines(curves, x, y, columns=3)
