"""Steps of different lengths: unstable below the critical step, by parametric resonance."""

from pathlib import Path

import numpy as np
import pytest

import percute as pc


def bar() -> pc.Problem:
    """Give a bar whose nodes all move at random: vibrations of all frequencies."""
    mesh = pc.Mesh.bar(0.1, elements=40)
    velocity = np.random.default_rng(1).normal(size=(41, 1))
    return pc.Problem(mesh, material=pc.Elastic(young=70e9, density=2700.0, section=0.02), initial_velocity=velocity)


def alternating(problem: pc.Problem, count: int) -> np.ndarray:
    """Give steps of 0.8 and 0.9 of the critical one in turn."""
    return problem.critical_time_step * np.where(np.arange(count) % 2, 0.9, 0.8)


@pytest.mark.filterwarnings("ignore::percute.SimulationWarning")
def test_unstable_steps_are_refused_with_a_way_out() -> None:
    problem = bar()
    with pytest.raises(pc.InputError, match=r"`steps` change so that they amplify .* would be unstable, .*; take equal steps"):
        pc.simulate(problem, steps=alternating(problem, 400))
    with pytest.raises(pc.InputError, match="take equal steps"):
        pc.true_errors([], problem, steps=alternating(problem, 400))
    # Equal steps, and steps that change slowly, are not.
    critical = problem.critical_time_step
    pc.simulate(problem, steps=np.full(400, 0.85 * critical))
    pc.simulate(problem, steps=critical * (0.7 + 0.2 * np.sin(0.05 * np.arange(400))))


def test_each_result_has_the_warnings_of_the_command(tmp_path: Path) -> None:
    problem = bar()
    steps = alternating(problem, 50)
    with pytest.warns() as told:
        history = pc.simulate(problem, steps=steps, store=tmp_path / "a.vtkhdf")
    kinds = {warning.category: str(warning.message) for warning in told}
    assert "amplify vibrations" in kinds[pc.InputWarning]
    assert "the energy balance is off by" in kinds[pc.SimulationWarning] and "take equal time steps" in kinds[pc.SimulationWarning]
    coarse = pc.simulate(problem, end=float(steps.sum()), courant=0.1)
    with pytest.warns() as of_reference:
        pc.true_errors([coarse], problem, steps=steps)
    assert {warning.category: str(warning.message) for warning in of_reference} == kinds
    balance = history.balance
    assert balance.energy_drift[-1] > 0.1
    with pytest.warns() as told:
        estimate = pc.estimate(pc.open(tmp_path / "a.vtkhdf"))
    assert {warning.category for warning in told} == {pc.InputWarning, pc.SimulationWarning}
    assert {str(warning.message) for warning in told} == set(estimate.warnings)
    for warning in estimate.warnings:
        assert f"warning: {warning}" in str(estimate)
    estimate.save(tmp_path / "e.vtkhdf")
    assert pc.open(tmp_path / "e.vtkhdf").warnings == estimate.warnings


@pytest.mark.filterwarnings("ignore::percute.SimulationWarning")
def test_a_run_whose_file_is_lost_has_its_estimate(tmp_path: Path) -> None:
    (tmp_path / "before").mkdir()
    case = "\n".join(
        [
            "[mesh]",
            "bar = { length = 0.1, elements = 200 }",
            "[material]",
            "young = 70e9",
            "density = 2700.0",
            "section = 0.02",
            "[initial]",
            "velocity = -400.0",
            "[[obstacle]]",
            "point = -2e-4",
            "normal = 1.0",
            "[time]",
            "end = 2e-3",
            "courant = 0.9",
        ]
    )
    expected = pc.run(case)

    def move(progress: pc.Progress) -> None:
        if (tmp_path / "before").exists():
            (tmp_path / "before").rename(tmp_path / "after")

    with pytest.raises(pc.StorageError, match=r"was moved, .* during the run; all steps done are in it, as .*after/a\.vtkhdf") as raised:
        pc.run(case, store=tmp_path / "before" / "a.vtkhdf", progress=move)
    assert raised.value.estimate.sup == expected.sup
    assert raised.value.history.path == tmp_path / "after" / "a.vtkhdf"
    assert pc.estimate(raised.value.history).sup == expected.sup
