"""Histories that are sampled more coarsely than the steps of their solver."""

import json
import subprocess
import sys
import warnings
from pathlib import Path

import numpy as np
import percute as pc
import pytest
from studies.sampled import problem, sampled, table
from test_foreign import write


@pytest.fixture(scope="module")
def history() -> pc.History:
    stated, end = problem("block")
    return pc.simulate(stated, end=end, step=end / 50)


# 13 % for the block at 0.3 Δt_c, above the limit of the guard.
@pytest.mark.filterwarnings("ignore:contact gives the auxiliary solution 13")
def test_samples_give_nearly_the_same_estimate() -> None:
    rows = list(table(cases=(("block", 0.3), ("bar", 0.9)), every=(1, 2, 5, 10)))
    for row in rows:
        own = next(other for other in rows if (other.body, other.every) == (row.body, 1))
        # Measured: −10 to +5 % of the mean, but −20 to +50 % where samples lie within
        # a critical step: docs/foreign.md.
        if 1.0 < row.distance < 4.5:
            assert row.mean == pytest.approx(own.mean, rel=0.1), row


def test_the_report_says_what_is_not_seen(history: pc.History) -> None:
    samples = sampled(history, 10)
    with pytest.warns(pc.InputWarning, match="6 samples, 3.103 critical steps apart.*changes within 2.6e-6 s are not seen"):
        estimate = pc.estimate(samples, instants=3)
    document = json.loads(estimate.to_json())
    assert document["samples"]["count"] == 6 and document["derived"] == ["reaction", "touching"]
    assert document["samples"]["distance"] == pytest.approx(2.6e-6)
    # At 400 m/s strains are not small.
    assert [warning["name"] for warning in document["warnings"]] == ["samples", "large_strain"]
    # Maps are at samples, the last at the end.
    assert estimate.maps[-1].time == pytest.approx(history.time[-1]) and len(estimate.maps) == 3
    assert estimate.consistency is not None and (estimate.consistency["balance"] or 0) < 1e-11


@pytest.mark.parametrize("every", [2, 4])
def test_correct_samples_are_not_called_inconsistent(every: int) -> None:
    """Velocities of samples are not those of their displacements."""
    fast, end = problem("block")
    # At 20 m/s strains are small.
    plane = pc.Plane(point=(0.0, -1e-5), normal=(0.0, 1.0), friction=0.2)
    stated = pc.Problem(fast.mesh, material=fast.material, obstacles=[plane], initial_velocity=(20.0, -20.0))
    own = pc.simulate(stated, end=end, courant=0.9)
    steps = {name: getattr(own, name)[::every] for name in ("displacement", "velocity", "acceleration", "reaction")}
    with pytest.warns(pc.InputWarning, match="critical steps apart"):
        estimate = pc.estimate(pc.History.from_arrays(stated, own.time[::every], **steps))
    assert (estimate.consistency or {})["velocity"] > 0.01
    assert estimate.trust == "limited" and "not consistent" not in estimate.verdict
    assert not json.loads(estimate.to_json())["accepted_inconsistent"]


def test_samples_without_motion_are_refused(history: pc.History) -> None:
    arrays = {name: getattr(history, name)[::10] for name in ("displacement", "reaction", "touching")}
    said = (
        "3.1 critical steps apart .limit 1.*are samples.*at most 8.378e-7 s apart .* or give velocities and "
        "accelerations too, at most 5 critical steps"
    )
    with pytest.raises(pc.InputError, match=said):
        pc.estimate(pc.History.from_arrays(history.problem, history.time[::10], **arrays))
    few = {name: array[::2] for name, array in arrays.items()}
    with pytest.raises(pc.InputError, match="6.21 critical steps apart .limit 1.*are samples"):
        pc.estimate(pc.History.from_arrays(history.problem, history.time[::20], **few))
    with pytest.raises(pc.InputError, match="accelerations differ from those of the displacements.*give velocities too"):
        pc.estimate(
            pc.History.from_arrays(history.problem, history.time[::10], acceleration=history.acceleration[::10], **arrays)
        )


def test_spoilt_samples_are_refused(history: pc.History) -> None:
    names = ("displacement", "velocity", "acceleration", "reaction")
    arrays = {name: np.array(getattr(history, name)[::10]) for name in names}
    arrays["reaction"] *= 2
    with pytest.raises(pc.InputError, match="symmetry or thickness"):
        pc.estimate(pc.History.from_arrays(history.problem, history.time[::10], **arrays))


def test_the_command_takes_samples(history: pc.History, tmp_path: Path) -> None:
    samples = sampled(history, 10)
    write(tmp_path / "samples.vtkhdf", samples, ("velocity", "acceleration"))
    words = [sys.executable, "-m", "percute", "estimate", "samples.vtkhdf", "--output", "error.vtkhdf"]
    done = subprocess.run(words, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert "critical steps apart" in done.stderr
    with pytest.warns(pc.InputWarning):
        expected = pc.estimate(samples)
    found = pc.open(tmp_path / "error.vtkhdf")
    assert isinstance(found, pc.Estimate) and found.relative_sup == pytest.approx(expected.relative_sup, rel=1e-9)


@pytest.mark.filterwarnings("ignore::percute.SimulationWarning")
@pytest.mark.parametrize("every", [25, 50])
def test_samples_far_apart_are_told_the_way_out(every: int, history: pc.History) -> None:
    """Two or three samples: their velocities and accelerations are enough, whatever the distance."""
    rows = {name: getattr(history, name)[::every] for name in ("displacement", "velocity", "acceleration")}
    with pytest.warns(pc.InputWarning, match="samples"):
        assert pc.estimate(pc.History.from_arrays(history.problem, history.time[::every], **rows)).trust == "low"
    place, velocity = {"displacement": rows["displacement"]}, {"velocity": rows["velocity"]}
    forces = {name: getattr(history, name)[::every] for name in ("reaction", "touching")}
    for motion, missing in ((place, "velocities and accelerations"), (place | velocity, "accelerations")):
        with pytest.raises(pc.InputError, match=f"are samples, not the steps .* or give {missing} too, at most 5 critical"):
            pc.estimate(pc.History.from_arrays(history.problem, history.time[::every], **motion, **forces))
        # Without forces the last instant is left out; two instants are too few for that.
        said = f"or give {missing} too" if every == 25 else "2 instants: too few"
        with warnings.catch_warnings(), pytest.raises(pc.InputError, match=said):
            warnings.filterwarnings("ignore", "the last instant", pc.InputWarning)
            pc.estimate(pc.History.from_arrays(history.problem, history.time[::every], **motion))
