"""Several bodies that strike each other: the same from Python and from a case, in memory and from a file."""

import pickle
import re
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import percute as pc
import pytest

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


def test_bodies_that_slip_are_told_of() -> None:
    problem = blocks(0.0)
    velocity = np.array(problem.initial_velocity)
    velocity[velocity[:, 0] > 0, 0] = 150.0
    fast = pc.Problem(problem.mesh, material=problem.material, contacts=problem.contacts, initial_velocity=velocity)
    slipping = pc.estimate(pc.simulate(fast, end=20e-6, courant=0.9))
    # 150 m/s until contact ends after 12 µs are 0.18 edges of 10 mm.
    assert "pairs of nodes that slip by 0.18" in str(slipping.verdict)
    assert slipping.trust == "limited"
    assert "slip" not in str(pc.estimate(pc.simulate(problem, end=10e-6, courant=0.9)).verdict)
    velocity[velocity[:, 0] > 0, 0] = 1500.0
    far = pc.Problem(problem.mesh, material=problem.material, contacts=problem.contacts, initial_velocity=velocity)
    assert pc.estimate(pc.simulate(far, end=20e-6, courant=0.9)).trust == "low"


def test_histories_of_other_programs_are_refused() -> None:
    problem = blocks()
    history = pc.simulate(problem, end=10e-6, courant=0.9)
    with pytest.raises(pc.PercuteError, match="single body"):
        pc.History.from_arrays(problem, history.time, history.displacement, history.reaction)


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
    with pytest.warns(pc.InputWarning, match="moves through them"):
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
            pc.Problem(bodies=[anvil, hammer], contacts=[pc.Interface(groups=groups_of, friction=0.0)])
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
