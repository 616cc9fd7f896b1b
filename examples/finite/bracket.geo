// A bracket in mm: an L with legs of 80 and 60 mm, 15 mm thick, that has turned by 10° about its corner.
// gmsh -2 bracket.geo -format msh41
Point(1) = {0, 0, 0};
Point(2) = {80, 0, 0};
Point(3) = {80, 15, 0};
Point(4) = {15, 15, 0};
Point(5) = {15, 60, 0};
Point(6) = {0, 60, 0};
Rotate {{0, 0, 1}, {0, 0, 0}, Pi / 18} { Point{:}; }
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 5};
Line(5) = {5, 6};
Line(6) = {6, 1};
Curve Loop(1) = {1:6};
Plane Surface(1) = {1};
Physical Surface("bracket") = {1};
MeshSize {:} = 3.5;
