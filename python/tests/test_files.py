"""Files of histories, and the ways in which they are missing, taken or wrong."""

import json
import os
import pickle
import re
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import h5py
import matplotlib.pyplot as plt
import numpy as np
import percute as pc
import pytest
from conftest import bar, block


@pytest.fixture
def stored(tmp_path: Path) -> pc.History:
    return pc.simulate(block(), end=13e-6, courant=0.9, store=tmp_path / "block.vtkhdf")


def test_a_stored_history_maps_its_file(stored: pc.History, block_history: pc.History) -> None:
    for name in ("displacement", "reaction", "touching"):
        array = getattr(stored, name)
        assert isinstance(array, np.memmap) and not array.flags.writeable, name
        assert array.tobytes() == getattr(block_history, name).tobytes(), name
        with pytest.raises(ValueError, match="read-only"):
            array[...] = 0
    assert stored.complete and stored.problem.obstacles == block_history.problem.obstacles
    assert np.array_equal(stored.contact_nodes, block_history.contact_nodes)
    assert np.array_equal(stored.balance.friction, block_history.balance.friction)


def test_names_of_files_outlive_a_change_of_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    history = pc.simulate(bar(), end=5e-6, courant=0.9, store="bar.vtkhdf")
    monkeypatch.chdir("/")
    assert history.path == tmp_path / "bar.vtkhdf" and len(history.displacement) == len(history)


def test_nothing_is_overwritten_unless_told_so(stored: pc.History) -> None:
    assert stored.path is not None
    before = stored.path.read_bytes()
    with pytest.raises(pc.ExistingFileError, match="overwrite=True") as raised:
        pc.simulate(bar(), end=5e-6, courant=0.9, store=stored.path)
    assert isinstance(raised.value, FileExistsError) and not hasattr(raised.value, "history")
    assert stored.path.read_bytes() == before
    replaced = pc.simulate(bar(), end=5e-6, courant=0.9, store=stored.path, overwrite=True)
    assert replaced.problem.mesh.dimension == 1


def test_a_missing_file(tmp_path: Path) -> None:
    for action in (pc.open, pc.run):
        with pytest.raises(FileNotFoundError, match="none.toml") as raised:
            action(tmp_path / "none.toml")
        assert isinstance(raised.value, pc.MissingFileError)


def begun(_: pc.Progress) -> None:
    raise AssertionError("the work has begun")


def test_a_folder_that_is_not_there(tmp_path: Path) -> None:
    """It is a mistake in the call, found before any work."""
    none, history = tmp_path / "none", pc.simulate(bar(), end=5e-6, courant=0.9)
    calls: list[Callable[[], object]] = [
        lambda: pc.simulate(bar(), end=5e-6, courant=0.9, store=none / "bar.vtkhdf", progress=begun),
        lambda: pc.estimate(history).save(none / "error.vtkhdf"),
        lambda: bar().mesh.write(none / "bar.msh"),
    ]
    for call in calls:
        with pytest.raises(pc.MissingFileError, match="there is no folder .*none; create it first") as raised:
            call()
        assert isinstance(raised.value, FileNotFoundError)


def test_files_of_other_kinds(tmp_path: Path) -> None:
    text, other = tmp_path / "text.vtkhdf", tmp_path / "other.vtkhdf"
    text.write_text("no history")
    with h5py.File(other, "w") as file:
        file["numbers"] = [1, 2, 3]
    for path in (text, other):
        with pytest.raises(pc.FileFormatError) as raised:
            pc.open(path)
        assert isinstance(raised.value, ValueError) and path.name in str(raised.value)


def test_arrays_of_another_program_are_shown_their_way(tmp_path: Path) -> None:
    file = tmp_path / "mine.npz"
    np.savez(file, displacement=np.zeros((3, 4, 2)))
    for words in (["estimate", str(file)], ["report", str(file), str(tmp_path / "page.html")]):
        done = subprocess.run([sys.executable, "-m", "percute", *words], capture_output=True, text=True, check=False)
        said = " ".join(done.stderr.split())
        assert done.returncode == 2 and "`pc.History.from_arrays` (docs/foreign.md)" in said, said


