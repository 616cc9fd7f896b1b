"""Random bodies that strike a plane or vibrate, each made from its seed."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
import percute as pc
from studies.random_bodies import meshes
from studies.random_bodies.draws import Draws
from studies.random_bodies.meshes import Integers, NoMesh, Sizes
from studies.random_bodies.shapes import SHAPES, Floats, Shape
from studies.random_bodies.velocities import Velocity, smooth

KINDS = ("impact", "vibration", "graded", "turning", "yielding")
"""Impacts of any kind; free bodies that vibrate; impacts on meshes that are graded towards the contact; bodies that spin and strike, with finite kinematics;
impacts of metals that yield."""
MATERIALS: dict[str, tuple[float, float, float]] = {
    "steel": (210e9, 0.3, 7800.0),
    "aluminium": (70e9, 0.33, 2700.0),
    "titanium": (114e9, 0.34, 4430.0),
    "copper": (120e9, 0.35, 8900.0),
    "glass": (70e9, 0.22, 2500.0),
    "concrete": (30e9, 0.18, 2400.0),
    "polymer": (3e9, 0.38, 1200.0),
    "soft polymer": (0.3e9, 0.45, 950.0),
    "rubber": (20e6, 0.485, 1100.0),
}
"""Young's modulus (Pa), Poisson's ratio and density (kg/m³)."""
REFERENCE_WORK = 3e8
"""Most elements times critical steps of a reference, which take some ten seconds, unless it would be too coarse."""
OF_CELLS = ("rectangle", "beam", "L", "bracket", "frame", "disc")
"""Shapes that may have a mesh of equal cells, the disc one in rings."""
ATTEMPTS = 200
"""How often a body is drawn again whose mesh is not good."""
FASTEST = 0.1
"""Largest speed over that of waves in a bar of the material: a little more than in any evidence."""
WORK = 1e6
"""Most elements times critical steps of the run: simulation, estimate and reference take 10 to 20 s."""
FINITE_LAWS: list[Literal["neo_hookean", "svk", "hencky"]] = ["neo_hookean", "neo_hookean", "hencky", "svk"]
"""The default twice."""
FINITE = 4.0
"""What a step of a finite law takes over one of small strains."""
METALS = ("steel", "aluminium", "titanium", "copper")
SLOWEST_STRAIN = 0.01
"""Largest speed of a metal that yields over that of waves in a bar: strains stay small."""
SHORTEST = 0.3
"""Fewest wave passages; a body that takes more work for them is drawn again."""


@dataclass(frozen=True, eq=False)
class RandomBody:
    """A body and its run."""

    kind: str
    seed: int
    shape: str
    mesh_kind: str
    mesh: pc.Mesh
    """In its place at the start."""
    material: str
    law: pc.Elastic
    courant: float
    end: float
    """s"""
    passages: float
    """Times of a wave along the diagonal: from the first touch to the end, or of the whole run."""
    tilt: float = 0.0
    """°"""
    speed: float = 0.0
    """Across the plane (m/s)."""
    along: float = 0.0
    """Velocity along the plane over the speed."""
    friction: float = 0.0
    gap: float = 0.0
    """m"""
    velocity: Velocity | None = None
    """That of a body that vibrates, over places (m)."""
    spin: float = 0.0
    """Initial angular velocity (rad/s)."""

    def problem(self) -> pc.Problem:
        """Give the problem."""
        return self._on(self.mesh)

    def reference(self, further: int = 0) -> pc.Problem:
        """Give the problem on a much finer mesh, the finest that is not too much work, refined some further times."""
        if self.velocity is not None or len(self._lowest) > 1:
            return self._finest(lambda times: self.mesh.refine(times + further), (3, 2), 8.0**further)
        return self._finest(lambda times: self._where_it_touches(2 + further, times + further), range(7, 2, -1), 8.0**further)

    def _finest(self, mesh: Callable[[int], pc.Mesh], times: Sequence[int], more: float) -> pc.Problem:
        """Give the problem on the first of these meshes that is not too much work, or on the last one."""
        for each in times[:-1]:
            problem = self._on(mesh(each))
            if self._cost * len(problem.mesh.cells) * self.end < REFERENCE_WORK * more * problem.critical_time_step:
                return problem
        return self._on(mesh(times[-1]))

    @property
    def _cost(self) -> float:
        return FINITE if self.law.kinematics == "finite" else 1.0

    @property
    def _lowest(self) -> Integers:
        """The nodes that touch first."""
        heights = self.mesh.points[:, 1]
        lowest: Integers = np.flatnonzero(heights < heights.min() + 1e-9 * self.mesh.size)
        return lowest

    def _where_it_touches(self, times: int, there: int) -> pc.Mesh:
        """Refine the mesh so often, and more often where its lowest node is: a slow contact is much smaller than elements."""
        mesh, lowest = self.mesh.refine(times), self._lowest
        touching = (self.mesh.cells == lowest[0]).any(axis=1)
        size = float(meshes.longest(self.mesh)[touching].min()) / math.sqrt(2.0) / 2.0**there
        return meshes.refined(mesh, Sizes(self.mesh.points[lowest[[0, 0]]], size, self.mesh.size, 0.25), 10 * len(mesh.cells))

    def _on(self, mesh: pc.Mesh) -> pc.Problem:
        if self.velocity is not None:
            return pc.Problem(mesh, material=self.law, initial_velocity=self.velocity(mesh.points))
        plane = pc.Plane(point=(0.0, float(self.mesh.points[:, 1].min()) - self.gap), normal=(0.0, 1.0), friction=self.friction)
        velocity = np.broadcast_to((self.along * self.speed, -self.speed), mesh.points.shape)
        if self.spin:
            arm = mesh.points - self.mesh.points.mean(axis=0)
            velocity = velocity + self.spin * np.stack([-arm[:, 1], arm[:, 0]], axis=1)
        return pc.Problem(mesh, material=self.law, obstacles=[plane], initial_velocity=velocity)

    @property
    def grading(self) -> float:
        """The longest edge of the mesh over the shortest."""
        sides = meshes.edges(self.mesh)
        return float(sides.max() / sides.min())


def body(kind: str, seed: int) -> RandomBody:
    """Make the body of a kind with this seed, always the same (meshes of Gmsh: by the same version of Gmsh)."""
    for attempt in range(ATTEMPTS):
        draws = Draws(KINDS.index(kind), seed, attempt)
        try:
            return _vibrating(draws, seed) if kind == "vibration" else _striking(draws, seed, kind)
        except NoMesh:
            continue
    raise AssertionError(f"no mesh of {kind} {seed} in {ATTEMPTS} attempts")


def _law(draws: Draws, names: Sequence[str] = tuple(MATERIALS)) -> tuple[str, pc.Elastic, float]:
    """Draw a material; give the speed of waves in a bar of it, too (m/s)."""
    name = draws.one(list(names))
    young, poisson, density = MATERIALS[name]
    if name == "rubber":
        poisson = draws.uniform(0.45, 0.49)
    plane: Literal["stress", "strain"] = "strain" if draws.chance(0.5) else "stress"
    return name, pc.Elastic(young=young, poisson=poisson, density=density, plane=plane), math.sqrt(young / density)


def _mesh(draws: Draws, shape: Shape, kind: str, place: Floats, grading: float) -> pc.Mesh:
    elements, slope, mirrored = round(draws.log_uniform(150.0, 1000.0)), draws.uniform(0.2, 0.6), draws.chance(0.5)
    algorithm = draws.one([5, 6])
    if kind == "cells":
        return meshes.checked(meshes.of_cells(shape, round(elements / (1.0 + 0.3 * math.log(grading))), place, grading, slope, mirrored))
    sizes = meshes.sized(shape, place, elements, grading, slope)
    return meshes.checked(meshes.delaunay(shape, sizes, draws) if kind == "Delaunay" else meshes.by_gmsh(shape, sizes, algorithm))


def _shape(draws: Draws, names: Sequence[str]) -> Shape:
    """Draw a shape of one of these names, of 5 to 300 mm."""
    return SHAPES[draws.one(names)](draws, draws.log_uniform(5e-3, 0.3))


def _mesh_kind(draws: Draws, shape: Shape) -> str:
    """Draw a kind of mesh that the shape can have."""
    return draws.one([*(["cells"] if shape.name in OF_CELLS else []), "Delaunay", "Gmsh"])


def _tilt(draws: Draws) -> float:
    """Draw a tilt (°): often none, sometimes 45°, sometimes small."""
    part = draws.uniform(0.0, 1.0)
    if part < 0.25:
        return draws.one([0.0, 0.0, 90.0, 180.0])
    if part < 0.35:
        return draws.one([45.0, -45.0, 135.0])
    return draws.uniform(-8.0, 8.0) if part < 0.5 else draws.uniform(-180.0, 180.0)


def _turned(mesh: pc.Mesh, tilt: float) -> pc.Mesh:
    """Turn a mesh counterclockwise by an angle (°)."""
    if tilt == 0.0:
        return mesh
    cosine, sine = math.cos(math.radians(tilt)), math.sin(math.radians(tilt))
    return pc.Mesh(mesh.points @ np.array([[cosine, sine], [-sine, cosine]]), mesh.cells)


def _striking(draws: Draws, seed: int, kind: str) -> RandomBody:
    """Draw a body that strikes a plane."""
    graded = kind == "graded"
    cells = graded and draws.chance(0.5)
    shape = _shape(draws, OF_CELLS if cells else list(SHAPES))
    name, law, wave = _law(draws, METALS if kind == "yielding" else tuple(MATERIALS))
    if kind == "turning":
        law = replace(law, kinematics="finite", law=draws.one(FINITE_LAWS))
    tilt = draws.one([45.0, draws.uniform(1.0, 20.0), draws.uniform(-180.0, 180.0)]) if graded else _tilt(draws)
    place = shape.lowest(math.radians(tilt))
    if draws.chance(0.5):
        # One end of an edge.
        place = place[[0, 0]]
    if graded:
        grading = draws.one([4.0, 16.0, 64.0, 256.0])
    else:
        grading = draws.log_uniform(1.5, 100.0) if draws.chance(1.0 / 3.0) else 1.0
    mesh_kind = ("cells" if cells else "Gmsh") if graded else _mesh_kind(draws, shape)
    mesh = _turned(_mesh(draws, shape, mesh_kind, place, grading), tilt)
    free = pc.Problem(mesh, material=law)
    speed = min(draws.log_uniform(0.3, 200.0), FASTEST * wave)
    if kind == "yielding":
        speed = min(speed, SLOWEST_STRAIN * wave)
        law = _yielding(draws, law, law.young * speed / wave)
    # Half of the speed of the fall at the rim, at most.
    spin = draws.uniform(-1.0, 1.0) * speed / mesh.size if kind == "turning" else 0.0
    along = 0.0 if draws.chance(0.6) else draws.uniform(-1.0, 1.0)
    friction = 0.0 if draws.chance(0.4) else draws.uniform(0.0, 0.5)
    courant = draws.uniform(0.3, 0.95)
    step = courant * free.critical_time_step
    gap = draws.log_uniform(1.2, 20.0) * step * speed
    passage = mesh.size / free.wave_speed
    passages = draws.log_uniform(SHORTEST, 3.0 if graded else 30.0)
    work = WORK / FINITE if kind == "turning" else WORK
    passages = min(passages, (work / len(mesh.cells) * free.critical_time_step - gap / speed) / passage)
    if passages < SHORTEST:
        raise NoMesh("too much work")
    end = gap / speed + passages * passage
    return RandomBody(kind, seed, shape.name, mesh_kind, mesh, name, law, courant, end, passages, tilt, speed, along, friction, gap, spin=spin)


def _yielding(draws: Draws, law: pc.Elastic, stress: float) -> pc.Elastic:
    """Draw where a metal yields that an impact gives this stress (Pa) in a bar, and how it hardens."""
    tangent = draws.log_uniform(0.02, 0.3) * law.young
    kinematic = draws.one([0.0, 0.0, 1.0, draws.uniform(0.0, 1.0)])
    return replace(law, yield_stress=stress / draws.log_uniform(0.5, 10.0), tangent=tangent, kinematic=kinematic)


def _vibrating(draws: Draws, seed: int) -> RandomBody:
    """Draw a free body with a smooth initial velocity."""
    shape = _shape(draws, list(SHAPES))
    name, law, wave = _law(draws)
    place = shape.lowest(draws.uniform(-math.pi, math.pi))
    grading = draws.log_uniform(1.5, 10.0) if draws.chance(1.0 / 3.0) else 1.0
    mesh_kind = _mesh_kind(draws, shape)
    mesh = _mesh(draws, shape, mesh_kind, place, grading)
    free = pc.Problem(mesh, material=law)
    velocity = smooth(draws, mesh, draws.log_uniform(1e-5, 1e-3) * wave)
    courant = draws.uniform(0.3, 0.95)
    passage = mesh.size / free.wave_speed
    end = draws.log_uniform(1.0, 30.0) * period(shape, passage)
    end = min(end, WORK / len(mesh.cells) * free.critical_time_step)
    if end < period(shape, passage):
        raise NoMesh("too much work")
    return RandomBody("vibration", seed, shape.name, mesh_kind, mesh, name, law, courant, end, end / passage, velocity=velocity)


def period(shape: Shape, passage: float) -> float:
    """Give about the period of the lowest mode (s): 1.06 times that of Lamé's mode of a square, 0.9 times that of a slender beam.

    Both follow from passages and the mean thickness 2 A/P, for ν = 0.3.
    """
    return 0.7 * passage * shape.diagonal * shape.perimeter / (2.0 * shape.area)
