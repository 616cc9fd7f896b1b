"""The paper's table 1, with the assumptions that the paper leaves open."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import percute as pc
from studies import figures
from studies.block import Block
from studies.choices import ACCELERATIONS, DEFAULTS, PLANE_CHOICES, RECONSTRUCTIONS
from studies.page import Column, Figure, Section, Table, percent, short
from studies.parallel import Resolution, Stop


@dataclass(frozen=True)
class Row:
    """A row of the paper's table 1; each pair is the largest error and the mean."""

    cells: tuple[int, int]
    """Squares along x and y, each cut in two: the paper gives their nodes and elements, 30 and 40 to 1 353 and 2 560."""
    relative: tuple[float, float]
    """ε (%)."""
    absolute: tuple[float, float]
    """e (J^½)."""

    @property
    def denominators(self) -> tuple[float, float]:
        """D (J^½), which both give together."""
        return 100 * self.absolute[0] / self.relative[0], 100 * self.absolute[1] / self.relative[1]


PAPER = (
    Row((5, 4), (31.6, 26.6), (499.0, 394.0)),
    Row((10, 8), (25.5, 21.3), (396.0, 313.0)),
    Row((20, 16), (22.1, 17.8), (346.0, 260.0)),
    Row((40, 32), (20.0, 15.7), (312.0, 228.0)),
)
"""Source: Louf, Gallimard and Pelle, table 1."""
FEW = 2
"""Meshes of a small study."""
VARIANTS: dict[str, list[tuple[str, dict[str, Any]]]] = {
    # Fractions of a step beyond a whole one: below, a node may touch at the first step already.
    "gap": [(f"{steps} steps", {"flight": steps}) for steps in (1.1, 1.3, 1.5, 1.7, 1.9)],
    "T": [(f"{short(1e6 * past, 2)} µs", {"past": past}) for past in (8e-6, 10e-6, 12e-6, 14e-6, 16e-6)],
    "plane": [(plane, {"plane": plane}) for plane in ("stress", "strain")],
}
"""Other values of one assumption at a time, in words and as arguments of `Block`."""
ABSOLUTE = ("e_sup", "e_mean")

Found = tuple[pc.Estimate, ...]


def compute(section: Section, resolution: Resolution) -> None:
    """Compute the study."""
    rows = resolution.first(FEW, PAPER)
    variants = [(name, value, changed) for name, values in VARIANTS.items() for value, changed in values]
    runs: list[dict[str, Any]] = [{"cells": row.cells, **changed} for changed in ({}, *(v[2] for v in variants)) for row in rows]
    defaults = [{"reconstruction": name, "acceleration": DEFAULTS[name]} for name in RECONSTRUCTIONS]

    def work(run: dict[str, Any], stop: Stop) -> Found:
        impact = Block(**run).impact()
        history = impact.simulate(stop)
        choices = PLANE_CHOICES if len(run) == 1 else defaults
        return tuple(pc.estimate(history, every=1, threads=1, progress=stop, **choice) for choice in choices)

    found = resolution.map(work, runs, lambda run: run["cells"][0] ** 3)
    own, others = found[: len(rows)], found[len(rows) :]
    absolute, relative = _tables(rows, own)
    base = Block(rows[0].cells)
    section.add(
        "An aluminium block of 50 × 40 mm strikes a plane at 400 m/s along it and 400 m/s towards it, with friction (μ = "
        f"{base.friction}). The step is {base.courant} of the critical one. The table has the largest error over time, e_sup [15], and the "
        "mean, e_mean [16], for each reconstruction of the contact force and each Γ_DA, beside the paper's values. The paper's method is "
        f"`published`; the default is `corrected` with `{DEFAULTS['corrected']}`.",
        "The paper does not state the distance from which the block starts, the end T of the interval, and whether the block is in plane "
        "stress or plane strain. Taken here: plane stress, a gap that the block crosses in 1.3 steps, and the first whole step past "
        f"{short(1e6 * base.past, 3)} µs. The influence of each is below.",
        Figure("table1-errors", CAPTION, _draw(absolute)),
        " ".join(_conclusions(rows, own)),
        absolute,
    )
    table = _assumptions(rows, variants, others)
    section.add(_spreads(table), Figure("table1-gap", GAP_CAPTION, _draw_gap(table, rows)), relative, table)


