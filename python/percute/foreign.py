"""Arrays of other programs: checks of their shapes, and the rows of the contact surface."""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from percute.arrays import integers, numbers
from percute.checks import refuse_masked
from percute.errors import InputError
from percute.problem import Problem

__all__ = ["ForeignArrays"]

SIZES = {"t": "instants", "n": "nodes", "c": "contact nodes", "d": "dimension"}


class ForeignArrays:
    """The arrays of a history, in the shapes of the engine."""

    def __init__(self, problem: Problem, time: ArrayLike, displacement: ArrayLike, contact_nodes: ArrayLike | None) -> None:
        self._surface = problem.contact_nodes
        self.time = _time(time)
        self._sizes = {"t": len(self.time), "n": len(problem.mesh.points), "c": len(self._surface), "d": problem.mesh.dimension}
        self.displacement = self.nodal("displacement", displacement)
        self._listed = None if contact_nodes is None else integers("contact_nodes", contact_nodes, None)
        if self._listed is not None:
            self._check_nodes(self._listed)

    def nodal(self, name: str, given: ArrayLike) -> NDArray[np.float64]:
        """Give a field of all nodes, (instants, nodes, dimension)."""
        return self._shaped(name, _floats(name, given), "tnd")

    def optional(self, name: str, given: ArrayLike | None) -> NDArray[np.float64] | None:
        """Give it unless it is missing."""
        return None if given is None else self.nodal(name, given)

    def reaction(self, given: ArrayLike | None) -> NDArray[np.float64] | None:
        """Give the forces of the contact surface; those of the last instant may be missing, or NaN."""
        if given is None:
            return None
        array = _floats("reaction", given, finite=False)
        if len(array) == len(self.time) - 1 and array.ndim > 1:
            array = np.concatenate([array, np.zeros_like(array[:1])])
        elif len(array) == len(self.time) and np.all(np.isnan(array[-1])):
            array = np.concatenate([array[:-1], np.zeros_like(array[:1])])
        _finite("reaction", array)
        return self._rows("reaction", array, "d")

    def touching(self, given: ArrayLike | None) -> NDArray[np.bool_] | None:
        """Give the status of the contact surface."""
        if given is None:
            return None
        refuse_masked("touching", given)
        array = np.asarray(given)
        if array.dtype.kind not in "bui" or (array.dtype.kind != "b" and (array.min(initial=0) < 0 or array.max(initial=0) > 1)):
            raise InputError(f"`touching` is an array of {array.dtype}; it must hold booleans, or 0 and 1")
        return np.ascontiguousarray(self._rows("touching", array, ""), dtype=np.bool_)

    def _rows(self, name: str, array: NDArray[Any], last: str) -> NDArray[Any]:
        """Give the rows of the contact surface, from those of the listed nodes or of all nodes."""
        listed = self._listed
        if listed is None:
            whole = array.ndim > 1 and array.shape[1] == self._sizes["n"] != self._sizes["c"]
            if not whole:
                return self._shaped(name, array, "tc" + last)
            listed = np.arange(self._sizes["n"])
        array = self._shaped(name, array, "tk" + last, {**self._sizes, "k": len(listed)}, {**SIZES, "k": "rows of nodes"})
        other = ~np.isin(listed, self._surface)
        acts = array.astype(bool).any(axis=(0, *range(2, array.ndim))) & other
        if acts.any():
            node = int(listed[np.flatnonzero(acts)[0]])
            raise InputError(
                f"`{name}` is not zero at node {node}, which can touch no plane of the problem: is the order of the nodes that of the "
                "mesh? Otherwise give forces of contact only, and for each plane of the other program an obstacle"
            )
        found = np.zeros((len(array), self._sizes["c"], *array.shape[2:]), dtype=array.dtype)
        place = {int(node): i for i, node in enumerate(self._surface)}
        for row, node in enumerate(listed.tolist()):
            if node in place:
                found[:, place[node]] = array[:, row]
        return found

    def _shaped(
        self,
        name: str,
        array: NDArray[Any],
        axes: str,
        sizes: dict[str, int] | None = None,
        words: dict[str, str] | None = None,
    ) -> NDArray[Any]:
        """Check a shape; of a bar the last axis may be missing."""
        sizes, words = sizes or self._sizes, words or SIZES
        needed = tuple(sizes[axis] for axis in axes)
        if axes.endswith("d") and sizes["d"] == 1 and array.shape == needed[:-1]:
            array = array[..., None]
        if array.shape == needed:
            return array
        shape = f"`{name}` has the shape {array.shape}; it must have {needed}: ({', '.join(words[axis] for axis in axes)})"
        for order in itertools.permutations(range(array.ndim)):
            if array.ndim == len(needed) and tuple(array.shape[i] for i in order) == needed:
                raise InputError(f"{shape}. It is transposed: give np.transpose({name}, {order})")
        if axes.endswith("d") and array.ndim == len(needed) and array.shape[:-1] == needed[:-1] and array.shape[-1] == 3:
            raise InputError(f"{shape}. Files of VTK have three components: give {name}[..., :{needed[-1]}]")
        raise InputError(shape)

    def _check_nodes(self, listed: NDArray[np.int64]) -> None:
        wrong = listed[(listed < 0) | (listed >= self._sizes["n"])]
        if wrong.size:
            raise InputError(f"`contact_nodes` holds {wrong[0]}; the nodes are 0 to {self._sizes['n'] - 1}")
        nodes, count = np.unique(listed, return_counts=True)
        if (count > 1).any():
            raise InputError(f"`contact_nodes` holds node {nodes[count > 1][0]} twice")


def _time(given: ArrayLike) -> NDArray[np.float64]:
    """Give the instants; equal steps in single precision are made equal again."""
    time = _floats("time", given)
    if time.ndim != 1:
        raise InputError(f"`time` has the shape {time.shape}; it must have (instants,)")
    if np.asarray(given).dtype == np.float32 and len(time) > 1:
        equal = np.linspace(0.0, time[-1], len(time))
        if np.all(np.abs(time - equal) <= 2 * np.finfo(np.float32).eps * abs(time[-1])):
            return equal
    return time


def _floats(name: str, given: ArrayLike, *, finite: bool = True) -> NDArray[np.float64]:
    """Give an array of numbers that are precise enough."""
    array = numbers(name, given, most=3)
    if np.asarray(given).dtype == np.float16:
        raise InputError(f"`{name}` is an array of float16, which has three digits; give float64 or float32")
    if finite:
        _finite(name, array)
    return array


def _finite(name: str, array: NDArray[np.float64]) -> None:
    wrong = np.argwhere(~np.isfinite(array))
    if wrong.size:
        at = tuple(wrong[0].tolist())
        raise InputError(f"`{name}` is {array[at]} at [{', '.join(map(str, at))}]; it must be finite")
