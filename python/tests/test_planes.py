"""Causes of inconsistent histories: place and normal of a plane, friction, and forces, gaps and status of rounding size."""

import re
import warnings

import numpy as np
import percute as pc
import pytest
from conftest import block
from spoiling import cause, given, parts, times, without


@pytest.mark.parametrize("lacks", [(), ("reaction", "touching")])
@pytest.mark.parametrize("turn", [-1e-3, -2e-2])
def test_a_turned_normal_is_named(turn: float, lacks: tuple[str, ...]) -> None:
    history = pc.simulate(block(), end=20e-6, courant=0.8)
    # Turned so that the plane does not cut through the block.
    said = cause(history.problem, without({**parts(history), "turn": turn}, *lacks))
    found = re.search(r"the `normal` of the plane is off by (\S+) rad.* it should be (\S+), (\S+), ", said)
    assert found, said
    assert float(found[1]) == pytest.approx(abs(turn), rel=1e-3) and found[2] == "(0" and found[3] == "1)", said


def test_forces_above_the_plane_are_named(correct: pc.History) -> None:
    """Noise of 1e-7 m at the nodes that touch."""
    whole = parts(correct)
    noise = 1e-7 * np.random.default_rng(1).standard_normal(correct.displacement.shape)
    noise[0] = 0.0
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", pc.InputWarning)
        history = given(correct.problem, without({**whole, "displacement": whole["displacement"] + noise}, "touching"))
    with pytest.raises(pc.InputError) as refused:
        pc.estimate(history)
    said = str(refused.value)
    assert "leave `touching` out" not in said, said
    assert re.search("contact forces act at [0-9]+ nodes and instants where the node is more than 1e-5 of an element above", said), said


def test_forces_of_rounding_size_do_not_touch() -> None:
    history = pc.simulate(block(), end=13e-6, courant=0.9)
    whole = parts(history)
    faint = 1e-8 * np.abs(whole["reaction"]).max()
    noise = faint * np.random.default_rng(1).standard_normal(whole["reaction"].shape)
    estimate = pc.estimate(given(history.problem, {**whole, "reaction": whole["reaction"] + noise}))
    assert estimate.consistency is not None and estimate.consistency["touching"] == 0.0


def test_friction_that_is_too_large_is_named(correct: pc.History) -> None:
    if correct.problem.mesh.dimension == 1:
        pytest.skip("a bar has no friction")
    for factor in (1.2, 3.0):
        for lacks in ((), ("reaction", "touching")):
            said = cause(correct.problem, without(times("friction", factor)(parts(correct)), *lacks))
            assert f"is 0.2 on average, not {0.2 * factor:.3g}" in said, said
    said = cause(correct.problem, times("friction", 0.5)(parts(correct)))
    assert "is 0.2 on average, not 0.1" in said, said
    # The shares of sliding nodes: μ is too large by a fifth of what is right, a sixth of what is stated.
    forced = pc.estimate(given(correct.problem, times("friction", 1.2)(parts(correct))), force=True)
    assert forced.consistency is not None and forced.consistency["slip"] == pytest.approx(1 / 6, rel=1e-6)


@pytest.mark.parametrize("lacks", [(), ("touching",), ("reaction", "touching")])
@pytest.mark.parametrize("offset", [2e-4, 1e-6, -2e-4, -1e-6])
def test_a_plane_at_another_place_is_named(offset: float, lacks: tuple[str, ...], correct: pc.History) -> None:
    whole = parts(correct)
    # The plane of the problem is below that of the history, or cuts off the end of its flight.
    offset = min(offset, 1.9e-4)
    said = cause(correct.problem, without({**whole, "plane": offset}, *lacks))
    found = re.search(r"the `point` of the plane is off by (\S+) m: .* m (below|above) it on average; move it by (\S+) m", said)
    assert found, said
    assert float(found[1]) == abs(offset) and float(found[3]) == -offset and (found[2] == "below") == (offset > 0), said


@pytest.mark.parametrize("lacks", [("touching",), ("reaction", "touching")])
def test_a_gap_of_rounding_size_is_contact(lacks: tuple[str, ...], correct: pc.History) -> None:
    ours = pc.estimate(correct)
    for offset in (1e-12, -1e-12, -1e-9):
        with warnings.catch_warnings():
            warnings.filterwarnings("ignore", "the last instant", pc.InputWarning)
            history = given(correct.problem, without({**parts(correct), "plane": offset}, *lacks))
        assert np.array_equal(history.touching, correct.touching[: len(history)])
        if len(history) == len(correct):
            assert pc.estimate(history).sup == pytest.approx(ours.sup, rel=1e-4)


def test_noise_is_no_contact(correct: pc.History) -> None:
    noise = 1e-13 * np.random.default_rng(1).standard_normal(correct.displacement.shape)
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", "the last instant", pc.InputWarning)
        theirs = pc.History.from_arrays(correct.problem, correct.time, correct.displacement + noise * (correct.time > 0)[:, None, None])
    assert np.array_equal(theirs.touching, correct.touching[: len(theirs)])


def test_noise_is_no_sliding(correct: pc.History) -> None:
    """A history with noise of 1e-10 m is not refused for its friction."""
    noise = 1e-10 * np.random.default_rng(1).standard_normal(correct.displacement.shape)
    noisy = {**parts(correct), "displacement": correct.displacement + noise * (correct.time > 0)[:, None, None]}
    estimate = pc.estimate(given(correct.problem, without(noisy, "touching")), force=True)
    assert ((estimate.consistency or {})["slip"] or 0.0) < 1e-2
