"""Impacts of plane bodies on meshes that are refined: estimates beside errors against still finer meshes."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
import percute as pc
from numpy.typing import NDArray
from percute.estimating import ablated
from studies import figures
from studies.block import ALUMINIUM
from studies.bodies import BODIES, corners, elastic, graded
from studies.choices import RECONSTRUCTIONS
from studies.parallel import Stop

RECONSTRUCTION_OPTIONS = [{"reconstruction": name} for name in RECONSTRUCTIONS]
"""The reconstructions of the contact force, as arguments of `percute.estimate`."""
STEP = 0.9
"""Δt/Δt_c, exactly, of all runs but those for short steps."""
MESHES = 4
"""Meshes that are estimated, each with four times as many elements as the one before."""
FEW = 2
"""Meshes of a small study, and of studies of other things than the mesh, which show the last of them."""
GOOD = (0.9, 1.5)
"""The range of a good estimate."""
CONTACT_SIZES = ((40.0, 62e-6), (10.0, 31e-6), (0.0, 16e-6))
"""From these speeds across the plane on (m/s), the size of the elements of a reference at corners that come into contact (m)."""
OBLIQUE, NORMAL = (400.0, -400.0), (0.0, -400.0)
"""Velocity along and across the plane (m/s)."""
FLAT, TILTED, CURVED, CORNER = KINDS = ("flat", "tilted by 3°", "curved", "corner first")
"""Cases that are judged together: a side arrives at once or from one end to the other, a curved outline, a corner alone."""


@dataclass(frozen=True)
class Found:
    """The results on one mesh."""

    elements: int
    steps: int
    estimates: list[pc.Estimate]
    """One of each choice."""
    touching: tuple[float, float] | None
    """First and last instant at which a node touches (s)."""
    most: int
    """The most nodes that touch at one instant."""
    last: int
    """How many touch at the end."""
    exact: list[pc.TrueError] = field(default_factory=list)
    """e_ref against each reference."""

    def effectivity(self, choice: int) -> tuple[float, float]:
        """Give e/e_ref, sup and mean, of a choice against the finest reference."""
        index = self.estimates[choice].effectivity(self.exact[-1])
        return index.sup, index.mean

    def contact(self, choice: int) -> float:
        """Give the part of contact in η where it is largest."""
        parts = self.estimates[choice].parts
        return parts.contact / parts.total


@dataclass(frozen=True)
class Case:
    """One impact, of aluminium as in the paper's §7.2 unless it names another material."""

    body: str = "block"
    """One of `bodies.BODIES`. Refined meshes are of the same polygon."""
    material: str = "aluminium"
    """One of `bodies.MATERIALS`, or `bodies.LAYERS` for a body of two layers."""
    plane: Any = "stress"
    friction: float = 0.2
    tilt: float = 0.0
    """By how much the plane is turned clockwise under the body (°)."""
    velocity: tuple[float, float] = OBLIQUE
    gap: float = 0.2e-3
    """Distance of the lowest node from the plane (m)."""
    end: float = 13e-6
    """T (s); a run ends with its first instant at or past it."""
    ratio: float = STEP
    meshes: int = MESHES
    references: tuple[int, ...] = (5, 6)
    """Refinements of the references, coarsest first; the last one counts."""
    sizes: tuple[float, ...] = ()
    """Size of the elements of each reference at the corners that come into contact (m); without it references are uniform."""
    gravity: float = 0.0
    """Acceleration towards the plane (m/s²), of bodies of aluminium only."""

    @property
    def kind(self) -> str:
        """Which other cases it is judged with."""
        if self.body in ("disc", "rounded block"):
            return CURVED
        # At 3°, the 50 mm of a side arrive within 6.5 µs; at 10° only the corner does.
        return FLAT if self.tilt == 0.0 else TILTED if abs(self.tilt) < 5.0 else CORNER

    @property
    def name(self) -> str:
        """Its name in tables."""
        tilt = f" tilted by {self.tilt:g}°".replace("-", "−") if self.tilt else ""
        way = "normal" if self.velocity[0] == 0.0 else "oblique"
        material = "" if self.material == "aluminium" else f", {self.material}"
        return f"{self.body}{tilt}{material}, plane {self.plane}, μ = {self.friction:g}, {way}"

    @property
    def cost(self) -> float:
        """How long it takes, in any unit: its finest reference decides."""
        return 8.0 ** self.references[-1] * self.end

    def at(self, **changes: Any) -> Case:
        """Give the case with some changes."""
        return replace(self, **changes)

    def few(self) -> Case:
        """Give the case on few meshes, against the first of its references."""
        return self.at(meshes=FEW, references=self.references[:1])

    def scaled(self, scale: float) -> Case:
        """Give the case with another speed, and the gap in proportion: the body touches at the same instant."""
        return self.at(velocity=(scale * self.velocity[0], scale * self.velocity[1]), gap=scale * self.gap)

    def mesh(self, refinements: int) -> pc.Mesh:
        """Give the mesh after a number of refinements."""
        if self.body == "block":
            # The same triangles as by refinement, but in rows, which is faster.
            return pc.Mesh.rectangle(0.05, 0.04, nx=5 << refinements, ny=4 << refinements)
        return BODIES[self.body]().refine(refinements)

    def problem(self, refinements: int, places: NDArray[np.float64] | None = None, size: float = 0.0) -> pc.Problem:
        """Give the problem on one of the meshes, with elements of a size at some places."""
        mesh = self.mesh(refinements)
        return self.on(mesh if places is None else graded(mesh, places, size))

    def on(self, mesh: pc.Mesh) -> pc.Problem:
        """Give the problem on a mesh."""
        angle = math.radians(self.tilt)
        normal, tangent = np.array([math.sin(angle), math.cos(angle)]), np.array([math.cos(angle), -math.sin(angle)])
        lowest = float(np.min(mesh.points[:, 0] * normal[0] + mesh.points[:, 1] * normal[1])) - self.gap
        return pc.Problem(
            mesh,
            material=elastic(self.material, self.plane),
            body_forces=[pc.BodyForce(value=-self.gravity * ALUMINIUM["density"] * normal)] if self.gravity else [],
            initial_velocity=self.velocity[0] * tangent + self.velocity[1] * normal,
            obstacles=[pc.Plane(point=normal * lowest, normal=normal, friction=self.friction)],
        )

    def run(self, choices: Sequence[Mapping[str, Any]], stop: Stop | None = None) -> list[Found | None]:
        """Estimate on each mesh with each choice, then compare with the references.

        A mesh that is not wanted, or on which the body starts too near to the plane, gives None.
        """
        found: list[Found | None] = []
        histories, ends = [], []
        for refinements in range(self.meshes):
            problem = self.problem(refinements)
            times = steps_past(self.end, self.ratio, problem)
            ends.append(times["end"])
            try:
                history = pc.simulate(problem, **times, progress=stop)
            except pc.InputError as error:
                if "obstacles[0].point" not in str(error):
                    raise
                found.append(None)
                continue
            estimates = [ablated(history, every=1, threads=1, progress=stop, **choice) for choice in choices]
            count = history.touching.sum(axis=1)
            during = history.time[np.flatnonzero(count)]
            touching = (float(during[0]), float(during[-1])) if len(during) else None
            steps = len(history) - 1
            found.append(Found(len(problem.mesh.cells), steps, estimates, touching, int(count.max()), int(count[-1])))
            histories.append(history)
        there = [each for each in found if each is not None]
        places = np.unique(np.concatenate([np.empty((0, 2)), *map(touched, histories)]), axis=0)
        for k, refinements in enumerate(self.references):
            fine = self.problem(refinements, places, self.sizes[k]) if self.sizes else self.problem(refinements)
            errors = pc.true_errors(histories, fine, **steps_past(max(ends), STEP, fine), progress=stop)
            for each, true in zip(there, errors, strict=True):
                each.exact.append(true)
        return found + [None] * (MESHES - self.meshes)

    def finest(self, choices: Sequence[Mapping[str, Any]], stop: Stop | None = None) -> Found:
        """Run it and give the results on the finest of the meshes that are estimated."""
        return [found for found in self.run(choices, stop) if found is not None][-1]


