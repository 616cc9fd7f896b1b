"""Nearly flat elements make an estimate too large: where they do, the verdict and a warning say so."""

import json
import re

import numpy as np
import pytest

import percute as pc


def mapped(n: int) -> pc.Mesh:
    """Map a square grid to an ellipse: its four corners become nearly flat."""
    mesh = pc.Mesh.rectangle(2, 2, nx=n, ny=n)
    x, y = (mesh.points - 1).T
    return pc.Mesh(np.column_stack([x * np.sqrt(1 - y * y / 2), y * np.sqrt(1 - x * x / 2)]) * [0.03, 0.02] + [0, 0.02], mesh.cells)


def moved(part: float) -> pc.Mesh:
    """Move a node of a block to a part of its distance from the opposite edge of a triangle."""
    n = 8
    mesh = pc.Mesh.rectangle(0.05, 0.04, nx=n, ny=n)
    points, node = mesh.points.copy(), n // 2 * (n + 1) + n // 2
    middle = (points[node - 1] + points[node + n + 1]) / 2
    points[node] = middle + part * (points[node] - middle)
    return pc.Mesh(points, mesh.cells)


def problem(mesh: pc.Mesh) -> pc.Problem:
    material = pc.Elastic(young=70e9, poisson=0.3, density=2700.0, plane="stress")
    plane = pc.Plane(point=(0, mesh.points[:, 1].min() - 2e-4), normal=(0, 1), friction=0.2)
    return pc.Problem(mesh, material=material, obstacles=[plane], initial_velocity=(0, -100))


def run(mesh: pc.Mesh) -> tuple[pc.Estimate, pc.TrueError]:
    history = pc.simulate(problem(mesh), end=8e-6, courant=0.9)
    (error,) = pc.true_errors([history], problem(mesh.refine(1)), end=8e-6, courant=0.9)
    return pc.estimate(history, every=1), error


def angles(mesh: pc.Mesh) -> np.ndarray:
    """Largest angle of each element, in degrees."""
    corners = mesh.points[mesh.cells]
    edges = np.roll(corners, -1, axis=1) - corners
    unit = edges / np.linalg.norm(edges, axis=2, keepdims=True)
    return np.asarray(np.degrees(np.arccos(-np.einsum("eic,eic->ei", unit, np.roll(unit, 1, axis=1)))).max(axis=1))


@pytest.mark.parametrize("mesh", [mapped(14), mapped(18), moved(0.05), moved(0.02)])
def test_flat_elements_are_named(mesh: pc.Mesh) -> None:
    with pytest.warns(pc.SimulationWarning, match="nearly flat") as told:
        estimate, error = run(mesh)
    text = next(str(each.message) for each in told if "nearly flat, with" in str(each.message))
    verdict = json.loads(estimate.to_json())["verdict"]
    assert estimate.trust == "limited" and "nearly flat elements" in str(estimate.verdict)
    # A mesh of half the size misses a part of the error: the index may be larger, but must not be smaller.
    assert verdict["effectivity"][0] < min(estimate.sup / error.sup, estimate.mean / error.mean)
    largest, share = angles(mesh), estimate.by_element**2 / np.sum(estimate.by_element**2)
    named = re.findall(r"element (\d+) \(([0-9.]+)°, ([0-9.e-]+) %\)", text)
    assert 1 <= len(named) <= 3 and int(named[0][0]) in np.flatnonzero(largest > largest.max() - 1e-6)
    for element, angle, part in named:
        assert float(angle) == pytest.approx(largest[int(element)], abs=0.06)
        assert float(part) == pytest.approx(100 * share[int(element)], rel=0.01)
    flat = np.isin(mesh.cells, mesh.cells[largest > 150]).any(axis=1)
    all_of_them = re.search(r"around them have ([0-9.]+) %", text)
    assert all_of_them is not None and float(all_of_them[1]) == pytest.approx(100 * share[flat].sum(), rel=0.01)
    assert share[flat].sum() > 0.35


@pytest.mark.parametrize("mesh", [pc.Mesh.rectangle(0.05, 0.04, nx=8, ny=8), pc.Mesh.rectangle(0.05, 0.04, nx=40, ny=2), moved(0.3), moved(0.1)])
def test_others_have_no_such_warning(mesh: pc.Mesh) -> None:
    estimate, _ = run(mesh)
    assert not any("flat" in each for each in estimate.warnings) and "flat elements" not in str(estimate.verdict)


def test_the_effect_on_the_step_is_that_of_the_mesh() -> None:
    with pytest.warns(pc.SimulationWarning, match="nearly flat"):
        estimate, _ = run(moved(0.02))
    text = " ".join(estimate.warnings)
    found = re.search(r"could be ([0-9.]+) times as long", text)
    assert found is not None
    # A lower bound by the other elements, some of which are deformed, too.
    gain = problem(pc.Mesh.rectangle(0.05, 0.04, nx=8, ny=8)).critical_time_step / problem(moved(0.02)).critical_time_step
    assert 1.1 < float(found[1]) < gain
