// The section of a cup in mm: 70 mm wide, 90 mm high, walls of 3 mm and round edges. It has turned by 20° about its lowest point.
// gmsh -2 cup.geo -format msh41
Point(1) = {0, 8, 0};
Point(2) = {8, 0, 0};
Point(3) = {62, 0, 0};
Point(4) = {70, 8, 0};
Point(5) = {70, 90, 0};
Point(6) = {67, 90, 0};
Point(7) = {67, 8, 0};
Point(8) = {62, 3, 0};
Point(9) = {8, 3, 0};
Point(10) = {3, 8, 0};
Point(11) = {3, 90, 0};
Point(12) = {0, 90, 0};
Point(13) = {8, 8, 0};
Point(14) = {62, 8, 0};
Rotate {{0, 0, 1}, {8, 0, 0}, Pi / 9} { Point{:}; }
Circle(1) = {1, 13, 2};
Line(2) = {2, 3};
Circle(3) = {3, 14, 4};
Line(4) = {4, 5};
Line(5) = {5, 6};
Line(6) = {6, 7};
Circle(7) = {7, 14, 8};
Line(8) = {8, 9};
Circle(9) = {9, 13, 10};
Line(10) = {10, 11};
Line(11) = {11, 12};
Line(12) = {12, 1};
Curve Loop(1) = {1:12};
Plane Surface(1) = {1};
Physical Surface("cup") = {1};
MeshSize {:} = 1.5;
