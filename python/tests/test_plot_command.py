"""`percute plot` and animations: the same pictures as from Python, and nothing left behind."""

import signal
import subprocess
import sys
from pathlib import Path

import matplotlib.pyplot as plt
import percute as pc
import pytest
from PIL import Image

EXAMPLES = Path(__file__).parents[2] / "examples"


def plot(*arguments: str | Path, cwd: Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run([sys.executable, "-m", "percute", "plot", *map(str, arguments)], cwd=cwd, capture_output=True, text=True)


@pytest.fixture(scope="module")
def files(block_history: pc.History, tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    folder = tmp_path_factory.mktemp("files")
    history = pc.simulate(block_history.problem, end=13e-6, courant=0.9, store=folder / "block.vtkhdf")
    pc.estimate(history).save(folder / "error.vtkhdf")
    return folder / "block.vtkhdf", folder / "error.vtkhdf"


@pytest.mark.parametrize("kind", ["map", "over-time", "sources", "energies", "force", "pressure"])
def test_the_command_draws_what_python_draws(kind: str, files: tuple[Path, Path], tmp_path: Path) -> None:
    stored = pc.open(files[1])
    assert isinstance(stored, pc.Estimate)
    expected = tmp_path / "expected.svg"
    calls = {"map": stored.plot_map, "energies": stored.plot_energies, "force": stored.plot_force, "pressure": stored.plot_pressure}
    if kind in calls:
        calls[kind](save=expected)
    else:
        stored.plot_over_time("parts" if kind == "over-time" else "sources", save=expected)
    plt.close("all")
    done = plot(files[1], "--kind", kind, "--save", "drawn.svg", cwd=tmp_path)
    assert (done.returncode, done.stdout, done.stderr) == (0, "drawn.svg\n", "")
    assert (tmp_path / "drawn.svg").read_bytes() == expected.read_bytes()


def test_a_history_is_estimated_and_its_fields_are_drawn(files: tuple[Path, Path], tmp_path: Path) -> None:
    done = plot(files[0], cwd=tmp_path)
    assert (done.returncode, done.stdout) == (0, "block-map.png\n") and (tmp_path / "block-map.png").stat().st_size > 10_000
    done = plot(files[0], "--kind", "field", "--quantity", "pressure", "--step", "9", "--scale", "2", "--save", "p.svg", cwd=tmp_path)
    assert (done.returncode, done.stderr) == (0, "")
    history = pc.open(files[0])
    assert isinstance(history, pc.History)
    history.plot("pressure", step=9, scale=2.0, save=tmp_path / "expected.svg")
    plt.close("all")
    assert (tmp_path / "p.svg").read_bytes() == (tmp_path / "expected.svg").read_bytes()


def test_a_case_is_run(tmp_path: Path) -> None:
    # At 20 m/s strains are small, and nothing is told.
    case = (EXAMPLES / "bar.toml").read_text().replace("-400.0 ", "-20.0 ").replace("-0.0002 ", "-0.00001 ")
    (tmp_path / "rod.toml").write_text(case)
    done = plot("rod.toml", "--kind", "field", cwd=tmp_path)
    assert (done.returncode, done.stdout, done.stderr) == (0, "rod-field.png\n", "")


def test_mistakes_are_told_before_any_work(
    files: tuple[Path, Path], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    from percute.plot_command import main

    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("signal.signal", lambda *_: None)
    (tmp_path / "there.png").write_text("mine")
    for arguments, message in (
        ((files[1], "--save", "there.png"), "the file exists already; give another name, or --force"),
        ((files[1], "--save", "map.jpg"), "--save is 'map.jpg'; the name must end in .svg or .png or .pdf"),
        ((files[1], "--kind", "animation", "--save", "map.png"), "the name must end in .gif or .mp4"),
        ((files[1], "--step", "3"), "--step belongs to --kind field, not to map"),
        ((files[1], "--kind", "field"), "an estimate file has no displacements; name its history or its case"),
        ((files[0], "--kind", "field", "--step", "1000"), "--step is 1000; it must be from"),
        (("none.vtkhdf",), "there is no file 'none.vtkhdf'"),
        ((files[1], "--kind", "chart"), "invalid choice"),
    ):
        try:
            code = main(list(map(str, arguments)))
        except SystemExit as end:
            code = end.code if isinstance(end.code, int) else 1
        printed = capsys.readouterr()
        assert code == 2 and message in printed.err and not printed.out, printed.err
    plt.close("all")
    assert (tmp_path / "there.png").read_text() == "mine" and len(list(tmp_path.iterdir())) == 1
    done = plot(files[1], "--save", "there.png", "--force", cwd=tmp_path)
    assert done.returncode == 0 and (tmp_path / "there.png").stat().st_size > 10_000


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="only Linux has /dev/full")
def test_a_result_that_cannot_be_written_is_told(files: tuple[Path, Path], tmp_path: Path) -> None:
    command = [sys.executable, "-m", "percute", "plot", str(files[1]), "--quiet"]
    with open("/dev/full", "w") as full:
        done = subprocess.run(command, cwd=tmp_path, stdout=full, stderr=subprocess.PIPE, text=True)
    assert (done.returncode, done.stderr) == (1, "error: cannot write the result: No space left on device\n")


@pytest.mark.parametrize(("contents", "says"), [("empty", "is empty"), ("text", "is not an HDF5 file"), ("cut", "is truncated or damaged")])
def test_damaged_files_have_one_message(contents: str, says: str, files: tuple[Path, Path], tmp_path: Path) -> None:
    there = files[0].read_bytes()
    (tmp_path / "h.vtkhdf").write_bytes({"empty": b"", "text": b"[mesh]\n", "cut": there[: len(there) // 2]}[contents])
    told = set()
    for command in (["plot", "h.vtkhdf"], ["report", "h.vtkhdf"], ["estimate", "h.vtkhdf"], ["export", "h.vtkhdf", "-o", "f.vtkhdf"]):
        done = subprocess.run([sys.executable, "-m", "percute", *command], cwd=tmp_path, capture_output=True, text=True)
        assert done.returncode == 2, command
        told.add(done.stderr)
    assert len(told) == 1 and says in told.pop()
    with pytest.raises(pc.FileFormatError, match=says):
        pc.open(tmp_path / "h.vtkhdf")


def test_without_matplotlib_the_command_names_the_way_out(files: tuple[Path, Path], tmp_path: Path) -> None:
    program = "import sys; sys.modules['matplotlib'] = None; from percute.plot_command import main; sys.exit(main(sys.argv[1:]))"
    done = subprocess.run([sys.executable, "-c", program, str(files[1])], cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 1 and done.stderr == 'error: pictures need matplotlib: pip install matplotlib\n'


@pytest.mark.parametrize("quantity", [None, "displacement", "pressure"])
def test_an_animation_has_its_frames(quantity: str | None, block_history: pc.History, tmp_path: Path) -> None:
    told: list[tuple[str, int, int]] = []
    file = tmp_path / "block.gif"
    block_history.animate(file, quantity, frames=4, rate=5, progress=lambda p: told.append((p.stage, p.done, p.total)))
    assert told == [("animating", n, 4) for n in range(1, 5)] and [each.name for each in tmp_path.iterdir()] == ["block.gif"]
    with Image.open(file) as film:
        assert film.n_frames == 4 and film.info["duration"] == 200 and film.size == (640, 480)  # type: ignore[attr-defined]
    assert not plt.get_fignums()
    with pytest.raises(pc.ExistingFileError):
        block_history.animate(file)


def test_the_frames_of_a_bar_have_one_scale(bar_history: pc.History, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from percute import animation_pictures

    spans, drawn = [], animation_pictures.draw_field
    monkeypatch.setattr(animation_pictures, "draw_field", lambda *arguments: spans.append(arguments[5]) or drawn(*arguments))
    bar_history.animate(tmp_path / "bar.gif", frames=3)
    last = len(bar_history) - 1
    values = bar_history.stress([0, round(last / 2), last])
    assert len(spans) == 3 and set(spans) == {(values.min(), values.max())}


def test_the_command_writes_an_animation(files: tuple[Path, Path], tmp_path: Path) -> None:
    """In a process of its own: nothing but the animation imports what it needs."""
    done = plot(files[0], "--kind", "animation", "--frames", "2", cwd=tmp_path)
    assert (done.returncode, done.stdout, done.stderr) == (0, "block-animation.gif\n", "")


def test_a_stopped_animation_leaves_nothing(block_history: pc.History, tmp_path: Path) -> None:
    def stop(progress: pc.Progress) -> None:
        if progress.done == 2:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        block_history.animate(tmp_path / "block.gif", frames=5, progress=stop)
    # Ctrl-C within matplotlib, where an exception may be lost: it acts after the frame.
    frames: list[int] = []

    def press(progress: pc.Progress) -> None:
        frames.append(progress.done)
        signal.raise_signal(signal.SIGINT)
        frames.append(0)

    with pytest.raises(KeyboardInterrupt):
        block_history.animate(tmp_path / "block.gif", frames=5, progress=press)
    assert frames == [1, 0] and signal.getsignal(signal.SIGINT) is signal.default_int_handler and not list(tmp_path.iterdir())

    def fail(progress: pc.Progress) -> None:
        raise OSError("mine")

    with pytest.raises(OSError, match="^mine$"):
        block_history.animate(tmp_path / "block.gif", frames=5, progress=fail)
    assert not list(tmp_path.iterdir())


@pytest.mark.skipif(sys.platform == "win32", reason="a script in place of ffmpeg")
def test_a_failure_of_ffmpeg_is_told(block_history: pc.History, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "ffmpeg").write_text("#!/bin/sh\ncat > /dev/null\nexit 3\n")
    (tmp_path / "ffmpeg").chmod(0o755)
    monkeypatch.setenv("PATH", f"{tmp_path}:/usr/bin:/bin")
    with pytest.raises(pc.StorageError, match="block.mp4: ffmpeg cannot write it: exit code 3; write a .gif instead"):
        block_history.animate(tmp_path / "block.mp4", frames=2)
    assert [each.name for each in tmp_path.iterdir()] == ["ffmpeg"]


def test_without_ffmpeg_the_way_out_is_named(block_history: pc.History, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(pc.PercuteError, match="an .mp4 needs the program ffmpeg"):
        block_history.animate(tmp_path / "block.mp4", frames=2)
    assert not list(tmp_path.iterdir())
