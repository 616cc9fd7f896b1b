"""Words of messages and descriptions."""

from __future__ import annotations


def counted(count: int, thing: str) -> str:
    """Give a number of things, such as ``1 step`` or ``2 steps``."""
    return f"{count} {thing}{'' if count == 1 else 's'}"