def stated(estimate: pc.Estimate) -> tuple[str, str, float, float]:
    """Give what the verdict states: trust, how the body touches, and the range of the effectivity index."""
    verdict = json.loads(estimate._data.verdict())["verdict"]
    low, high = verdict["effectivity"]
    return verdict["trust"], verdict["touches"], low, high


VERDICT = tuple(f"verdict: {name}" for name in ("trust", "touches", "lowest", "highest"))
"""Columns of what `stated` gives."""


def holds(estimate: pc.Estimate, pair: tuple[float, float]) -> bool:
    """Say whether the range of the verdict contains the effectivity index of the largest error and of the mean."""
    _, _, low, high = stated(estimate)
    return low <= min(pair) and max(pair) <= high


def inside(held: Iterable[bool]) -> str:
    """Say in how many runs the range of the verdict holds."""
    each = list(held)
    return f"The range that the verdict states contains both indices in {sum(each)} of {len(each)} runs."


def contact_size(speed: float) -> float:
    """Give the size of the elements of a reference at corners that come into contact (m)."""
    return next(size for least, size in CONTACT_SIZES if speed >= least)


def curve(name: str, found: Sequence[Found | None], choice: int, measure: int, colour: int) -> figures.Curve:
    """Give the effectivity index of a choice over refinement: of the largest error (0) or of the mean (1)."""
    values = [math.nan if each is None else each.effectivity(choice)[measure] for each in found]
    return figures.Curve(name, [2.0**mesh for mesh in range(len(found))], values, figures.own(colour), marked=True)


