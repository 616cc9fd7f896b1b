"""The default without each of its parts, and the other reconstructions, on some of the cases."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import percute as pc
from percute.estimating import ablated
from studies import figures
from studies.bar import Outcome, Setting
from studies.choices import RECONSTRUCTIONS
from studies.impacts import FLAT, GOOD, KINDS, Case, Found, cases, curve
from studies.page import Column, Figure, Section, Table, percent, short
from studies.parallel import Resolution, Stop

ATTEMPTS: dict[str, tuple[dict[str, Any], str]] = {
    "corrected": ({}, "the default with all its parts"),
    "no auxiliary solution": (
        {"ablation": "auxiliary solution"},
        "the balance of the simulation's own displacements: the difference between the nodal forces of the density and the reactions "
        "becomes acceleration [55] and drifts; the accumulated dispersion is not seen",
    ),
    "auxiliary solution as dispersive": (
        {"ablation": "correction"},
        "an auxiliary solution without its two corrections: nothing drifts, but the waves of simulation and balance are late together, and "
        "the estimate loses them on fine meshes with small steps",
    ),
    "no concentration": (
        {"ablation": "concentration"},
        "tractions over whole edges, however far these leave the plane: at a corner the index is 1.5 times larger at 400 m/s, 8 times at "
        "4 m/s",
    ),
    "tractions of the stars": (
        {"ablation": "least energy"},
        "no descent to tractions of least energy: where contact begins, and around corners, the elastic part is several times too large",
    ),
    "lumped mass": (
        {"acceleration": "closest"},
        "tractions that balance the lumped mass of an element: Γ_DA turns where the motion turns the elements; on bars this is the default",
    ),
    "no moment": (
        {"ablation": "moment"},
        "the densities R_k/ℓ_k without the moment of the reactions: of little weight during an impact, but a sliding body turns ever "
        "faster (below)",
    ),
    "no normal work": (
        {"ablation": "normal work"},
        "the normal law at displacement level alone: the loss when a node is brought to rest enters at that instant only; the waves that "
        "it causes are missing afterwards",
    ),
    "twice the normal work": (
        {"ablation": "doubled work"},
        "the weight that [14] gives to the work of friction: an estimate from above everywhere on the bar, but farther from the true error "
        "elsewhere",
    ),
    "consistent": ({"reconstruction": "consistent"}, "forces on touching edges only"),
    "published": ({"reconstruction": "published"}, "the paper's forces"),
}
"""Name, arguments of `percute.estimating.ablated`, and description of each attempt."""
CHOICES = [choice for choice, _ in ATTEMPTS.values()]
ELEMENTS, RATIOS, FRACTIONS = (10, 40, 160), (0.5, 0.8, 1.0), (0.1, 0.3, 0.5, 0.7, 0.9)
"""Part of the grid of the bar maps: N_s, α, fraction; up to the end of contact."""
PAPER = (0.7, 1.8)
"""The range of the paper's effectivity indices of the bar."""
MESHES, REFERENCE = 3, (5,)
SLIDE = (0.25, 0.5, 1.0)
"""Parts of the slide."""


def compute(section: Section, resolution: Resolution) -> None:
    """Compute the study."""
    elements = resolution.first(2, ELEMENTS)
    bars = [Setting(n, ratio, fraction, 2.0) for n in elements for ratio in RATIOS for fraction in FRACTIONS]
    on_bars = resolution.map(lambda bar, stop: bar.run(CHOICES, stop), bars, lambda bar: bar.elements**2 / bar.ratio)
    bodies = _bodies(resolution)
    on_bodies = resolution.map(lambda case, stop: case.run(CHOICES, stop), bodies, lambda case: case.cost)
    results = list(zip(bodies, on_bodies, strict=True))
    attempts = Table("ablation-attempts", "The attempts: what each leaves out, and why this matters.", [Column("attempt"), Column("difference and effect")], on_page=False)
    for name, (_, description) in ATTEMPTS.items():
        attempts.add(name, description)
    section.add(
        "The default `corrected` is made of several parts (see the page on reconstructions). Each is left out in turn here, and the other "
        "reconstructions are given with it: e/e_Ex on a part of the grid of bars, and e/e_ref on plane bodies.",
        Figure(
            "ablation",
            "Effectivity index of the largest error [15] over refinement (both axes logarithmic), a panel for each body, a curve for each "
            "attempt; dashed for the other reconstructions. A rising curve exceeds the true error more and more as the mesh becomes finer.",
            _draw(results),
        ),
        attempts,
    )
    if not resolution.small:
        section.add(_bar(on_bars))
    section.add(_plane(results))
    _slide(section, resolution)


def _bodies(resolution: Resolution) -> list[Case]:
    """Give one body of each kind, and the flat impact that sticks in plane strain."""
    chosen: list[Case] = []
    for kind in KINDS:
        own = [case for case in cases() if case.kind == kind and case.body in ("block", "disc")]
        # The first flat case is without friction, the last one sticks most.
        chosen += [own[0], own[-1]] if kind == FLAT else own[:1]
    meshes = resolution.either(2, MESHES)
    return [case.at(meshes=meshes, references=REFERENCE) for case in resolution.first(2, chosen)]


