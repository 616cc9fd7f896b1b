// A block of two materials (mm): the left part is meshed clockwise, the point 9 belongs to no triangle.
h = 12;
Point(1) = {0, 0, 5, h};
Point(2) = {20, 0, 5, h};
Point(3) = {50, 0, 5, h};
Point(4) = {50, 40, 5, h};
Point(5) = {20, 40, 5, h};
Point(6) = {0, 40, 5, h};
Point(9) = {25, 60, 5, h};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 5};
Line(5) = {5, 6};
Line(6) = {6, 1};
Line(7) = {2, 5};
Curve Loop(1) = {-7, -1, -6, -5};
Plane Surface(1) = {1};
Curve Loop(2) = {2, 3, 4, -7};
Plane Surface(2) = {2};
Physical Surface("steel") = {1};
Physical Surface("aluminium") = {2};
// Without a name; the first surface is in two groups.
Physical Surface(30) = {1};
Physical Curve("bottom") = {1, 2};
Physical Curve("right side") = {3};
Physical Curve("Dach, außen") = {4, -5};
// Inside the body.
Physical Curve("interface") = {7};
Physical Point("probe") = {9};
