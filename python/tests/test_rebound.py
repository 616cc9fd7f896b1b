"""The rebound of a body against exact solutions."""

import json
import subprocess
import sys
import warnings
from pathlib import Path

import numpy as np
import percute as pc
import pytest

BAR = {"length": 0.1, "young": 70e9, "density": 2700.0, "section": 0.02, "speed": 400.0, "gap": 2e-4}


def strikes(elements: int) -> pc.Rebound:
    """Run the bar until it is away from its plane again."""
    mesh = pc.Mesh.bar(BAR["length"], elements=elements)
    material = pc.Elastic(young=BAR["young"], density=BAR["density"], section=BAR["section"])
    plane = pc.Plane(point=-BAR["gap"], normal=1.0)
    problem = pc.Problem(mesh, material=material, obstacles=[plane], initial_velocity=-BAR["speed"])
    rebound = pc.simulate(problem, end=50e-6, courant=0.9).rebound
    assert rebound is not None and rebound.ended
    return rebound


def test_a_bar_rebounds_like_the_exact_one() -> None:
    """Restitution 1 and contact for 2L/c: errors fall with the order of the front, 2/3 (docs/verification.md, bar_impact)."""
    exact = pc.exact.BarImpact(**BAR)
    duration = exact.release_time - exact.impact_time
    assert duration == pytest.approx(2.0 * BAR["length"] / exact.wave_speed, rel=1e-12)
    found = [strikes(elements) for elements in (25, 100, 400)]
    restitution = np.array([1.0 - each.restitution for each in found if each.restitution is not None])
    durations = np.array([abs(each.time_in_contact / duration - 1.0) for each in found])
    for errors, least in ((restitution, 0.5), (durations, 0.5)):
        # Two halvings of the size; steps make the instants of touch and release coarse.
        assert np.log2(errors[0] / errors[-1]) / 4.0 > least, errors
    assert abs(restitution[-1]) < 0.01 and durations[-1] < 0.005
    assert found[-1].velocity_before.tolist() == [pytest.approx(-400.0, rel=1e-12)]
    assert found[-1].release is not None and found[-1].first_touch == pytest.approx(exact.impact_time, abs=2e-7)


def test_momentum_and_impulse_give_the_rebound() -> None:
    """A block with friction: V′ − V is the impulse of contact over the mass, in both components."""
    mesh = pc.Mesh.rectangle(0.05, 0.04, nx=5, ny=4)
    material = pc.Elastic(young=70e9, poisson=0.3, density=2700.0, plane="stress")
    plane = pc.Plane(point=(0, -2e-4), normal=(0, 1), friction=0.2)
    problem = pc.Problem(mesh, material=material, obstacles=[plane], initial_velocity=(400, -400))
    history = pc.simulate(problem, end=40e-6, courant=0.9)
    rebound = history.rebound
    assert rebound is not None and rebound.velocity_after is not None and rebound.restitution is not None
    given = history.contact.resultants.impulse[-1] / problem.mass.sum()
    assert rebound.velocity_after - rebound.velocity_before == pytest.approx(given, rel=1e-9)
    assert rebound.restitution == pytest.approx(-rebound.velocity_after[1] / rebound.velocity_before[1], rel=1e-12)
    assert 0.5 < rebound.restitution < 1.0
    touches = history.time[history.touching.any(axis=1)]
    assert (rebound.first_touch, rebound.release) == (touches[0], touches[-1])
    assert rebound.time_in_contact == touches[-1] - touches[0]


def test_normal_components_are_those_of_the_plane_with_the_largest_impulse() -> None:
    """A box strikes a wall three times as fast as the floor, stated before or behind it."""
    mesh = pc.Mesh.rectangle(0.05, 0.04, nx=5, ny=4)
    material = pc.Elastic(young=70e9, poisson=0.3, density=2700.0, plane="stress")
    planes = [pc.Plane(point=(0, -1e-5), normal=(0, 1), friction=0.0), pc.Plane(point=(-3e-5, 0), normal=(1, 0), friction=0.0)]
    for obstacles in (planes, planes[::-1]):
        rebound = pc.simulate(pc.Problem(mesh, material=material, obstacles=obstacles, initial_velocity=(-30, -10)), end=10e-6, courant=0.9).rebound
        assert rebound is not None and rebound.normal_before == pytest.approx(-30.0, rel=1e-12)