def _bar(outcomes: Sequence[Outcome]) -> Table:
    """Give the range of each attempt on the bars."""
    columns = [Column("attempt"), Column("measure"), *(Column(name, digits=3) for name in ("lowest", "highest", "highest/lowest"))]
    values = [", ".join(short(float(v), 2) for v in each) for each in (ELEMENTS, RATIOS, FRACTIONS)]
    caption = "Effectivity index e/e_Ex of the bar on {} elements, with Δt/Δt_c of {} and the fractions {} of a step, until t_c + 2L/c.".format(*values)
    table = Table("ablation-bar", caption, [*columns, Column(f"within {PAPER[0]} to {PAPER[1]}", "%", digits=3)], on_page=False)
    for k, attempt in enumerate(ATTEMPTS):
        for m, measure in enumerate(("sup", "mean")):
            found = [outcome.effectivity(k)[m] for outcome in outcomes]
            within = sum(PAPER[0] <= value <= PAPER[1] for value in found)
            table.add(attempt, measure, min(found), max(found), max(found) / min(found), 100.0 * within / len(found))
    return table


def _plane(results: Sequence[tuple[Case, list[Found | None]]]) -> Table:
    """Give each attempt on each body."""
    columns = [Column("case"), Column("attempt")]
    columns += [Column(f"{measure}, mesh {mesh + 1}", digits=3) for measure in ("sup", "mean") for mesh in range(MESHES)]
    caption = (
        "Effectivity index e/e_ref of each attempt on the three coarser meshes, against a reference with 32 times as many elements along a "
        "side as the coarsest."
    )
    table = Table("ablation-plane", caption, columns, on_page=False)
    for case, found in results:
        for k, attempt in enumerate(ATTEMPTS):
            table.add(case.name, attempt, *(None if f is None else f.effectivity(k)[m] for m in range(2) for f in found[:MESHES]))
    return table


def _draw(results: Sequence[tuple[Case, list[Found | None]]]) -> figures.Drawing:

    def drawn(k: int, attempt: str, found: list[Found | None]) -> figures.Curve:
        return replace(curve(attempt, found[:MESHES], k, 0, k), dashed=attempt in RECONSTRUCTIONS[1:])

    panels = [(case.name, [drawn(k, attempt, found) for k, attempt in enumerate(ATTEMPTS)]) for case, found in results]
    ticks = (0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0)
    x, y = "times finer than mesh 1", "e/e_ref"
    return figures.lines(panels, x, y, log="xy", columns=2, band=GOOD, xticks=(1, 2, 4), yticks=ticks)


def _sliding_block() -> tuple[pc.Problem, dict[str, Any]]:
    """Give the block that slides down a plane tilted by 30°, and its instants; its weight presses it at the start."""
    width, height, young, density, gravity = 0.4, 0.2, 2e7, 1000.0, 9.81
    along, across = density * gravity * math.sin(math.pi / 6), density * gravity * math.cos(math.pi / 6)
    mesh = pc.Mesh.rectangle(width, height, nx=4, ny=2)
    problem = pc.Problem(
        mesh,
        material=pc.Elastic(young=young, poisson=0.0, density=density, plane="stress"),
        obstacles=[pc.Plane(point=(0, 0), normal=(0, 1), friction=0.3, group="bottom")],
        body_forces=[pc.BodyForce(value=(along, -across))],
        initial_displacement=[(0.0, -across / young * y * (height - 0.5 * y)) for _, y in mesh.points],
    )
    return problem, {"end": 0.2, "courant": 0.9}


def _slide(section: Section, resolution: Resolution) -> None:
    """Add the block that slides for long: errors that accumulate."""
    problem, times = _sliding_block()
    history = pc.simulate(problem, **times)
    lengths = [math.floor(part * (len(history) - 1) + 0.5) for part in SLIDE]

    def errors(run: tuple[int, dict[str, Any]], stop: Stop) -> float:
        count, choice = run
        first = pc.simulate(problem, end=float(history.time[count]), step=float(history.time[count]) / count, progress=stop)
        return 100.0 * ablated(first, every=1, threads=1, progress=stop, **choice).published_relative_mean

    found = iter(resolution.map(errors, [(count, choice) for choice in CHOICES for count in lengths], lambda run: run[0]))
    columns = [Column("attempt"), *(Column(f"T = {short(part * times['end'], 2)} s", "%", "[22]", digits=3) for part in SLIDE)]
    caption = "The relative error ε_mean of the block that slides down a tilted plane (benchmark tilted_plane), in longer and longer runs."
    table = Table("ablation-slide", caption, columns, on_page=False)
    for attempt in ATTEMPTS:
        table.add(attempt, *(next(found) for _ in SLIDE))
    waves = times["end"] * problem.wave_speed / 0.2
    last = columns[-1].name
    of = {attempt: percent(0.01 * table.where(last, {"attempt": attempt})[0]) for attempt in ATTEMPTS}
    section.add(
        "### Errors that accumulate",
        f"A block slides down a plane for {short(times['end'], 2)} s, about {short(waves, 2)} times as long as a wave needs through its "
        "height. The energy of its motion grows like the square of the time and its error does not, so that ε falls. Where ε stays, a "
        "force is missing that accelerates the admissible fields as long as the block slides. At the end ε_mean is "
        f"{of['corrected']} with `corrected`, {of['no moment']} without the moment of the reactions, {of['no auxiliary solution']} without the "
        f"auxiliary solution, {of['consistent']} with `consistent` and {of['published']} with `published`.",
        table,
    )
