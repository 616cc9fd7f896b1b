"""Makes the mesh files of this folder by Gmsh: ``python make.py``, with gmsh 4.15.2 of PyPI."""

import gmsh

FORMATS = [("4.1", 0), ("4.1", 1), ("2.2", 0), ("2.2", 1)]


def write(name):
    """Write the mesh in all formats."""
    for version, binary in FORMATS:
        gmsh.option.setNumber("Mesh.MshFileVersion", float(version))
        gmsh.option.setNumber("Mesh.Binary", binary)
        gmsh.write(f"{name}-{version}{'-binary' if binary else ''}.msh")


gmsh.initialize()
gmsh.option.setNumber("General.Terminal", 0)
gmsh.open("block.geo")
gmsh.model.mesh.generate(2)
# Gaps, and another order than that of the file.
nodes, _, _ = gmsh.model.mesh.getNodes()
gmsh.model.mesh.renumberNodes(nodes, [7 * (len(nodes) - i) + 3 for i in range(len(nodes))])
_, elements, _ = gmsh.model.mesh.getElements()
tags = [tag for of_kind in elements for tag in of_kind]
gmsh.model.mesh.renumberElements(tags, [11 * (len(tags) - i) for i in range(len(tags))])
write("block")

gmsh.clear()
gmsh.open("bar.geo")
gmsh.model.mesh.generate(1)
write("bar")
gmsh.finalize()