CAPTION = (
    "Absolute error over the number of elements (logarithmic): largest over time [15] on the left, mean [16] on the right, each "
    "reconstruction with its default Γ_DA, and the paper's values in black."
)
GAP_CAPTION = (
    "The largest error [15] over the gap in steps of flight, for each reconstruction with its default Γ_DA, one curve for each mesh: the "
    "instant of impact inside a step matters on all meshes."
)


def deviation(errors: Sequence[tuple[float, float]]) -> float | None:
    """Give the root mean square of the relative differences from the paper's absolute errors; None unless all meshes are there."""
    if len(errors) != len(PAPER):
        return None
    ratios = [ours / theirs - 1 for pair, row in zip(errors, PAPER, strict=True) for ours, theirs in zip(pair, row.absolute, strict=True)]
    return float((sum(ratio**2 for ratio in ratios) / len(ratios)) ** 0.5)


def _tables(rows: Sequence[Row], found: Sequence[Found]) -> tuple[Table, Table]:
    first = [Column(name) for name in ("reconstruction", "Γ_DA", "default", "mesh", "elements")]
    named = {"e_sup": "[15]", "paper's e_sup": "", "e_mean": "[16]", "paper's e_mean": ""}
    caption = "Absolute errors of the four meshes, beside the paper's; on the page those with the default Γ_DA."
    columns = [*first, *(Column(name, "J^½", equation) for name, equation in named.items())]
    absolute = Table("table1-absolute", caption, columns, on_page={"default": "yes"})
    named = {"ε_sup": "[22]", "paper's ε_sup": "", "ε_mean": "[22]", "paper's ε_mean": ""}
    columns = [*first, *(Column(name, "%", equation, 3) for name, equation in named.items())]
    named = {"D_sup": "[23]", "paper's D_sup": "", "D_mean": "", "paper's D_mean": ""}
    columns += [Column(name, "J^½", equation) for name, equation in named.items()]
    caption = "Relative errors and their denominators. The paper's D is its absolute over its relative error."
    relative = Table("table1-relative", caption, columns, on_page=False)
    for c, choice in enumerate(PLANE_CHOICES):
        for row, estimates in zip(rows, found, strict=True):
            e = estimates[c]
            default = "yes" if choice["acceleration"] == DEFAULTS[choice["reconstruction"]] else "no"
            names = choice["reconstruction"], choice["acceleration"], default, Block(row.cells).mesh, len(e.by_element)
            absolute.add(*names, e.sup, row.absolute[0], e.mean, row.absolute[1])
            errors = 100 * e.published_relative_sup, row.relative[0], 100 * e.published_relative_mean, row.relative[1]
            relative.add(*names, *errors, e.reference_sup, row.denominators[0], e.reference_mean, row.denominators[1])
    return absolute, relative


def _conclusions(rows: Sequence[Row], found: Sequence[Found]) -> list[str]:
    pieces = []
    place = PLANE_CHOICES.index({"reconstruction": "published", "acceleration": ACCELERATIONS[0]})
    off = [deviation([(each[place + k].sup, each[place + k].mean) for each in found]) for k in range(len(ACCELERATIONS))]
    if None not in off:
        each = [f"{percent(value or 0.0)} with `{name}`" for value, name in zip(off, ACCELERATIONS, strict=True)]
        pieces.append(f"With `published`, the eight absolute values differ from the paper's by {', '.join(each)} (root mean square).")
    ours = [e.reference_sup for each in found for e in each]
    theirs = ", ".join(short(row.denominators[0], 4) for row in rows)
    return [
        *pieces,
        f"The relative errors differ by their denominator. D_sup by [22]–[24] as printed is {short(min(ours), 4)} to {short(max(ours), 4)} J^½ "
        f"here; absolute over relative error of the paper's table gives {theirs} J^½. The paper's table therefore uses another norm than "
        "[22]–[24]. The absolute errors do not depend on it.",
    ]


