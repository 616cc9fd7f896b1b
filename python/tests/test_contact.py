"""What contact did, against what follows from displacements and reactions by hand."""

import json
import pickle
from pathlib import Path

import h5py
import matplotlib.pyplot as plt
import numpy as np
import percute as pc
import pytest
from conftest import bar, block

ARRAYS = ("time", "nodes", "obstacle", "points", "normals", "area", "force", "gap", "sliding_velocity", "status")
ARRAYS += ("friction_energy", "first_touch", "time_in_contact", "peak_normal_force", "time_of_peak", "peak_pressure", "impulse")
RESULTANTS = ("force", "normal_force", "impulse", "area", "in_contact", "slipping", "friction_energy", "centre")


def same(first: pc.Contact, second: pc.Contact | None) -> None:
    assert second is not None
    for name in ARRAYS:
        assert getattr(first, name).tobytes() == getattr(second, name).tobytes(), name
    pairs = zip((first.resultants, *first.obstacles), (second.resultants, *second.obstacles), strict=True)
    for one, other in pairs:
        for name in RESULTANTS:
            assert np.array_equal(getattr(one, name), getattr(other, name), equal_nan=True), name


@pytest.fixture(scope="module")
def long() -> pc.History:
    """A block that slides, sticks and leaves the plane."""
    return pc.simulate(block(friction=0.4), end=30e-6, courant=0.9)


def test_arrays_follow_from_the_steps(long: pc.History) -> None:
    contact, u = long.contact, long.displacement[:, long.contact_nodes]
    assert np.array_equal(contact.nodes, long.contact_nodes) and contact.time.tobytes() == long.time.tobytes()
    assert contact.force.tobytes() == long.reaction.tobytes()
    # The plane is y = -2e-4, the block's bottom y = 0, of rounding 1e-16 of the displacements.
    assert np.allclose(contact.gap, u[..., 1] + 2e-4, rtol=0, atol=1e-17)
    assert contact.area.sum() == pytest.approx(0.05) and contact.area[0] == pytest.approx(0.05 / 16)
    free = contact.status == pc.ContactStatus.FREE
    assert np.array_equal(~free[:-1], long.touching[1:])
    assert {*np.unique(contact.status)} == {0, 1, 2}
    sliding = np.diff(u[..., 0], axis=0) / np.diff(long.time)[:, None]
    sliding = np.where(free, 0.0, np.append(sliding, sliding[-1:], axis=0))
    # Differences of u of 1e-2 m over 1e-7 s.
    assert np.allclose(contact.sliding_velocity[..., 0], sliding, rtol=0, atol=1e-9) and not contact.sliding_velocity[..., 1].any()
    assert np.abs(contact.sliding_velocity[contact.status == pc.ContactStatus.STICK]).max() < 1e-9
    slips = contact.status == pc.ContactStatus.SLIP
    tangential = np.abs(contact.tangential_force[..., 0])
    assert np.allclose(tangential[slips], 0.4 * contact.normal_force[slips], rtol=1e-12)
    assert np.array_equal(contact.normal_force, long.reaction[..., 1])
    assert np.array_equal(contact.density, long.reaction / contact.area[:, None])
    assert np.array_equal(contact.pressure, contact.density[..., 1])
    mean = (long.reaction[1:, :, 0] + long.reaction[:-1, :, 0]) / 2
    spent = -np.cumsum(mean * np.diff(u[..., 0], axis=0), axis=0)
    assert np.allclose(contact.friction_energy[1:], spent, rtol=0, atol=1e-12 * spent.max())


def test_resultants_are_sums(long: pc.History) -> None:
    contact, total = long.contact, long.contact.resultants
    scale = np.abs(total.force).max()
    touching = contact.status > 0
    assert np.allclose(total.force, contact.force.sum(axis=1), rtol=0, atol=1e-14 * scale)
    assert np.allclose(total.normal_force, contact.normal_force.sum(axis=1), rtol=0, atol=1e-14 * scale)
    assert np.allclose(total.area, touching @ contact.area, rtol=1e-14)
    assert np.array_equal(total.in_contact, touching.sum(axis=1))
    assert np.array_equal(total.slipping, (contact.status == 2).sum(axis=1))
    # Sums of a few thousand terms in another order.
    spent = long.balance.friction
    assert np.allclose(total.friction_energy, spent, rtol=0, atol=1e-12 * spent.max())
    momentum = long.problem.mass @ (long.velocity - long.problem.initial_velocity).transpose(1, 0, 2).reshape(63, -1)
    assert np.allclose(total.impulse, momentum.reshape(-1, 2), rtol=0, atol=1e-10 * np.abs(momentum).max())
    assert np.allclose(contact.impulse.sum(axis=0), total.impulse[-1], rtol=1e-12)
    places = contact.points + long.displacement[:, contact.nodes]
    held = total.in_contact > 0
    centre = np.einsum("nc,ncd->nd", contact.normal_force, places)[held] / total.normal_force[held, None]
    assert np.allclose(total.centre[held], centre, rtol=0, atol=1e-15) and np.isnan(total.centre[~held]).all()
    assert np.array_equal(contact.peak_normal_force, contact.normal_force.max(axis=0))
    weights = np.convolve(np.diff(contact.time), [0.5, 0.5])
    assert np.allclose(contact.time_in_contact, weights @ touching, rtol=1e-12)
    assert np.array_equal(contact.first_touch, contact.time[long.touching.argmax(axis=0)])


