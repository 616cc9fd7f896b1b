"""Nearly flat elements make an estimate too large: where they do, the verdict and a warning say so."""

import json
import re
from pathlib import Path

import numpy as np
import pytest

import percute as pc
from studies.flat_elements import angles, meshes, moved, problem, row, share

ROOT = Path(__file__).parents[2]


def run(mesh: pc.Mesh) -> tuple[pc.Estimate, pc.TrueError]:
    history = pc.simulate(problem(mesh), end=8e-6, courant=0.9)
    (error,) = pc.true_errors([history], problem(mesh.refine(1)), end=8e-6, courant=0.9)
    return pc.estimate(history, every=1), error


@pytest.mark.parametrize("mesh", [moved(0.01), moved(0.006), moved(0.004), moved(0.002, 16)])
def test_flat_elements_are_named(mesh: pc.Mesh) -> None:
    with pytest.warns(pc.SimulationWarning, match="nearly flat") as told:
        estimate, error = run(mesh)
    text = next(str(each.message) for each in told if "nearly flat, with" in str(each.message))
    verdict = json.loads(estimate.to_json())["verdict"]
    assert estimate.trust == "limited" and "nearly flat elements" in str(estimate.verdict)
    # A mesh of half the size misses a part of the error: the index may be larger, but must not be smaller.
    assert verdict["effectivity"][0] < min(estimate.sup / error.sup, estimate.mean / error.mean)
    largest, shares = angles(mesh), estimate.by_element**2 / np.sum(estimate.by_element**2)
    named = re.findall(r"element (\d+) \(([0-9.]+)°, ([0-9.e-]+) %\)", text)
    assert 1 <= len(named) <= 3 and int(named[0][0]) in np.flatnonzero(largest > largest.max() - 1e-6)
    for element, angle, part in named:
        assert float(angle) == pytest.approx(largest[int(element)], abs=0.06)
        assert float(part) == pytest.approx(100 * shares[int(element)], rel=0.01)
    all_of_them = re.search(r"around them have ([0-9.]+) %", text)
    assert all_of_them is not None and float(all_of_them[1]) == pytest.approx(100 * share(estimate), rel=0.01)
    assert share(estimate) > 0.35


@pytest.mark.parametrize("mesh", [pc.Mesh.rectangle(0.05, 0.04, nx=8, ny=8), pc.Mesh.rectangle(0.05, 0.04, nx=40, ny=2), moved(0.3), moved(0.1), moved(0.02)])
def test_others_have_no_such_warning(mesh: pc.Mesh) -> None:
    """With such nodes the index is at most 1.6, as without (docs/verdict.md)."""
    estimate, _ = run(mesh)
    assert not any("flat" in each for each in estimate.warnings) and "flat elements" not in str(estimate.verdict)


def test_the_effect_on_the_step_is_that_of_the_mesh() -> None:
    with pytest.warns(pc.SimulationWarning, match="nearly flat"):
        estimate, _ = run(moved(0.004))
    text = " ".join(estimate.warnings)
    found = re.search(r"could be ([0-9.]+) times as long", text)
    assert found is not None
    # A lower bound by the other elements, some of which are deformed, too.
    gain = problem(pc.Mesh.rectangle(0.05, 0.04, nx=8, ny=8)).critical_time_step / problem(moved(0.004)).critical_time_step
    assert 1.1 < float(found[1]) < gain


@pytest.mark.parametrize("name", ["disc in rings", "block, node moved to 0.1", "block, node moved to 0.01"])
def test_the_table_of_the_page_is_that_of_its_command(name: str) -> None:
    page = (ROOT / "docs" / "verdict.md").read_text(encoding="utf-8")
    told = re.search(rf"(?m)^\| {name} \| (\d+)° \| (\d+) % \| ([\d.]+) \| ([\d.]+) \|$", page)
    assert told is not None
    angle, part, sup, mean = row(meshes()[name])
    # Half a unit of the last digit.
    assert [float(each) for each in told.groups()] == pytest.approx([angle, 100 * part, sup, mean], abs=0.5) and float(told[3]) == pytest.approx(sup, abs=0.0051)
