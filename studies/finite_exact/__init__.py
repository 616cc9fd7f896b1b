"""Finite kinematics against exact solutions: shocks, steady spins, a bent beam, and the limit of a rigid body.

``python -m studies.finite_exact`` prints the table, which is a section of ``docs/verification.md``. `shock`, `spin`, `elastica` and `rigid` state
the solutions and the quantities; `numerics` integrates their equations.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

from studies.benchmarks.trial import Outcome, Quantity
from studies.finite_exact import elastica, rigid, shock, spin
from studies.page import Column, Section, Table
from studies.parallel import Resolution, Stop

SIZE, STIFFER = "element size and step", "1/c"


@dataclass(frozen=True)
class Comparison:
    """Some runs and their exact solution."""

    name: str
    run: Callable[[Stop | None], Outcome]
    halved: str = SIZE
    """What is halved from run to run."""


COMPARISONS = (
    Comparison("shock in a bar", partial(shock.shock, "bar")),
    Comparison("shock in a block", partial(shock.shock, "block")),
    Comparison("spinning bar", spin.spinning_bar),
    Comparison("spinning ring", spin.spinning_ring),
    Comparison("bent beam", elastica.bent_beam),
    Comparison("tumbling block", rigid.tumbling_block, STIFFER),
    Comparison("struck corner", rigid.struck_corner, STIFFER),
)


def table() -> Table:
    """Give the table, without rows."""
    caption = (
        "Exact and computed quantities, each of three runs. From run to run the quantity in the second column is halved. What converges "
        "has an order, observed and expected; what does not has a bound of the last difference."
    )
    names = ("case", "halved", "quantity", "unit")
    values = [Column(f"run {n}", digits=6) for n in (1, 2, 3)]
    orders = [Column("order", digits=2), Column("expected order", digits=2), Column("bound", digits=2)]
    return Table("finite-exact", caption, [*(Column(name) for name in names), Column("exact", digits=6), *values, *orders])


def fill(rows: Table, comparison: Comparison, quantity: Quantity) -> None:
    """Add a row."""
    found = *quantity.computed, quantity.observed, quantity.order, quantity.bound
    rows.add(comparison.name, comparison.halved, quantity.name, quantity.unit or None, quantity.exact, *found)


def compute(section: Section, resolution: Resolution) -> None:
    """Run all comparisons, also in a small study: it takes seconds."""
    outcomes = resolution.map(lambda each, stop: each.run(stop), COMPARISONS)
    rows = table()
    for comparison, outcome in zip(COMPARISONS, outcomes, strict=True):
        for quantity in outcome.quantities:
            fill(rows, comparison, quantity)
    section.add(*TEXTS, rows)


TEXTS = (
    "Neo-Hookean bodies of rubber (10 MPa, 1100 kg/m³), in plane strain but for the bar, with steps of 0.9.",
    "Shock: a bar, or a block with ν = 0.4 that is held at its sides, flies against a plane at 10 m/s, 0.10 and 0.07 of the wave speed. Exact "
    "is the shock of Rankine and Hugoniot, ρSV = −P(F) and S(1 − F) = V. The scheme does not dissipate: in place of the jump it has a train of "
    "waves, the first of which runs ahead. The state behind them is that of a simple wave, V = ∫c dF, which keeps the energy, too. Both states "
    "differ by the third power of the strain.",
    "Spin: a rectangle with ν = 0, where P′ = −ρω²x along both axes, and a ring with ν = 0.4, by its radial balance, start in their exact "
    "steady state and turn once.",
    "Bent beam: a clamped beam with ν = 0, 20 times as long as high, bends under PL²/EI = 2 like Euler's elastica. Its equilibrium is the mean "
    "of small vibrations. One, two and four cells across, each cut in four, are too stiff in bending. The value extrapolated from two meshes "
    "shows that the mesh is the reason.",
    "Tumbling block, struck corner: a block with ν = 0.3 turns once in free flight, or falls on a corner at 2 m/s without friction, with wave "
    "speeds of 111, 221 and 442 m/s.",
)
