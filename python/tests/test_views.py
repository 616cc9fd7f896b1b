"""Arrays are read-only views of memory that lives as long as any of them."""

import gc
from collections.abc import Callable

import numpy as np
import percute as pc
import pytest
from conftest import block
from numpy.typing import NDArray

ARRAYS: dict[str, Callable[[pc.History], NDArray[np.generic]]] = {
    "points": lambda h: h.problem.mesh._data.points,
    "cells": lambda h: h.problem.mesh._data.cells,
    "mass": lambda h: h.problem._data.mass,
    "initial_velocity": lambda h: h.problem._data.initial_velocity,
    "time": lambda h: h._data.times,
    "displacement": lambda h: h._data.displacement(),
    "reaction": lambda h: h._data.reaction(),
    "touching": lambda h: h._data.touching(),
}


@pytest.mark.parametrize("name", ARRAYS)
def test_a_view_is_no_copy_and_cannot_be_written(name: str, block_history: pc.History) -> None:
    first, second = ARRAYS[name](block_history), ARRAYS[name](block_history)
    assert first.size > 0 and np.shares_memory(first, second)
    assert not first.flags.writeable and not first.flags.owndata
    with pytest.raises(ValueError, match="WRITEABLE"):
        first.flags.writeable = True
    with pytest.raises(ValueError, match="read-only"):
        first[...] = 0


def test_estimates_show_what_they_hold(block_history: pc.History) -> None:
    data = pc.estimate(block_history, instants=2, fields=True)._data
    assert np.shares_memory(data.by_element(), data.by_element())
    for name in ("kinetic", "accumulated", "displacement", "stress"):
        first, second = data.maps()[1][name], data.maps()[1][name]
        assert np.shares_memory(first, second) and not first.flags.writeable


def test_memory_lives_as_long_as_a_view_of_it() -> None:
    history = pc.simulate(block(), end=5e-6, courant=0.9)
    displacement, row, cells = history.displacement, history.displacement[3, 5], history.problem.mesh.cells
    kept = displacement.copy(), row.copy(), cells.copy()
    del history, displacement
    gc.collect()
    # Memory that had been given back would be taken again by these.
    for _ in range(3):
        pc.simulate(block(friction=0.0), end=5e-6, courant=0.9)
    assert np.array_equal(row, kept[1]) and np.array_equal(cells, kept[2])
    base = row
    while isinstance(base.base, np.ndarray):
        base = base.base
    assert np.array_equal(base, kept[0]) and type(base.base).__name__ == "Owner"


def test_shapes_and_types(block_history: pc.History) -> None:
    history, mesh = block_history, block_history.problem.mesh
    steps, nodes, contact = len(history), len(mesh.points), len(history.contact_nodes)
    shapes = {"time": (steps,), "displacement": (steps, nodes, 2), "velocity": (steps, nodes, 2)}
    shapes |= {"acceleration": (steps, nodes, 2), "reaction": (steps, contact, 2), "touching": (steps, contact)}
    for name, shape in shapes.items():
        array = getattr(history, name)
        assert array.shape == shape and array.dtype == (bool if name == "touching" else np.float64), name
    assert mesh.points.shape == (63, 2) and mesh.cells.shape == (96, 3) and mesh.cells.dtype == np.uint32
    assert np.array_equal(history.contact_nodes, np.arange(9)) and history.touching.any()


def test_velocities_follow_from_displacements(block_history: pc.History) -> None:
    """v_{n+1/2} = (u_{n+1} - u_n)/dt is the mean of v_n and v_{n+1} less a quarter of the change of dt a [29]-[31]."""
    history, dt = block_history, block_history.time[1]
    half = np.diff(history.displacement, axis=0) / dt
    u, v, a = history.displacement, history.velocity, history.acceleration
    # Rounding of u, some 1e-16 of 1e-2 m, over dt of 1e-6 s.
    assert np.abs(half - (v[:-1] + 0.5 * dt * a[:-1])).max() < 1e-9 * 400
    assert np.array_equal(v[0], history.problem.initial_velocity) and np.abs(u[1] - u[0]).max() > 0
