"""How an exact solution measures the error of its simulations."""

from __future__ import annotations

from abc import ABC, abstractmethod

from percute.checks import instance
from percute.errors import InputError
from percute.estimation import Estimate
from percute.history import History
from percute.true_error import Effectivity, TrueError

__all__ = ["Compared"]


class Compared(ABC):
    """An exact solution that gives the true error of its simulations."""

    @abstractmethod
    def error(self, history: History) -> TrueError:
        """Give the true error of a simulation, eq. [60]."""

    def effectivity(self, estimate: Estimate, history: History | None = None) -> Effectivity:
        """Give the estimated over the true error, for the largest and the mean one.

        Parameters
        ----------
        estimate : Estimate
            The estimate.
        history : History, optional
            What it is the estimate of; needed only if the estimate comes from a file.
        """
        instance("estimate", estimate, Estimate)
        measured = history if history is not None else estimate.history
        if measured is None:
            raise InputError("`history` is missing: an estimate from a file does not hold it")
        return estimate.effectivity(self.error(measured))