@pytest.mark.filterwarnings("ignore::percute.InputWarning")
def test_contact_that_lasts_and_a_body_that_never_touches() -> None:
    mesh = pc.Mesh.bar(0.1, elements=10)
    material = pc.Elastic(young=70e9, density=2700.0, section=0.02)
    for gap, touches in ((1e-3, True), (1.0, False)):
        problem = pc.Problem(mesh, material=material, obstacles=[pc.Plane(point=-gap, normal=1.0)], initial_velocity=-400.0)
        history = pc.simulate(problem, end=10e-6, courant=0.9)
        rebound = history.rebound
        assert (rebound is not None) == touches
        if rebound is not None:
            assert not rebound.ended and rebound.restitution is None and rebound.release is None and rebound.velocity_after is None
            assert rebound.time_in_contact == pytest.approx(history.time[-1] - rebound.first_touch)
        document = json.loads(pc.estimate(history).to_json())
        assert (document["rebound"] is None) != touches
        assert document["verdict"]["touches"] == ("edge" if touches else "none")


def summary(history: pc.History) -> str:
    """What the command prints about a history in a file."""
    assert history.path is not None
    return subprocess.run([sys.executable, "-m", "percute", "estimate", history.path], capture_output=True, text=True, check=True).stdout


def test_a_body_that_still_arrives_has_no_restitution(tmp_path: Path) -> None:
    """A block strikes with a corner and turns: its centre still moves to the plane when the corner leaves, and it touches again."""
    mesh = pc.Mesh.rectangle(0.05, 0.02, nx=10, ny=4)
    material = pc.Elastic(young=70e9, poisson=0.3, density=2700.0, plane="stress")
    normal = np.array([np.sin(np.radians(20.0)), np.cos(np.radians(20.0))])
    plane = pc.Plane(point=-1e-4 * normal, normal=normal, friction=0.0)
    problem = pc.Problem(mesh, material=material, obstacles=[plane], initial_velocity=-50.0 * normal)
    history = pc.simulate(problem, end=60e-6, courant=0.9, store=tmp_path / "turns.vtkhdf")
    rebound = history.rebound
    assert rebound is not None and rebound.ended and rebound.release is not None and rebound.normal_after is not None
    assert rebound.normal_after < 0.0 and rebound.restitution is None
    assert rebound.no_restitution is not None and "still moves towards the plane" in rebound.no_restitution
    longer = pc.simulate(problem, end=400e-6, courant=0.9)
    again = (longer.contact.resultants.normal_force > 0.0) & (longer.time > rebound.release)
    assert again.any(), "the reason says that it touches again"
    assert "motion    from -50 to" in summary(history)
    assert np.isnan(pc.verify(problem, end=60e-6, courant=0.9, levels=1).rebound[0])


def test_a_body_with_supports_does_not_rebound(tmp_path: Path) -> None:
    """Supports take a part of its momentum; the free bar has a coefficient of restitution and no reason."""
    mesh = pc.Mesh.bar(0.1, elements=20)
    material = pc.Elastic(young=70e9, density=2700.0, section=0.02)
    plane = pc.Plane(point=-1e-3, normal=1.0)
    reasons = []
    for supports in ([], [pc.Support(group="end", components="x", velocity=[-400.0, -400.0], time=[0.0, 1.0])]):
        problem = pc.Problem(mesh, material=material, obstacles=[plane], supports=supports, initial_velocity=-400.0)
        history = pc.simulate(problem, end=80e-6, courant=0.9, store=tmp_path / f"{len(supports)}.vtkhdf")
        rebound, told = history.rebound, summary(history)
        assert rebound is not None and (rebound.restitution is None) == bool(supports)
        assert ("\nmotion    " in told) == bool(supports) == ("\nrebound   " not in told)
        # A bar has no edges.
        assert "An end of the bar touches" in " ".join(told.split()) and "edge" not in told
        reasons.append(rebound.no_restitution)
    assert reasons == [None, "supports change the velocity, too"]


RUBBER = """
[mesh]
bar = {{ length = 0.1, elements = 20 }}
[material]
young = 70e9
density = 2700.0
section = 0.02
[initial]
velocity = -400.0
[[obstacle]]
point = -0.002
normal = 1.0
[time]
{time}
courant = 0.9
"""


def hits() -> pc.Problem:
    material = pc.Elastic(young=70e9, density=2700.0, section=0.02)
    mesh = pc.Mesh.bar(0.1, elements=20)
    return pc.Problem(mesh, material=material, obstacles=[pc.Plane(point=-0.002, normal=1.0)], initial_velocity=-400.0)


def test_a_run_that_ends_with_the_rebound_is_one_with_that_end() -> None:
    after = 10e-6
    history = pc.simulate(hits(), end="rebound", longest=1e-3, after=after, courant=0.9)
    end = float(history.time[-1])
    rebound = history.rebound
    assert rebound is not None and rebound.release is not None and rebound.normal_after is not None and rebound.normal_after > 0.0
    # The end is that of the first pass, whose steps differ, rounded up to four digits.
    step = float(np.diff(history.time).max())
    assert rebound.release + after - 2 * step <= end <= rebound.release + after + 3 * step + 1e-3 * end
    assert end == float(f"{end:.3e}")
    same = pc.simulate(hits(), end=end, courant=0.9)
    assert same.time.tolist() == history.time.tolist() and np.array_equal(same.displacement, history.displacement)
    case = pc.run(RUBBER.format(time=f'end = "rebound"\nlongest = 1e-3\nafter = {after}'))
    assert case.history is not None and np.array_equal(case.history.displacement, history.displacement)


