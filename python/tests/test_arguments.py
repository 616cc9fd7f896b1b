"""Every wrong argument is told by its name, before any work is done and any file is made."""

import inspect
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import percute as pc
import pytest
from conftest import bar, block

HUGE, LONG = 10**30, 10**5000
"""Whole numbers beyond those of the machine, and beyond what Python prints."""

POINTS, CELLS = [[0, 0], [1, 0], [0, 1]], [[0, 1, 2]]
NO_NUMBERS: tuple[Any, ...] = ("7", True, np.True_, b"7", [1.0], 1j, object(), LONG)
NO_WHOLES = (*NO_NUMBERS[:-1], 1.5, 1.0, np.float64(2), HUGE, LONG, -1)
NO_FLAGS: tuple[Any, ...] = ("yes", 1, 0, None, [])
NO_PATHS: tuple[Any, ...] = (3, b"file", "", "a\0b", "\ud800", True, ["file"])
NO_TEXTS: tuple[Any, ...] = (3, b"x", True, ["x"], "\ud800")
NO_ARRAYS: tuple[Any, ...] = ("x", object(), [[1.0], [1.0, 2.0]], True, 1j, [None], [LONG], [LONG, 0.5], {})
NO_LISTS: tuple[Any, ...] = (None, 3, [3], [None], "x")
NO_PROGRESS: tuple[Any, ...] = (3, 1, "yes", [], np.ones(2))
NO_AXES: tuple[Any, ...] = (3, "x", True, [])