def _assumptions(rows: Sequence[Row], variants: Sequence[tuple[str, str, Any]], found: Sequence[Found]) -> Table:
    columns = [Column(name) for name in ("reconstruction", "assumption", "value")]
    columns += [Column(f"{name} {Block(row.cells).mesh}", "J^½", f"[{15 + k}]") for k, name in enumerate(ABSOLUTE) for row in PAPER]
    caption = (
        "Absolute errors with the default Γ_DA, one assumption changed at a time. The last column is the root mean square of the eight "
        "relative differences from the paper's table."
    )
    table = Table("table1-assumptions", caption, [*columns, Column("from the paper", "%", digits=3)], on_page=False)
    empty = [None] * (len(PAPER) - len(rows))
    for r, name in enumerate(RECONSTRUCTIONS):
        for v, (assumption, value, _) in enumerate(variants):
            errors = [(each[r].sup, each[r].mean) for each in found[v * len(rows) : (v + 1) * len(rows)]]
            off = deviation(errors)
            cells = [*(sup for sup, _ in errors), *empty, *(mean for _, mean in errors), *empty]
            table.add(name, assumption, value, *cells, None if off is None else 100 * off)
    return table


def _spreads(table: Table) -> str:
    """State by how much each assumption moves the errors."""

    def spread(name: str, assumption: str) -> str:
        of = {"reconstruction": name, "assumption": assumption}
        columns = [table.where(column.name, of) for column in table.columns if column.unit == "J^½"]
        return percent(max(max(errors) / min(errors) - 1 for errors in columns if errors[0] == errors[0]))

    all_of = (
        f"with `{name}` by up to {spread(name, 'gap')} (gap), {spread(name, 'T')} (T) and {spread(name, 'plane')} (plane hypothesis)"
        for name in RECONSTRUCTIONS
    )
    return (
        "The place of the impact inside a step, the end of the interval and the plane hypothesis each move the errors. From its least to its "
        f"largest value, an error on one mesh moves {'; '.join(all_of)}."
    )


def _draw(table: Table) -> figures.Drawing:
    def curves(measure: str) -> list[figures.Curve]:
        of = [{"reconstruction": name, "default": "yes"} for name in RECONSTRUCTIONS]
        elements = table.where("elements", of[0])
        ours = [figures.Curve(each["reconstruction"], elements, table.where(measure, each), figures.own(k), marked=True) for k, each in enumerate(of)]
        return [*ours, figures.Curve("the paper's table", elements, table.where(f"paper's {measure}", of[0]), dashed=True, marked=True)]

    marks = sorted(set(table.where("elements")))
    panels = [(measure, curves(measure)) for measure in ABSOLUTE]
    return figures.lines(panels, "elements", "error (J^½)", log="x", columns=2, xticks=marks, zero=True)


def _draw_gap(table: Table, rows: Sequence[Row]) -> figures.Drawing:
    gaps = [changed["flight"] for _, changed in VARIANTS["gap"]]

    def curves(name: str) -> list[figures.Curve]:
        values = [table.where(f"e_sup {Block(row.cells).mesh}", {"reconstruction": name, "assumption": "gap"}) for row in rows]
        hues = [figures.ordered(k / (len(PAPER) - 1)) for k in range(len(rows))]
        return [figures.Curve(Block(row.cells).mesh, gaps, y, hue, marked=True) for row, y, hue in zip(rows, values, hues, strict=True)]

    panels = [(name, curves(name)) for name in RECONSTRUCTIONS]
    return figures.lines(panels, "gap (steps)", "e_sup (J^½)", columns=3, xticks=gaps, zero=True)
