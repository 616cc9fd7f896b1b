"""Meshes compare by their contents, and the package names what is public."""

import pickle

import numpy as np
import percute as pc
import pytest


def triangle(**changed: object) -> pc.Mesh:
    right: dict[str, object] = {"points": [[0, 0], [1, 0], [0, 1]], "cells": [[0, 1, 2]]}
    right |= {"edge_groups": {"bottom": [[0, 1]]}, "element_groups": {"all": [0]}}
    return pc.Mesh(**(right | changed))  # type: ignore[arg-type]


def test_meshes_with_the_same_contents_are_equal() -> None:
    mesh = triangle()
    assert mesh == triangle() == pickle.loads(pickle.dumps(mesh)) and hash(mesh) == hash(triangle())
    # Another number, sign of zero apart, is another mesh.
    assert mesh == triangle(points=[[0, 0], [1, -0.0], [0, 1]]) and hash(mesh) == hash(triangle(points=[[0, 0], [1, -0.0], [0, 1]]))
    assert len({mesh, triangle(), mesh.refine(0), mesh.refine()}) == 2


@pytest.mark.parametrize(
    "changed",
    [
        {"points": [[0, 0], [1, 0], [0, np.nextafter(1, 2)]]},
        {"cells": [[1, 2, 0]]},
        {"edge_groups": {"bottom": [[1, 2]]}},
        {"edge_groups": {"low": [[0, 1]]}},
        {"element_groups": {}},
    ],
)
def test_other_meshes_differ(changed: dict[str, object]) -> None:
    assert triangle() != triangle(**changed)
    assert triangle() != 3 and triangle() != pc.Mesh.bar(1.0, elements=2)


def test_the_package_lists_its_public_names_only() -> None:
    assert dir(pc) == sorted(pc.__all__)
