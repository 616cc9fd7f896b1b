"""Grade a simulation of another program: a block in Akantu, with and without contact.

    pip install akantu
    python examples/with_akantu.py

Akantu integrates with central differences and a lumped mass, as percute does, but it treats contact by a penalty: a force in
proportion to the penetration, where percute has Lagrange multipliers and no penetration. The script takes some seconds and
prints the error of each simulation. docs/recipes.md has the results.

The file cannot be called akantu.py: Python would import it in place of Akantu.
"""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import count
from pathlib import Path

import akantu as aka
import numpy as np
import percute as pc
from numpy.typing import NDArray

YOUNG, POISSON, DENSITY = 70e9, 0.3, 2700.0
FRICTION = 0.2
GAP = 2e-4
"""Distance between the block and the plane at the start (m)."""
VELOCITY = (400.0, -400.0)
END = 13e-6
MESH = pc.Mesh.rectangle(0.05, 0.04, nx=20, ny=16)
BLOCK = pc.Elastic(young=YOUNG, poisson=POISSON, density=DENSITY, plane="stress")
MATERIAL = f"rho = {DENSITY}\n E = {YOUNG}\n nu = {POISSON}\n Plane_Stress = true"
PENALTIES = ((1e13, 45), (3e13, 60), (1e14, 90), (3e14, 150), (1e15, 270))
"""Stiffness of the penalty (Pa/m), and steps for which it is stable."""
NUMBERS = count()

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Run:
    """A simulation of Akantu: arrays over its instants."""

    time: Floats
    """(instants,), s"""
    displacement: Floats
    """(instants, nodes, 2), m"""
    reaction: Floats | None = None
    """(instants, nodes, 2), N"""


def flight_velocity(mesh: pc.Mesh) -> Floats:
    """A velocity (m/s) at each node that makes the block vibrate."""
    x, y = (mesh.points / MESH.size).T
    return np.stack([10 * np.sin(3 * x + y), -20 * np.cos(2 * y)], axis=1)


def flight_problem(mesh: pc.Mesh = MESH) -> pc.Problem:
    """The block without a plane."""
    return pc.Problem(mesh, material=BLOCK, initial_velocity=flight_velocity(mesh))


def impact_problem(mesh: pc.Mesh = MESH) -> pc.Problem:
    """The block that strikes the plane: the same as examples/block.toml."""
    plane = pc.Plane(point=(0, -GAP), normal=(0, 1), friction=FRICTION, group="bottom")
    return pc.Problem(mesh, material=BLOCK, obstacles=[plane], initial_velocity=VELOCITY)


def write_mesh(file: Path) -> None:
    """Write the block and, below it, two triangles of which Akantu makes the plane, as a file of Gmsh."""
    nodes = len(MESH.points)
    left, right, top, bottom = -0.05, 0.10, -GAP, -GAP - 0.01
    points = np.vstack([MESH.points, [(left, bottom), (right, bottom), (right, top), (left, top)]])
    elements = [(1, 1, edge) for edge in MESH.edge_groups["bottom"]]
    elements += [(1, 2, (nodes + 3, nodes + 2))]
    elements += [(2, 3, cell) for cell in MESH.cells]
    elements += [(2, 4, (nodes, nodes + 1, nodes + 2)), (2, 4, (nodes, nodes + 2, nodes + 3))]
    names = ['1 1 "bottom"', '1 2 "surface"', '2 3 "block"', '2 4 "ground"']
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", "4", *names, "$EndPhysicalNames", "$Nodes", f"{len(points)}"]
    lines += [f"{k} {x:.17g} {y:.17g} 0" for k, (x, y) in enumerate(points, 1)]
    lines += ["$EndNodes", "$Elements", f"{len(elements)}"]
    for k, (kind, group, corners) in enumerate(elements, 1):
        lines.append(f"{k} {kind} 2 {group} {group} " + " ".join(str(node + 1) for node in corners))
    file.write_text("\n".join([*lines, "$EndElements", ""]))


def flight(steps: int) -> Run:
    """Let the block vibrate in free flight."""
    with tempfile.TemporaryDirectory() as folder:
        material = Path(folder) / "material.dat"
        material.write_text(f"material elastic [\n name = block\n {MATERIAL}\n]\n")
        aka.parseInput(str(material))
    mesh = aka.Mesh(2, f"flight{next(NUMBERS)}")
    accessor = aka.MeshAccessor(mesh)
    accessor.resizeNodes(len(MESH.points))
    mesh.getNodes()[:] = MESH.points
    mesh.addConnectivityType(aka._triangle_3)
    accessor.resizeConnectivity(len(MESH.cells), aka._triangle_3)
    mesh.getConnectivity(aka._triangle_3)[:] = MESH.cells
    accessor.makeReady()
    model = aka.SolidMechanicsModel(mesh)
    model.initFull(_analysis_method=aka._explicit_lumped_mass)
    time = np.linspace(0.0, END, steps + 1)
    model.setTimeStep(time[1])
    model.getVelocity()[:] = flight_velocity(MESH)
    displacement = np.zeros((steps + 1, *MESH.points.shape))
    for n in range(1, steps + 1):
        model.solveStep()
        displacement[n] = model.getDisplacement()
    return Run(time, displacement)


