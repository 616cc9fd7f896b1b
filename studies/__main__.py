"""The command ``python -m studies``: computes the evidence."""

from __future__ import annotations

import argparse
import signal
import sys
from collections.abc import Sequence
from pathlib import Path

from percute.errors import ExistingFileError, InputError, PercuteError
from percute.estimating import pace
from percute.progress import shown
from studies.parallel import Resolution
from studies.catalogue import STUDIES, Study, chosen, run

DONE, FAILED, BAD_INPUT, INTERRUPTED = 0, 1, 2, 130


def _parser() -> argparse.ArgumentParser:
    text = "Compute the evidence again: the paper's tables and figures, exact solutions, how close the estimate is to the true error"
    parser = argparse.ArgumentParser("python -m studies", description=text, allow_abbrev=False)
    parser.add_argument("studies", nargs="*", help="which studies, by the names that --list prints [default: all]")
    parser.add_argument("--output", type=Path, default=Path("percute-evidence"), metavar="FOLDER", help="the folder [default: %(default)s]")
    parser.add_argument("--list", action="store_true", help="print the names of the studies and end")
    parser.add_argument("--small", action="store_true", help="compute some rows of each table only; the numbers are the same")
    parser.add_argument("--force", "--overwrite", action="store_true", help="replace files that are there")
    parser.add_argument("--threads", type=int, metavar="N", help="number of threads [default: one for each core]; no number depends on it")
    parser.add_argument("--quiet", action="store_true", help="no progress on standard error")
    return parser


def _said(error: PercuteError) -> str:
    """Give the message of an error in the words of the command."""
    return str(error).replace("`folder`: ", "--output: ").replace("`studies`: ", "").replace("`threads`", "--threads").replace("overwrite=True", "--force")


def main(arguments: Sequence[str]) -> int:
    """Run the command with these arguments, without its name, and return its exit code."""
    given = _parser().parse_args(arguments)
    if given.list:
        width = max(len(study.key) for study in STUDIES)
        print("\n".join(f"{study.key:{width}}  {study.title}" for study in STUDIES))
        return DONE
    # SIGTERM and SIGHUP, with which batch systems and terminals end processes, are like Ctrl-C. `nohup` ignores SIGHUP.
    for name in ("SIGTERM", "SIGHUP"):
        if hasattr(signal, name) and signal.getsignal(getattr(signal, name)) == signal.SIG_DFL:
            signal.signal(getattr(signal, name), signal.default_int_handler)
    done: list[Study] = []
    code, page = DONE, given.output / "index.html"
    try:
        studies = chosen(given.studies)
        with shown(not given.quiet) as tell:

            def tell_done(study: Study) -> None:
                done.append(study)
                if not given.quiet:
                    print(f"\r\x1b[K" * sys.stderr.isatty() + f"{len(done)} of {len(studies)} studies done: {study.title}", file=sys.stderr)

            run(given.output, studies, Resolution(given.small, pace(given.threads, None)[0], tell=tell), given.force, tell_done)
    except KeyboardInterrupt:
        code = INTERRUPTED
    except PercuteError as error:
        print(f"error: {_said(error)}", file=sys.stderr)
        return BAD_INPUT if isinstance(error, ExistingFileError | InputError) and not done else FAILED
    if not done:
        print("interrupted: no study is done", file=sys.stderr)
        return code
    print(f"{page}: {len(done)} of {len(studies)} studies{', INTERRUPTED' if code else ''}")
    return code


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
