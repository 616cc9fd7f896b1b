"""Patch tests: a uniform stress, in a body that flies (case patch.toml) and against the ground (patch_contact.toml).

A linear displacement is in the finite-element space, whatever the mesh. With the tractions of its stress nothing swings, and
the estimate is zero to rounding for all choices of the method. Against the ground the reactions are those of the uniform pressure.
"""

import percute as pc

from pack import HERE, compare


def main() -> None:
    """Compare stresses and estimates."""
    history = pc.run(HERE / "patch.toml").history
    for reconstruction in (None, "published"):
        for acceleration in ("closest", "rigid", "weak"):
            estimate = pc.estimate(history, reconstruction=reconstruction, acceleration=acceleration)
            name = reconstruction or "the default"
            compare(f"relative error, {name}, {acceleration}", 0.0, [estimate.relative_sup])
    estimate = pc.run(HERE / "patch_contact.toml")
    density = estimate.contact.density
    compare("largest pressure on the ground", 5e7, [float(density[:, :, 1].max())], "Pa")
    compare("smallest pressure on the ground", 5e7, [float(density[:, :, 1].min())], "Pa")
    compare("largest shear on the ground", -1e7, [float(density[:, :, 0].min())], "Pa")
    compare("relative error in contact", 0.0, [estimate.relative_sup])


if __name__ == "__main__":
    main()
