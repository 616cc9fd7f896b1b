"""Histories in memory that are saved into files."""

from __future__ import annotations

import json
import pickle
import subprocess
import sys
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import percute as pc
import pytest
from conftest import bar, block

FIELDS = ("time", "displacement", "reaction", "touching", "contact_nodes", "velocity", "acceleration")
BASE = Path(__file__).parents[2] / "tests" / "bases" / "block.toml"


def run(folder: Path, *arguments: str) -> str:
    """What a command prints; it succeeds."""
    done = subprocess.run([sys.executable, "-m", "percute", *arguments], cwd=folder, check=True, capture_output=True, encoding="utf-8")
    return done.stdout


def document(estimate: pc.Estimate) -> dict[str, Any]:
    """The document of an estimate without its duration and the name of its file."""
    found: dict[str, Any] = json.loads(estimate.to_json())
    return {key: value for key, value in found.items() if key not in ("seconds", "case")}


def theirs(history: pc.History, *names: str, program: str | None = None) -> pc.History:
    """The history as one of another program; its start is off by digits that are not the problem's."""
    arrays = {name: getattr(history, name).copy() for name in names}
    arrays["displacement"][0] += 1e-9
    return pc.History.from_arrays(history.problem, history.time, **arrays, program=program)


@pytest.mark.filterwarnings("ignore:the last instant")
@pytest.mark.parametrize("make", [bar, block])
@pytest.mark.parametrize(
    "names",
    [("displacement",), ("displacement", "reaction"), ("displacement", "reaction", "touching", "velocity", "acceleration")],
    ids=len,
)
def test_a_history_of_another_program_stays_the_same(make: Any, names: tuple[str, ...], tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    history = theirs(pc.simulate(make(), end=9e-6, courant=0.9), *names, program="a solver µ")
    before = pc.estimate(history)
    history.save("their.vtkhdf")
    opened = pc.open("their.vtkhdf")
    assert isinstance(opened, pc.History)
    assert opened.program == history.program == "a solver µ" and opened.derived == history.derived
    for name in FIELDS:
        assert getattr(opened, name).tobytes() == getattr(history, name).tobytes(), name
    # The start of the problem, from which step 0 differs, is kept as well.
    assert np.array_equal(opened.problem.initial_displacement, history.problem.initial_displacement)
    assert before.consistency is not None and before.consistency["initial_displacement"] > 0
    assert document(pc.estimate(opened)) == document(before)
    assert document(before)["simulated_by"] == "a solver µ"
    # So does the command, which the page names.
    before.report(tmp_path / "page.html")
    page = (tmp_path / "page.html").read_text(encoding="utf-8")
    command = page.split("<pre>percute ")[1].split("</pre>")[0].split()
    assert command[:2] == ["estimate", "their.vtkhdf"] and "simulated by a solver µ, estimated by percute" in page
    printed = json.loads(run(tmp_path, *command, "--json"))
    assert {key: printed[key] for key in document(before)} == document(before)
    assert (tmp_path / "report.html").read_text(encoding="utf-8").replace("report.html", "page.html") == page.replace("report.html", "page.html")


@pytest.mark.filterwarnings("ignore:the last instant")
def test_a_page_names_the_file_that_was_saved_last_from_its_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for folder in ("runs", "pages", "pages/sub"):
        (tmp_path / folder).mkdir()
    monkeypatch.chdir(tmp_path)
    history = theirs(pc.simulate(block(), end=9e-6, courant=0.9), "displacement", "reaction")
    estimate = pc.estimate(history)
    for file, page, command in (
        ("first.vtkhdf", "a.html", "first.vtkhdf"),
        ("runs/b.vtkhdf", "pages/b.html", "../runs/b.vtkhdf"),
        ("pages/sub/c.vtkhdf", "pages/c.html", "sub/c.vtkhdf"),
    ):
        history.save(file)
        estimate.report(page)
        shown = (tmp_path / page).read_text(encoding="utf-8").split("<pre>percute ")[1].split("</pre>")[0]
        assert shown.split()[:2] == ["estimate", command]
        run((tmp_path / page).parent, *shown.split(), "--quiet", "--force")


@pytest.mark.filterwarnings("ignore:the last instant")
def test_a_forced_estimate_says_how_it_is_made_again(tmp_path: Path) -> None:
    history = pc.simulate(block(), end=9e-6, courant=0.9)
    late = pc.History.from_arrays(history.problem, history.time, history.displacement, np.roll(history.reaction, 1, axis=0), program="a\x1b[31m solver")
    late.save(tmp_path / "late.vtkhdf")
    estimate = pc.estimate(late, force=True)
    estimate.report(tmp_path / "page.html")
    command = (tmp_path / "page.html").read_text(encoding="utf-8").split("<pre>percute ")[1].split("</pre>")[0].split()
    assert "--accept-inconsistent" in command
    assert "in Python <code>force=True</code>" in (tmp_path / "page.html").read_text(encoding="utf-8")
    told = run(tmp_path, *command)
    # The name of the program is shown, without what colours a terminal.
    for text in (told, run(tmp_path, "info", "late.vtkhdf")):
        assert "a\\u{1b}[31m solver" in text and "\x1b" not in text
    # A page may also be asked for as elsewhere.
    run(tmp_path, "report", "late.vtkhdf", "--accept-inconsistent", "--report", "again.html")
    assert "--accept-inconsistent" in (tmp_path / "again.html").read_text(encoding="utf-8")


def test_other_commands_read_it(tmp_path: Path, block_history: pc.History) -> None:
    theirs(block_history, "displacement", "reaction", "touching").save(tmp_path / "a.vtkhdf")
    told = run(tmp_path, "info", "a.vtkhdf")
    assert "simulated by another program" in told and "without checksums" not in told
    found = json.loads(run(tmp_path, "info", "a.vtkhdf", "--json"))
    assert found["foreign"] is True and found["simulated_by"] is None
    run(tmp_path, "report", "a.vtkhdf", "--program", "Solver <1>", "--quiet")
    assert "simulated by Solver &lt;1&gt;, estimated by" in (tmp_path / "a.html").read_text(encoding="utf-8")
    run(tmp_path, "export", "a.vtkhdf", "-o", "a.vtu", "--steps", "0", "--quiet")
    assert list(tmp_path.glob("a*.vtu"))
    # It is no run that could go on.
    with h5py.File(tmp_path / "a.vtkhdf", "r+") as file:
        assert "checkpoints" not in file["percute"]
        file["percute/complete"][()] = 0
    with pytest.raises(pc.FileFormatError, match="its run cannot be resumed: another program has simulated it"):
        pc.resume(tmp_path / "a.vtkhdf")
    # Its name and its start are under the checksums.
    with h5py.File(tmp_path / "a.vtkhdf", "r+") as file:
        file["percute/initial_displacement"][0, 0] = 1e-3
    with pytest.raises(pc.FileFormatError, match="checksum"):
        pc.open(tmp_path / "a.vtkhdf")


@pytest.mark.parametrize("end", [2e-6, 30e-6], ids=["without checkpoints", "with checkpoints"])
def test_a_simulation_in_memory_makes_the_file_of_a_stored_one(end: float, tmp_path: Path) -> None:
    steps = {"end": end, "courant": 0.9}
    pc.simulate(block(), **steps, store=tmp_path / "stored.vtkhdf")
    history = pc.simulate(block(), **steps)
    history.save(tmp_path / "saved.vtkhdf")
    assert (tmp_path / "saved.vtkhdf").read_bytes() == (tmp_path / "stored.vtkhdf").read_bytes()


def test_the_history_of_a_case_keeps_its_case(tmp_path: Path) -> None:
    (tmp_path / "case.toml").write_bytes(BASE.read_bytes())
    estimate = pc.run(tmp_path / "case.toml")
    assert estimate.history is not None
    estimate.history.save(tmp_path / "saved.vtkhdf")
    pc.run(tmp_path / "case.toml", store=tmp_path / "stored.vtkhdf")
    assert (tmp_path / "saved.vtkhdf").read_bytes() == (tmp_path / "stored.vtkhdf").read_bytes()


def test_an_interrupted_history_keeps_its_steps(tmp_path: Path) -> None:
    def stop(progress: pc.Progress) -> None:
        if progress.done > 100:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt) as raised:
        pc.simulate(block(nx=40, ny=32), end=1e-3, courant=0.01, long=True, progress=stop)
    history = raised.value.history  # type: ignore[attr-defined]
    history.save(tmp_path / "a.vtkhdf")
    opened = pc.open(tmp_path / "a.vtkhdf")
    assert isinstance(opened, pc.History) and len(opened) == len(history) > 100 and not opened.complete
    assert np.array_equal(opened.displacement, history.displacement)


