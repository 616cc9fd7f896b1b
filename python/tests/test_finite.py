"""Bodies of finite kinematics: the page on them, files, resumed runs, and the motion of a rigid body."""

import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import percute as pc
import pytest


def rubber(young: float = 10e6, speed: float = 20.0, friction: float = 0.2, law: str | None = None) -> pc.Problem:
    """The block of the page, on a coarser mesh."""
    material = pc.Elastic(young=young, poisson=0.4, density=1100.0, plane="strain", kinematics="finite", law=law)  # type: ignore[arg-type]
    plane = pc.Plane(point=(0, -0.002), normal=(0.3, 1), friction=friction)
    return pc.Problem(pc.Mesh.rectangle(0.05, 0.04, nx=8, ny=6), material=material, obstacles=[plane], initial_velocity=(3, -speed))


class Stopped(Exception):
    """A run that was stopped."""


def test_the_case_of_the_page_runs(tmp_path: Path) -> None:
    page = (Path(__file__).parents[2] / "docs" / "finite.md").read_text(encoding="utf-8")
    [case] = re.findall(r"```toml\n(.*?)```", page, re.DOTALL)
    (tmp_path / "rubber.toml").write_text(case)

    def percute(*arguments: str) -> str:
        done = subprocess.run([sys.executable, "-m", "percute", *arguments], cwd=tmp_path, capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
        return done.stdout

    assert "steps or more" in percute("info", "rubber.toml")
    percute("simulate", "rubber.toml", "--quiet")
    history = pc.open(tmp_path / "rubber.vtkhdf")
    assert isinstance(history, pc.History)
    mesh = pc.Mesh.rectangle(0.05, 0.04, nx=20, ny=16)
    same = pc.simulate(pc.Problem(mesh, material=rubber().material, obstacles=rubber().obstacles, initial_velocity=(3, -20)), end=2e-3, courant=0.9)
    assert np.array_equal(history.displacement, same.displacement)


def test_a_history_is_that_of_its_file(tmp_path: Path) -> None:
    history = pc.simulate(rubber(), end=2e-3, courant=0.9)
    stored = pc.simulate(rubber(), end=2e-3, courant=0.9, store=tmp_path / "a.vtkhdf")
    again = pc.open(tmp_path / "a.vtkhdf")
    assert isinstance(again, pc.History)
    assert again.problem.material == rubber().material == pc.Elastic(young=10e6, poisson=0.4, density=1100.0, plane="strain", kinematics="finite", law="neo_hookean")
    for other in (stored, again):
        assert np.array_equal(history.time, other.time)
        assert np.array_equal(history.displacement, other.displacement)
    steps = np.diff(history.time)
    # The neo-Hookean law hardens where it is compressed: the steps fall by a fifth.
    assert steps[-1] < 0.85 * steps[0]
    assert np.all(np.diff(steps) <= 1e-9 * steps[0])
    # The scheme keeps what a shock would dissipate; measured: 0.1 %.
    assert abs(history.balance.energy_drift[-1]) < 0.01
    estimate = pc.estimate(history)
    assert estimate.sup == pc.estimate(again).sup
    # Balanced exactly in the present places, at strains of a third.
    assert max(estimate.residuals.values()) < 1e-11
    assert 0.2 < estimate.relative_sup < 1.0
    assert "large_strain" not in estimate.to_json() and estimate.trust != "low"


@pytest.mark.parametrize("law", ["neo_hookean", "svk", "hencky"])
def test_a_stiff_body_moves_like_a_rigid_one(law: str) -> None:
    """Without friction, momentum changes along the normal alone; between contacts the spin is constant, and energy is kept."""
    problem = rubber(young=1e9, speed=10.0, friction=0.0, law=law)
    history = pc.simulate(problem, end=1.5e-3, courant=0.9)
    mass = problem.mass
    normal = np.array([0.3, 1.0]) / np.hypot(0.3, 1.0)
    velocity = np.array([history.velocity[n] for n in (0, -1)])
    momentum = np.einsum("n,tnc->tc", mass, velocity)
    along = momentum @ np.array([normal[1], -normal[0]])
    assert along[1] == pytest.approx(along[0], rel=1e-10)
    assert (momentum @ normal)[1] > 0.5 * (momentum @ normal)[0]
    place = problem.mesh.points + history.displacement[-1]
    arm = place - mass @ place / mass.sum()
    mean = momentum[1] / mass.sum()
    spin = np.sum(mass * (arm[:, 0] * velocity[1, :, 1] - arm[:, 1] * velocity[1, :, 0])) / np.sum(mass * np.sum(arm**2, axis=1))
    rigid = mean + spin * np.stack([-arm[:, 1], arm[:, 0]], axis=1)
    # Vibration that the contact leaves behind has some per cent of the energy.
    assert mass @ np.sum((velocity[1] - rigid) ** 2, axis=1) < 0.1 * (mass @ np.sum(velocity[1] ** 2, axis=1))
    assert abs(spin) > 5.0
    # The rigid body has turned, and is no larger: the small-strain theory would make it grow by half the square of the angle.
    sides = np.linalg.norm(place[problem.mesh.cells[:, 0]] - place[problem.mesh.cells[:, 1]], axis=1)
    before = np.linalg.norm(problem.mesh.points[problem.mesh.cells[:, 0]] - problem.mesh.points[problem.mesh.cells[:, 1]], axis=1)
    assert np.max(np.abs(sides / before - 1.0)) < 0.01


def test_an_element_that_is_turned_inside_out_keeps_the_steps_before(tmp_path: Path) -> None:
    with pytest.raises(pc.SimulationError, match="is turned inside out") as caught:
        pc.simulate(rubber(speed=60.0, law="svk"), end=2e-3, courant=0.9, store=tmp_path / "a.vtkhdf")
    history = pc.open(tmp_path / "a.vtkhdf")
    assert isinstance(history, pc.History)
    assert f"at step {len(history)}," in str(caught.value)


def test_a_stopped_run_is_resumed(tmp_path: Path) -> None:
    whole = pc.simulate(rubber(), end=2e-3, courant=0.9)

    def watch(progress: pc.Progress) -> None:
        if progress.stage == "simulating" and progress.done >= 60:
            raise Stopped

    with pytest.raises(Stopped):
        pc.simulate(rubber(), end=2e-3, courant=0.9, store=tmp_path / "a.vtkhdf", progress=watch)
    resumed = pc.resume(tmp_path / "a.vtkhdf")
    assert np.array_equal(whole.displacement, resumed.displacement)
    assert np.array_equal(whole.time, resumed.time)


def test_a_tumbling_body_ends_with_its_rebound() -> None:
    history = pc.simulate(rubber(speed=8.0), end="rebound", longest=0.1, courant=0.9)
    assert 1e-3 < history.time[-1] < 0.05
    assert np.max(np.abs(history.reaction[-1])) == 0.0 < np.max(np.abs(history.reaction))


def rubber_block(n: int = 2, *, speed: float = 10.0, law: str = "neo_hookean") -> pc.Problem:
    """Make a rubber block that lands on a corner."""
    rubber = pc.Elastic(young=10e6, poisson=0.4, density=1100.0, plane="strain", kinematics="finite", law=law)
    mesh = pc.Mesh.rectangle(0.05, 0.04, nx=5 * n, ny=4 * n).rotated(20)
    return pc.Problem(mesh, material=rubber, obstacles=[pc.Plane(gap=1e-4, normal=(0, 1), friction=0.3)], initial_velocity=(3.0, -speed))


def test_the_estimate_falls_with_refinement() -> None:
    """Refined runs find their own steps, and the verdict's range holds against the finest."""
    verification = pc.verify(rubber_block(), end=1e-3, courant=0.9, levels=2, progress=None)
    low, high = verification.expected
    assert low < verification.effectivity_sup[0] < high
    assert verification.error_sup[1] < 0.9 * verification.error_sup[0]


@pytest.mark.parametrize("law", ["neo_hookean", "svk", "hencky"])
def test_a_history_of_another_program_has_the_same_estimate(law: str) -> None:
    """Displacements alone give the contact forces, from the internal forces of the law, and with them the estimate."""
    problem = rubber_block(speed=5.0, law=law)
    own = pc.simulate(problem, end=1e-3, courant=0.9, progress=None)
    with pytest.warns(pc.InputWarning):
        other = pc.History.from_arrays(problem, own.time, own.displacement)
    # The last contact forces cannot be derived.
    count = len(other)
    assert len(own) - 1 <= count <= len(own)
    assert np.abs(other.reaction[: count - 1] - own.reaction[: count - 1]).max() < 1e-6 * np.abs(own.reaction).max()
    estimates = [pc.estimate(history, every=1, progress=None) for history in (own, other)]
    assert estimates[1].mean == pytest.approx(estimates[0].mean, rel=1e-2)


def test_another_law_is_not_in_balance() -> None:
    """Displacements of another law leave forces inside the body, and this is told."""
    own = pc.simulate(rubber_block(speed=15.0), end=1e-3, courant=0.9, progress=None)
    with pytest.raises(pc.InputError, match="not consistent"), pytest.warns(pc.InputWarning):
        pc.estimate(pc.History.from_arrays(rubber_block(speed=15.0, law="hencky"), own.time, own.displacement), progress=None)