def touched(history: pc.History) -> NDArray[np.float64]:
    """Give the corners that come into contact (m)."""
    nodes = history.contact_nodes[history.touching.any(axis=0)]
    return history.problem.mesh.points[np.intersect1d(nodes, corners(history.problem.mesh))]


def steps_past(reach: float, ratio: float, problem: pc.Problem) -> dict[str, Any]:
    """Give steps of exactly a part of Δt_c that reach an instant."""
    step = ratio * problem.critical_time_step
    return {"end": math.ceil(reach / step) * step, "step": step}


def cases(small: bool = False) -> list[Case]:
    """Give the cases; the small ones are some of them, on fewer meshes."""
    block = Case()
    tilted = replace(block, end=16e-6)
    if small:
        return [block.few(), replace(tilted, tilt=3.0).few()]
    flat = [
        replace(block, plane=plane, friction=friction, velocity=velocity)
        for plane in ("stress", "strain")
        for friction in (0.0, 0.2, 0.5)
        for velocity in (OBLIQUE, NORMAL)
    ]
    # One case has a third reference of 640×512 cells.
    flat = [replace(case, references=(5, 6, 7)) if case == block else case for case in flat]
    unstructured = replace(block, body="unstructured block")
    rounded = replace(tilted, body="rounded block", tilt=10.0)
    return [
        *flat,
        unstructured,
        replace(unstructured, plane="strain", friction=0.5),
        replace(tilted, tilt=3.0),
        replace(tilted, tilt=-3.0),
        replace(tilted, body="unstructured block", tilt=3.0),
        *(replace(tilted, tilt=tilt, velocity=NORMAL, gap=0.1e-3) for tilt in (10.0, -10.0)),
        *(replace(rounded, velocity=velocity) for velocity in (OBLIQUE, NORMAL)),
        *(replace(tilted, body="disc", velocity=velocity, end=40e-6) for velocity in (OBLIQUE, NORMAL)),
    ]