def test_what_is_wrong_is_refused(tmp_path: Path, block_history: pc.History) -> None:
    history = theirs(block_history, "displacement", "reaction")
    for name, again in (("here.vtkhdf", history), ("pickled.vtkhdf", pickle.loads(pickle.dumps(history)))):
        again.save(tmp_path / name)
    # The same contents make the same bytes.
    assert (tmp_path / "here.vtkhdf").read_bytes() == (tmp_path / "pickled.vtkhdf").read_bytes()
    with pytest.raises(pc.ExistingFileError, match="overwrite=True"):
        history.save(tmp_path / "here.vtkhdf")
    history.save(tmp_path / "here.vtkhdf", overwrite=True)
    opened = pc.open(tmp_path / "here.vtkhdf")
    assert isinstance(opened, pc.History)
    with pytest.raises(pc.InputError, match=r"the history is in the file '.*here\.vtkhdf'; copy that"):
        opened.save(tmp_path / "copy.vtkhdf")
    with pytest.raises(pc.InputError, match="ends in .vtkhdf"):
        history.save(tmp_path / "a.h5")
    for wrong in ("", " ", "a\0b", 5):
        with pytest.raises(pc.InputError, match="`program` is .*; it must be a text"):
            pc.History.from_arrays(block_history.problem, block_history.time, block_history.displacement, program=wrong)  # type: ignore[arg-type]
    assert sorted(path.name for path in tmp_path.iterdir()) == ["here.vtkhdf", "pickled.vtkhdf"]
