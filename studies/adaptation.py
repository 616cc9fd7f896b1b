"""Meshes for a wanted accuracy: cases that the policy of `percute.adapt` was not tuned on."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import percute as pc
from numpy.typing import NDArray
from studies.block import ALUMINIUM
from studies.bodies import BODIES, STEEL, graded, without
from studies.page import Column, Section, Table, interval, short
from studies.parallel import Resolution, Stop

RUBBER: dict[str, Any] = {"young": 5e6, "poisson": 0.4, "density": 1100.0}
PART = 0.4
"""The target over the first error."""
COURANT = 0.9
FINEST, MOST = 3, 1.6e8
"""Refinements from the best mesh to the finest reference, and the most elements times steps of one that is refined everywhere."""
MOST_RUNS = 4
AGREE = (0.7, 1.3)
"""The error reached over the one that was predicted should be in this range."""
SETTLED = 0.1
"""References count as fine enough if the true error moves by at most so much to the finer one."""


@dataclass(frozen=True)
class Case:
    """A problem on its first mesh."""

    name: str
    problem: Callable[[], pc.Problem]
    end: float
    """End of the run (s)."""


def _fan(corners: NDArray[np.float64], times: int) -> pc.Mesh:
    """Make a convex polygon of triangles around its centre."""
    count = len(corners)
    points = np.vstack([corners, corners.mean(axis=0)])
    return pc.Mesh(points, [(k, (k + 1) % count, count) for k in range(count)]).refine(times)


def wedge() -> pc.Mesh:
    """Make a wedge of 60° whose tip is at the origin, of two halves of 40 mm height."""
    half = 0.04 * math.tan(math.radians(30.0))
    return pc.Mesh([(0.0, 0.0), (half, 0.04), (0.0, 0.04), (-half, 0.04)], [(0, 1, 2), (0, 2, 3)]).refine(3)


def hexagon(refinements: int) -> pc.Mesh:
    """Make a hexagon of 20 mm sides with a vertex below, of 6 triangles that are refined so often."""
    angle = np.radians(-90.0 + 60.0 * np.arange(6))
    return _fan(0.02 * np.column_stack([np.cos(angle), np.sin(angle)]), refinements)


def slotted() -> pc.Mesh:
    """Make a block of 50 × 40 mm with a slot of 10 × 20 mm from above."""
    block = pc.Mesh.rectangle(0.05, 0.04, nx=5, ny=4)
    x, y = block.points[block.cells].mean(axis=1).T
    return without(block.points, block.cells, (abs(x - 0.025) < 0.005) & (y > 0.02))


def ring() -> pc.Mesh:
    """Make a ring of 15 to 25 mm radius, a polygon of 32 edges, with a vertex below."""
    count, radii = 32, (0.015, 0.02, 0.025)
    angle = 2.0 * np.pi * np.arange(count) / count - np.pi / 2.0
    points = np.vstack([r * np.column_stack([np.cos(angle), np.sin(angle)]) for r in radii])
    cells = []
    for row in range(len(radii) - 1):
        for k in range(count):
            a, b = row * count + k, row * count + (k + 1) % count
            cells += [(a, a + count, b + count), (a, b + count, b)]
    return pc.Mesh(points, cells)


def thrown(
    mesh: pc.Mesh,
    material: pc.Elastic | Mapping[str, pc.Elastic],
    speed: float,
    *,
    tilt: float = 0.0,
    friction: float = 0.0,
    along: float = 0.0,
    wait: float = 5e-7,
) -> pc.Problem:
    """Throw a body against a plane, tilted (°) under it, at a gap of the way in so long a time (s)."""
    angle = math.radians(tilt)
    normal = np.array([math.sin(angle), math.cos(angle)])
    velocity = along * np.array([normal[1], -normal[0]]) - speed * normal
    plane = pc.Plane(point=(float((mesh.points @ normal).min()) - wait * speed) * normal, normal=normal, friction=friction)
    return pc.Problem(mesh, material=material, obstacles=[plane], initial_velocity=velocity)


def _on_plate(disc: bool) -> pc.Problem:
    """Let a block fall on an equal one, node on node, or a disc of steel on a plate of aluminium."""
    aluminium, steel = (pc.Elastic(**law, plane="strain") for law in (ALUMINIUM, STEEL))
    if disc:
        plate = pc.Body(name="plate", mesh=pc.Mesh.rectangle(0.04, 0.01, nx=12, ny=3), material=aluminium)
        above = pc.Body(name="upper", mesh=pc.Mesh.disc(0.01, rings=3), material=steel, origin=(0.0207, 0.020008), velocity=(0.0, -8.0))
        return pc.Problem(bodies=[plate, above], contacts=[pc.Interface(bodies=("upper", "plate"), friction=0.1)])
    block = pc.Mesh.rectangle(0.03, 0.02, nx=3, ny=2)
    lower = pc.Body(name="lower", mesh=block, material=steel)
    upper = pc.Body(name="upper", mesh=block, material=aluminium, origin=(0.0, 0.02003), velocity=(3.0, -30.0))
    return pc.Problem(bodies=[lower, upper], contacts=[pc.Interface(groups=("lower.top", "upper.bottom"), friction=0.3)])


def _cantilever() -> pc.Problem:
    """Clamp a beam of steel at its left end and press on it from above, more and more."""
    time = np.linspace(0.0, 2e-4, 41)
    load = [(0.0, -2e6 * math.sin(math.pi * t / 4e-4) ** 2) for t in time]
    clamp = pc.Support(group="left", components=("x", "y"))
    press = pc.Traction(group="top", value=load, time=time)
    return pc.Problem(pc.Mesh.rectangle(0.08, 0.02, nx=8, ny=2), material=pc.Elastic(**STEEL, plane="stress"), supports=[clamp], tractions=[press])


def _bar() -> pc.Problem:
    """Throw a bar of steel against a wall."""
    material = pc.Elastic(young=210e9, density=7800.0, section=1e-4)
    return pc.Problem(pc.Mesh.bar(0.5, elements=12), material=material, obstacles=[pc.Plane(point=0.5001, normal=-1.0)], initial_velocity=7.0)


def cases() -> list[Case]:
    """Give the cases."""
    stress, strain = (pc.Elastic(**ALUMINIUM, plane=plane) for plane in ("stress", "strain"))
    steel = pc.Elastic(**STEEL, plane="stress")
    layered, trapezoid = BODIES["layered block"](), BODIES["trapezoid 45°"]()
    rubber = pc.Elastic(**RUBBER, plane="strain")
    layers = {"lower": pc.Elastic(**STEEL, plane="stress"), "upper": stress}
    return [
        Case("wedge of 60°, tip first, plane strain, 15 m/s", lambda: thrown(wedge(), strain, 15.0), 25e-6),
        Case("hexagon of steel on a vertex, μ = 0.3, 2 m/s", lambda: thrown(hexagon(1), steel, 2.0, friction=0.3, tilt=2.0), 30e-6),
        Case("block with a slot, μ = 0.1, 12 m/s", lambda: thrown(slotted(), stress, 12.0, friction=0.1), 35e-6),
        Case("ring, plane strain, μ = 0.2, 6 m/s", lambda: thrown(ring(), strain, 6.0, friction=0.2), 40e-6),
        Case("steel under aluminium, tilted by 7°, μ = 0.2, 15 m/s", lambda: thrown(layered.refine(1), layers, 15.0, tilt=7.0, friction=0.2), 30e-6),
        Case("trapezoid of 45°, μ = 0.5, oblique, 60 m/s", lambda: thrown(trapezoid, stress, 60.0, friction=0.5, along=30.0), 15e-6),
        Case("disc of steel, 1 m/s", lambda: thrown(BODIES["disc"](), steel, 1.0), 40e-6),
        Case("hexagon of rubber, tilted by 10°, plane strain, μ = 0.4, 3 m/s", lambda: thrown(hexagon(2), rubber, 3.0, tilt=10.0, friction=0.4, wait=1e-5), 2e-3),
        Case("block on a block of steel, in pairs, μ = 0.3, 30 m/s", lambda: _on_plate(False), 12e-6),
        Case("disc of steel on a plate, μ = 0.1, 8 m/s", lambda: _on_plate(True), 12e-6),
        Case("cantilever of steel under a load", _cantilever, 2e-4),
        Case("bar of steel, 7 m/s", _bar, 150e-6),
    ]


@dataclass(frozen=True)
class Found:
    """What became of a case."""

    adaptation: pc.Adaptation
    true: float
    """True mean error on the best mesh, relative as the estimate."""
    index: float
    """Effectivity index of the mean error on the best mesh."""
    moved: float
    """By how much the true error moves from the coarser reference to the finer one, relative."""
    expected: tuple[float, float]
    """The range of the index that the verdict states."""

    @property
    def ratios(self) -> list[float]:
        """The error of each run over the predicted one."""
        runs = self.adaptation.iterations
        return [float(value) for value in (runs.error / runs.predicted)[1:]]


def run(case: Case, stop: Stop | None = None) -> Found:
    """Adapt the mesh of a case, and measure the true error on the best one."""
    problem = case.problem()
    first = pc.estimate(pc.simulate(problem, end=case.end, courant=COURANT, progress=stop), progress=stop, threads=1)
    found = pc.adapt(problem, target=PART * first.relative_mean, end=case.end, courant=COURANT, threads=1, progress=stop)
    best, estimate = found.problem, found.estimate
    assert best is not None and estimate is not None
    history = pc.simulate(best, end=case.end, courant=COURANT, progress=stop)
    meshes = [best.mesh.refine(1)]
    work = float(len(best.mesh.cells) * len(history.time))
    # A refinement multiplies elements by four, or two of a bar, and steps by two.
    growth = 2.0 * len(meshes[0].cells) / len(best.mesh.cells)
    meshes += [best.mesh.refine(level) for level in range(2, FINEST + 1) if work * growth**level <= MOST]
    if len(meshes) == 1 and history.touching.any():
        # Where the whole mesh would be too much, the elements at the contact are refined once more.
        touched = best.mesh.points[history.contact_nodes[history.touching.any(axis=0)]]
        meshes.append(graded(meshes[0], touched, 0.25 * float(found.iterations.smallest[found.best])))
    meshes = meshes[-2:]
    errors = [pc.true_errors([history], best.on(mesh), end=case.end, courant=COURANT, progress=stop)[0].mean for mesh in meshes]
    true = errors[-1]
    low, high = json.loads(estimate.to_json())["verdict"]["effectivity"]
    moved = true / errors[0] - 1.0 if len(errors) > 1 else math.nan
    return Found(found, estimate.relative_mean * true / estimate.mean, estimate.mean / true, moved, (low, high))


def compute(section: Section, resolution: Resolution) -> None:
    """Compute the study."""
    # The last one takes a second.
    wanted = resolution.either(cases()[-1:], cases())
    section_of(section, list(zip(wanted, resolution.map(run, wanted), strict=True)))


def section_of(section: Section, found: list[tuple[Case, Found]]) -> None:
    """Fill the section from results."""
    within = sum(each.adaptation.reached and len(each.adaptation.iterations) <= MOST_RUNS for _, each in found)
    ratios = [ratio for _, each in found for ratio in each.ratios]
    agree = sum(AGREE[0] <= ratio <= AGREE[1] for ratio in ratios)
    held = sum(each.expected[0] <= each.index <= each.expected[1] for _, each in found)
    coarse = sum(not abs(each.moved) <= SETTLED for _, each in found)
    section.add(
        "`percute.adapt` on cases that its rules were not tuned on: other shapes, materials, speeds and supports. Each target is "
        f"{PART:g} of the error on the first mesh, which is coarse. Meshes are bisections of the first one. The true error of the best mesh is that against "
        f"its refinements, up to {FINEST} times, but of at most {short(MOST, 2)} elements times steps; where a second refinement would have more, only "
        "the elements at the contact are refined twice. The table has the number for the finest reference, and by how much it exceeds that "
        f"for the coarser one. In {within} of {len(found)} cases the target is reached within {MOST_RUNS} runs, the first included. {agree} of {len(ratios)} "
        f"runs have an error of {AGREE[0]} to {AGREE[1]} times the one that was expected ({interval(min(ratios), max(ratios))}). The range of the verdict "
        f"contains the index of the mean error on the best mesh in {held} of {len(found)} cases. In {coarse} cases the true error moves by more than "
        f"{100 * SETTLED:.0f} % between the references: it is then larger than the table says, and the index smaller.",
        "More than four runs are needed where the first error is above 100 %. The first plan then refines more than the place of the contact, and expects too "
        "much of it. The adaptation of the disc on the plate ends because the estimate is not trusted: where several nodes of a fine mesh touch those of "
        "another body, the estimate of the third run is too large, and the result is the run before.",
        _table(found),
    )


def _table(found: list[tuple[Case, Found]]) -> Table:
    columns = [Column("case"), Column("branches"), Column("first error", "%", digits=3), Column("target", "%", digits=3), Column("error", "%", digits=3)]
    columns += [Column("end"), Column("runs"), Column("elements, first"), Column("elements, best"), Column("elements times steps, all runs", digits=2)]
    columns += [Column("reached over expected, each run"), Column("true error", "%", digits=3), Column("it moved by", "%", digits=2)]
    columns += [Column("index", digits=3), Column("range of the verdict"), Column("trust")]
    caption = "Adaptations to a target. Reached over expected: the error of each run after the first over the one expected of its mesh."
    table = Table("adaptation", caption, columns)
    for case, each in found:
        adaptation, runs = each.adaptation, each.adaptation.iterations
        best = adaptation.best
        assert best is not None
        table.add(
            case.name,
            ", ".join(dict.fromkeys(branch for branch in runs.branch if branch)),
            100.0 * runs.error[0],
            100.0 * adaptation.target,
            100.0 * runs.error[best],
            adaptation.reason,
            len(runs),
            int(runs.elements[0]),
            int(runs.elements[best]),
            float(runs.element_steps.sum()),
            ", ".join(f"{ratio:.2f}" for ratio in each.ratios),
            100.0 * each.true,
            100.0 * each.moved,
            each.index,
            interval(*each.expected),
            runs.trust[best],
        )
    return table
