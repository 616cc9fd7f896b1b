"""Fields of a history: methods that the class inherits."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from percute import element_fields
from percute.element_fields import Step
from percute.immutable import Immutable

if TYPE_CHECKING:
    from percute.history import History

__all__ = ["HistoryFields"]


class HistoryFields(Immutable):
    """Fields of nodes and elements, and probes."""

    def displacement_at(self: History, step: Step) -> NDArray[np.float64]:  # type: ignore[misc]
        """Give the displacement of each node (m), shape (nodes, dimension); ``step`` as for `strain`.

        Of a history in a file, only these instants are read and compared with their checksums; ``displacement`` compares all.
        """
        chosen, one = element_fields.rows(self, step)
        values = self._displacement_at(chosen)
        return values[0] if one else values

    def strain(self: History, step: Step) -> NDArray[np.float64]:  # type: ignore[misc]
        """Give the strain of each element, eq. [5].

        Parameters
        ----------
        step : int, slice or array of ints
            Which instant; negative ones count from the end. A slice or an array gives several, along the first axis.

        Returns
        -------
        ndarray
            Shape (elements, dimension, dimension).
        """
        return element_fields.element_field(self, "strain", step)

    def stress(self: History, step: Step) -> NDArray[np.float64]:  # type: ignore[misc]
        """Give the stress of each element (Pa), shape (elements, dimension, dimension), eq. [9]; ``step`` as for `strain`."""
        return element_fields.element_field(self, "stress", step)

    def von_mises(self: History, step: Step) -> NDArray[np.float64]:  # type: ignore[misc]
        """Give the von Mises stress of each element (Pa), shape (elements,), with σ_zz in plane strain; ``step`` as for `strain`."""
        return element_fields.element_field(self, "von_mises", step)

    def pressure(self: History, step: Step) -> NDArray[np.float64]:  # type: ignore[misc]
        """Give −⅓ tr σ of each element (Pa), shape (elements,), positive in compression; ``step`` as for `strain`."""
        return element_fields.element_field(self, "pressure", step)

    def strain_energy(self: History, step: Step) -> NDArray[np.float64]:  # type: ignore[misc]
        """Give the strain energy of each element (J), shape (elements,); the sum is that of ``balance``. ``step`` as for `strain`."""
        return element_fields.element_field(self, "strain_energy", step)

    def kinetic_energy(self: History, step: Step) -> NDArray[np.float64]:  # type: ignore[misc]
        """Give the kinetic energy of each element's share of the lumped masses (J), shape (elements,), with v_n; ``step`` as for `strain`."""
        return element_fields.element_field(self, "kinetic_energy", step)

    def probe(  # type: ignore[misc]
        self: History, where: str | ArrayLike, quantity: str = "displacement", *, each: bool = False
    ) -> NDArray[np.float64]:
        """Read a quantity at a point or a group, at all instants.

        Parameters
        ----------
        where : (dimension,) floats or str
            A point of the undeformed body (m), or the name of a group of edges or elements.
        quantity : str, default: "displacement"
            Of the nodes ``displacement``, ``velocity`` or ``acceleration``: linear in an element. Of the elements ``strain``,
            ``stress``, ``von_mises`` or ``pressure``: constant in an element; on an edge between elements that of one of them.
        each : bool, default: False
            For a group: whether each of its nodes (elements), in ascending order, has its own values. Otherwise the result is the
            mean over the length of the edges, or over the area of the elements.

        Returns
        -------
        ndarray
            Shape (instants, …) with the components of the quantity, or (instants, members, …) with ``each``.

        Raises
        ------
        InputError
            The point is outside the body; the message has the nearest point. Or there is no group of this name.
        """
        return element_fields.probe(self, where, quantity, each)
