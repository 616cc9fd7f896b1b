// A bar along x (m) of two parts, finer to the left.
Point(1) = {0.02, 0, 0, 0.01};
Point(2) = {0.06, 0, 0, 0.02};
Point(3) = {0.12, 0, 0, 0.03};
Line(1) = {1, 2};
Line(2) = {3, 2};
Physical Curve("left") = {1};
Physical Curve("right") = {2};
Physical Point("start") = {1};
Physical Point("middle") = {2};
Physical Point("end") = {3};
