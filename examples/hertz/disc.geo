// A disc of radius 10 mm around the origin, for Gmsh 4 (https://gmsh.info); sizes in m.
//     gmsh -2 disc.geo -o disc.msh        (disc.msh is from Gmsh 4.15.2)
// The triangles are finest at the first point of contact, (0, -R). The half-width of contact there is about a tenth of R.
SetFactory("Built-in");
R = 0.01;
fine = R / 160;     // near the contact point ...
near = 0.11 * R;     // ... up to this distance,
coarse = R / 11;    // and far away,
far = 1.2 * R;      // from this distance on

Point(1) = {0, 0, 0};
Point(2) = {0, -R, 0};
Point(3) = {R, 0, 0};
Point(4) = {0, R, 0};
Point(5) = {-R, 0, 0};
Circle(1) = {2, 1, 3};
Circle(2) = {3, 1, 4};
Circle(3) = {4, 1, 5};
Circle(4) = {5, 1, 2};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};

Physical Surface("disc") = {1};
Physical Curve("lower") = {1, 4};   // the half that faces the plane

Field[1] = Distance;
Field[1].PointsList = {2};
Field[2] = Threshold;
Field[2].InField = 1;
Field[2].SizeMin = fine;
Field[2].SizeMax = coarse;
Field[2].DistMin = near;
Field[2].DistMax = far;
Background Field = 2;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;
Mesh.MeshSizeFromCurvature = 0;
Mesh.Algorithm = 6;             // frontal Delaunay: nearly equilateral triangles
Mesh.MshFileVersion = 4.1;
Mesh.Binary = 1;
