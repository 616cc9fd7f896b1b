"""The choices of the method: reconstructions of the contact force and fields Γ_DA, the default first."""

from __future__ import annotations

from typing import Any

RECONSTRUCTIONS = ("corrected", "consistent", "published")
ACCELERATIONS = ("closest", "rigid", "weak")
"""The Γ_DA that all reconstructions have."""
CHOICES: list[dict[str, Any]] = [{"reconstruction": r, "acceleration": a} for r in RECONSTRUCTIONS for a in ACCELERATIONS]
"""Their pairs, as arguments of `percute.estimate`."""
DEFAULT = ACCELERATIONS[0]
"""The default Γ_DA of bars."""
DEFAULTS = {"corrected": "split", "consistent": DEFAULT, "published": DEFAULT}
"""The default Γ_DA of plane bodies."""
PLANE_CHOICES = [{"reconstruction": "corrected", "acceleration": "split"}, *CHOICES]
"""All pairs of plane bodies."""


def of_default(reconstruction: str) -> int:
    """Give the place of a reconstruction with the default Γ_DA of bars among the choices."""
    return CHOICES.index({"reconstruction": reconstruction, "acceleration": DEFAULT})