class Calls:
    """Calls that are right but for the argument that is put in."""

    def __init__(self, block: pc.History, bar: pc.History, folder: Path) -> None:
        self.block, self.bar, self.folder = block, bar, folder
        self.estimated = pc.estimate(bar)
        self.exact = pc.exact.BarImpact(length=0.1, young=70e9, density=2700.0, section=0.02, speed=400.0, gap=2e-4)

    def mesh(self, **wrong: Any) -> object:
        return pc.Mesh(**({"points": POINTS, "cells": CELLS} | wrong))

    def moved(self, **wrong: Any) -> object:
        return pc.Mesh.rectangle(1.0, 1.0, nx=1, ny=1).moved(**({"by": (1.0, 0.0)} | wrong))

    def rotated(self, **wrong: Any) -> object:
        return pc.Mesh.rectangle(1.0, 1.0, nx=1, ny=1).rotated(**({"degrees": 3.0, "about": (1.0, 0.0)} | wrong))

    def rectangle(self, **wrong: Any) -> object:
        return pc.Mesh.rectangle(**({"width": 1.0, "height": 1.0, "nx": 1, "ny": 1} | wrong))

    def disc(self, **wrong: Any) -> object:
        return pc.Mesh.disc(**({"radius": 1.0, "rings": 2} | wrong))

    def uniform_bar(self, **wrong: Any) -> object:
        return pc.Mesh.bar(**({"length": 1.0, "elements": 2} | wrong))

    def elastic(self, **wrong: Any) -> object:
        return pc.Elastic(**({"young": 1.0, "density": 1.0} | wrong))

    def plane(self, **wrong: Any) -> object:
        return pc.Plane(**({"point": (0, 0), "normal": (0, 1), "friction": 0.2} | wrong))

    def support(self, **wrong: Any) -> object:
        return pc.Support(**({"group": "left", "components": "x"} | wrong))

    def traction(self, **wrong: Any) -> object:
        return pc.Traction(**({"group": "left", "value": (0, 1)} | wrong))

    def body_force(self, **wrong: Any) -> object:
        return pc.BodyForce(**({"value": (0, 1)} | wrong))

    def problem(self, **wrong: Any) -> object:
        return pc.Problem(**({"mesh": self.block.problem.mesh, "material": self.block.problem.material} | wrong))

    def simulate(self, **wrong: Any) -> object:
        """With a file, which must not be there in the end."""
        right: dict[str, Any] = {"problem": bar(4), "end": 1e-6, "courant": 0.1, "store": self.folder / "history.vtkhdf"}
        return pc.simulate(**(right | wrong))

    def simulate_step(self, **wrong: Any) -> object:
        return self.simulate(courant=None, **wrong)

    def run(self, **wrong: Any) -> object:
        text = (Path(__file__).parents[2] / "examples" / "bar.toml").read_text()
        right: dict[str, Any] = {"case": text, "store": self.folder / "history.vtkhdf"}
        return pc.run(**(right | wrong))

    def estimate(self, **wrong: Any) -> object:
        return pc.estimate(**({"history": self.bar} | wrong))

    def open(self, **wrong: Any) -> object:
        return pc.open(**wrong)

    def save(self, **wrong: Any) -> object:
        self.estimated.save(**({"path": self.folder / "error.vtkhdf"} | wrong))
        return None

    def worst_elements(self, **wrong: Any) -> object:
        return self.estimated.worst_elements(**wrong)

    def plot_map(self, **wrong: Any) -> object:
        return self.estimated.plot_map(**wrong)

    def plot_over_time(self, **wrong: Any) -> object:
        return self.estimated.plot_over_time(**wrong)

    def plot(self, **wrong: Any) -> object:
        return self.block.plot(**wrong)

    def plot_energies(self, **wrong: Any) -> object:
        return self.block.plot_energies(**wrong)

    def probe(self, **wrong: Any) -> object:
        return self.block.probe(**({"where": "bottom"} | wrong))

    def stress(self, **wrong: Any) -> object:
        return self.block.stress(**({"step": 0} | wrong))

    def animate(self, **wrong: Any) -> object:
        return self.block.animate(**({"path": self.folder / "block.gif"} | wrong))  # type: ignore[func-returns-value]

    def plot_pressure(self, **wrong: Any) -> object:
        return self.estimated.plot_pressure(**wrong)

    def plot_bar(self, **wrong: Any) -> object:
        return self.bar.plot(**wrong)

    def to_pandas(self, **wrong: Any) -> object:
        return self.block.to_pandas(**({"over": "nodes"} | wrong))

    def to_xarray(self, **wrong: Any) -> object:
        return self.block.to_xarray(**wrong)

    def bar_impact(self, **wrong: Any) -> object:
        right = {"length": 0.1, "young": 7e10, "density": 2700.0, "section": 0.02, "speed": 400.0, "gap": 2e-4}
        return pc.exact.BarImpact(**(right | wrong))

    def displacement(self, **wrong: Any) -> object:
        return self.exact.displacement(**({"x": 0.0, "t": 0.0} | wrong))

    def true_error(self, **wrong: Any) -> object:
        return self.exact.error(**wrong)

    def effectivity(self, **wrong: Any) -> object:
        return self.exact.effectivity(**({"estimate": self.estimated} | wrong))


