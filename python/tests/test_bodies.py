"""Several bodies that strike each other: the same from Python and from a case, in memory and from a file."""

import json
import pickle
import re
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import percute as pc
import pytest
from studies.block import ALUMINIUM

BASE = Path(__file__).parents[2] / "tests" / "bases" / "bodies.toml"


def steel() -> pc.Elastic:
    return pc.Elastic(young=210e9, poisson=0.3, density=7800, plane="stress")


def aluminium() -> pc.Elastic:
    return pc.Elastic(young=70e9, poisson=0.3, density=2700, plane="stress")


def blocks(friction: float = 0.2) -> pc.Problem:
    """Give the problem of the case ``bodies.toml``."""
    mesh = pc.Mesh.rectangle(0.04, 0.025, nx=4, ny=3)
    hammer = pc.Body(name="hammer", mesh=mesh, material=aluminium(), origin=(0, 0.02505), velocity=(2, -20))
    return pc.Problem(
        bodies=[pc.Body(name="anvil", mesh=mesh, material=steel()), hammer],
        contacts=[pc.Interface(groups=("anvil.top", "hammer.bottom"), friction=friction)],
    )


def test_python_and_case_are_one() -> None:
    run, problem = pc.run(BASE), blocks()
    estimate = pc.estimate(pc.simulate(problem, end=10e-6, courant=0.9))
    assert estimate.sup == run.sup
    assert np.array_equal(estimate.by_element, run.by_element)
    assert problem.contacts == (pc.Interface(groups=("anvil.top", "hammer.bottom"), friction=0.2),)
    assert problem.obstacles == ()
    assert set(problem.mesh.element_groups) == {"anvil", "hammer"}


def test_surfaces_are_found() -> None:
    """By the names of the bodies, or without a word about them, they are those that groups name."""
    expected = pc.run(BASE)
    text = BASE.read_text(encoding="utf-8")
    named = 'groups = ["anvil.top", "hammer.bottom"]\n'
    assert named in text
    anvil, hammer = (pc.Body(name=name, mesh=pc.Mesh.rectangle(0.04, 0.025, nx=4, ny=3), material=law, origin=(0, y), velocity=v) for name, law, y, v in (
        ("anvil", steel(), 0, (0, 0)), ("hammer", aluminium(), 0.02505, (2, -20))
    ))
    for instead, contact in (
        ('bodies = ["anvil", "hammer"]\n', pc.Interface(bodies=("anvil", "hammer"), friction=0.2)),
        ("", pc.Interface(friction=0.2)),
        (named + "matching = true\n", pc.Interface(groups=("anvil.top", "hammer.bottom"), friction=0.2, matching=True)),
    ):
        run = pc.run(text.replace(named, instead))
        problem = pc.Problem(bodies=[anvil, hammer], contacts=[contact])
        assert problem.contacts == (pc.Interface(groups=("anvil.top", "hammer.bottom"), friction=0.2),)
        assert run.sup == expected.sup == pc.estimate(pc.simulate(problem, end=10e-6, courant=0.9)).sup
    with pytest.raises(pc.InputError, match="could touch each other, but their coefficient of friction is missing"):
        pc.Problem(bodies=[anvil, hammer])


def test_bars_touch_without_a_word_about_it() -> None:
    law = pc.Elastic(young=70e9, density=2700, section=1e-4)
    bodies = [pc.Body(name=name, mesh=pc.Mesh.bar(0.1, elements=20), material=law, origin=x, velocity=10.0 * (x == 0.0)) for name, x in zip("abc", (0.0, 0.1001, 0.2002), strict=True)]
    problem = pc.Problem(bodies=bodies)
    assert [contact.groups for contact in problem.contacts] == [("a.end", "b.start"), ("b.end", "c.start")]
    impacts = pc.simulate(problem, end=1e-4, courant=0.9).impacts
    assert impacts is not None and all(each.first_touch is not None for each in impacts.interfaces)


