"""All steps of a simulation: their arrays, in memory or in a file."""

from __future__ import annotations

import json
import os
from collections.abc import Sequence
from functools import cached_property
from pathlib import Path
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from percute import _percute
from percute.balance import Balance
from percute.checks import encodable, flag, instance, vtkhdf, warn, words
from percute.contact import Contact
from percute.errors import InputError
from percute.foreign import ForeignArrays
from percute.immutable import Immutable
from percute.impacts import Impacts
from percute.mapped import MappedArrays
from percute.problem import Problem
from percute.rebound import Rebound
from percute.termination import file_closed_at_signals
from percute.words import counted

__all__ = ["Steps"]


class Steps(Immutable):
    """What a `percute.History` holds."""

    _problem: Problem | None
    _name: str
    _saved: str = ""
    _file: str | None

    def __init__(self) -> None:
        raise TypeError("histories are made by percute.simulate, percute.run, percute.open and History.from_arrays")

    @classmethod
    def from_arrays(
        cls,
        problem: Problem,
        time: ArrayLike,
        displacement: ArrayLike,
        reaction: ArrayLike | None = None,
        touching: ArrayLike | None = None,
        velocity: ArrayLike | None = None,
        acceleration: ArrayLike | None = None,
        contact_nodes: ArrayLike | None = None,
        program: str | None = None,
    ) -> Self:
        """Make a history of the arrays of another program.

        Missing contact forces are derived from the balance M a + K u − F at the nodes of the planes, and a missing touching
        status from gaps and forces; ``derived`` and the report name both.

        Parameters
        ----------
        problem : Problem
            What the other program simulated.
        time : (instants,) floats
            t_n (s), from 0 on.
        displacement : (instants, nodes, dimension) floats
            u_n (m). Of a bar the last axis may be missing, here and below.
        reaction : (instants, contact nodes, dimension) floats, optional
            R_n (N): the forces of the planes on the nodes in the step from t_n to t_{n+1}, in global axes. Those of the last
            instant may be missing, or NaN.
        touching : (instants, contact nodes) booleans, optional
            Whether a node touches at t_n: in percute if and only if R_{n−1} is not zero.
        velocity, acceleration : (instants, nodes, dimension) floats, optional
            v_n (m/s) and a_n (m/s²). By default they follow from the scheme.
        contact_nodes : (contact nodes,) ints, optional
            The nodes of the rows of ``reaction`` and ``touching``, by default `Problem.contact_nodes`. Arrays of all nodes are
            accepted without it.
        program : str, optional
            The name of the other program, for reports.

        Returns
        -------
        History
            In memory, with copies of the arrays.

        Warns
        -----
        InputWarning
            The last instant is left out, because its contact forces are not known.

        Raises
        ------
        InputError
            An array has a wrong shape, is transposed, masked, of half precision or not finite; a node that can touch no plane
            has a contact force.
        """
        arrays = ForeignArrays(instance("problem", problem, Problem), time, displacement, contact_nodes)
        data, notice = _percute.HistoryData.foreign(
            problem._data,
            arrays.time.tolist(),
            arrays.displacement,
            arrays.reaction(reaction),
            arrays.touching(touching),
            arrays.optional("velocity", velocity),
            arrays.optional("acceleration", acceleration),
            words("program", program),
        )
        warn([] if notice is None else [notice])
        return cls._of(data, problem)

    @classmethod
    def _of(cls, data: _percute.HistoryData, problem: Problem | None = None, name: str = "") -> Self:
        history = cls._at(None, problem, name)
        history._data = data
        return history

    @classmethod
    def _at(cls, file: str | None, problem: Problem | None, name: str = "") -> Self:
        """Give a history in a file, which is opened on demand."""
        history = cls.__new__(cls)
        history._file = file
        history._problem = problem
        history._name = name
        return history

    @cached_property
    def _data(self) -> _percute.HistoryData:
        assert self._file is not None
        return _percute.open_history(self._file)

    @property
    def problem(self) -> Problem:
        """The problem that was simulated."""
        if self._problem is None:
            self._problem = Problem._of(self._data.problem)
        return self._problem

    @cached_property
    def time(self) -> NDArray[np.float64]:
        """Instants t_n (s), shape (instants,)."""
        return self._data.times[: self._data.count]

    @cached_property
    def steps(self) -> NDArray[np.int64]:
        """Number of the step of each instant in the run, shape (instants,): 0, 1, 2, … unless a file keeps a part of them."""
        kept = self._data.steps()
        return np.arange(len(self)) if kept is None else kept

    @cached_property
    def displacement(self) -> NDArray[np.float64]:
        """Displacements u_n (m), shape (instants, nodes, dimension), eq. [28]."""
        mapped = self._mapped.checked("displacement")
        return self._data.displacement() if mapped is None else mapped[..., : self.problem.mesh.dimension]

    @cached_property
    def reaction(self) -> NDArray[np.float64]:
        """Reactions R_n of the planes on the contact nodes (N), shape (instants, contact nodes, dimension)."""
        self._expect("reaction")
        mapped = self._mapped.checked("reaction")
        return self._data.reaction() if mapped is None else mapped

    @cached_property
    def touching(self) -> NDArray[np.bool_]:
        """Whether each contact node touches at t_n, shape (instants, contact nodes)."""
        self._expect("reaction")
        mapped = self._mapped.checked("touching")
        # Any byte but 0 means true in the file; a bool of numpy must be 1.
        if mapped is None or mapped.max(initial=0) > 1:
            return self._data.touching()
        return mapped.view(np.bool_)

    @cached_property
    def _mapped(self) -> MappedArrays:
        return MappedArrays(self._data)

    def _expect(self, name: str) -> None:
        """Refuse a field that a thinned history lacks."""
        if name in self._data.lacks():
            told = f"{name} is not in this history, which keeps a part of its run; simulate again with {name!r} among `fields`"
            raise InputError(f"{self.path}: {told}")

    def _displacement_at(self, steps: NDArray[np.intp]) -> NDArray[np.float64]:
        """Give the displacements at some instants, of which alone the checksums are compared."""
        if "displacement" in vars(self) or (view := self._mapped.view("displacement")) is None:
            return self.displacement[steps]
        values = np.ascontiguousarray(view[steps])
        self._mapped.check("displacement", steps, values)
        return values[..., : self.problem.mesh.dimension]

    @cached_property
    def contact_nodes(self) -> NDArray[np.int64]:
        """Nodes of the rows of ``reaction`` and ``touching``, shape (contact nodes,)."""
        return self._data.contact_nodes

    @cached_property
    def path(self) -> Path | None:
        """The file with the steps; None if they are in memory."""
        return self._data.path

    @cached_property
    def _motion(self) -> Sequence[NDArray[np.float64]]:
        return self._data.motion()

    def _moving(self, which: int) -> NDArray[np.float64]:
        """Give velocity or acceleration: by the scheme, or as a thinned history keeps them."""
        if self._data.steps() is None:
            return self._motion[which]
        self._expect(("velocity", "acceleration")[which])
        return self._data.stored_motion(which == 1)

    @cached_property
    def velocity(self) -> NDArray[np.float64]:
        """Velocities v_n (m/s), shape (instants, nodes, dimension), eq. [29], [31]; computed on first access."""
        return self._moving(0)

    @cached_property
    def acceleration(self) -> NDArray[np.float64]:
        """Accelerations a_n (m/s²), shape (instants, nodes, dimension), eq. [30]; computed on first access."""
        return self._moving(1)

    @cached_property
    def balance(self) -> Balance:
        """Energies and works over time (J)."""
        return Balance(time=self.time, per_metre=self.problem.per_metre, **self._data.balance())

    @cached_property
    def contact(self) -> Contact:
        """Contact results at each node, and their resultants; computed on first access."""
        surfaces = [None] * len(self.problem.obstacles) + [group for each in self.problem.contacts for group in each.groups or ()]
        return Contact._of(self._data.contact(), self.problem.mesh, surfaces, self.problem.per_metre)

    @cached_property
    def rebound(self) -> Rebound | None:
        """Velocities before and after contact, restitution and time in contact; None without contact."""
        return Rebound._of(self._rebounds["rebound"])

    @cached_property
    def impacts(self) -> Impacts | None:
        """Velocities of several bodies before and after contact, and restitution at each interface; None of a single body."""
        return Impacts._of(self._rebounds["impacts"])

    @cached_property
    def _rebounds(self) -> dict[str, Any]:
        found: dict[str, Any] = json.loads(self._data.rebound())
        return found

    @property
    def derived(self) -> tuple[str, ...]:
        """The parts of a history of another program that were derived: "reaction", "touching"."""
        return tuple(self._data.derived or ())

    @property
    def program(self) -> str | None:
        """The program that simulated a history of another program, if its name is known."""
        return self._data.program

    @property
    def complete(self) -> bool:
        """Whether all planned steps are present."""
        return self._data.complete

    def save(self, path: str | os.PathLike[str], *, overwrite: bool = False) -> None:
        """Write a history that is in memory into a file, for ``percute estimate``, ``report``, ``info``, ``export`` and `percute.open`.

        It is the file that ``store`` of `simulate` makes, byte by byte. A history of another program stays one. The file gives
        the same arrays and the same estimate, bit by bit. Described in ``docs/history.md``.

        Parameters
        ----------
        path : str or path
            The file, such as ``"history.vtkhdf"``.
        overwrite : bool, default: False
            Whether a file that exists already is replaced.

        Raises
        ------
        InputError
            The history is in a file; copy that instead.
        ExistingFileError, MissingFileError, StorageError
            The file exists already, its folder does not exist, or it cannot be written.
        """
        file, replace = vtkhdf("path", path), flag("overwrite", overwrite)
        if self.path is not None:
            raise InputError(f"the history is in the file {str(self.path)!r}; copy that")
        with file_closed_at_signals(file):
            self._data.save(os.path.abspath(file), replace)
        # A page names the file that was saved last; the history of a case keeps the name of the case.
        if self._name in ("", self._saved):
            self._name = self._saved = encodable(file)

    def __len__(self) -> int:
        return self._data.count

    def __repr__(self) -> str:
        kept = "" if self._data.steps() is None else "part of a run: "
        held = f"{kept}{counted(len(self), 'instant')} to {self.time[-1]:.4g} s"
        planned = "" if self.complete else f" of {len(self._data.times)} planned"
        nodes, dimension = self.problem.mesh.points.shape
        return f"<percute.History: {held}{planned}, {counted(nodes, 'node')}, {dimension}D>"

    def __reduce__(self) -> tuple[Any, ...]:
        if self.path is not None:
            return self._reopen, (str(self.path),)
        arrays = (self.displacement.copy(), self.reaction.copy(), self.touching.copy())
        velocity, acceleration = self._data.supplied
        motion = (self.velocity.copy() if velocity else None, self.acceleration.copy() if acceleration else None)
        origin = None if self._data.derived is None else (self._data.program, self._data.derived)
        return self._rebuild, (self.problem, self._data.times.tolist(), *arrays, self._data.options(), motion, origin)

    @classmethod
    def _reopen(cls, path: str) -> Self:
        return cls._of(_percute.open_history(path), name=path)

    @classmethod
    def _rebuild(cls, problem: Problem, *contents: Any) -> Self:
        return cls._of(_percute.HistoryData.from_arrays(problem._data, *contents), problem)
