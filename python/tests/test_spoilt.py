"""Histories that contradict themselves or their problem are named or refused, in Python and by the command."""

import json
import re
import subprocess
import sys
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any, cast

import h5py
import numpy as np
import percute as pc
import pytest
from conftest import bar, block, disc, tilted
from numpy.typing import NDArray
from spoiling import Parts, changed, given, parts, shifted

def without_a_node(parts: Parts) -> Parts:
    # Not the last node of the boundary: the first that carries force.
    at = int(np.abs(parts["reaction"]).sum(axis=(0, 2)).argmax())
    rest = np.delete(np.arange(len(parts["contact_nodes"])), at)
    rows = {name: parts[name][:, rest] for name in ("reaction", "touching")}
    return {**parts, **rows, "contact_nodes": parts["contact_nodes"][rest]}


def exchanged(u: NDArray[Any]) -> NDArray[Any]:
    order = np.arange(u.shape[1])
    order[[2, 9]] = [9, 2]
    return u[:, order]


def backwards(parts: Parts) -> Parts:
    return {**parts, **{name: parts[name][::-1] for name in ("displacement", "reaction", "touching")}}


def last_forgotten(reaction: NDArray[Any]) -> NDArray[Any]:
    assert reaction[-1].any()
    return np.concatenate([reaction[:-1], np.zeros_like(reaction[-1:])])


SPOILT: dict[str, tuple[Callable[[Parts], Parts], str]] = {
    "a step late": (changed("reaction", lambda r: shifted(r, 1)), "the contact forces are a step too late"),
    "a step early": (changed("reaction", lambda r: shifted(r, -1)), "the contact forces are a step too early"),
    "sign": (changed("reaction", lambda r: -r), "the sign of the contact forces is wrong"),
    "factor 2": (changed("reaction", lambda r: 2 * r), r"should be 0.5 times as large \(symmetry or thickness\)"),
    "factor 1000": (changed("reaction", lambda r: 1000 * r), r"should be 0.001 times as large \(given in mN\?\)"),
    "touching nowhere": (changed("touching", np.zeros_like), "`touching` and the contact forces disagree"),
    "touching late": (changed("touching", lambda t: shifted(t, 1)), "`touching` is a step late"),
    "touching early": (changed("touching", lambda t: shifted(t, -1)), "`touching` is a step early"),
    "initial velocity": (changed("speed", lambda _: 1.1), "`initial_velocity` is not that of the history.*0.9091 times"),
    "density": (changed("density", lambda _: 1.2), "`density` is not that of the history: it should be 0.8333 times"),
    "steps": (changed("time", lambda t: 1.05 * t), "`time` is not that of the history: the steps should be 0.9524 times"),
    "a node missing": (without_a_node, "the contact forces of node [0-9]+ are missing"),
    "nodes exchanged": (changed("displacement", exchanged), "the displacements of nodes (2 and 9|9 and 2) are exchanged"),
    "nodes reversed": (changed("displacement", lambda u: u[:, ::-1]), "displacements are in the opposite order of the nodes"),
    "nodes shuffled": (
        changed("displacement", lambda u: u[:, np.random.default_rng(1).permutation(u.shape[1])]),
        "the displacements do not fit the mesh",
    ),
    "backwards": (backwards, "the order in time is reversed"),
    "last forces": (changed("reaction", last_forgotten), "the last instant, .* is left out"),
}


@pytest.fixture(scope="module", params=[bar, block, tilted, disc])
def correct(request: pytest.FixtureRequest) -> pc.History:
    return pc.simulate(request.param(), end=13e-6, courant=0.9)


def stored(history: pc.History, parts: Parts, path: Path) -> Path:
    """The file of another program."""
    pc.simulate(history.problem, steps=np.diff(history.time), store=path)
    with h5py.File(path, "r+") as file:
        own = file["percute"]
        own.attrs["program"] = "another program"
        rows = np.zeros((parts["displacement"].shape[0] * parts["displacement"].shape[1], 3))
        rows[:, : parts["displacement"].shape[2]] = parts["displacement"].reshape(len(rows), -1)
        file["VTKHDF/PointData/displacement"][:] = rows
        file["VTKHDF/Steps/Values"][:] = parts["time"]
        own["times"][:] = parts["time"]
        own["initial_velocity"][:] *= parts["speed"]
        del own["contact"]
        own["contact/nodes"], own["contact/reaction"] = parts["contact_nodes"], parts["reaction"]
        own["contact/touching"] = parts["touching"].astype("u1")
        text = own["problem"].asstr()[()].replace("density = 2700.0", f"density = {2700.0 * parts['density']}")
        assert parts["density"] == 1.0 or "density = 3240.0" in text
        del own["problem"]
        own["problem"] = text
    return path