def unlike(velocity: tuple[float, float] = (0, -20)) -> pc.Problem:
    """Give two blocks of which no nodes face each other."""
    anvil = pc.Body(name="anvil", mesh=pc.Mesh.rectangle(0.04, 0.025, nx=7, ny=6), material=aluminium())
    hammer = pc.Body(name="hammer", mesh=pc.Mesh.rectangle(0.04, 0.025, nx=10, ny=8), material=steel(), origin=(0, 0.02505), velocity=velocity)
    return pc.Problem(bodies=[anvil, hammer], contacts=[pc.Interface(friction=0.2)])


def test_surfaces_that_do_not_match(tmp_path: Path) -> None:
    problem = unlike()
    sliding = pc.Interface(groups=("anvil.top", "hammer.bottom"), friction=0.2, matching=False)
    assert problem.contacts == (sliding,) and repr(pc.Problem(problem.mesh, material=problem.material, contacts=[sliding]).contacts) == repr((sliding,))
    history = pc.simulate(problem, end=14e-6, courant=0.9)
    # Opposite forces on the two surfaces, to rounding of their sums.
    force = history.reaction.sum(axis=1)
    assert np.abs(history.reaction).max() > 1e3 and np.abs(force).max() < 1e-9 * np.abs(history.reaction).max()
    impacts = history.impacts
    assert impacts is not None and impacts.interfaces[0].first_touch is not None
    estimate = pc.estimate(history)
    (surfaces,) = estimate.non_matching
    assert surfaces.groups == impacts.interfaces[0].groups
    # Cells cut along one diagonal move the surfaces along each other a little.
    assert 0.0 < surfaces.slide < 1e-5 and 0.0 < surfaces.lift < 2e-6 and surfaces.rounds >= 2 and 0.0 < surfaces.stress < 0.05
    # The moment of all normal forces about one point, at the places of their nodes.
    press, nodes = history.reaction[:, :, 1], history.contact_nodes
    places = problem.mesh.points[nodes, 0] + history.displacement[:, nodes, 0]
    force = np.abs(press[:, nodes < 8 * 7].sum(axis=1))
    couple = np.abs((press * places).sum(axis=1)).max() / force.max()
    assert surfaces.couple == pytest.approx(couple, rel=1e-6)
    estimate.save(tmp_path / "unlike.vtkhdf")
    assert pc.open(tmp_path / "unlike.vtkhdf").non_matching == estimate.non_matching
    (tmp_path / "unlike.vtkhdf").unlink()
    stored = pc.simulate(problem, end=14e-6, courant=0.9, store=tmp_path / "unlike.vtkhdf")
    again = pc.open(tmp_path / "unlike.vtkhdf")
    assert np.array_equal(again.displacement, history.displacement) and np.array_equal(stored.reaction, history.reaction)
    assert again.problem.contacts == problem.contacts and pickle.loads(pickle.dumps(problem)).contacts == problem.contacts


def test_a_body_that_enters_another_one_ends_the_run() -> None:
    """At 200 m/s the gap is closed after 0.25 µs; a tenth of the height of an element, 0.83 mm, is passed before 5 µs."""
    problem = blocks()
    velocity = problem.initial_velocity.copy()
    velocity[velocity[:, 1] < 0, 1] = -200.0
    free = pc.Problem(problem.mesh, material=problem.material, initial_velocity=velocity)
    with pytest.warns(pc.InputWarning), pytest.raises(pc.SimulationError, match="inside \"(anvil|hammer)\": no contact was defined there") as told:
        pc.simulate(free, end=30e-6, courant=0.9)
    assert "is stated" not in str(told.value) and "define a contact by `groups`" in str(told.value)


def test_a_stored_history_gives_the_same(tmp_path: Path) -> None:
    problem = blocks()
    stored = pc.simulate(problem, end=10e-6, courant=0.9, store=tmp_path / "blocks.vtkhdf")
    expected = pc.estimate(stored)
    history = pc.open(tmp_path / "blocks.vtkhdf")
    assert pc.estimate(history).sup == expected.sup
    assert history.problem.contacts == problem.contacts
    # Forces on pairs are opposite.
    reaction = history.reaction
    half = reaction.shape[1] // 2
    assert np.abs(reaction).max() > 0
    assert np.array_equal(reaction[:, :half], -reaction[:, half:])


