// A beam, 200 mm long and 20 mm high, in mm. A round foot, 2 mm deep, is below its free end.
// gmsh -2 beam.geo -format msh41
Point(1) = {0, 0, 0};
Point(2) = {160, 0, 0};
Point(3) = {200, 0, 0};
Point(4) = {200, 20, 0};
Point(5) = {0, 20, 0};
Point(6) = {180, 99, 0};
Line(1) = {1, 2};
Circle(2) = {2, 6, 3};
Line(3) = {3, 4};
Line(4) = {4, 5};
Line(5) = {5, 1};
Curve Loop(1) = {1, 2, 3, 4, 5};
Plane Surface(1) = {1};
Physical Surface("beam") = {1};
Physical Curve("clamp") = {5};
Physical Curve("foot") = {2};
MeshSize {:} = 4;
MeshSize {2, 3} = 2;
