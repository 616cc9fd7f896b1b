"""The estimated over the true error of impacts in 2D, against finer meshes."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

from studies import figures, steps, turning
from studies.choices import RECONSTRUCTIONS as NAMES
from studies.impacts import CORNER, CURVED, FLAT, GOOD, KINDS, MESHES, RECONSTRUCTION_OPTIONS, STEP, TILTED, VERDICT, Case, Found
from studies.impacts import cases, curve, holds, inside, stated
from studies.page import Column, Figure, Section, Table, percent, short
from studies.parallel import Resolution, Stop

Result = tuple[Case, list[Found | None]]
MEASURES = ("sup", "mean")


def compute(section: Section, resolution: Resolution) -> None:
    """Compute the study."""
    wanted = cases(resolution.small)

    def work(case: Case, stop: Stop) -> list[Found | None]:
        return case.run(RECONSTRUCTION_OPTIONS, stop)

    found = resolution.map(work, wanted, lambda case: case.cost)
    results = list(zip(wanted, found, strict=True))
    table = _effectivities(results)
    every = [holds(each.estimates[r], each.effectivity(r)) for _, found in results for each in filter(None, found) for r in range(len(NAMES))]
    section.add(
        f"Bodies of aluminium (E = 70 GPa, ν = 0.3, ρ = 2700 kg/m³) fly against a rigid plane. The estimates, each with its default Γ_DA, are "
        "compared with the energy norm of the difference to a run on a much finer mesh, in which the mesh is nested: e_ref² = max or mean "
        "over the t_n of ½∫ρ|Δv|² + ½∫Δε:K:Δε, exact in space, with the reference interpolated linearly between its instants. Runs take "
        f"steps of {STEP} Δt_c, except for the short steps below, and end with the first instant past T. The velocity is 400 m/s across the "
        "plane (normal), and as much along it for oblique impacts. A tilt turns plane and velocity clockwise under the body.",
        "The block is that of the paper's table 1, on 5×4 to 40×32 cells cut in two, or on unstructured triangles of 10 mm that are refined "
        "three times. The rounded block has lower corners with a radius of 15 mm, the disc has a radius of 25 mm. They are the same polygons "
        "on all meshes, with edges of 22.5° and 15°, so that one edge after the other comes into contact. "
        f"{inside(every)}",
        Figure(
            "effectivity",
            "Effectivity index e/e_ref over refinement (both axes logarithmic), of the largest error ([15], above) and of the mean ([16], "
            "below), for each reconstruction: one curve for each case, in the colour of its family. The band is from "
            f"{GOOD[0]} to {GOOD[1]}. A good curve falls to the band and stays there; a rising curve shows an estimate that exceeds the "
            "true error more and more as meshes become finer.",
            _draw(results),
        ),
    )
    # These need all cases, meshes and references.
    if not resolution.small:
        section.add(_kinds(results), _outside(results), table)
    steps.add(section, resolution)
    turning.add(section, resolution)
    section.add("### The cases and their references", _cases(results))
    if not resolution.small:
        section.add(_settled(results))
    section.add(_references(results), _runs(results))


def _on_mesh(pairs: Sequence[tuple[float, float] | None]) -> list[float | None]:
    """Give both measures on each mesh."""
    return [None if pair is None else pair[m] for m in range(2) for pair in pairs]


def _measured(unit: str = "", digits: int = 4) -> list[Column]:
    return [Column(f"{measure}, mesh {mesh + 1}", unit, digits=digits) for measure in MEASURES for mesh in range(MESHES)]


def _effectivities(results: Iterable[Result]) -> Table:
    caption = (
        "Effectivity index e/e_ref of the largest error and of the mean, on four meshes from the coarsest to the finest, each with four times "
        "as many elements as the one before, against the finest reference. Empty cells: the body starts too near to its plane."
    )
    columns = [Column("kind"), Column("case"), Column("reconstruction"), *_measured(digits=3)]
    table = Table("effectivity", caption, columns, on_page=False)
    for case, found in results:
        for r, name in enumerate(NAMES):
            table.add(case.kind, case.name, name, *_on_mesh([None if each is None else each.effectivity(r) for each in found]))
    return table


def _kinds(results: Sequence[Result]) -> Table:
    """Give the range of each kind with each reconstruction, and how it moves under refinement."""
    columns = [Column("kind"), Column("reconstruction")]
    for measure in MEASURES:
        names = ("lowest", "highest", "lowest, meshes 3 and 4", "highest, meshes 3 and 4", "largest growth, mesh 2 to 4")
        columns += [Column(f"{measure}: {name}", digits=3) for name in names]
    caption = (
        "The effectivity indices of all cases of a kind: their range on all meshes and on the two finer ones, and the largest ratio of the "
        "value on mesh 4 to that on mesh 2 (below 1: it falls in all cases)."
    )
    table = Table("effectivity-kinds", caption, columns)
    for kind in KINDS:
        for r, name in enumerate(NAMES):
            cells: list[float] = []
            for m in range(2):
                values = [[math.nan if f is None else f.effectivity(r)[m] for f in found] for case, found in results if case.kind == kind]
                for start in (0, 2):
                    known = [value for each in values for value in each[start:] if math.isfinite(value)]
                    cells += [min(known), max(known)]
                cells.append(max(each[3] / each[1] for each in values))
            table.add(kind, name, *cells)
    return table


def _outside(results: Sequence[Result]) -> str:
    """Say which part contact has where a corner touches alone, and which case grows."""
    least = min(found[-1].contact(0) for case, found in results if case.kind == CORNER and found[-1] is not None)
    return (
        "Where a corner touches alone, `corrected` concentrates its force on a part of the edges beside the corner. These edges are off the "
        "plane, and a point force would have no stress of finite energy. The energy gap·F_n of the force and the work of the arriving mass "
        f"are at least {percent(least)} of the largest η on mesh 4. "
        f"With the curved bodies each edge that comes into contact is such a corner for some steps. {_growth(results)}"
    )


def _growth(results: Iterable[Result]) -> str:
    """Say which case grows most from mesh 2 to mesh 4, and why."""
    grown = []
    for case, found in results:
        meshes = [each for each in found if each is not None]
        if len(meshes) == MESHES:
            grown.append((meshes[3].effectivity(0)[0] / meshes[1].effectivity(0)[0], case, meshes))
    growth, case, meshes = max(grown, key=lambda each: each[0])
    falls = ", ".join(short(a.exact[-1].sup / b.exact[-1].sup, 3) for a, b in zip(meshes, meshes[1:], strict=False))
    return (
        f"The largest growth from mesh 2 to mesh 4 is that of the largest error for {case.name}: by {percent(growth - 1.0)}, of which the "
        f"error of the references may explain {percent(_moves(meshes)[-1])} (below). Its part of contact goes from "
        f"{percent(meshes[1].contact(0))} of η to {percent(meshes[3].contact(0))}. The true error falls by {falls} from mesh to mesh."
    )


def _cases(results: Iterable[Result]) -> Table:
    columns = [Column("case"), Column("elements of mesh 1"), Column("steps on mesh 1"), Column("gap", "mm", digits=2), Column("T", "µs", digits=3)]
    columns += [Column("touches from", "µs", digits=3), Column("until", "µs", digits=3), Column("most nodes at once"), Column("nodes at the end")]
    caption = "The cases, and how the body touches the plane on the finest of the four meshes."
    table = Table("effectivity-cases", caption, columns, on_page=False)
    for case, found in results:
        coarse, fine = found[0], found[-1]
        table.add(
            case.name,
            *((None, None) if coarse is None else (coarse.elements, coarse.steps)),
            1e3 * case.gap,
            1e6 * case.end,
            *((None, None) if fine is None or fine.touching is None else (1e6 * fine.touching[0], 1e6 * fine.touching[1])),
            *((None, None) if fine is None else (fine.most, fine.last)),
        )
    return table


def _references(results: Iterable[Result]) -> Table:
    caption = (
        "True error e_ref (J^½) of each mesh against references of more and more elements: the change from one to the next shows how far the "
        "reference is from the limit."
    )
    columns = [Column("case"), Column("elements of the reference"), *_measured("J^½")]
    table = Table("effectivity-references", caption, columns, on_page=False)
    for case, found in results:
        coarsest = next(each.elements >> (2 * mesh) for mesh, each in enumerate(found) if each is not None)
        for k, level in enumerate(case.references):
            errors = [None if each is None else (each.exact[k].sup, each.exact[k].mean) for each in found]
            table.add(case.name, coarsest << (2 * level), *_on_mesh(errors))
    return table


def _runs(results: Iterable[Result]) -> Table:
    columns = [Column("case"), Column("reconstruction"), Column("elements"), Column("steps")]
    columns += [Column("e sup", "J^½", "[15]"), Column("e mean", "J^½", "[16]"), Column("ε sup", "", "[22]"), Column("ε mean", "", "[22]")]
    columns += [Column("impulse ratio"), Column("contact part at the sup", "%", digits=3), Column("e_ref sup", "J^½"), Column("e_ref mean", "J^½")]
    columns += [Column(name, digits=3) for name in VERDICT]
    caption = "All runs: estimate, relative error, the part of the contact impulse that the admissible force keeps, and true error."
    table = Table("effectivity-runs", caption, columns, on_page=False)
    for case, found in results:
        for r, name in enumerate(NAMES):
            for each in filter(None, found):
                e = each.estimates[r]
                measures = (e.sup, e.mean, e.published_relative_sup, e.published_relative_mean, e.impulse_ratio)
                true = each.exact[-1]
                table.add(case.name, name, each.elements, each.steps, *measures, 100.0 * each.contact(r), true.sup, true.mean, *stated(e))
    return table


def _moves(found: Sequence[Found | None]) -> list[float]:
    """Give by how much each reference but the first moves the true error on mesh 4, relative: the larger of sup and mean."""
    exact = found[-1].exact if found[-1] is not None else []
    return [max(abs(b.sup / a.sup - 1.0), abs(b.mean / a.mean - 1.0)) for a, b in zip(exact, exact[1:], strict=False)]


def _settled(results: Sequence[Result]) -> str:
    """Say how far references agree, kind by kind."""
    moved = [f"{percent(max(_moves(found)[0] for case, found in results if case.kind == kind))} ({kind})" for kind in KINDS]
    further = [
        f"For {case.name}, a third reference moves it by another {percent(_moves(found)[1])} after {percent(_moves(found)[0])}. "
        for case, found in results
        if len(_moves(found)) == 2
    ]
    logs = []
    for case, found in results:
        first, last = found[0], found[-1]
        if case.kind == FLAT and first is not None and last is not None:
            logs.append(math.log(first.exact[-1].sup / last.exact[-1].sup) / (MESHES - 1))
    return (
        "From the first reference to the second, which has four times as many elements, the true error on mesh 4 moves by at most "
        f"{', '.join(moved)}. {''.join(further)}For flat impacts, whose fronts are discontinuous, the true error falls by a factor of about "
        f"{short(math.exp(sum(logs) / len(logs)), 2)} from mesh to mesh. The last reference is off by about the last move at most: "
        "effectivity indices on mesh 4 are too large by that, and those on coarser meshes by less."
    )


def _family(case: Case) -> tuple[int, str]:
    """Give the colour of a case and the name of its family."""
    if case.body == "disc":
        return 6, "disc"
    if case.kind == CURVED:
        return 5, "rounded corner"
    if case.kind == TILTED:
        return 3, "tilted by ±3°"
    if case.kind == CORNER:
        return 4, "tilted by ±10°"
    return round(10.0 * case.friction) // 2, f"flat, μ = {case.friction:g}"


def _draw(results: Sequence[Result]) -> figures.Drawing:
    """Draw a row of panels for each measure, a panel for each reconstruction, a curve for each case."""

    panels = [
        (f"{name}, {measure}", [curve(_family(case)[1], found, r, m, _family(case)[0]) for case, found in results])
        for m, measure in enumerate(MEASURES)
        for r, name in enumerate(NAMES)
    ]
    ticks = (0.5, 0.7, 1.0, 1.5, 2.0, 3.0, 5.0, 10.0, 20.0, 50.0)
    x, y = "times finer than mesh 1", "e/e_ref"
    return figures.lines(panels, x, y, log="xy", columns=3, band=GOOD, xticks=(1, 2, 4, 8), yticks=ticks)