def test_contact_of_a_pair_is_counted_once() -> None:
    estimate = pc.estimate(pc.simulate(blocks(), end=10e-6, courant=0.9))
    contact = estimate.contact
    assert contact is not None
    first, second = contact.obstacles
    assert np.array_equal(contact.resultants.force, first.force)
    assert np.array_equal(first.force, -second.force)
    assert np.array_equal(contact.resultants.normal_force, first.normal_force)


@pytest.mark.filterwarnings("ignore::percute.SimulationWarning")
def test_bodies_that_slip_are_told_of() -> None:
    problem = blocks(0.0)
    velocity = np.array(problem.initial_velocity)
    velocity[velocity[:, 0] > 0, 0] = 150.0
    fast = pc.Problem(problem.mesh, material=problem.material, contacts=problem.contacts, initial_velocity=velocity)
    slipping = pc.estimate(pc.simulate(fast, end=20e-6, courant=0.9))
    # 150 m/s until contact ends after 12 µs are 0.18 edges of 10 mm.
    assert "node pairs with a slip of 0.18" in str(slipping.verdict)
    assert slipping.trust == "limited"
    assert "slip" not in str(pc.estimate(pc.simulate(problem, end=10e-6, courant=0.9)).verdict)
    velocity[velocity[:, 0] > 0, 0] = 1500.0
    far = pc.Problem(problem.mesh, material=problem.material, contacts=problem.contacts, initial_velocity=velocity)
    assert pc.estimate(pc.simulate(far, end=20e-6, courant=0.9)).trust == "low"


def test_histories_of_other_programs_are_read() -> None:
    """Displacements alone give the contact forces of both bodies, and the estimate of percute's own history."""
    problem = blocks()
    history = pc.simulate(problem, end=20e-6, courant=0.9)
    expected = pc.estimate(history)
    given = pc.History.from_arrays(problem, history.time, history.displacement, history.reaction)
    assert pc.estimate(given).sup == pytest.approx(expected.sup, rel=1e-12)
    alone = pc.History.from_arrays(problem, history.time, history.displacement)
    estimate = pc.estimate(alone)
    # Second differences of displacements of 1e-4 m: 1e-16·1e-4/(1e-7)² over accelerations of 1e8.
    assert estimate.sup == pytest.approx(expected.sup, rel=1e-6)
    derived = np.asarray(alone.reaction)
    half = derived.shape[1] // 2
    assert np.array_equal(derived[:, :half], -derived[:, half:])
    assert np.allclose(derived, history.reaction[: len(derived)], atol=1e-6 * np.abs(history.reaction).max())
    assert np.array_equal(alone.touching, history.touching[: len(derived)])
    one_sided = np.array(history.reaction)
    one_sided[:, half:] = 0.0
    with pytest.raises(pc.PercuteError, match="which touch each other, are not opposite at step"):
        pc.History.from_arrays(problem, history.time, history.displacement, one_sided)
    # Another friction than that of the history is named with its surface.
    other = blocks(0.05)
    with pytest.raises(pc.PercuteError, match=r'the surface that faces "anvil.top"|"hammer.bottom"'):
        pc.estimate(pc.History.from_arrays(other, history.time, history.displacement, history.reaction))


def test_bars_and_places() -> None:
    law = pc.Elastic(young=70e9, density=2700, section=1e-4)
    bar = pc.Mesh.bar(0.3, elements=30)
    problem = pc.Problem(
        bodies=[pc.Body(name="left", mesh=bar, material=law, velocity=10.0), pc.Body(name="right", mesh=bar, material=law, origin=0.3001)],
        contacts=[pc.Interface(groups=("left.end", "right.start"))],
    )
    assert problem.mesh.points[31, 0] == 0.3001
    estimate = pc.estimate(pc.simulate(problem, end=2e-4, courant=0.9))
    assert max(estimate.residuals.values()) < 1e-10
    square = pc.Mesh.rectangle(1.0, 1.0, nx=1, ny=1)
    turned = pc.Problem(bodies=[pc.Body(name="a", mesh=square, material=steel(), rotation=90, origin=(2, 0))])
    # Rounding of the sine.
    assert np.allclose(turned.mesh.points, np.asarray([(2 - y, x) for x, y in square.points]), atol=1e-15)


