"""The verdict on an estimate: situation, trust and recommendation."""

import json
import math
import re
import warnings
from dataclasses import replace
from typing import Any

import numpy as np
import percute as pc
import pytest
from studies import ends
from studies.bodies import BODIES
from studies.durations import Impact

pytestmark = pytest.mark.filterwarnings("ignore::percute.InputWarning")
ALUMINIUM = {"young": 70e9, "poisson": 0.3, "density": 2700.0}


def struck(mesh: pc.Mesh, *, tilt: float = 0.0, speed: float = 5.0, **changes: Any) -> pc.Estimate:
    """Estimate the impact of a body on a plane that is turned under it by some degrees."""
    angle = math.radians(tilt)
    normal = np.array([math.sin(angle), math.cos(angle)])
    lowest = float((mesh.points @ normal).min()) - 5e-7 * speed
    plane = pc.Plane(point=normal * lowest, normal=normal, friction=changes.pop("friction", 0.2))
    times = {"end": changes.pop("end", 12e-6), "courant": changes.pop("courant", 0.9)}
    material = pc.Elastic(**ALUMINIUM, plane="stress")
    problem = pc.Problem(mesh, material=material, obstacles=[plane], initial_velocity=-speed * normal, **changes)
    return pc.estimate(pc.simulate(problem, **times))


def facts(estimate: pc.Estimate) -> dict[str, Any]:
    found: dict[str, Any] = json.loads(estimate.to_json())["verdict"]
    return found


def warnings_of(estimate: pc.Estimate) -> list[str]:
    """The names of its warnings."""
    return [warning["name"] for warning in json.loads(estimate.to_json())["warnings"]]


@pytest.mark.parametrize(
    ("body", "tilt", "touches"),
    [
        ("block", 0.0, "edge"),
        ("unstructured block", 0.0, "edge"),
        ("block", 10.0, "corner"),
        ("disc", 0.0, "curve"),
        ("crowned block", 0.0, "curve"),
        ("rounded block", 10.0, "curve"),
        ("trapezoid 63°", 0.0, "end"),
    ],
)
def test_how_a_body_touches(body: str, tilt: float, touches: str) -> None:
    estimate = struck(BODIES[body]().refine(), tilt=tilt)
    found = facts(estimate)
    assert found["touches"] == touches and found["phases"] == 1 and found["outside_tested_range"] == []
    assert estimate.trust == "high" and estimate.verdict is not None and estimate.verdict.count(". ") == 2
    assert found["speed_ratio"] == pytest.approx(5.0 / math.sqrt(70e9 / (2700.0 * (1 - 0.09))), rel=1e-6)
    assert sum(found["shares"].values()) == pytest.approx(1.0)


def test_the_second_sentence_has_the_share_of_the_elements_that_touch() -> None:
    """They have two nodes or one on the plane: in the block, all that touch its lower edge."""
    estimate = struck(BODIES["block"]().refine())
    lowest = estimate.mesh.points[:, 1] == 0.0
    squares = estimate.by_element**2
    shares = {100.0 * squares[lowest[estimate.mesh.cells].sum(axis=1) >= least].sum() / squares.sum() for least in (1, 2)}
    told = re.search(r"(\d+) % of the squared mean error lies in elements at the contact", str(estimate.verdict))
    assert told is not None and int(told[1]) in {round(share) for share in shares}


def test_a_disc_that_stands_on_one_of_its_edges_is_a_curve() -> None:
    """The lowest edge of the polygon is parallel to the plane; the next ones turn by 15° and follow."""
    assert facts(struck(BODIES["disc"]().refine(), tilt=7.5, speed=400.0))["touches"] == "curve"


def test_a_corner_of_one_element_and_a_thin_body() -> None:
    corner = struck(BODIES["trapezoid 45° with a corner of one element"]().refine())
    assert corner.trust == "limited" and facts(corner)["effectivity"] == [0.95, 2.0] and "two elements" in str(corner.verdict)
    thin = struck(BODIES["frame"]().refine(), tilt=10.0, speed=100.0)
    assert thin.trust == "limited" and facts(thin)["slenderness"] < 0.15