def test_contact_that_does_not_end_in_time_is_warned_about() -> None:
    with pytest.warns(pc.InputWarning, match="not left its plane by 3e-5 s"):
        history = pc.simulate(hits(), end="rebound", longest=3e-5, courant=0.9)
    assert history.time[-1] == 3e-5 and history.complete
    with pytest.warns(pc.InputWarning, match="not left its plane by 3e-5 s"):
        estimate = pc.run(RUBBER.format(time='end = "rebound"\nlongest = 3e-5'))
    assert [each for each in estimate.warnings if "not left its plane by 3e-5 s" in each]
    assert "not left its plane" in " ".join(str(estimate).split())
    assert "no_rebound" in [each["name"] for each in json.loads(estimate.to_json())["warnings"]]


def test_a_rebound_needs_a_plane_that_is_struck() -> None:
    problem = hits()
    free = pc.Problem(problem.mesh, material=problem.material, initial_velocity=1.0)
    with pytest.raises(pc.InputError, match="needs a plane"):
        pc.simulate(free, end="rebound", longest=1e-4, courant=0.9)
    away = pc.Problem(problem.mesh, material=problem.material, obstacles=problem.obstacles, initial_velocity=-problem.initial_velocity)
    with pytest.warns(pc.InputWarning) as told:
        pc.simulate(away, end="rebound", longest=3e-5, courant=0.9)
    assert any("has not touched a plane by 3e-5 s" in str(each.message) for each in told)


def test_a_corner_that_would_hit_next_is_named_with_its_instant() -> None:
    """A tilted block lands on a corner, rises and turns on to the next one: a longer run has that touch at the instant that is told."""
    mesh = pc.Mesh.rectangle(0.05, 0.03, nx=6, ny=4).rotated(26.0)
    plane = pc.Plane(point=(0.0, float(mesh.points[:, 1].min()) - 1e-5), normal=(0.0, 1.0), friction=0.0)
    material = pc.Elastic(young=2e9, poisson=0.3, density=1200.0, plane="stress")
    problem = pc.Problem(mesh, material=material, obstacles=[plane], initial_velocity=(0.0, -2.0))
    history = pc.simulate(problem, end=4e-4, courant=0.9)
    with pytest.warns(pc.InputWarning, match="would reach plane_0 at"):
        estimate = pc.estimate(history, every=20)
    rebound = estimate.rebound
    assert rebound is not None and rebound.touches_again is not None and rebound.restitution is not None
    spin, again = rebound.angular_velocity_after, rebound.touches_again
    # The impulse acts left of the centre of mass, and turns the block clockwise, towards its right corner.
    assert spin is not None and spin < -10.0 and again.node == 6
    assert history.rebound is not None and history.rebound.touches_again is None
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", pc.InputWarning)
        longer = pc.simulate(problem, end=1.2 * again.time, courant=0.9)
    touched = longer.time[longer.touching.any(axis=1)]
    later = touched[touched > rebound.first_touch + rebound.span + 1e-4]
    # In small strains nodes move along straight lines, not along arcs: after 0.9 rad the corner is a third farther away.
    assert later.size == 0 or later[0] == pytest.approx(again.time, rel=0.5)
    assert "touches_again" in [each["name"] for each in json.loads(estimate.to_json())["warnings"]]


def test_peak_force_does_not_depend_on_the_step() -> None:
    """The raw force of a bar grows like one over the step; its average over the time in which a wave crosses the element is ρcvS."""
    exact = pc.exact.BarImpact(**BAR)
    plateau = BAR["density"] * exact.wave_speed * BAR["speed"] * BAR["section"]
    mesh = pc.Mesh.bar(BAR["length"], elements=30)
    material = pc.Elastic(young=BAR["young"], density=BAR["density"], section=BAR["section"])
    problem = pc.Problem(mesh, material=material, obstacles=[pc.Plane(point=-BAR["gap"], normal=1.0)], initial_velocity=-BAR["speed"])
    for courant in (0.9, 0.3, 0.1, 0.03):
        history = pc.simulate(problem, end=2e-5, courant=courant)
        peak = pc.estimate(history, every=10).contact_peak
        assert peak is not None
        raw = float(history.contact.resultants.normal_force.max())
        # Above 1 by the oscillation of the lumped mass behind the front, 1.24 at most.
        assert 1.0 - 1e-3 < peak.force / plateau < 1.25, (courant, peak)
        assert peak.pressure == pytest.approx(peak.force / BAR["section"], rel=1e-12)
        if courant < 0.2:
            assert raw > 3.0 * plateau