def test_contacts_are_pickled() -> None:
    problem = blocks()
    copied = pickle.loads(pickle.dumps(problem))
    assert copied.contacts == problem.contacts
    assert np.array_equal(copied.contact_nodes, problem.contact_nodes)


def test_a_body_without_contact_is_told_of() -> None:
    problem = blocks()
    free = pc.Problem(problem.mesh, material=problem.material, initial_velocity=problem.initial_velocity)
    with pytest.warns(pc.InputWarning, match="the run ends with an error where it enters one"):
        pc.simulate(free, end=10e-6, courant=0.9)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        pc.simulate(problem, end=10e-6, courant=0.9)


def test_surfaces_must_have_the_same_edges() -> None:
    mesh = pc.Mesh.rectangle(0.04, 0.025, nx=4, ny=3)
    groups = {name: np.asarray(edges) for name, edges in mesh.edge_groups.items()}
    # All nodes of the top, but not its second edge.
    groups["top"] = np.delete(groups["top"], 1, axis=0)
    holed = pc.Mesh(mesh.points, mesh.cells, groups)
    anvil = pc.Body(name="anvil", mesh=holed, material=steel())
    hammer = pc.Body(name="hammer", mesh=mesh, material=aluminium(), origin=(0, 0.02505), velocity=(0, -20))
    for groups_of in (("anvil.top", "hammer.bottom"), ("hammer.bottom", "anvil.top")):
        with pytest.raises(pc.InputError, match="no edge of the other group faces"):
            pc.Problem(bodies=[anvil, hammer], contacts=[pc.Interface(groups=groups_of, friction=0.0, matching=True)])
    strain = pc.Elastic(young=70e9, poisson=0.3, density=2700, plane="strain")
    both = [pc.Body(name="anvil", mesh=mesh, material=steel()), pc.Body(name="hammer", mesh=mesh, material=strain, origin=(0, 0.02505))]
    with pytest.raises(pc.InputError, match="plane stress"):
        pc.Problem(bodies=both, contacts=[pc.Interface(groups=("anvil.top", "hammer.bottom"), friction=0.0)])


def test_the_page_runs(tmp_path: Path) -> None:
    page = (BASE.parents[2] / "docs" / "bodies.md").read_text(encoding="utf-8")
    [case] = re.findall(r"```toml\n(.*?)```", page, re.DOTALL)
    [program] = re.findall(r"```python\n(.*?)```", page, re.DOTALL)
    names: dict[str, Any] = {}
    exec(program, names)
    file = tmp_path / "case.toml"
    file.write_text(case + "[time]\nend = 20e-6\ncourant = 0.9\n", encoding="utf-8")
    run = pc.run(file)
    assert names["estimate"].sup == run.sup


