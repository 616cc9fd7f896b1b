"""The verdict on histories of other programs, and histories in which nothing deforms."""

import re
from pathlib import Path

import numpy as np
import percute as pc
import pytest
from conftest import block
from studies.consistency import FIGURES, Cases, table

ROOT = Path(__file__).parents[2]


def test_a_rigid_flight_has_no_error() -> None:
    mesh = pc.Mesh.rectangle(0.05, 0.04, nx=5, ny=4)
    material = pc.Elastic(young=70e9, poisson=0.3, density=2700.0, plane="stress")
    problem = pc.Problem(mesh, material=material, initial_velocity=(30.0, -10.0))
    own = pc.simulate(problem, end=5e-5, courant=0.9)
    for kind in (np.float64, np.float32):
        history = pc.History.from_arrays(problem, own.time, own.displacement.astype(kind))
        estimate = pc.estimate(history)
        assert estimate.consistency is not None
    # In double precision; single precision makes waves of its own.
    estimate = pc.estimate(pc.History.from_arrays(problem, own.time, own.displacement))
    assert estimate.relative_sup < 1e-9
    assert "zero to rounding" in estimate.verdict


def test_the_page_on_histories_writes_one_that_is_graded(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    page = (ROOT / "docs" / "history.md").read_text()
    script = next(code for code in re.findall(r"```python\n(.*?)```", page, re.DOTALL) if "h5py.File" in code)
    exec(script, {})
    with pytest.warns(pc.InputWarning, match="moves the body away from the plane"):
        assert pc.estimate(pc.open("flight.vtkhdf")).relative_sup < 1e-9


def test_a_history_that_is_not_consistent_is_not_trusted() -> None:
    problem = block()
    own = pc.simulate(problem, end=13e-6, courant=0.9)
    late = np.concatenate([own.reaction[:1], own.reaction[:-1]])
    history = pc.History.from_arrays(problem, own.time, own.displacement, reaction=late)
    with pytest.raises(pc.InputError) as refused:
        pc.estimate(history)
    estimate = pc.estimate(history, force=True)
    # The figure and the cause are those of the refusal.
    figure, cause = re.search(r"(the history is not consistent: .*)\. Likely cause: (.*); .*force=True", str(refused.value)).groups()  # type: ignore[union-attr]
    assert estimate.trust == "low" and figure in estimate.verdict and f"likely cause: {cause}" in estimate.verdict
    correct = pc.History.from_arrays(problem, own.time, own.displacement, reaction=own.reaction)
    assert pc.estimate(correct).trust == pc.estimate(own).trust


def test_remedies_of_a_history_that_is_not_consistent_are_its_own() -> None:
    problem = block()
    own = pc.simulate(problem, end=13e-6, courant=0.9)
    pulled = pc.History.from_arrays(problem, own.time, own.displacement, reaction=-own.reaction)
    with pytest.warns(pc.SimulationWarning) as warned:
        pc.estimate(pulled, force=True)
    told = [str(warning.message) for warning in warned]
    assert any("relative error" in message for message in told)
    assert all(message.endswith("the history is not consistent: correct it first") for message in told), told


@pytest.mark.filterwarnings("ignore:no contact force acted:percute.SimulationWarning")
def test_a_history_that_goes_through_its_plane_is_refused() -> None:
    """It is in balance: a rigid flight."""
    problem = block()
    time = np.linspace(0.0, 13e-6, 60)
    flight = problem.initial_velocity * time[:, None, None]
    with pytest.raises(pc.InputError, match="no contact force acts; the penetration.*nodes go through their plane without contact"):
        pc.estimate(pc.History.from_arrays(problem, time, flight))
    # Until it has gone too deep, as a penalty does before its first force.
    short = time[: 1 + int(np.searchsorted(time, 1.2e-6))]
    with pytest.warns(pc.InputWarning, match="the last instant"):
        estimate = pc.estimate(pc.History.from_arrays(problem, short, flight[: len(short)]))
    assert 0.0 < (estimate.consistency or {})["penetration"] < 0.1


def test_three_components_are_told(block_history: pc.History) -> None:
    padded = np.pad(block_history.displacement, ((0, 0), (0, 0), (0, 1)))
    with pytest.raises(pc.InputError, match=r"three components: give displacement\[\.\.\., :2\]"):
        pc.History.from_arrays(block_history.problem, block_history.time, padded)


def test_the_largest_figures_of_correct_histories_hold() -> None:
    """Some histories of the table of the page; none is refused, and none has larger figures than the page."""
    page = (ROOT / "docs" / "foreign.md").read_text()
    found, count = table(Cases((400.0,), (0.5,), (1.0,)))
    assert count == 18
    for (kind, forces), figures in found.items():
        row = next(line for line in page.splitlines() if line.startswith(f"| `{kind}`, {forces} |"))
        # The last column is that of two figures.
        told = [float(cell.replace("–", "0")) for cell in row.split("|")[2:-1]]
        for name, limit in zip(FIGURES, [*told, told[-1]], strict=True):
            # One digit of the page is rounded.
            assert figures[name] <= 1.5 * limit, (kind, forces, name)