NAN = float("nan")
TABLE: list[tuple[Callable[..., object], str, tuple[Any, ...]]] = [
    (Calls.mesh, "points", (None, *NO_ARRAYS, [[[0.0]]])),
    (Calls.mesh, "cells", (None, *NO_ARRAYS, [[0.0, 1.0, 2.0]], [[0, 1, HUGE]], np.array([[0, 1, 2**63]], np.uint64))),
    (Calls.mesh, "edge_groups", (3, [], "x", {3: [[0, 1]]}, {"a": None}, {"a": [[0.5, 1.0]]}, {"\ud800": [[0, 1]]})),
    (Calls.mesh, "element_groups", (3, [], "x", {3: [0]}, {"a": None}, {"a": [0.5]}, {"a": 0}, {None: [0]})),
    (Calls.moved, "by", (None, *NO_ARRAYS, 1.0, NAN)),
    (Calls.rotated, "degrees", (None, *NO_NUMBERS, NAN)),
    (Calls.rotated, "about", (None, *NO_ARRAYS, 1.0, NAN)),
    (Calls.rectangle, "width", (None, *NO_NUMBERS, NAN, 0, -1.0)),
    (Calls.rectangle, "height", (None, *NO_NUMBERS, NAN, 0, -1.0)),
    (Calls.rectangle, "diagonals", (None, *NO_TEXTS, "left")),
    (Calls.rectangle, "nx", (None, *NO_WHOLES, 0, 10**9)),
    (Calls.rectangle, "ny", (None, *NO_WHOLES, 0, 10**9)),
    (Calls.disc, "radius", (None, *NO_NUMBERS, NAN, 0, -1.0)),
    (Calls.disc, "rings", (None, *NO_WHOLES, 0, 1826)),
    (Calls.uniform_bar, "length", (None, *NO_NUMBERS, NAN)),
    (Calls.uniform_bar, "elements", (None, *NO_WHOLES, 0, 10**9)),
    (Calls.elastic, "young", (None, *NO_NUMBERS)),
    (Calls.elastic, "density", (None, *NO_NUMBERS)),
    (Calls.elastic, "thickness", (None, *NO_NUMBERS)),
    (Calls.elastic, "poisson", NO_NUMBERS),
    (Calls.elastic, "section", NO_NUMBERS),
    (Calls.elastic, "plane", (*NO_TEXTS, "x", np.zeros(2))),
    (Calls.plane, "point", (None, *NO_ARRAYS, [[0.0, 0.0]])),
    (Calls.plane, "normal", (None, *NO_ARRAYS, [[0.0, 0.0]])),
    (Calls.plane, "friction", (None, *NO_NUMBERS)),
    (Calls.plane, "group", NO_TEXTS),
    (Calls.support, "group", (None, *NO_TEXTS)),
    (Calls.support, "components", (None, 3, [3], ["x", "x"], b"x", "xy", "w", ())),
    (Calls.support, "velocity", NO_ARRAYS),
    (Calls.support, "time", NO_ARRAYS),
    (Calls.traction, "group", (None, *NO_TEXTS)),
    (Calls.traction, "value", (None, *NO_ARRAYS)),
    (Calls.traction, "time", NO_ARRAYS),
    (Calls.traction, "profile", (3, "x", (1.0,), ("x", (0, 0)), (1.0, "x"), (True, (0, 0)))),
    (Calls.body_force, "value", (None, *NO_ARRAYS)),
    (Calls.body_force, "group", NO_TEXTS),
    (Calls.problem, "mesh", (None, 3, "x")),
    (Calls.problem, "material", (None, 3, "x", {"a": 3}, {3: None}, {}, {3: pc.Elastic(young=1, density=1)})),
    *((Calls.problem, name, NO_LISTS) for name in ("obstacles", "supports", "tractions", "body_forces")),
    (Calls.problem, "initial_velocity", (*NO_ARRAYS, [NAN, 0.0], 3.0)),
    (Calls.problem, "initial_displacement", (*NO_ARRAYS, [NAN, 0.0])),
    (Calls.simulate, "problem", (None, 3, "x")),
    (Calls.simulate, "end", (None, *NO_NUMBERS, NAN, -1.0, float("inf"))),
    (Calls.simulate, "courant", (None, *NO_NUMBERS, NAN, 0, 2.0)),
    (Calls.simulate_step, "step", (None, *NO_NUMBERS, NAN, 0, 1.0)),
    (Calls.simulate_step, "steps", (*NO_ARRAYS, [NAN], [], [[1e-7]])),
    (Calls.simulate, "store", NO_PATHS),
    (Calls.simulate, "overwrite", NO_FLAGS),
    (Calls.simulate, "progress", NO_PROGRESS),
    (Calls.run, "case", (None, *NO_PATHS, "\n\ud800")),
    (Calls.run, "store", NO_PATHS),
    (Calls.run, "overwrite", NO_FLAGS),
    (Calls.run, "threads", (*NO_WHOLES, 0, 1025)),
    (Calls.run, "window", (*NO_WHOLES, 0)),
    (Calls.run, "progress", NO_PROGRESS),
    (Calls.estimate, "history", (None, 3, "x")),
    (Calls.estimate, "reconstruction", (*NO_TEXTS, "", "blunt")),
    (Calls.estimate, "acceleration", (*NO_TEXTS, "", "blunt")),
    (Calls.estimate, "every", (*NO_WHOLES, 0)),
    (Calls.estimate, "threads", (*NO_WHOLES, 0, 1025, 20000)),
    (Calls.estimate, "window", (*NO_WHOLES, 0, 2**64)),
    (Calls.estimate, "instants", ("x", True, -1, 0, HUGE, LONG, [NAN], [-1.0], [], 1j)),
    (Calls.estimate, "fields", (*NO_FLAGS, True)),
    (Calls.estimate, "progress", NO_PROGRESS),
    (Calls.open, "path", (None, *NO_PATHS)),
    (Calls.save, "path", (None, *NO_PATHS)),
    (Calls.save, "overwrite", NO_FLAGS),
    (Calls.worst_elements, "n", (None, *NO_WHOLES, 10**20)),
    (Calls.plot_map, "axes", NO_AXES),
    (Calls.plot_over_time, "axes", NO_AXES),
    (Calls.to_pandas, "over", (None, *NO_TEXTS, "space")),
    (Calls.to_pandas, "step", (*NO_NUMBERS, 1.5, HUGE, 10000)),
    (Calls.to_xarray, "fields", (None, 3, "x", [3], ["displacement", None])),
    (Calls.plot, "axes", NO_AXES),
    (Calls.plot, "quantity", (None, *NO_TEXTS, np.zeros(2), "x")),
    (Calls.plot, "step", (None, *NO_NUMBERS, 1.5, HUGE, 10000)),
    (Calls.plot, "scale", (None, *NO_NUMBERS, NAN, float("inf"))),
    (Calls.plot_map, "scale", (None, *NO_NUMBERS, NAN, float("inf"))),
    (Calls.plot_over_time, "by", (None, *NO_TEXTS, "x")),
    (Calls.plot_energies, "axes", NO_AXES),
    (Calls.plot_energies, "save", (*NO_PATHS, "x.gif")),
    (Calls.plot_energies, "overwrite", NO_FLAGS),
    (Calls.probe, "where", (None, *NO_ARRAYS, 3.0, [NAN, 0.0], [1.0, 1.0])),
    (Calls.probe, "quantity", (None, *NO_TEXTS, "x")),
    (Calls.probe, "each", NO_FLAGS),
    (Calls.stress, "step", (None, *NO_NUMBERS[:4], 1.5, HUGE, 10000, [10000], slice("a"))),
    (Calls.animate, "path", (None, *NO_PATHS, "x.png")),
    (Calls.animate, "quantity", (*NO_TEXTS, "x")),
    (Calls.animate, "frames", (None, *NO_WHOLES, 1)),
    (Calls.animate, "rate", (None, *NO_NUMBERS, NAN, 0.0, 1000.0)),
    (Calls.animate, "scale", (None, *NO_NUMBERS, NAN)),
    (Calls.animate, "overwrite", NO_FLAGS),
    (Calls.animate, "progress", NO_PROGRESS),
    (Calls.plot_pressure, "plane", (*NO_WHOLES, 5)),
    (Calls.plot_bar, "scale", (None, *NO_NUMBERS, NAN)),
    *((Calls.bar_impact, name, (None, *NO_NUMBERS, NAN, 0)) for name in ("length", "young", "gap")),
    (Calls.displacement, "x", (None, *NO_ARRAYS, NAN, 0.2)),
    (Calls.displacement, "t", (None, *NO_ARRAYS, NAN)),
    (Calls.true_error, "history", (None, 3)),
    (Calls.effectivity, "estimate", (None, 3)),
    (Calls.effectivity, "history", (3,)),
]