def test_impulses_give_the_motion_of_each_body(tmp_path: Path) -> None:
    """Against Σ m v of the nodes; contact has ended after 20 µs."""
    problem = blocks()
    history = pc.simulate(problem, end=20e-6, courant=0.9)
    alone = pc.Problem(problem.mesh.part("anvil"), material=aluminium(), initial_velocity=(1, 0))
    assert history.rebound is None and pc.simulate(alone, end=1e-5, courant=0.9).impacts is None
    impacts = history.impacts
    assert impacts is not None
    half = len(problem.mesh.points) // 2
    for body, nodes, name in zip(impacts.bodies, (slice(half), slice(half, None)), ("anvil", "hammer"), strict=True):
        mass, velocity = problem.mass[nodes], history.velocity[[0, -1], nodes]
        mean = np.einsum("k,tkc->tc", mass, velocity) / mass.sum()
        assert body.name == name and body.mass == pytest.approx(mass.sum(), rel=1e-12)
        # Rounding of sums of some hundred impulses.
        assert np.allclose(body.velocity_before, mean[0], atol=1e-12)
        assert body.velocity_after is not None and np.allclose(body.velocity_after, mean[1], atol=1e-11)
    [interface] = impacts.interfaces
    assert interface.groups == ("anvil.top", "hammer.bottom") and interface.normal.tolist() == [0.0, -1.0]
    assert np.copysign(1.0, interface.normal[0]) == 1.0
    assert interface.ended and interface.normal_before == pytest.approx(-20.0, rel=1e-12)
    after = impacts.bodies[0].velocity_after, impacts.bodies[1].velocity_after
    assert after[0] is not None and after[1] is not None
    # There is no contact any more, and no load: the velocities of the end are those of the release.
    assert interface.normal_after == pytest.approx(after[1][1] - after[0][1], rel=1e-12)
    assert interface.restitution == pytest.approx(-(interface.normal_after or 0.0) / -20.0, rel=1e-12)
    touching = history.time[history.touching.any(axis=1)]
    assert interface.first_touch == touching[0] and interface.release == touching[-1]
    # The same in the estimate, in its file and in its document.
    estimate = pc.estimate(history)
    estimate.save(tmp_path / "e.vtkhdf")
    document = json.loads(estimate.to_json())
    assert document["problem"]["obstacles"][0]["normal"] == [0.0, -1.0] and "-0.0" not in json.dumps(document["problem"])
    for other in (estimate.impacts, pc.open(tmp_path / "e.vtkhdf").impacts):
        assert other is not None and other.interfaces[0].restitution == interface.restitution
    assert document["impacts"]["interfaces"][0]["restitution"] == interface.restitution
    early = pc.simulate(problem, end=8e-6, courant=0.9).impacts
    assert early is not None and early.interfaces[0].no_restitution == "contact has not ended"
    weight = pc.BodyForce(value=(0.0, -1e3))
    heavy = pc.Problem(problem.mesh, material=problem.material, contacts=problem.contacts, initial_velocity=problem.initial_velocity, body_forces=[weight])
    loaded = pc.simulate(heavy, end=20e-6, courant=0.9).impacts
    assert loaded is not None and loaded.bodies[0].velocity_after is None
    assert loaded.interfaces[0].no_restitution == "supports or loads change the velocities, too"


def test_a_free_body_has_a_restitution_where_the_other_one_is_held(tmp_path: Path) -> None:
    """The anvil is fixed below: the velocity of the hammer alone counts."""
    problem = blocks()
    held = pc.Problem(
        problem.mesh,
        material=problem.material,
        contacts=problem.contacts,
        initial_velocity=problem.initial_velocity * (problem.initial_velocity < 0.0),
        supports=[pc.Support(group="anvil.bottom", components=("x", "y"))],
    )
    history = pc.simulate(held, end=40e-6, courant=0.9)
    impacts = history.impacts
    assert impacts is not None
    anvil, hammer = impacts.bodies
    [interface] = impacts.interfaces
    assert anvil.velocity_after is None and hammer.velocity_after is not None and interface.ended, interface
    assert interface.restitution == pytest.approx(-hammer.velocity_after[1] / hammer.velocity_before[1], rel=1e-12)
    estimated = pc.estimate(history).impacts
    assert estimated is not None and estimated.bodies[1].angular_velocity_after is not None