def test_properties_without_evidence_are_named() -> None:
    mesh = pc.Mesh.rectangle(0.05, 0.04, nx=5, ny=4)
    for changes, named in (
        ({"friction": 1.0}, "friction above 0.5"),
        ({"courant": 0.01}, "steps of 0.01"),
        ({"speed": 800.0}, "of the wave speed"),
        ({"speed": 1e-2}, "of the wave speed"),
    ):
        estimate = struck(mesh, **changes)  # type: ignore[arg-type]
        # Strains at 800 m/s are far from small.
        assert estimate.trust == ("low" if changes.get("speed") == 800.0 else "limited") and len(facts(estimate)["outside_tested_range"]) == 1
        assert named in facts(estimate)["outside_tested_range"][0] and "outside the tested range" in str(estimate.verdict)


@pytest.mark.parametrize(("slope", "curvature", "touches"), [(0.0, 0.0, "edge"), (0.0, 4.0, "curve"), (0.2, 0.0, "curve"), (1.0, 0.0, "corner")])
def test_half_of_a_body_touches_as_the_whole(slope: float, curvature: float, touches: str) -> None:
    """On the line of symmetry, a flat side goes on and a roof turns by twice its slope."""
    for width, cells, supports in ((0.02, 10, []), (0.01, 5, [pc.Support(group="left", components="x")])):
        flat = pc.Mesh.rectangle(width, 0.02, nx=cells, ny=10)
        aside = np.abs(flat.points[:, 0] - (width - 0.01))
        points = flat.points + np.outer(slope * aside + curvature * aside**2, [0.0, 1.0])
        mesh = pc.Mesh(points, flat.cells, edge_groups=flat.edge_groups)
        assert facts(struck(mesh, supports=supports))["touches"] == touches


@pytest.mark.filterwarnings("ignore::percute.SimulationWarning")
@pytest.mark.parametrize(("pair", "gives"), [(ends.PAIRS[-1], True), (ends.PAIRS[1], False)], ids=["gives", "takes"])
def test_contact_that_gives_energy_has_low_trust(pair: ends.Pair, gives: bool) -> None:
    """A small block on the end of another one, of two or three elements: contact gives 20 % of the energy. No contact gives any."""
    estimate = pc.estimate(pc.simulate(pair.problem(), end=pair.end, courant=0.9))
    assert (ends.given(estimate) > 0.01) is gives
    assert ("contact_energy" in warnings_of(estimate)) is gives and (estimate.trust == "low") is gives


@pytest.mark.filterwarnings("ignore::percute.SimulationWarning")
@pytest.mark.parametrize("matching", [True, False])
@pytest.mark.parametrize(("slope", "ranged"), [(9.0, True), (16.0, False)])
def test_chevrons_that_lean_together_have_no_range(slope: float, ranged: bool, matching: bool) -> None:
    """The surfaces of both bodies touch where they are inclined to the normal, as pairs of nodes or sliding."""

    def body(name: str, up: float, speed: float) -> pc.Body:
        flat = pc.Mesh.rectangle(0.02, 0.01, nx=6, ny=3)
        points = flat.points + np.outer(np.abs(flat.points[:, 0] - 0.01), [0.0, math.tan(math.radians(slope))])
        mesh = pc.Mesh(points, flat.cells, edge_groups=flat.edge_groups)
        material = pc.Elastic(**ALUMINIUM, plane="stress")
        return pc.Body(name=name, mesh=mesh, material=material, origin=(0.0, up), velocity=(0.0, speed))

    bodies = [body("lower", 0.0, 0.0), body("upper", 0.01001, -20.0)]
    contact = pc.Interface(groups=("upper.bottom", "lower.top"), friction=0.2, matching=matching)
    estimate = pc.estimate(pc.simulate(pc.Problem(bodies=bodies, contacts=[contact]), end=8e-6, courant=0.9))
    assert ("inclined_surfaces" in warnings_of(estimate)) is not ranged
    assert (facts(estimate)["effectivity"] is not None) is ranged


