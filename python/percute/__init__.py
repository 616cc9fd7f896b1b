"""Elastic impacts, simulated and certified."""

from percute._percute import __version__

__all__ = ["__version__"]
