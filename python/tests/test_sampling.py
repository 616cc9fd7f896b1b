"""At which steps the error is sampled."""

from pathlib import Path

import percute as pc
import pytest
from studies.block import ALUMINIUM


@pytest.fixture(scope="module")
def history() -> pc.History:
    """Give the impact of a block of 4000 elements, of which every second step is a sample."""
    problem = pc.Problem(
        pc.Mesh.rectangle(0.05, 0.04, nx=50, ny=40),
        material=pc.Elastic(**ALUMINIUM, plane="stress"),
        initial_velocity=(400.0, -400.0),
        obstacles=[pc.Plane(point=(0.0, -2e-4), normal=(0.0, 1.0), friction=0.2)],
    )
    return pc.simulate(problem, end=18e-6, courant=0.9)


def test_the_default_takes_fewer_steps_for_the_same_error(history: pc.History) -> None:
    sparse, dense = pc.estimate(history), pc.estimate(history, every=1)
    assert sparse.options["every"] == "auto" and dense.options["every"] == 1
    assert len(sparse.over_time.time) < 0.4 * len(dense.over_time.time)
    # The promise of docs/speed.md.
    assert sparse.sup == pytest.approx(dense.sup, rel=0.01)
    assert sparse.mean == pytest.approx(dense.mean, rel=0.01)
    again = pc.estimate(history, every="auto")
    assert (again.sup, again.mean) == (sparse.sup, sparse.mean)


def test_instants_of_maps_are_sampled(history: pc.History) -> None:
    times = [history.time[k] for k in (31, 44, 57)]
    maps = pc.estimate(history, instants=times).maps
    assert [each.time for each in maps] == times


def test_it_is_stored_and_read(history: pc.History, tmp_path: Path) -> None:
    text = (Path(__file__).parents[2] / "examples" / "block.toml").read_text().replace("every = 1 ", 'every = "auto" ')
    estimate = pc.run(text + f'\n[output]\nestimate = "{tmp_path / "error.vtkhdf"}"\n', store=tmp_path / "history.vtkhdf")
    stored, again = pc.open(tmp_path / "error.vtkhdf"), pc.open(tmp_path / "history.vtkhdf")
    assert isinstance(stored, pc.Estimate) and isinstance(again, pc.History)
    assert estimate.options["every"] == stored.options["every"] == pc.estimate(again).options["every"] == "auto"
    # All steps of so small a mesh are samples.
    assert pc.estimate(again, every=1).sup == estimate.sup


def test_another_name_is_refused(history: pc.History) -> None:
    with pytest.raises(pc.InputError, match=r'`every` is .*often.*; it must be "auto" or a whole number'):
        pc.estimate(history, every="often")  # type: ignore[arg-type]
