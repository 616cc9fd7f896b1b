"""Strains, rotations and stresses beside an estimate, and runs without contact."""

import json
import pickle
import warnings
from pathlib import Path

import numpy as np
import percute as pc
import pytest


def block(speed: float, gap: float | None = None, spin: float = 0.0, yield_stress: float | None = None) -> pc.Problem:
    """A block of aluminium that strikes a plane."""
    mesh = pc.Mesh.rectangle(0.05, 0.04, nx=5, ny=4)
    gap = 5e-7 * speed if gap is None else gap
    turn = spin * (mesh.points - [0.025, 0.02])[:, ::-1] * [-1.0, 1.0]
    return pc.Problem(
        mesh,
        material=pc.Elastic(young=70e9, poisson=0.3, density=2700.0, plane="stress", yield_stress=yield_stress),
        obstacles=[pc.Plane(point=(0, -gap), normal=(0, 1), friction=0.2)],
        initial_velocity=turn - [0.0, speed],
    )


def test_strains_and_rotations_are_told() -> None:
    with pytest.warns(pc.SimulationWarning, match="principal strain of −"):
        fast = pc.estimate(pc.simulate(block(300.0), end=1e-5, courant=0.9))
    assert fast.trust == "limited" and fast.deformation is not None
    strain = fast.deformation.strain
    assert -0.1 < strain.value < -0.02 and f"element {strain.element} has" in "".join(fast.warnings)
    with pytest.warns(pc.InputWarning, match="spins the body at "):
        history = pc.simulate(block(5.0, spin=4000.0, gap=1e-2), end=4e-5, courant=0.9)
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        turned = pc.estimate(history)
    assert any("the body turns by 0.16 rad" in str(each.message) for each in told)
    assert turned.trust == "low" and turned.deformation is not None
    assert turned.deformation.bodies[0].rotation == pytest.approx(0.16, rel=1e-9)


def test_the_strain_is_that_of_the_displacements() -> None:
    """Of all instants that are looked at, from the displacements of the history."""
    history = pc.simulate(block(20.0), end=2e-5, courant=0.9)
    found = pc.estimate(history).deformation
    assert found is not None
    mesh, largest = history.problem.mesh, (0.0, 0, 0.0)
    for step in sorted({*range(0, len(history), 8), len(history) - 1}):
        corners, moved = mesh.points[mesh.cells], history.displacement[step][mesh.cells]
        sides = (np.stack([each[:, 1] - each[:, 0], each[:, 2] - each[:, 0]], axis=2) for each in (corners, moved))
        before, after = sides
        gradient = after @ np.linalg.inv(before)
        strain = np.linalg.eigvalsh(0.5 * (gradient + gradient.transpose(0, 2, 1)))
        for element, both in enumerate(strain):
            value = max(both, key=abs)
            if abs(value) > abs(largest[0]):
                largest = (value, element, history.time[step])
    # Rounding of displacements of 1e-4 m in an element of 1e-2 m.
    assert found.strain.value == pytest.approx(largest[0], rel=1e-9)
    assert (found.strain.element, found.strain.time) == largest[1:]


def test_yielding(tmp_path: Path) -> None:
    estimate = pc.estimate(pc.simulate(block(20.0, yield_stress=150e6), end=1e-5, courant=0.9))
    assert estimate.deformation is not None and estimate.verdict is not None
    (material,) = estimate.deformation.materials
    assert material.yielding is not None and 0 < material.yielding.share < 1 and material.von_mises.value > 150e6
    assert "above the yield stress of 1.50e8 Pa in" in estimate.verdict
    assert estimate.problem is not None and estimate.problem.material == block(20.0, yield_stress=150e6).material
    assert pickle.loads(pickle.dumps(estimate)).deformation == estimate.deformation
    estimate.save(tmp_path / "error.vtkhdf")
    stored = pc.open(tmp_path / "error.vtkhdf")
    assert isinstance(stored, pc.Estimate) and stored.deformation == estimate.deformation
    plain = pc.estimate(pc.simulate(block(20.0), end=1e-5, courant=0.9))
    assert plain.sup == estimate.sup and plain.deformation is not None and plain.deformation.materials[0].yielding is None


def test_nothing_touched() -> None:
    with pytest.warns(pc.InputWarning, match="closes after"):
        history = pc.simulate(block(20.0, gap=1e-3), end=1e-5, courant=0.9)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        estimate = pc.estimate(history)
    assert estimate.nearest is not None and estimate.verdict is not None
    assert estimate.nearest.gap == pytest.approx(1e-3 - 20.0 * 1e-5, rel=1e-9)
    # The speed is a difference of displacements of 2e-4 m, over 1e-7 s.
    assert estimate.nearest.touch == pytest.approx(1e-3 / 20.0, rel=1e-6)
    assert estimate.verdict.startswith("Nothing touched: ")
    assert json.loads(estimate.to_json())["contact"]["nearest"]["node"] == estimate.nearest.node
    assert pc.estimate(pc.simulate(block(20.0), end=1e-5, courant=0.9)).nearest is None
