// Die of the shallow ironing test (Fischer and Wriggers 2006), one layer of hex8 thick.
//
// Axes: z vertical (contact normal), x along, y thickness. 1.2 wide, from x = 0.2; the lower edge is an arc of radius
// 0.75 with its lowest point at (0.8, 4.2) and its ends at z = 4.5; the sides go up to z = 5.4.
// Run through generate.sh, or by hand:
//   gmsh -3 ironing_die.geo -o ironing_die.msh
DefineConstant[
  along = 12, // cells along the arc
  up = 6      // and up the sides
];

radius = 0.75;
left = 0.2; middle = 0.8; right = 1.4;
lowest = 4.2; corner = 4.5; top = 5.4;
thickness = 1;

Point(1) = {left, 0, corner};
Point(2) = {right, 0, corner};
Point(3) = {right, 0, top};
Point(4) = {left, 0, top};
Point(5) = {middle, 0, lowest + radius}; // centre of the arc
Circle(1) = {1, 5, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Transfinite Curve {1, 3} = along + 1;
Transfinite Curve {2, 4} = up + 1;
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Transfinite Surface {1};
Recombine Surface {1};
out[] = Extrude {0, thickness, 0} { Surface{1}; Layers{1}; Recombine; }; // copy, volume, a face per curve

Physical Volume("die") = {out[1]};
Physical Surface("contact") = {out[2], out[3], out[5]}; // the arc and both sides: the base reaches round the corners
Physical Surface("head") = {out[4]};
Physical Surface("ymin") = {1};
Physical Surface("ymax") = {out[0]};
