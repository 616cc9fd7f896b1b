"""The recipes of docs/recipes.md run on files that another program could have written."""

import re
from pathlib import Path

import meshlane
import numpy as np
import percute as pc
import pytest

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def block() -> pc.History:
    """The block of the README."""
    plane = pc.Plane(point=(0, -2e-4), normal=(0, 1), friction=0.2)
    material = pc.Elastic(young=70e9, poisson=0.3, density=2700.0, plane="stress")
    mesh = pc.Mesh.rectangle(0.05, 0.04, nx=20, ny=16)
    problem = pc.Problem(mesh, material=material, obstacles=[plane], initial_velocity=(400, -400))
    return pc.simulate(problem, end=13e-6, courant=0.9)


def nodal(history: pc.History) -> np.ndarray:
    """Give the reactions (N) at all nodes."""
    reaction = np.zeros_like(history.displacement)
    reaction[:, history.contact_nodes] = history.reaction
    return reaction


def recipe(heading: str) -> str:
    page = (ROOT / "docs" / "recipes.md").read_text()
    return re.findall(rf"## {heading}\n.*?```python\n(.*?)```", page, re.DOTALL)[0]


def run(heading: str, history: pc.History) -> None:
    names: dict[str, object] = {}
    exec(recipe(heading), names)
    found = names["estimate"]
    assert isinstance(found, pc.Estimate)
    own = pc.estimate(history)
    # The steps of the page are those of the run but for rounding, by which the accelerations u'' differ a little more.
    assert found.relative_sup == pytest.approx(own.relative_sup, rel=1e-6)
    assert found.relative_mean == pytest.approx(own.relative_mean, rel=1e-6)


def test_vtu_files(block: pc.History, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("results").mkdir()
    mesh, reaction = block.problem.mesh, nodal(block)
    for n, displacement in enumerate(block.displacement):
        fields = {"displacement": np.pad(displacement, ((0, 0), (0, 1))), "reaction": np.pad(reaction[n], ((0, 0), (0, 1)))}
        points = np.pad(mesh.points, ((0, 0), (0, 1)))
        meshlane.Mesh(points, [("triangle", mesh.cells)], point_data=fields).write(f"results/step-{n:04}.vtu")
    run("A series of VTU files", block)


def test_a_table(block: pc.History, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    block.problem.mesh.write("block.msh")
    reaction = nodal(block)
    rows = [
        (time, node + 1, *block.displacement[n, node], *reaction[n, node])
        for n, time in enumerate(block.time)
        for node in range(len(block.problem.mesh.points))
    ]
    np.random.default_rng(1).shuffle(rows)
    np.savetxt("results.csv", rows, delimiter=",", header="time,node,ux,uy,rx,ry", comments="", fmt="%.17g")
    run("A table of nodal values", block)