@pytest.mark.filterwarnings("ignore::percute.SimulationWarning")
def test_the_bar_is_pressed_for_two_transits() -> None:
    """With Δt = h/c the scheme is exact at the nodes: ρcv₀ for 2L/c."""
    law, speed = bar().material, bar().wave_speed
    step = 0.1 / 40 / speed
    # A fall of three whole steps.
    plane = pc.Plane(point=-3 * step * 400, normal=1)
    problem = pc.Problem(pc.Mesh.bar(0.1, elements=40), material=law, obstacles=[plane], initial_velocity=-400)
    contact = pc.simulate(problem, steps=np.full(100, step)).contact
    assert contact.time_in_contact[0] == pytest.approx(0.2 / speed, rel=1e-12)
    assert contact.first_touch[0] == pytest.approx(4 * step, rel=1e-12)
    # The first multiplier stops the half mass of the end node only.
    expected = np.full(80, 2700 * speed * 400)
    expected[0] /= 2
    assert np.allclose(contact.pressure[3:83, 0], expected, rtol=1e-10) and contact.status.sum() == 2 * 80
    assert not contact.friction_energy.any() and not contact.sliding_velocity.any()


@pytest.mark.parametrize("make", [bar, block])
def test_files_and_pickles_hold_the_same(make: object, tmp_path: Path) -> None:
    assert callable(make)
    problem = make()
    history = pc.simulate(problem, end=13e-6, courant=0.9)
    stored = pc.simulate(problem, end=13e-6, courant=0.9, store=tmp_path / "a.vtkhdf")
    same(history.contact, stored.contact)
    same(history.contact, pickle.loads(pickle.dumps(history)).contact)
    same(history.contact, pickle.loads(pickle.dumps(history.contact)))
    estimate = pc.estimate(stored, instants=3)
    same(history.contact, estimate.contact)
    estimate.save(tmp_path / "e.vtkhdf")
    again = pc.open(tmp_path / "e.vtkhdf")
    assert isinstance(again, pc.Estimate)
    same(history.contact, again.contact)
    unpickled = pickle.loads(pickle.dumps(estimate))
    assert unpickled.contact is None
    unpickled.save(tmp_path / "u.vtkhdf")
    bare = pc.open(tmp_path / "u.vtkhdf")
    assert isinstance(bare, pc.Estimate) and bare.contact is None and len(bare.maps) == 3


def test_another_order_of_rows_and_chunks_change_nothing(block_history: pc.History, tmp_path: Path) -> None:
    """A file that cannot be mapped, with its contact nodes backwards; its arrays are read in blocks."""
    path = tmp_path / "a.vtkhdf"
    pc.simulate(block(), end=13e-6, courant=0.9, store=path)
    with h5py.File(path, "r+") as file:
        for name, flip in (("percute/contact/nodes", 0), ("percute/contact/reaction", 1), ("percute/contact/touching", 1)):
            values = np.flip(file[name][()], flip)
            del file[name]
            file.create_dataset(name, data=values, chunks=True)
        values = file["VTKHDF/PointData/displacement"][()]
        del file["VTKHDF/PointData/displacement"]
        # The file is changed on purpose.
        del file["percute/checksum"], file["percute/checksums"]
        file.create_dataset("VTKHDF/PointData/displacement", data=values, chunks=(50, 3))
    opened = pc.open(path)
    assert isinstance(opened, pc.History)
    assert opened.displacement.tobytes() == block_history.displacement.tobytes()
    assert np.array_equal(opened.reaction[:, ::-1], block_history.reaction)
    assert np.array_equal(opened.touching[:, ::-1], block_history.touching)
    assert np.array_equal(opened.contact_nodes[::-1], block_history.contact.nodes)
    same(block_history.contact, opened.contact)