@pytest.mark.parametrize(
    ("name", "content", "says"),
    [
        ("empty.vtkhdf", b"", "an empty file, no history and no estimate file"),
        ("text.h5", b"hello", "not an HDF5 file in spite of its name"),
        ("report.json", b'{"error": 1}', "a JSON document, not a case"),
        ("map.svg", b"<svg></svg>", "XML, such as an SVG picture"),
        ("mine.npz", b"PK\x03\x04", "arrays of another program are graded in Python, by `pc.History.from_arrays` (docs/foreign.md)"),
        ("map.png", b"\x89PNG\r\n\x1a\n\x00\xff", "a picture (PNG), not a case"),
    ],
)
def test_the_kind_of_a_file_comes_first(name: str, content: bytes, says: str, tmp_path: Path) -> None:
    """In `percute info` and `pc.run`, before any part of a case is missed."""
    file = tmp_path / name
    file.write_bytes(content)
    told = subprocess.run([sys.executable, "-m", "percute", "info", str(file)], capture_output=True, text=True)
    assert told.returncode == 2 and told.stderr == f"error: {file}: this is {told.stderr.split(': this is ')[-1]}" and says in told.stderr
    with pytest.raises(pc.InputError, match="^`case`: .*" + re.escape(says)):
        pc.run(file)


def test_a_truncated_file(stored: pc.History) -> None:
    assert stored.path is not None
    short = stored.path.with_name("short.vtkhdf")
    short.write_bytes(stored.path.read_bytes()[:-4000])
    with pytest.raises(pc.FileFormatError, match="short.vtkhdf"):
        pc.estimate(pc.open(short))


def test_a_value_that_is_no_number(stored: pc.History) -> None:
    path = stored.path
    assert path is not None
    with h5py.File(path, "r+") as file:
        file["VTKHDF/PointData/displacement"][5 * 63 + 7, 1] = np.nan
    with pytest.raises(pc.FileFormatError, match="NaN at step 5, node 7"):
        pc.estimate(pc.open(path))


def test_a_file_that_h5py_locks(stored: pc.History) -> None:
    path = stored.path
    assert path is not None
    with h5py.File(path, "r+", locking=True), pytest.raises(pc.StorageError, match="another program"):
        pc.open(path)
    assert pc.open(path).complete


def test_a_mistake_in_a_case_has_its_line() -> None:
    with pytest.raises(pc.InputError, match="case:2: .*bar"):
        pc.run("[mesh]\nbar = 3\n")
    with pytest.raises(pc.InputError, match="`case` is 3"):
        pc.run(3)  # type: ignore[arg-type]


