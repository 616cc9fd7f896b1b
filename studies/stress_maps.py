"""The paper's figures 8 and 9: stress, and the contribution of each element to the error, at several instants."""

from __future__ import annotations

from collections.abc import Sequence
from types import SimpleNamespace

import numpy as np
from numpy.typing import NDArray

import percute as pc
from studies import figures
from studies.block import Block
from studies.choices import DEFAULT, RECONSTRUCTIONS
from studies.page import Column, Figure, Section, Table, percent, short
from studies.parallel import Resolution, Stop

CELLS = (20, 16)
"""The mesh: 640 elements."""
PAPER = (29.1, 23.8)
"""Source: Louf, Gallimard and Pelle, §7.2.2: relative errors of the run of their figures 8 and 9 (%), largest and mean."""
INSTANTS = 6
"""Number of instants, without the start."""

Floats = NDArray[np.float64]


def compute(section: Section, resolution: Resolution) -> None:
    """Compute the study; a small study has all of it."""
    block = Block(CELLS)
    history = block.impact().simulate()

    def work(name: str, stop: Stop) -> pc.Estimate:
        return pc.estimate(history, every=1, reconstruction=name, acceleration=DEFAULT, instants=INSTANTS + 1, threads=1, progress=stop)  # type: ignore[arg-type]

    estimates = dict(zip(RECONSTRUCTIONS, resolution.map(work, RECONSTRUCTIONS), strict=True))
    here = ", ".join(f"{percent(e.published_relative_sup)} and {percent(e.published_relative_mean)} with `{name}`" for name, e in estimates.items())
    section.add(
        f"The block of the paper's table 1 on {block.mesh} squares cut in two, with the same assumptions. The paper does not state the mesh and the "
        f"instants of its figures 8 and 9. Its relative errors there, {PAPER[0]} % (sup) and {PAPER[1]} % (mean), belong to another mesh or interval "
        f"than those of its table 1. Here they are {here}."
    )
    times = [each.time for each in estimates["corrected"].maps[1:]]
    steps = [int(np.argmin(abs(history.time - time))) for time in times]
    titles = [f"t = {short(1e6 * time, 3)} µs" for time in times]
    mesh = history.problem.mesh
    bodies = [SimpleNamespace(points=mesh.points + history.displacement[n], cells=mesh.cells) for n in steps]
    height = float(np.asarray(history.problem.obstacles[0].point)[1])

    def draw(values: Sequence[Floats], colours: figures.Colours) -> figures.Drawing:
        return figures.mesh_maps(list(zip(titles, bodies, values, strict=True)), colours, columns=3, plane=height)

    stresses = [1e-9 * history.von_mises(n) for n in steps]
    highest = float(np.max(stresses))
    caption = "Von Mises stress of each element (by its centroid at the start) at each instant."
    table = _table("stress-maps-von-mises", caption, [Column(title, "GPa", "[9]") for title in titles])
    _fill(table, "all", mesh, stresses)
    section.add(Figure("figure-8", FIGURE_8.format(short(highest, 3)), draw(stresses, figures.between("von Mises stress (GPa)", 0.0, highest))), table)

    errors = {name: [each.error for each in estimate.maps[1:]] for name, estimate in estimates.items()}
    highest = float(np.max(list(errors.values())))
    caption = "e_E accumulated from 0 to each instant, √((1/T)∫₀ᵗ η_E dt), of each element (by its centroid at the start)."
    table, summary = _table("stress-maps-error", caption, [Column(title, "J^½", "[20]") for title in titles]), _summary()
    for name, values in errors.items():
        _fill(table, name, mesh, values)
        for time, of_elements in zip(times, values, strict=True):
            summary.add(name, 1e6 * time, *_concentration(of_elements))
        share = short(_concentration(values[-1])[-1], 2)
        colours = figures.ratio("accumulated e_E (J^½)", 0.01 * highest, highest)
        section.add(Figure(f"figure-9-{name}", FIGURE_9.format(name, share), draw(values, colours)))
    section.add(summary, table)


FIGURE_8 = (
    f"The paper's figure 8: von Mises stress of the finite-element solution at {INSTANTS} instants, from 0 to {{}} GPa in all maps. The body is drawn "
    "in its place, at true scale; grey is the rigid plane. The compression wave runs up from the plane, is reflected at the top and at the sides, and "
    "friction tilts it."
)
FIGURE_9 = (
    "The paper's figure 9, with the reconstruction `{}`: the contribution of each element to the mean error until the instant, √((1/T)∫₀ᵗ η_E dt) "
    "[20] (J^½). The colours are logarithmic, from a hundredth of the largest value on, and the same for all reconstructions. The squares of the last map "
    "add up to e_mean²; half of that is in {} % of the elements, along the plane and at its corners first."
)


def _table(key: str, caption: str, instants: Sequence[Column]) -> Table:
    """Give a table with a row for each element and a column for each instant."""
    return Table(key, caption, [Column("reconstruction"), Column("element"), Column("x", "mm"), Column("y", "mm"), *instants], on_page=False)


def _fill(table: Table, name: str, mesh: pc.Mesh, values: Sequence[Floats]) -> None:
    centroids = 1e3 * mesh.points[mesh.cells].mean(axis=1)
    for element, (centroid, row) in enumerate(zip(centroids.tolist(), np.transpose(values).tolist(), strict=True)):
        table.add(name, element, *centroid, *row)


def _summary() -> Table:
    columns = [Column("reconstruction"), Column("t", "µs"), Column("all elements", "J^½", "[20]"), Column("largest element", "J^½", "[20]")]
    caption = "The accumulated error at the instants of the maps: of all elements, the largest of one, and the part of the elements that holds half of its square."
    return Table("stress-maps-summary", caption, [*columns, Column("half of it in", "% of the elements", digits=3)], on_page=False)


def _concentration(errors: Floats) -> tuple[float, float, float]:
    """Give the error of all elements, the largest, and the part of the elements (%) that holds half of the square."""
    squares = np.sort(errors**2)[::-1]
    sums = np.cumsum(squares)
    few = 1 + int(np.count_nonzero(sums < 0.5 * sums[-1]))
    return float(sums[-1] ** 0.5), float(squares[0] ** 0.5), 100 * few / len(errors)