@pytest.fixture(scope="module")
def calls(
    block_history: pc.History, bar_history: pc.History, tmp_path_factory: pytest.TempPathFactory
) -> Calls:
    return Calls(block_history, bar_history, tmp_path_factory.mktemp("calls"))


@pytest.mark.parametrize(("call", "name", "values"), TABLE, ids=[f"{call.__name__}-{name}" for call, name, _ in TABLE])
def test_a_wrong_argument_is_named(call: Callable[..., object], name: str, values: tuple[Any, ...], calls: Calls) -> None:
    for value in values:
        with pytest.raises(pc.InputError) as raised:
            call(calls, **{name: value})
        message = str(raised.value)
        assert re.search(rf"`{name}\b", message) and len(message) < 300 and "\n" not in message, message
        assert not list(calls.folder.iterdir()), message


def test_all_calls_are_right_but_for_the_wrong_argument(calls: Calls) -> None:
    for call in {call for call, _, _ in TABLE} - {Calls.simulate_step, Calls.open, Calls.true_error}:
        call(calls)
        for file in calls.folder.iterdir():
            file.unlink()
    plt.close("all")


def test_numbers_of_other_kinds_are_taken() -> None:
    lengths: tuple[Any, Any] = np.float32(0.5), np.array(1.0)
    counts: dict[str, Any] = {"nx": np.int8(2), "ny": np.array(3)}
    mesh = pc.Mesh.rectangle(*lengths, **counts)
    assert len(mesh.cells) == 12 and mesh.points[-1].tolist() == [0.5, 1.0]


