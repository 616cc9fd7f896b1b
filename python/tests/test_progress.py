"""Progress as it is shown on terminals and in notebooks."""

import io
import sys
from types import SimpleNamespace
from typing import Any

import percute as pc
import pytest
from percute.progress import shown


class Stream(io.StringIO):
    """A stream that may be a terminal."""

    def __init__(self, terminal: bool) -> None:
        super().__init__()
        self.terminal = terminal

    def isatty(self) -> bool:
        return self.terminal


def at(done: int, stage: str = "simulating") -> Any:
    return SimpleNamespace(stage=stage, done=done, total=100)


def test_a_terminal_has_one_line_that_goes_in_the_end(monkeypatch: pytest.MonkeyPatch) -> None:
    stream = Stream(terminal=True)
    monkeypatch.setattr(sys, "stderr", stream)
    with shown(True) as tell:
        assert tell is not None
        tell(at(25))
        tell(at(100))
    _, first, last, end = stream.getvalue().split("\r\x1b[K")
    assert first.startswith("simulating " + "█" * 8 + "░" * 24 + " step 25 of 100") and first.endswith(" left")
    assert last == "simulating " + "█" * 32 + " step 100 of 100"
    assert end == ""


@pytest.mark.parametrize(("progress", "terminal"), [(True, False), (False, True), (None, True)])
def test_nothing_is_shown_where_nobody_asked_or_sees_it(
    progress: bool | None, terminal: bool, monkeypatch: pytest.MonkeyPatch, bar_history: pc.History
) -> None:
    stream = Stream(terminal)
    monkeypatch.setattr(sys, "stderr", stream)
    pc.estimate(bar_history, progress=progress)
    assert stream.getvalue() == ""


def test_a_notebook_has_one_output_that_is_updated(monkeypatch: pytest.MonkeyPatch) -> None:
    outputs: list[list[str]] = []

    def display(text: str, display_id: bool) -> Any:
        assert display_id
        outputs.append([text])
        return SimpleNamespace(update=outputs[-1].append)

    shell = type("ZMQInteractiveShell", (), {})()
    monkeypatch.setitem(sys.modules, "IPython", SimpleNamespace(get_ipython=lambda: shell))  # type: ignore[arg-type]
    monkeypatch.setitem(sys.modules, "IPython.display", SimpleNamespace(HTML=str, display=display))  # type: ignore[arg-type]
    with shown(True) as tell:
        assert tell is not None
        tell(at(50))
        tell(at(10, "<estimating>"))
    (texts,) = outputs
    assert [text.count("<progress ") for text in texts] == [1, 1, 1]
    assert texts[0].startswith("simulating <progress value=\"0.500\" max=\"1\"") and " step 50 of 100" in texts[0]
    assert texts[1].startswith("&lt;estimating&gt; <progress value=\"0.100\"")
    # In the end the time that it took.
    assert texts[2].endswith("</progress> 0 s")
