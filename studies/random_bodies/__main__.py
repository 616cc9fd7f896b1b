"""The command: runs random bodies, and prints their table."""

from __future__ import annotations

import argparse
import csv
import multiprocessing
import os
import signal
import sys
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from contextlib import contextmanager
from functools import partial
from pathlib import Path

from percute import PercuteError, Progress
from percute.progress import shown
from studies.random_bodies.cases import KINDS
from studies.random_bodies.judge import COLUMNS, HEADER, Row, judged, line, summary

DONE, BAD_INPUT, INTERRUPTED = 0, 2, 130


def _parser() -> argparse.ArgumentParser:
    text = "Make random bodies, and print how close the estimate of their error is to the true one, beside what the verdict states."
    parser = argparse.ArgumentParser("python -m studies.random_bodies", description=text, allow_abbrev=False)
    parser.add_argument("--seed", type=_whole(0), default=0, metavar="S", help="seed of the first body [default: %(default)s]")
    parser.add_argument("--count", type=_whole(1), default=20, metavar="N", help="number of bodies, with the seeds S to S + N − 1 [default: %(default)s]")
    parser.add_argument("--kind", choices=KINDS, default=KINDS[0], help="what the bodies do [default: %(default)s]")
    parser.add_argument("--jobs", type=_whole(1), default=1, metavar="J", help="processes side by side [default: %(default)s]; no number depends on it")
    parser.add_argument("--csv", type=Path, metavar="FILE", help="a table to which each body is added once it is done; bodies in it are not run again")
    parser.add_argument("--again", action="store_true", help="run bodies again that are in the table")
    further = "refine the reference so many further times [default: %(default)s]: with 1, a body takes four to eight times as long"
    parser.add_argument("--further", type=_whole(0), default=0, metavar="R", help=further)
    return parser


def _whole(least: int) -> Callable[[str], int]:
    """Read a whole number from a least one on."""

    def read(text: str) -> int:
        if not text.isdecimal() or int(text) < least:
            raise argparse.ArgumentTypeError(f"{text!r}; it must be a whole number from {least} on")
        return int(text)

    return read


def stored(file: Path) -> list[Row]:
    """Read the rows of a table; a line that was cut off by the end of a process is left out."""
    if not file.exists():
        return []
    with file.open(newline="", encoding="utf-8") as lines:
        header, *rows = list(csv.reader(lines)) or [COLUMNS]
    if header != COLUMNS:
        raise ValueError(f"{file}: not a table of random bodies of this version; give another name")
    if rows and len(rows[-1]) < len(COLUMNS):
        rows.pop()
    return [Row.of_cells(row) for row in rows]


class Table:
    """The rows in memory, and in a file if there is one."""

    def __init__(self, file: Path | None, rows: Sequence[Row]) -> None:
        self.file = file
        self.rows = {(row.kind, row.further, row.seed): row for row in rows}
        if file is not None:
            # Anew, without what was cut off or is to be run again.
            draft = file.with_name(f"{file.name}.new")
            with draft.open("w", newline="", encoding="utf-8") as lines:
                csv.writer(lines, lineterminator="\n").writerows([COLUMNS, *(row.cells for row in rows)])
            os.replace(draft, file)

    def add(self, row: Row) -> None:
        """Add a row; it is in the file at once."""
        self.rows[row.kind, row.further, row.seed] = row
        if self.file is not None:
            with self.file.open("a", newline="", encoding="utf-8") as lines:
                csv.writer(lines, lineterminator="\n").writerow(row.cells)


def rows_of(kind: str, seeds: Sequence[int], further: int, jobs: int) -> Iterator[Row]:
    """Run bodies in so many processes; give their rows in the order of the seeds."""
    work = partial(judged, kind, further=further)
    if jobs <= 1 or len(seeds) <= 1:
        yield from map(work, seeds)
        return
    # Ctrl-C goes to all processes of a terminal; the first one ends the others.
    ignore = partial(signal.signal, signal.SIGINT, signal.SIG_IGN)
    pool = ProcessPoolExecutor(min(jobs, len(seeds)), multiprocessing.get_context("spawn"), initializer=ignore)
    try:
        for future in [pool.submit(work, seed) for seed in seeds]:
            yield future.result()
    except BaseException:
        # A body takes seconds: its result would be waited for, and left out.
        for process in list(pool._processes.values()):
            process.terminate()
        raise
    finally:
        pool.shutdown(cancel_futures=True)


@contextmanager
def _signals() -> Iterator[None]:
    """Take SIGTERM and SIGHUP, with which batch systems and terminals end processes, for Ctrl-C."""
    taken = [getattr(signal, name) for name in ("SIGTERM", "SIGHUP") if hasattr(signal, name)]
    before = [signal.getsignal(number) for number in taken]
    for number, handler in zip(taken, before, strict=True):
        if handler == signal.SIG_DFL:
            signal.signal(number, signal.default_int_handler)
    try:
        yield
    finally:
        for number, handler in zip(taken, before, strict=True):
            signal.signal(number, handler)


def main(arguments: Sequence[str]) -> int:
    """Run the command with these arguments, without its name, and return its exit code."""
    given = _parser().parse_args(arguments)
    wanted = range(given.seed, given.seed + given.count)
    keys = [(given.kind, given.further, seed) for seed in wanted]
    try:
        rows = stored(given.csv) if given.csv else []
        if given.again:
            rows = [row for row in rows if (row.kind, row.further, row.seed) not in keys]
        table = Table(given.csv, rows)
    except (OSError, ValueError) as error:
        print(f"error: {error}", file=sys.stderr)
        return BAD_INPUT
    left = [seed for kind, further, seed in keys if (kind, further, seed) not in table.rows]
    code = DONE
    try:
        with _signals(), shown(True) as tell:
            for done, row in enumerate(rows_of(given.kind, left, given.further, given.jobs), start=1):
                table.add(row)
                if tell is not None:
                    tell(Progress("running bodies", done, len(left)))
    except PercuteError as error:
        print(f"error: {error}", file=sys.stderr)
        return BAD_INPUT
    except KeyboardInterrupt:
        code = INTERRUPTED
        print("interrupted" + f": {given.csv} has the bodies that are done" * (given.csv is not None), file=sys.stderr)
    found = [table.rows[key] for key in keys if key in table.rows]
    print("\n".join([HEADER, f"|{'---|' * (HEADER.count('|') - 1)}", *map(line, found), "", *summary(found)]))
    return code


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