@pytest.mark.filterwarnings("ignore::percute.SimulationWarning")
@pytest.mark.parametrize(("speed", "driven", "ranged"), [(80.0, False, False), (0.0, True, False), (0.0, False, True)])
def test_a_block_that_slides_onto_a_ramp_has_no_range(speed: float, driven: bool, ranged: bool) -> None:
    """It touches a level surface first, whether it has its speed at the start or a support drives it."""
    flat = pc.Mesh.rectangle(0.06, 0.02, nx=24, ny=6)
    ramp = flat.points[:, 1] / 0.02 * np.maximum(flat.points[:, 0] - 0.03, 0.0) * math.tan(math.radians(18.0))
    ramp = pc.Mesh(flat.points + np.outer(ramp, [0.0, 1.0]), flat.cells, edge_groups=flat.edge_groups)
    block = pc.Mesh.rectangle(0.01, 0.01, nx=5, ny=4)
    material = pc.Elastic(**ALUMINIUM, plane="stress")
    lower = pc.Body(name="lower", mesh=ramp, material=material)
    upper = pc.Body(name="upper", mesh=block, material=material, origin=(0.0198, 0.02001), velocity=(speed, -20.0))
    push = pc.Support(group="upper.top", components="x", velocity=[0.0, 150.0, 150.0], time=[0.0, 1e-6, 1.0])
    contact = pc.Interface(groups=("upper.bottom", "lower.top"), friction=0.2, matching=False)
    problem = pc.Problem(bodies=[lower, upper], contacts=[contact], supports=[push] if driven else [])
    estimate = pc.estimate(pc.simulate(problem, end=15e-6, courant=0.9))
    assert ("inclined_surfaces" in warnings_of(estimate)) is not ranged
    assert (facts(estimate)["effectivity"] is not None) is ranged


@pytest.mark.filterwarnings("ignore::percute.SimulationWarning")
def test_a_corner_that_flies_over_a_slope_does_not_lean() -> None:
    """A small block bounces off a level surface before the slope, while another one is still pressed on that surface."""
    flat = pc.Mesh.rectangle(0.09, 0.02, nx=36, ny=6)
    fall = flat.points[:, 1] / 0.02 * np.maximum(flat.points[:, 0] - 0.06, 0.0) * -math.tan(math.radians(18.0))
    slope = pc.Mesh(flat.points + np.outer(fall, [0.0, 1.0]), flat.cells, edge_groups=flat.edge_groups)
    material = pc.Elastic(**ALUMINIUM, plane="stress")
    small, large = pc.Mesh.rectangle(0.005, 0.002, nx=4, ny=2), pc.Mesh.rectangle(0.02, 0.01, nx=10, ny=4)
    bodies = [
        pc.Body(name="lower", mesh=slope, material=material),
        pc.Body(name="small", mesh=small, material=material, origin=(0.0545, 0.02001), velocity=(80.0, -20.0)),
        pc.Body(name="large", mesh=large, material=material, origin=(0.033, 0.02001), velocity=(0.0, -20.0)),
    ]
    contacts = [pc.Interface(groups=("lower.top", f"{name}.bottom"), friction=0.2, matching=False) for name in ("small", "large")]
    pressed = pc.Support(group="large.top", components="y", velocity=[-20.0, -20.0], time=[0.0, 1.0])
    problem = pc.Problem(bodies=bodies, contacts=contacts, supports=[pressed])
    estimate = pc.estimate(pc.simulate(problem, end=30e-6, courant=0.9))
    assert "inclined_surfaces" not in warnings_of(estimate)