def impact(stiffness: float, steps: int) -> Run:
    """Let the block strike the plane, with a penalty of this stiffness (Pa/m)."""
    with tempfile.TemporaryDirectory() as folder:
        grid, material = Path(folder) / "block.msh", Path(folder) / "material.dat"
        write_mesh(grid)
        bodies = "\n".join(f"material elastic [\n name = {name}\n {MATERIAL}\n]" for name in ("block", "ground"))
        material.write_text(
            f"{bodies}\ncontact_detector [\n type = explicit\n master = surface\n slave = bottom\n projection_tolerance = 1e-10\n"
            f" max_iterations = 100\n extension_tolerance = 0.2\n]\n"
            f"contact_resolution penalty_linear [\n name = penalty\n mu = {FRICTION}\n is_master_deformable = false\n"
            f" epsilon_n = {stiffness}\n epsilon_t = {stiffness}\n]\n"
        )
        aka.parseInput(str(material))
        mesh = aka.Mesh(2, f"impact{next(NUMBERS)}")
        mesh.read(str(grid))
    model = aka.CouplerSolidContact(mesh)
    solid, contact = model.getSolidMechanicsModel(), model.getContactMechanicsModel()
    selector = aka.MeshDataMaterialSelectorString("physical_names", solid)
    solid.setMaterialSelector(selector)
    model.initFull(_analysis_method=aka._explicit_lumped_mass)
    contact.getContactDetector().setSurfaceSelector(aka.PhysicalSurfaceSelector(mesh))
    nodes = len(MESH.points)
    solid.getBlockedDOFs()[nodes:] = True
    time = np.linspace(0.0, END, steps + 1)
    model.setTimeStep(time[1])
    solid.getVelocity()[:nodes] = VELOCITY
    displacement, reaction = np.zeros((2, steps + 1, *MESH.points.shape))
    for n in range(1, steps + 1):
        model.solveStep()
        displacement[n] = solid.getDisplacement()[:nodes]
        # The forces that act at t_n, from the penetration at t_n.
        reaction[n] = contact.getInternalForce()[:nodes]
    return Run(time, displacement, reaction)


def history(problem: pc.Problem, run: Run) -> pc.History:
    """Hand a run to percute."""
    nodes = problem.contact_nodes
    reaction = None if run.reaction is None else run.reaction[:, nodes]
    return pc.History.from_arrays(problem, run.time, run.displacement, reaction=reaction)


def grade(graded: pc.History, reference: pc.History) -> list[float]:
    """Give the error at its largest and its mean, its parts at the sup (%), the effectivity index and the penetration (mm)."""
    estimate = pc.estimate(graded, every=1)
    parts = (estimate.parts.kinetic, estimate.parts.elastic, estimate.parts.contact)
    index = estimate.effectivity(graded.error(reference)).mean
    nodes = graded.problem.contact_nodes
    penetration = max(0.0, -float(graded.displacement[:, nodes, 1].min(initial=-GAP)) - GAP)
    percent = [estimate.relative_sup, estimate.relative_mean, *(part / estimate.sup**2 for part in parts)]
    return [*(100 * value for value in percent), index, 1e3 * penetration]


def cases() -> Iterator[tuple[str, pc.History, pc.History]]:
    """Run all cases: their names, histories and references."""
    problem, steps = flight_problem(), 45
    reference = pc.simulate(flight_problem(MESH.refine(2)), end=END, courant=0.9)
    yield "flight, Akantu", history(problem, flight(steps)), reference
    yield "flight, percute", pc.simulate(problem, end=END, step=END / steps), reference
    problem = impact_problem()
    reference = pc.simulate(impact_problem(MESH.refine(2)), end=END, courant=0.9)
    yield "impact, percute", pc.simulate(problem, end=END, step=END / steps), reference
    for stiffness, steps in PENALTIES:
        yield f"impact, Akantu, {stiffness:.0e} Pa/m", history(problem, impact(stiffness, steps)), reference


def main() -> None:
    """Grade all cases."""
    names = ("sup (%)", "mean (%)", "kinetic", "elastic", "contact", "index", "depth (mm)")
    print(" " * 30 + "".join(f"{name:>11}" for name in names))
    for name, graded, reference in cases():
        sup, mean, kinetic, elastic, contact, index, depth = grade(graded, reference)
        print(f"{name:<30}{sup:11.2f}{mean:11.2f}{kinetic:11.0f}{elastic:11.0f}{contact:11.0f}{index:11.2f}{depth:11.2f}")


if __name__ == "__main__":
    main()
