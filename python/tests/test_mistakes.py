"""What `tests/mistakes.toml` says that users get wrong is told in words that help. Run as a program, it prints all messages."""

import os
import re
import shutil
import subprocess
import sys
import tempfile
import tomllib
import traceback
import warnings
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import percute as pc
import pytest
from conftest import bar, block

TABLE = Path(__file__).parents[2] / "tests" / "mistakes.toml"
MISTAKES: list[dict[str, Any]] = tomllib.loads(TABLE.read_text(encoding="utf-8"))["mistake"]
DEBUG = re.compile(r"\b(Some|Err|Ok)\(|\w \{ \w+: |panicked|unwrap|called `")
"""What Rust prints for its programmers."""


def names_of(folder: Path) -> dict[str, Any]:
    """Give the names that the expressions of the table use."""

    def problem(**changes: Any) -> pc.Problem:
        """The block of the paper with changes."""
        good = block(4, 3)
        stated: dict[str, Any] = {"mesh": good.mesh, "material": good.material, "obstacles": good.obstacles, "initial_velocity": (400, -400)}
        return pc.Problem(**(stated | changes))

    def elastic(**changes: Any) -> pc.Elastic:
        stated: dict[str, Any] = {"young": 70e9, "poisson": 0.3, "density": 2700.0, "plane": "stress"}
        return pc.Elastic(**(stated | changes))

    def simulate(given: pc.Problem | None = None, **changes: Any) -> pc.History:
        stated: dict[str, Any] = {"end": 5e-6, "courant": 0.9, "progress": stop}
        return pc.simulate(given or problem(), **(stated | changes))

    triangle: dict[str, Any] = {"points": [[0, 0], [1, 0], [0, 1]], "cells": [[0, 1, 2]]}
    return {
        "np": np,
        "pc": pc,
        "folder": folder,
        "problem": problem,
        "beam": bar(4),
        "elastic": elastic,
        "simulate": simulate,
        "history": pc.open(folder / "history.vtkhdf"),
        "estimate": pc.open(folder / "estimate.vtkhdf"),
        "mesh": lambda **changes: pc.Mesh(**(triangle | changes)),
        "nan": float("nan"),
    }


class Stopped(Exception):
    """A run that was only to warn."""


def stop(_: pc.Progress) -> None:
    raise Stopped


def case_of(mistake: dict[str, Any]) -> str | None:
    """Give the text of the case with the mistake, if it is one in a case."""
    text: str | None = mistake.get("text")
    if text is None and "change" in mistake:
        text = (TABLE.parent / "bases" / f"{mistake.get('base', 'block')}.toml").read_text(encoding="utf-8")
        for old, new in mistake["change"]:
            text = text.replace(old, new)
    return text


def told_of(call: Callable[[], object], mistake: dict[str, Any]) -> list[str]:
    """Give what is raised or warned of, which must be percute's own and must come from its package."""
    if "warning" in mistake:
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            try:
                call()
            except (Stopped, pc.PercuteError, MemoryError):
                pass  # The cause of the warning was a mistake indeed.
        assert all(issubclass(warning.category, pc.InputWarning) for warning in caught)
        # The line of the user's own that is shown must be the one that called.
        assert all(Path(warning.filename) == Path(__file__) or warning.filename == "<string>" for warning in caught)
        return [str(warning.message) for warning in caught]
    # Python's own class where a name of an argument is wrong.
    with pytest.raises((pc.PercuteError, TypeError)) as raised:
        call()
    assert type(raised.value).__name__ == mistake.get("raises", "FileFormatError" if "damage" in mistake else "InputError")
    last = Path(traceback.extract_tb(raised.value.__traceback__)[-1].filename)
    assert Path(pc.__file__).parent in last.parents, f"raised in {last}"
    assert raised.value.__cause__ is None or raised.value.__suppress_context__ or isinstance(raised.value, OSError)
    return [str(raised.value)]


def judge(mistake: dict[str, Any], told: list[str], begins: str, says: str = "says") -> None:
    """Check the words of the message that begins so."""
    messages = [message for message in told if message.startswith(begins)]
    assert messages, f"none begins with {begins!r}: {told}"
    for phrase in mistake.get(says, mistake["says"]):
        assert phrase in messages[0], f"it does not say {phrase!r}: {messages[0]}"
    assert not [phrase for phrase in mistake.get("unsaid", []) if phrase in " ".join(told)], told
    assert not DEBUG.search(messages[0].splitlines()[0]), messages[0]