@pytest.mark.filterwarnings("ignore::percute.SimulationWarning")
def test_the_number_is_not_trusted_for_a_reason() -> None:
    mesh = pc.Mesh.rectangle(0.05, 0.04, nx=5, ny=4)
    history = struck(mesh).history
    assert history is not None
    for reconstruction in ("consistent", "published"):
        estimate = pc.estimate(history, reconstruction=reconstruction)  # type: ignore[arg-type]
        assert estimate.trust == "low" and "Do not trust the number" in str(estimate.verdict)
    # An acceleration brings the body back to its plane several times.
    gravity = pc.BodyForce(value=(0.0, -2700.0 * 1e6))
    plane = pc.Plane(point=(0, -1e-4), normal=(0, 1), friction=0.2)
    material = pc.Elastic(**ALUMINIUM, plane="stress")
    problem = pc.Problem(mesh, material=material, obstacles=[plane], initial_velocity=(0, -40), body_forces=[gravity])
    bounces = pc.estimate(pc.simulate(problem, end=300e-6, courant=0.9))
    assert facts(bounces)["phases"] > 1 and bounces.trust == "low" and "several contacts" in str(bounces.verdict)


@pytest.mark.filterwarnings("ignore::percute.SimulationWarning")
@pytest.mark.parametrize(("friction", "along"), [(0.0, 0.0), (0.0, 10.0), (0.3, 2.0)])
def test_small_elements_along_a_flat_contact_are_not_tested(friction: float, along: float) -> None:
    """There the auxiliary solution gains energy, which neither friction nor a velocity along the plane hides: the index is 1.3 to 1.6 for 8."""
    mesh = pc.Mesh.rectangle(0.05, 0.05, nx=5, ny=5)
    for halvings in (2, 3):
        lowest = mesh
        for _ in range(halvings):
            lowest = lowest.refine(where=lowest.points[lowest.cells][:, :, 1].min(axis=1) < 1e-9)
        plane = pc.Plane(point=(0, -2e-6), normal=(0, 1), friction=friction)
        problem = pc.Problem(lowest, material=pc.Elastic(**ALUMINIUM, plane="stress"), obstacles=[plane], initial_velocity=(along, -1))
        estimate = pc.estimate(pc.simulate(problem, end=27e-6, courant=0.8))
        named = [text for text in facts(estimate)["outside_tested_range"] if text.startswith("elements at a flat contact smaller")]
        # 4 and 8 times smaller; the limit is 5.
        assert len(named) == (halvings == 3) and (estimate.trust == "high") == (halvings == 2)
    assert json.loads(estimate.to_json())["auxiliary_contact_energy"] > 0.1


@pytest.mark.filterwarnings("ignore::percute.SimulationWarning")
def test_what_locks_and_what_is_much_softer_is_not_tested() -> None:
    mesh = pc.Mesh.rectangle(0.05, 0.04, nx=10, ny=8)
    plane = pc.Plane(point=(0, -1e-6), normal=(0, 1), friction=0.0)
    for poisson, named in ((0.49, []), (0.495, ["plane strain with a Poisson's ratio above 0.49"])):
        rubber = pc.Elastic(young=70e9, poisson=poisson, density=2700.0, plane="strain")
        problem = pc.Problem(mesh, material=rubber, obstacles=[plane], initial_velocity=(0, -5))
        assert facts(pc.estimate(pc.simulate(problem, end=2e-6, courant=0.9)))["outside_tested_range"] == named
    # √(ρE) of two bodies: 8.6 and 94 times.
    hard = pc.Elastic(**ALUMINIUM, plane="stress")
    for young, count in ((1e9, 0), (8e6, 1)):
        soft = pc.Elastic(young=young, poisson=0.3, density=2700.0, plane="stress")
        lower, upper = (pc.Mesh.rectangle(0.05, 0.04, nx=4, ny=4) for _ in range(2))
        bodies = [pc.Body(name="lower", mesh=lower, material=hard), pc.Body(name="upper", mesh=upper, material=soft, origin=(0, 0.04 + 5e-6), velocity=(0, -0.5))]
        pair = pc.Problem(bodies=bodies, contacts=[pc.Interface(friction=0.0)])
        outside_tested_range = facts(pc.estimate(pc.simulate(pair, end=2e-5, courant=0.9)))["outside_tested_range"]
        assert sum(text.startswith("impedances that differ by a factor of") for text in outside_tested_range) == count, outside_tested_range