def command(file: Path, *options: str) -> subprocess.CompletedProcess[str]:
    words = [sys.executable, "-m", "percute", "estimate", str(file), *options]
    return subprocess.run(words, capture_output=True, text=True, check=False)


@pytest.mark.parametrize("name", SPOILT)
def test_a_spoilt_history_is_named_by_both(name: str, correct: pc.History, tmp_path: Path) -> None:
    spoil, cause = SPOILT[name]
    spoilt = spoil(parts(correct))
    file = stored(correct, spoilt, tmp_path / "spoilt.vtkhdf")
    done = command(file)
    said = " ".join(done.stderr.split())
    if name == "last forces":
        with pytest.warns(pc.InputWarning, match=cause):
            pc.estimate(given(correct.problem, spoilt))
        with pytest.warns(pc.InputWarning, match=cause):
            pc.estimate(cast("pc.History", pc.open(file)))
        assert done.returncode == 0
        assert "the last instant" in said
        return
    with warnings.catch_warnings():
        # A step early, the last forces are those of the first step: none.
        warnings.filterwarnings("ignore", "the last instant", pc.InputWarning)
        with pytest.raises(pc.InputError, match=f"not consistent: .*{cause}") as refused:
            pc.estimate(given(correct.problem, spoilt))
        # It is offered to estimate the history as it is, unless this is refused, too.
        if "force=True" not in str(refused.value):
            with pytest.raises(pc.PercuteError, match="initial displacement"):
                pc.estimate(given(correct.problem, spoilt), force=True)
        with pytest.raises((pc.InputError, pc.FileFormatError), match=cause):
            pc.estimate(cast("pc.History", pc.open(file)))
    assert done.returncode == 2, said
    assert re.search(cause, said), said
    # The first displacements of a file are those of its problem, which may start in its plane then.
    assert name == "backwards" or re.search(f"not consistent: .*{cause}", said), said
    assert ("force=True" in str(refused.value)) == ("--accept-inconsistent" in said) or name == "backwards", said


def test_the_correct_history_passes(correct: pc.History, tmp_path: Path) -> None:
    whole = parts(correct)
    ours = pc.estimate(correct)
    assert ours.consistency is None
    for history in (given(correct.problem, whole), pc.open(stored(correct, whole, tmp_path / "correct.vtkhdf"))):
        assert isinstance(history, pc.History)
        estimate = pc.estimate(history)
        assert estimate.by_element.tobytes() == ours.by_element.tobytes()
        figures = dict(estimate.consistency or {})
        # Rounding of the second difference of the displacements.
        assert 0 < figures["balance"] < 1e-11 and figures["initial_velocity"] < 1e-12 and figures["penetration"] < 1e-12
        assert figures["acceleration"] is None and figures["touching"] == 0.0 and figures["energy"] < 0.1
    done = command(tmp_path / "correct.vtkhdf", "--json")
    assert done.returncode == 0 and json.loads(done.stdout)["consistency"] == dict(estimate.consistency or {})
    assert "of another program: balance off by" in command(tmp_path / "correct.vtkhdf").stdout


@pytest.mark.filterwarnings("ignore::percute.SimulationWarning")
def test_an_inconsistent_history_is_estimated_on_demand(correct: pc.History, tmp_path: Path) -> None:
    spoilt = SPOILT["a step late"][0](parts(correct))
    estimate = pc.estimate(given(correct.problem, spoilt), force=True)
    assert estimate.consistency is not None and (estimate.consistency["balance"] or 0) > 0.1
    file = stored(correct, spoilt, tmp_path / "spoilt.vtkhdf")
    done = command(file, "--accept-inconsistent", "--json")
    document = json.loads(done.stdout)
    assert done.returncode == 0 and document["consistency"]["balance"] > 0.1 and document["verdict"]["trust"] == "low"
    # Whatever names the option has it.
    for words in (["report", str(file), str(tmp_path / "page.html")], ["plot", str(file), "--save", str(tmp_path / "map.png")]):
        percute = [sys.executable, "-m", "percute", *words]
        refused = subprocess.run(percute, capture_output=True, text=True, check=False)
        assert refused.returncode == 2 and "give --accept-inconsistent" in refused.stderr, refused.stderr
        subprocess.run([*percute, "--accept-inconsistent"], capture_output=True, check=True)
    assert (tmp_path / "page.html").exists() and (tmp_path / "map.png").exists()


def test_single_precision_passes(correct: pc.History) -> None:
    whole = parts(correct)
    single = {name: whole[name].astype(np.float32) for name in ("time", "displacement", "reaction")}
    estimate = pc.estimate(given(correct.problem, {**whole, **single}))
    assert estimate.consistency is not None and (estimate.consistency["balance"] or 0) < 1e-4