def test_bars_exchange_their_velocities() -> None:
    """A cradle: the first bar stops, the last one leaves. The bar in between has two contacts at once."""
    law = pc.Elastic(young=70e9, density=2700, section=1e-4)
    bar = pc.Mesh.bar(0.1, elements=50)
    bodies = [pc.Body(name=name, mesh=bar, material=law, origin=k * 0.10001, velocity=10.0 * (k == 0)) for k, name in enumerate("abc")]
    contacts = [pc.Interface(groups=("a.end", "b.start")), pc.Interface(groups=("b.end", "c.start"))]
    impacts = pc.simulate(pc.Problem(bodies=bodies, contacts=contacts), end=1.2e-4, courant=0.9).impacts
    assert impacts is not None
    velocities = [float(body.velocity_after[0]) for body in impacts.bodies if body.velocity_after is not None]
    # 0.08 m/s is what the smeared front leaves on 50 elements for one interface.
    assert [each.no_restitution for each in impacts.interfaces] == ["another contact changes the velocities, too"] * 2
    assert velocities == pytest.approx([0.0, 0.0, 10.0], abs=0.2) and sum(velocities) == pytest.approx(10.0, rel=1e-12)


def test_a_run_ends_when_all_contact_has_ended() -> None:
    """A cradle: its second impact comes later than the wait after the first one, and its first two bars stay beside each other."""
    law = pc.Elastic(young=70e9, density=2700, section=1e-4)
    bar = pc.Mesh.bar(0.1, elements=50)
    places = [0.0, 0.10001, 0.2008]
    bodies = [pc.Body(name=name, mesh=bar, material=law, origin=x, velocity=10.0 * (x == 0.0)) for name, x in zip("abc", places, strict=True)]
    contacts = [pc.Interface(groups=("a.end", "b.start")), pc.Interface(groups=("b.end", "c.start"))]
    problem, after = pc.Problem(bodies=bodies, contacts=contacts), 30e-6
    history = pc.simulate(problem, end="rebound", longest=1e-3, after=after, courant=0.9)
    impacts = history.impacts
    assert impacts is not None and all(each.ended for each in impacts.interfaces)
    first, second = (each.release for each in impacts.interfaces)
    assert first is not None and second is not None and second > first + 2 * after
    step = float(np.diff(history.time).max())
    # The end is that of a pass whose steps differ, rounded up to four digits.
    assert second + after - 2 * step <= history.time[-1] <= second + after + 3 * step + 1e-3 * history.time[-1]
    with pytest.warns(pc.InputWarning, match="contact has not ended by 3e-5 s"):
        pc.simulate(problem, end="rebound", longest=3e-5, courant=0.9)
    apart = pc.Problem(problem.mesh, material=problem.material, contacts=contacts, initial_velocity=-problem.initial_velocity)
    with pytest.warns(pc.InputWarning) as told:
        pc.simulate(apart, end="rebound", longest=3e-5, courant=0.9)
    for words in ("nothing has touched by 3e-5 s", "move apart at 10 m/s"):
        assert any(words in str(each.message) for each in told)


def test_pictures_and_tables_name_the_surfaces() -> None:
    pytest.importorskip("matplotlib")
    history = pc.simulate(blocks(), end=10e-6, courant=0.9)
    assert history.contact.surfaces == ("anvil.top", "hammer.bottom")
    axes = history.contact.plot("pressure")
    assert [each.get_title() for each in axes] == ["", "anvil.top and hammer.bottom"]
    assert "1 contact" in repr(history.problem)


def test_slip_is_a_warning() -> None:
    problem = blocks(0.0)
    velocity = np.array(problem.initial_velocity)
    velocity[velocity[:, 0] > 0, 0] = 150.0
    fast = pc.Problem(problem.mesh, material=problem.material, contacts=problem.contacts, initial_velocity=velocity)
    with pytest.warns(pc.SimulationWarning, match="slip by up to 0.18 edges"):
        estimate = pc.estimate(pc.simulate(fast, end=20e-6, courant=0.9))
    assert any("slip" in told for told in estimate.warnings)