def test_shorter_steps_help_where_they_do() -> None:
    """The recommendation follows from the sources, and has the change that they expect of shorter steps."""
    estimate = struck(BODIES["disc"]().refine(), speed=4.0)
    sources = estimate.sources
    assert sources is not None and sources.mean_with_halved_step is not None
    change = round(100 * (sources.mean_with_halved_step / estimate.mean - 1))
    told = f"{change:+d}" if change else "0"
    assert f": {told} %." in str(estimate.verdict) and "Grade the mesh towards the contact" in str(estimate.verdict)
    flat = str(struck(BODIES["block"]().refine()).verdict)
    assert "Refine the whole mesh" in flat or "is out of reach" in flat


@pytest.mark.parametrize(
    ("impact", "last"),
    [(Impact("flat block", 0, 0.5), 5.0), (Impact("block", 0, 0.9), 2.0), (Impact("block", 0, 0.1, oblique=True), 2.0)],
)
def test_the_range_depends_on_the_time_from_the_first_touch(impact: Impact, last: float) -> None:
    """Wide at the first touch, and wider again long after it: it contains the index at each time."""
    ranges = []
    for duration, sup, mean, (low, high) in replace(impact, last=last).indices():
        assert low <= min(sup, mean) and max(sup, mean) <= high, (duration, sup, mean)
        ranges.append((duration, high))
    assert ranges[0] == (0.1, 3.5) and ranges[-1] == (last, 1.6)


def test_a_very_long_run_is_not_tested() -> None:
    """A block flies on for fifteen wave passages."""
    mesh = pc.Mesh.rectangle(0.05, 0.04, nx=5, ny=4)
    estimate = struck(mesh, end=180e-6)
    found = facts(estimate)
    assert found["effectivity"] == [0.7, 1.6] and any("wave passages" in each for each in found["outside_tested_range"])
    assert estimate.trust == "limited"


@pytest.mark.filterwarnings("ignore::percute.SimulationWarning")
def test_a_release_is_no_spike_with_short_steps() -> None:
    """Neighbours of a node are released before it. Its return to the plane within a step once made an error of 70 %."""
    material = pc.Elastic(**ALUMINIUM, plane="stress")
    plane = pc.Plane(point=(0, -5e-6), normal=(0, 1), friction=0.2)
    problem = pc.Problem(pc.Mesh.rectangle(0.05, 0.04, nx=5, ny=4), material=material, obstacles=[plane], initial_velocity=(0, -10))
    # The onset of contact makes 21 %.
    assert pc.estimate(pc.simulate(problem, end=20e-6, courant=0.05)).published_relative_sup < 0.25


def test_a_mean_as_large_as_the_vibration_is_not_trusted() -> None:
    """A common velocity makes the published relative error as small as one likes, but not that of the vibration."""
    material = pc.Elastic(young=70e9, poisson=0.3, density=2700.0, plane="stress")
    mesh = pc.Mesh.rectangle(0.05, 0.04, nx=2, ny=2).rotated(20.0)
    plane = pc.Plane(point=(0.0, float(mesh.points[:, 1].min()) - 2e-5), normal=(0.0, 1.0), friction=0.0)
    for along in (0.0, 300.0):
        problem = pc.Problem(mesh, material=material, obstacles=[plane], initial_velocity=(along, -5.0))
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            estimate = pc.estimate(pc.simulate(problem, end=3e-5, courant=0.9))
        assert estimate.relative_mean > 1.0 and estimate.trust == "low"
        assert "as large as the solution" in (estimate.verdict or "")
    assert estimate.published_relative_mean < 0.1