def test_the_case_may_name_its_history(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    text = (Path(__file__).parents[2] / "examples" / "bar.toml").read_text()
    estimate = pc.run(text + '\n[output]\nhistory = "bar.vtkhdf"\n')
    assert estimate.history is not None and estimate.history.path == tmp_path / "bar.vtkhdf"
    assert os.listdir(tmp_path) == ["bar.vtkhdf"]


def test_a_pickle_of_a_file_knows_where_it_is(stored: pc.History) -> None:
    assert repr(stored) == f"<percute.History: {len(stored)} instants to 1.3e-05 s, 63 nodes, 2D>"


@pytest.mark.parametrize("make", [bar, block])
@pytest.mark.parametrize("fields", [False, True])
def test_a_saved_estimate_comes_back(make: object, fields: bool, tmp_path: Path) -> None:
    assert callable(make)
    estimate = pc.estimate(pc.simulate(make(), end=13e-6, courant=0.9), instants=3, fields=fields)
    file = tmp_path / "error.vtkhdf"
    estimate.save(file)
    with pytest.raises(pc.ExistingFileError):
        estimate.save(file)
    estimate.save(file, overwrite=True)
    opened = pc.open(file)
    for again in (opened, pickle.loads(pickle.dumps(opened))):
        assert isinstance(again, pc.Estimate) and again.history is None and again.problem is None
        assert again._measures == estimate._measures and again.parts == estimate.parts
        assert again.by_element.tobytes() == estimate.by_element.tobytes()
        assert again.worst_elements(4) == estimate.worst_elements(4)
        assert (dict(again.residuals), again.options) == (dict(estimate.residuals), estimate.options)
        for name in ("time", "kinetic", "elastic", "contact", "total", "reference"):
            assert getattr(again.over_time, name).tobytes() == getattr(estimate.over_time, name).tobytes()
        assert len(again.maps) == 3
        for first, second in zip(again.maps, estimate.maps, strict=True):
            for name, value in vars(second).items():
                assert np.array_equal(getattr(first, name), value), name
        assert np.array_equal(again.mesh.cells, estimate.mesh.cells)
        assert json.loads(again.to_json()) == json.loads(estimate.to_json()) | {"seconds": None}
        again.plot_map()
    plt.close("all")
    with pytest.raises(pc.InputError, match="copy that"):
        opened.save(tmp_path / "other.vtkhdf")  # type: ignore[union-attr]


CASE = (Path(__file__).parents[2] / "examples" / "bar.toml").read_text() + "\n[output]\n"


@pytest.mark.parametrize(
    ("outputs", "store", "error", "message"),
    [
        ('estimate = "one.vtkhdf"', "one.vtkhdf", pc.InputError, "[output] estimate one.vtkhdf is the file of `store` too"),
        ('estimate = "one.vtkhdf"', "./one.vtkhdf", pc.InputError, "is the file of `store` too"),
        ('history = "one.vtkhdf"\nestimate = "one.vtkhdf"', None, pc.InputError, "is the file of [output] history too"),
        ('estimate = "case.toml"', None, pc.InputError, '[output], estimate: is "case.toml"; it must be a name that ends in .vtkhdf'),
        ("", "case.toml", pc.InputError, "`store` case.toml is the case file itself"),
        ('estimate = "none/one.vtkhdf"', "two.vtkhdf", pc.MissingFileError, "[output] estimate: cannot write none/one.vtkhdf"),
        ('estimate = "folder.vtkhdf"', "two.vtkhdf", pc.StorageError, "it is not a regular file"),
    ],
)
def test_outputs_of_a_case_that_cannot_be(
    outputs: str, store: str | None, error: type[Exception], message: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Before the simulation: a run may take hours."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "folder.vtkhdf").mkdir()
    (tmp_path / "case.toml").write_text(CASE + outputs)
    heard: list[pc.Progress] = []
    with pytest.raises(error, match=re.escape(message)):
        pc.run("case.toml", store=store, overwrite=True, progress=heard.append)
    assert heard == [] and sorted(each.name for each in tmp_path.iterdir()) == ["case.toml", "folder.vtkhdf"]


@pytest.mark.parametrize("taken", ["history.vtkhdf", "error.vtkhdf"])
def test_outputs_of_a_case_that_are_there_already(taken: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path(taken).write_text("mine")
    heard: list[pc.Progress] = []
    with pytest.raises(pc.ExistingFileError, match=f"{taken}: .*overwrite=True"):
        pc.run(CASE + 'history = "history.vtkhdf"\nestimate = "error.vtkhdf"', progress=heard.append)
    assert heard == [] and os.listdir() == [taken] and Path(taken).read_text() == "mine"


def test_files_of_a_run_go_where_they_were_checked(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A callback may change the working directory."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "folder").mkdir()
    (tmp_path / "folder" / "error.vtkhdf").write_text("mine")
    text = CASE + 'history = "history.vtkhdf"\nestimate = "error.vtkhdf"'
    estimate = pc.run(text, overwrite=True, progress=lambda _: os.chdir(tmp_path / "folder"))
    assert isinstance(pc.open(tmp_path / "history.vtkhdf"), pc.History)
    assert pc.open(tmp_path / "error.vtkhdf").by_element.tobytes() == estimate.by_element.tobytes()  # type: ignore[union-attr]
    assert (tmp_path / "folder" / "error.vtkhdf").read_text() == "mine"


def test_an_estimate_does_not_replace_its_history(stored: pc.History, tmp_path: Path) -> None:
    assert stored.path is not None
    before = stored.path.read_bytes()
    link = tmp_path / "link.vtkhdf"
    link.symlink_to(stored.path)
    estimate = pc.estimate(pc.open(stored.path))  # type: ignore[arg-type]
    for path in (stored.path, link, tmp_path / "." / "block.vtkhdf"):
        with pytest.raises(pc.InputError, match="the file of the history"):
            estimate.save(path, overwrite=True)
    assert stored.path.read_bytes() == before


def test_the_arrays_of_a_history_are_those_of_one_file(stored: pc.History, tmp_path: Path) -> None:
    """Whichever was asked for before another file came in its place."""
    assert stored.path is not None
    reaction, touching = stored.reaction.copy(), stored.touching.copy()
    again, late = pc.open(stored.path), pc.open(stored.path)
    assert isinstance(again, pc.History) and isinstance(late, pc.History)
    assert again.displacement.any()
    pc.simulate(block(friction=0.0), end=13e-6, courant=0.9, store=stored.path, overwrite=True)
    assert np.array_equal(again.reaction, reaction) and np.array_equal(again.touching, touching)
    with pytest.raises(pc.StorageError, match="replaced"):
        _ = late.reaction


def test_a_history_whose_file_is_gone_or_short(stored: pc.History) -> None:
    assert stored.path is not None
    mapped, short, gone = pc.open(stored.path), pc.open(stored.path), pc.open(stored.path)
    assert mapped.displacement.any()  # type: ignore[union-attr]
    os.truncate(stored.path, 5000)
    for history in (mapped, short):
        with pytest.raises(pc.PercuteError, match="block.vtkhdf"):
            _ = history.touching  # type: ignore[union-attr]
    stored.path.unlink()
    with pytest.raises(pc.MissingFileError, match="block.vtkhdf"):
        _ = gone.touching  # type: ignore[union-attr]