def test_without_planes_there_is_nothing() -> None:
    problem = pc.Problem(pc.Mesh.rectangle(0.05, 0.04, nx=2, ny=2), material=block().material, initial_velocity=(1, 0))
    history = pc.simulate(problem, end=2e-5, courant=0.9)
    contact = history.contact
    assert contact.force.shape == (len(history), 0, 2) and contact.obstacles == ()
    assert not contact.resultants.force.any() and repr(contact) == f"<percute.Contact: 0 nodes, {len(history)} instants, at most 0 N/m>"
    with pytest.raises(pc.InputError, match="the problem has no planes"):
        contact.plot()


def test_arrays_are_read_only(long: pc.History) -> None:
    contact = long.contact
    for name in (*ARRAYS, "density", "pressure", "normal_force", "tangential_force"):
        assert not getattr(contact, name).flags.writeable, name
    assert not contact.resultants.centre.flags.writeable


def test_the_picture_shows_forces_and_zone(long: pc.History) -> None:
    contact = long.contact
    forces, zone = contact.plot()
    normal, tangential = forces.lines
    assert np.allclose(normal.get_ydata(), contact.resultants.normal_force / 1e6)  # type: ignore[arg-type]
    assert np.allclose(tangential.get_ydata(), contact.resultants.force[:, 0] / 1e6)  # type: ignore[arg-type]
    assert forces.get_ylabel() == "force of contact (MN/m)" and (zone.get_xlabel(), zone.get_ylabel()) == ("t (µs)", "x (mm)")
    drawn = zone.collections[0].get_array()
    assert drawn is not None
    order = np.argsort(contact.points[:, 0])
    assert np.array_equal(np.ma.filled(drawn, 0).reshape(9, -1)[np.argsort(order)][order], contact.status[:-1].T)
    assert [text.get_text() for text in zone.get_legend().get_texts()] == ["stick", "slip"]
    pressure = contact.plot("pressure")[1]
    assert pressure.child_axes[0].get_ylabel() == "pressure (GPa)"
    plt.close("all")


def test_the_picture_of_two_planes_and_of_a_bar(bar_history: pc.History) -> None:
    mesh = pc.Mesh.rectangle(0.03, 0.02, nx=4, ny=3)
    away = np.column_stack([np.zeros(len(mesh.points)), 1e4 * (mesh.points[:, 1] - 0.01)])
    planes = [
        pc.Plane(point=(0, -1e-4), normal=(0, 1), friction=0, group="bottom"),
        pc.Plane(point=(0, 0.0201), normal=(0, -1), friction=0, group="top"),
    ]
    problem = pc.Problem(mesh, material=block().material, obstacles=planes, initial_velocity=away)
    contact = pc.simulate(problem, end=5e-6, courant=0.9).contact
    figure, axes = plt.subplots(3)
    drawn = contact.plot(axes=list(axes))
    assert [each.figure for each in drawn] == [figure] * 3 and drawn[2].get_title() == "plane 1"
    assert len(drawn[0].lines) == 4
    with pytest.raises(pc.InputError, match="3 axes of matplotlib"):
        contact.plot(axes=axes[:2])
    with pytest.raises(pc.InputError, match="status, pressure"):
        contact.plot("force")  # type: ignore[arg-type]
    forces, zone = bar_history.contact.plot("pressure")
    assert len(forces.lines) == 1 and zone.get_yticklabels()[0].get_text() == "node 0"
    plt.close("all")


@pytest.mark.parametrize(("tilt", "end", "courant", "warns"), [(0.0, 0.4e-6, 0.1, True), (0.0, 1e-6, 0.9, False), (10.0, 40e-6, 0.9, False)])
@pytest.mark.filterwarnings("ignore::percute.SimulationWarning")
def test_the_kept_impulse_is_judged_unless_a_node_touches_alone(tilt: float, end: float, courant: float, warns: bool) -> None:
    normal = (np.sin(np.radians(tilt)), np.cos(np.radians(tilt)))
    problem = pc.Problem(
        pc.Mesh.rectangle(0.05, 0.04, nx=10, ny=8),
        material=pc.Elastic(young=70e9, poisson=0.3, density=2700.0, plane="stress"),
        obstacles=[pc.Plane(point=(0.0, -1e-6), normal=normal, friction=0.2)],
        initial_velocity=(0.0, -4.0),
    )
    estimate = pc.estimate(pc.simulate(problem, end=end, courant=courant), threads=1)
    names = [warning["name"] for warning in json.loads(estimate.to_json())["warnings"]]
    # A flat run that ends during the onset of contact keeps 59 %; on its corner the block keeps 87 % until 40 µs.
    assert ("impulse_ratio" in names) == warns
    assert (estimate.impulse_ratio < 0.9) == (warns or tilt > 0.0)
