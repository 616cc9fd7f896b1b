"""Tables of pandas and data sets of xarray (the extras ``pandas`` and ``xarray``)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from percute._percute import __version__
from percute.checks import one_of
from percute.contents import AXES, Contents, Quantity
from percute.errors import InputError, PercuteError

if TYPE_CHECKING:
    import pandas as _pandas
    import xarray as _xarray

VECTORS = ("component", "component2")


def pandas() -> Any:
    """Give pandas."""
    try:
        import pandas
    except ImportError as error:
        raise PercuteError('tables need pandas: pip install "percute[pandas]", or pip install pandas') from error
    return pandas


def xarray() -> Any:
    """Give xarray."""
    try:
        import xarray
    except ImportError as error:
        raise PercuteError('data sets need xarray: pip install "percute[xarray]", or pip install xarray') from error
    return xarray


def to_pandas(contents: Contents, over: object, known: dict[str, tuple[str, ...]]) -> _pandas.DataFrame:
    """Make a table of the quantities with some dimensions, one row for each place, one column for each component.

    ``known`` has the dimensions by the names that ``over`` may have.
    """
    frames = pandas()
    dims = known[one_of("over", over, known)]
    # Only maps may be missing.
    if not set(dims) <= set(contents.coordinates):
        raise InputError(f"`over` is {over!r}, but the estimate has no maps; ask for them with `instants`")
    columns: dict[str, NDArray[Any]] = {}
    units: dict[str, str] = {}
    for name, quantity in {**contents.coordinates, **contents.quantities}.items():
        if name in (*dims, *VECTORS) or not _fits(name, quantity, dims, contents):
            continue
        for column, values in _columns(name, quantity, dims, contents):
            columns[column], units[column] = values, quantity.unit
    labels = [contents.coordinates[name].values for name in dims]
    index = frames.Index(labels[0], name=dims[0]) if len(dims) == 1 else frames.MultiIndex.from_product(labels, names=dims)
    table = frames.DataFrame(columns, index=index)
    table.attrs["units"] = {name: contents.coordinates[name].unit for name in dims} | units
    table.attrs.update(contents.facts)
    return table


def _fits(name: str, quantity: Quantity, dims: tuple[str, ...], contents: Contents) -> bool:
    """Tell whether a quantity belongs into a table: of its dimensions, or a place of one of them."""
    own = tuple(each for each in quantity.dims if each not in VECTORS)
    return own == dims or (name in contents.coordinates and len(own) == 1 and own[0] in dims and name != own[0])


def _columns(name: str, quantity: Quantity, dims: tuple[str, ...], contents: Contents) -> list[tuple[str, NDArray[Any]]]:
    """Give the columns of a quantity; a symmetric tensor has its upper half."""
    counts = [len(contents.coordinates[each].values) for each in dims]
    own = [each for each in quantity.dims if each not in VECTORS]
    values = quantity.values
    if len(own) < len(dims):
        shape = [count if each in own else 1 for each, count in zip(dims, counts, strict=True)]
        values = np.broadcast_to(values.reshape(shape), counts)
    flat = values.reshape(int(np.prod(counts)), *values.shape[len(dims) :])
    if flat.ndim == 1:
        return [(name, flat)]
    if flat.ndim == 2:
        return [(f"{name}_{AXES[i]}", flat[:, i]) for i in range(flat.shape[1])]
    return [(f"{name}_{AXES[i]}{AXES[j]}", flat[:, i, j]) for i in range(flat.shape[1]) for j in range(i, flat.shape[2])]


def to_xarray(contents: Contents) -> _xarray.Dataset:
    """Make a data set of all quantities."""
    library = xarray()
    used = {dimension for quantity in contents.quantities.values() for dimension in quantity.dims}
    coordinates = {name: _variable(each) for name, each in contents.coordinates.items() if set(each.dims) <= used}
    quantities = {name: _variable(each) for name, each in contents.quantities.items()}
    found: _xarray.Dataset = library.Dataset(quantities, coordinates, {"source": f"percute {__version__}"} | contents.facts)
    return found


def _variable(quantity: Quantity) -> tuple[tuple[str, ...], NDArray[Any], dict[str, str]]:
    attributes = {"long_name": quantity.text}
    # Truth values and names of axes have no unit.
    if quantity.values.dtype.kind in "fiu":
        attributes["units"] = quantity.unit
    return quantity.dims, quantity.values, attributes