def shell(folder: Path, *arguments: str) -> tuple[int, str]:
    command = [sys.executable, "-m", "percute", *arguments]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    return done.returncode, done.stderr


def prepared(folder: Path) -> Path:
    """Fill a folder as the head of the table says."""
    shutil.copy(TABLE.parent / "bases" / "block.toml", folder / "case.toml")
    history = pc.simulate(block(4, 3), end=5e-6, courant=0.9, store=folder / "history.vtkhdf")
    pc.estimate(history, instants=2).save(folder / "estimate.vtkhdf")
    (folder / "notes.txt").write_text("The block fell.\n")
    (folder / "empty").mkdir()
    return folder


def damaged(mistake: dict[str, Any], good: Path, bad: Path) -> None:
    """Make a file that is damaged."""
    names: dict[str, Any] = {"np": np, "nan": float("nan"), "h5py": h5py}
    if mistake["damage"].startswith("b"):
        bad.write_bytes(eval(mistake["damage"], names | {"b": good.read_bytes()}))
        return
    shutil.copy(good, bad)
    with h5py.File(bad, "r+") as f:
        exec(mistake["damage"], names | {"f": f})


def parametrized(key: str) -> pytest.MarkDecorator:
    mistakes = [mistake for mistake in MISTAKES if (case_of(mistake) is not None if key == "case" else key in mistake)]
    return pytest.mark.parametrize("mistake", mistakes, ids=[mistake["name"] for mistake in mistakes])


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return prepared(tmp_path_factory.mktemp("mistakes"))


@pytest.fixture
def inside(folder: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """Work in the folder, in which nothing may be made."""
    monkeypatch.chdir(folder)
    before = sorted(folder.rglob("*"))
    yield folder
    assert sorted(folder.rglob("*")) == before


@parametrized("case")
def test_cases(mistake: dict[str, Any], tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "case.toml").write_text(case_of(mistake) or "", encoding="utf-8")
    if "mesh" in mistake:
        (tmp_path / "block.msh").write_text(mistake["mesh"], encoding="utf-8")
    place = f"{mistake['place']}: " if "place" in mistake else ""
    told = told_of(lambda: pc.run("case.toml", progress=stop), mistake)
    judge(mistake, told, f"case.toml:{mistake['line']}: {place}")
    assert {file.name for file in tmp_path.iterdir()} <= {"case.toml", "block.msh"}


@parametrized("python")
def test_calls(mistake: dict[str, Any], inside: Path) -> None:
    judge(mistake, told_of(lambda: eval(mistake["python"], names_of(inside)), mistake), mistake["argument"], "python_says")


@parametrized("damage")
def test_files(mistake: dict[str, Any], folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    kind = mistake.get("of", "history")
    damaged(mistake, folder / f"{kind}.vtkhdf", tmp_path / "bad.vtkhdf")

    def use() -> object:
        opened = pc.open("bad.vtkhdf")
        return pc.estimate(opened) if isinstance(opened, pc.History) else opened.by_element

    judge(mistake, told_of(use, mistake), str(tmp_path / "bad.vtkhdf"))
    code, said = shell(tmp_path, "estimate" if kind == "history" else "info", "bad.vtkhdf")
    assert code == mistake.get("code", 2)
    judge(mistake, [said], "error: bad.vtkhdf")


def main() -> None:
    """Print each message of the table, to be read on its own."""
    with tempfile.TemporaryDirectory() as name:
        folder = prepared(Path(name))
        os.chdir(folder)
        for mistake in MISTAKES:
            print(f"--- {mistake['name']}")
            if (text := case_of(mistake)) is not None:
                (folder / "mistake.toml").write_text(text, encoding="utf-8")
                (folder / "block.msh").write_text(mistake.get("mesh", ""), encoding="utf-8")
                print(shell(folder, "info" if "warning" in mistake else "run", "mistake.toml")[1].strip())
            if "shell" in mistake:
                print(f"$ percute {' '.join(mistake['shell'])}\n{shell(folder, *mistake['shell'])[1].strip()}")
            if "python" in mistake:
                print(f">>> {mistake['python']}")
                print("\n".join(told_of(lambda: eval(mistake["python"], names_of(folder)), mistake)))
            if "damage" in mistake:
                kind = mistake.get("of", "history")
                damaged(mistake, folder / f"{kind}.vtkhdf", folder / "bad.vtkhdf")
                print(shell(folder, "estimate" if kind == "history" else "info", "bad.vtkhdf")[1].strip())


if __name__ == "__main__":
    main()