def test_bodies_of_one_file(tmp_path: Path) -> None:
    """A Gmsh file with two bodies as groups of elements gives what two meshes give."""
    two = blocks().mesh
    whole = pc.Mesh(two.points, two.cells, {"below": two.edge_groups["anvil.top"], "above": two.edge_groups["hammer.bottom"]}, {
        name: two.element_groups[name] for name in ("anvil", "hammer")
    })
    whole.write(tmp_path / "two.msh")
    anvil = pc.Mesh.read(tmp_path / "two.msh").part("anvil")
    assert np.array_equal(anvil.points, two.points[: len(two.points) // 2]) and list(anvil.edge_groups) == ["below"]
    assert list(anvil.element_groups) == ["anvil"] and np.array_equal(two.bodies, np.repeat([0, 1], len(two.cells) // 2))
    with pytest.raises(pc.InputError, match="`group` is 'anvl'; the groups of elements are anvil, hammer; did you mean `anvil`"):
        whole.part("anvl")
    text = BASE.read_text(encoding="utf-8")
    mesh = "rectangle = { width = 0.04, height = 0.025, nx = 4, ny = 3 }"
    assert text.count(mesh) == 2
    for name in ("anvil", "hammer"):
        text = text.replace(mesh, f'file = "two.msh"\ngroup = "{name}"', 1)
    text = text.replace("origin = [0.0, 0.02505]\n", "").replace("anvil.top", "anvil.below").replace("hammer.bottom", "hammer.above")
    (tmp_path / "case.toml").write_text(text, encoding="utf-8")
    assert pc.run(tmp_path / "case.toml").sup == pc.run(BASE).sup
    (tmp_path / "case.toml").write_text(text.replace('group = "hammer"', 'group = "hamer"'), encoding="utf-8")
    with pytest.raises(pc.InputError, match=r"group of elements \"hamer\", which is not in the mesh; it has anvil, hammer; did you mean `hammer`"):
        pc.run(tmp_path / "case.toml")


def test_bodies_that_overlap_are_named() -> None:
    mesh = pc.Mesh.rectangle(0.04, 0.025, nx=4, ny=3)
    bodies = [pc.Body(name="anvil", mesh=mesh, material=steel()), pc.Body(name="hammer", mesh=mesh, material=aluminium(), origin=(0, 0.02))]
    with pytest.raises(pc.InputError, match=r'`bodies\[1\]`: "hammer" overlaps "anvil": node 18 of "anvil.top" at \[0.03, 0.025\] m is 0.005 m inside, behind "hammer.bottom"; bodies may touch'):
        pc.Problem(bodies=bodies)


def test_a_body_that_turns_is_a_warning() -> None:
    """Small rotations are assumed. Without contact the motion is ωt, of which the strain is 0 in linear elasticity."""
    law = pc.Elastic(**ALUMINIUM, plane="stress")
    bodies = [pc.Body(name=name, mesh=pc.Mesh.rectangle(0.02, 0.01, nx=4, ny=2), material=law, origin=(0.0, y)) for name, y in (("a", 0.0), ("b", 0.011))]
    apart = pc.Problem(bodies=bodies, contacts=[pc.Interface(friction=0.2)])
    spin = 4000.0 * (apart.mesh.points - [0.01, 0.005])[:, ::-1] * [-1.0, 1.0]
    spin[apart.mesh.points[:, 1] > 0.0105] = 0.0, 500.0
    problem = pc.Problem(apart.mesh, material=apart.material, contacts=apart.contacts, initial_velocity=spin)
    with pytest.warns(pc.SimulationWarning, match="no contact force"), pytest.warns(pc.SimulationWarning, match=r"\"a\" turns by 0\.040 rad.* larger by a part of 8\.0e-4"):
        estimate = pc.estimate(pc.simulate(problem, end=1e-5, courant=0.9))
    assert any("turns" in told for told in estimate.warnings)
    # Less than 1e-3 rad, which does not count.
    spin[apart.mesh.points[:, 1] < 0.0105] /= 50.0
    calm = pc.Problem(apart.mesh, material=apart.material, contacts=apart.contacts, initial_velocity=spin)
    with pytest.warns(pc.SimulationWarning, match="no contact force"):
        estimate = pc.estimate(pc.simulate(calm, end=1e-5, courant=0.9))
    assert not any("turns" in told for told in estimate.warnings)
