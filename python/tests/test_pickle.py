"""Pickles and copies are the same, bit by bit."""

import copy
import pickle
from pathlib import Path

import numpy as np
import percute as pc
import pytest
from conftest import bar, block
from test_statement import stack


@pytest.mark.parametrize("make", [bar, block, stack])
def test_a_pickled_problem_is_the_same(make: object) -> None:
    assert callable(make)
    problem = make()
    again = pickle.loads(pickle.dumps(problem))
    assert again.critical_time_step == problem.critical_time_step
    for name in ("mass", "initial_velocity", "initial_displacement", "contact_nodes"):
        assert np.array_equal(getattr(again, name), getattr(problem, name)), name
    for name in ("material", "obstacles", "supports", "tractions", "body_forces"):
        assert getattr(again, name) == getattr(problem, name), name
    for name in ("points", "cells"):
        assert np.array_equal(getattr(again.mesh, name), getattr(problem.mesh, name)), name
    assert {name: edges.tolist() for name, edges in again.mesh.edge_groups.items()} == {
        name: edges.tolist() for name, edges in problem.mesh.edge_groups.items()
    }
    first, second = (pc.simulate(p, end=4e-6, courant=0.9) for p in (problem, again))
    assert first.displacement.tobytes() == second.displacement.tobytes()


def same_history(first: pc.History, second: pc.History) -> None:
    for name in ("time", "displacement", "velocity", "reaction", "touching"):
        assert getattr(first, name).tobytes() == getattr(second, name).tobytes(), name
    for name in ("kinetic", "friction", "energy_drift"):
        assert np.array_equal(getattr(first.balance, name), getattr(second.balance, name)), name


def test_a_pickled_history_is_the_same(block_history: pc.History, tmp_path: Path) -> None:
    same_history(block_history, pickle.loads(pickle.dumps(block_history)))
    stored = pc.simulate(block(), end=13e-6, courant=0.9, store=tmp_path / "block.vtkhdf")
    again = pickle.loads(pickle.dumps(stored))
    assert again.path == stored.path
    same_history(block_history, again)


@pytest.mark.parametrize("fields", [False, True])
def test_a_pickled_estimate_is_the_same(fields: bool, block_history: pc.History) -> None:
    estimate = pc.estimate(block_history, reconstruction="published", every=2, instants=3, fields=fields)
    again = pickle.loads(pickle.dumps(estimate))
    assert again.history is None and again._measures == estimate._measures
    assert (again.parts, again.options, again.supplied) == (estimate.parts, estimate.options, estimate.supplied)
    assert dict(again.residuals) == dict(estimate.residuals) and again.to_json() == estimate.to_json()
    assert again.by_element.tobytes() == estimate.by_element.tobytes()
    assert again.worst_elements(3) == estimate.worst_elements(3)
    for name in ("time", "kinetic", "elastic", "contact", "total", "reference"):
        assert getattr(again.over_time, name).tobytes() == getattr(estimate.over_time, name).tobytes(), name
    assert len(again.maps) == 3
    for first, second in zip(again.maps, estimate.maps, strict=True):
        for name, value in vars(second).items():
            assert np.array_equal(getattr(first, name), value), name
        assert (first.stress is not None) == fields


def test_an_estimate_without_contact_says_why(block_history: pc.History, tmp_path: Path) -> None:
    estimate = pc.estimate(block_history)
    assert estimate.contact is not None and estimate.no_contact is None
    again = pickle.loads(pickle.dumps(estimate))
    assert again.contact is None and again.no_contact is not None and "unpickled without its history" in again.no_contact
    for call in (again.plot_force, again.plot_pressure):
        with pytest.raises(pc.InputError, match="there is nothing to draw: the estimate was unpickled without its history, .*; pickle both"):
            call()
    again.save(tmp_path / "again.vtkhdf")
    stored = pc.open(tmp_path / "again.vtkhdf")
    assert isinstance(stored, pc.Estimate) and stored.contact is None and (stored.no_contact or "").startswith("the file has no contact results")


def test_copies_need_no_room(block_history: pc.History) -> None:
    estimate = pc.estimate(block_history)
    for each in (block_history.problem.mesh, block_history.problem, block_history, estimate):
        assert copy.copy(each) is each and copy.deepcopy(each) is each


def test_values_and_exact_bars() -> None:
    exact = pc.exact.BarImpact(length=0.1, young=70e9, density=2700, section=0.02, speed=400, gap=2e-4)
    for value in (exact, *stack().supports, *stack().tractions):
        assert pickle.loads(pickle.dumps(value)) == value == copy.deepcopy(value)
