// Die of the ironing test in three dimensions: half a tube of hex8 that lies across the slab, one half of its length.
//
// Axes: x along, y along the tube's axis, z vertical (contact normal). Outer radius 3, thickness 0.2; the lowest line
// is at x = 2.5, z = 3, the ends of the half circle at z = 6; y from 0, the plane of symmetry, to 2.6.
// Run through generate.sh, or by hand:
//   gmsh -3 ironing_tube.geo -o ironing_tube.msh
DefineConstant[
  quarter = 12, // cells along a quarter of the circle
  across = 6,   // along the axis
  wall = 1      // through the wall
];

outer = 3; inner = 2.8;
x = 2.5; z = 6;
half = 2.6;

Point(1) = {x, 0, z}; // centre
Point(2) = {x - outer, 0, z};  Point(3) = {x, 0, z - outer};  Point(4) = {x + outer, 0, z};
Point(5) = {x - inner, 0, z};  Point(6) = {x, 0, z - inner};  Point(7) = {x + inner, 0, z};
Circle(1) = {2, 1, 3};  Circle(2) = {3, 1, 4};
Circle(3) = {5, 1, 6};  Circle(4) = {6, 1, 7};
Line(5) = {2, 5};  Line(6) = {3, 6};  Line(7) = {4, 7};
Transfinite Curve {1, 2, 3, 4} = quarter + 1;
Transfinite Curve {5, 6, 7} = wall + 1;
Curve Loop(1) = {1, 6, -3, -5};  Plane Surface(1) = {1};
Curve Loop(2) = {2, 7, -4, -6};  Plane Surface(2) = {2};
Transfinite Surface {1, 2};
Recombine Surface {1, 2};
left[] = Extrude {0, half, 0} { Surface{1}; Layers{across}; Recombine; }; // copy, volume, a face per curve
right[] = Extrude {0, half, 0} { Surface{2}; Layers{across}; Recombine; };

Physical Volume("die") = {left[1], right[1]};
Physical Surface("contact") = {left[2], right[2]};
Physical Surface("head") = {left[5], right[3]};
Physical Surface("ymin") = {1, 2};
Physical Surface("ymax") = {left[0], right[0]};