def test_the_most_elements_are_those_of_the_generators() -> None:
    with pytest.raises(pc.InputError, match="it must be a whole number from 1 to 20000000"):
        pc.Mesh.rectangle(1.0, 1.0, nx=20_000_001, ny=1)
    with pytest.raises(pc.InputError, match="a number of elements from 1 to 20 000 000"):
        pc.Mesh.rectangle(1.0, 1.0, nx=20_000_000, ny=2)


def test_a_message_tells_value_and_way_out(calls: Calls) -> None:
    table: list[tuple[Callable[..., object], dict[str, Any], str]] = [
        (calls.estimate, {"threads": 2000}, "`threads` is 2000; it must be a whole number from 1 to 1024"),
        (calls.estimate, {"fields": True}, "`fields` needs `instants`: give the number of instants"),
        (calls.simulate, {"progress": 3}, "`progress` is 3; it must be True, False or a function"),
        (calls.simulate, {"store": b"x"}, "`store` is b'x'; it must be the name of a file"),
        (calls.rectangle, {"nx": LONG}, "`nx` is of the type int; it must be a whole number from 1 to"),
        (calls.mesh, {"edge_groups": {3: []}}, "`edge_groups` has the key 3; it must be the name of a group"),
        (calls.plot_map, {"axes": 3}, "`axes` is 3; it must be axes of matplotlib"),
    ]
    for call, arguments, message in table:
        with pytest.raises(pc.InputError, match=re.escape(message)):
            call(**arguments)


def test_representations_are_short(calls: Calls) -> None:
    estimate = pc.estimate(calls.block, instants=2, fields=True)
    assert re.fullmatch(r"<percute.OverTime: \d+ samples to 1.3e-05 s, sup of η \S+ J>", repr(estimate.over_time))
    assert repr(estimate.maps) == (
        "(<percute.ElementMap: 96 elements at 0 s, with fields>, <percute.ElementMap: 96 elements at 1.3e-05 s, with fields>)"
    )
    count = len(calls.block)
    assert re.fullmatch(rf"<percute.Balance: {count} instants, energy drift \S+, impulse drift \S+>", repr(calls.block.balance))
    error = calls.exact.error(calls.bar)
    assert re.fullmatch(r"<percute.TrueError: sup \S+ J\^½, mean \S+ J\^½, \d+ instants>", repr(error))


def test_an_interruption_before_the_first_step_has_no_history(monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupted(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("percute._percute.simulate", interrupted)
    with pytest.raises(KeyboardInterrupt) as raised:
        pc.simulate(block(), end=1e-6, courant=0.9)
    assert raised.value.history is None  # type: ignore[attr-defined]


def test_public_functions_have_no_private_arguments() -> None:
    for name in pc.__all__:
        public = getattr(pc, name)
        members = [each for key, each in vars(public).items() if not key.startswith("_")] if inspect.isclass(public) else [public]
        for member in filter(inspect.isfunction, members):
            assert not [key for key in inspect.signature(member).parameters if key.startswith("_")], (name, member)
