// Lower half of the channel of the press fit (Fischer & Wriggers 2006): one body of hex8, extruded across the channel.
//
// Axes: x along the channel, y across, z vertical; the bottom is z = 0. Lengths in mm.
//
//                          _________________________  z = 300
//   z = 250  _____________/                            `contact`: flat, ramp, flat
//           |   800       |200|      900             |
//           |_____________|___|______________________|
//
// With a `radius` the upper edge at x = 1900 is an arc of a quarter of a circle, which belongs to `contact`.
//
// Run through generate.sh, or by hand:  gmsh -3 press_fit_channel.geo -o press_fit_channel.msh

DefineConstant[
  before = 2, ramp = 1, after = 2,  // cells along each of the three parts
  down = 3,                         // cells over the height
  radius = 0, bend = 8,             // of the edge at x = 1900, 0: sharp; cells round it
  width = 25, across = 1            // extent along y, from 0, and cells over it
];

end = 1900 - radius;
Point(1) = {0, 0, 0};     Point(2) = {800, 0, 0};   Point(3) = {1000, 0, 0};   Point(4) = {end, 0, 0};
Point(5) = {0, 0, 250};   Point(6) = {800, 0, 250}; Point(7) = {1000, 0, 300}; Point(8) = {end, 0, 300};
Line(1) = {1, 2};  Line(2) = {2, 3};  Line(3) = {3, 4};
Line(4) = {5, 6};  Line(5) = {6, 7};  Line(6) = {7, 8};
Line(7) = {1, 5};  Line(8) = {2, 6};  Line(9) = {3, 7};  Line(10) = {4, 8};
Transfinite Curve {1, 4} = before + 1;
Transfinite Curve {2, 5} = ramp + 1;
Transfinite Curve {3, 6} = after + 1;
Transfinite Curve {7, 8, 9, 10} = down + 1;

Curve Loop(1) = {1, 8, -4, -7};   Plane Surface(1) = {1};
Curve Loop(2) = {2, 9, -5, -8};   Plane Surface(2) = {2};
Curve Loop(3) = {3, 10, -6, -9};  Plane Surface(3) = {3};

back[] = {};  volume[] = {};  bottom[] = {};  top[] = {};
parts = 3;
If (radius > 0)
  parts = 4;
  Point(9) = {1900, 0, 0};  Point(10) = {1900, 0, 300 - radius};  Point(11) = {end, 0, 300 - radius};
  Line(11) = {4, 9};  Circle(12) = {8, 11, 10};  Line(13) = {9, 10};
  Transfinite Curve {11, 12} = bend + 1;
  Transfinite Curve {13} = down + 1;
  Curve Loop(4) = {11, 13, -12, -10};  Plane Surface(4) = {4};
EndIf
Transfinite Surface {1:parts};
Recombine Surface {1:parts};

// out[] of one surface: its copy, the volume, then one lateral face per curve of the loop.
For s In {1:parts}
  out[] = Extrude {0, width, 0} { Surface{s}; Layers{across}; Recombine; };
  back[] += out[0];
  volume[] += out[1];
  bottom[] += out[2];
  top[] += out[4];
EndFor

Physical Volume("channel") = {volume[]};
Physical Surface("contact") = {top[]};
Physical Surface("bottom") = {bottom[]};
Physical Surface("ymin") = {1:parts};
Physical Surface("ymax") = {back[]};
