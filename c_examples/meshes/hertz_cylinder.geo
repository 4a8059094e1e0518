// Half of a cylinder, radius 8, one layer of hex8 thick: one body of the Hertz line contact.
//
// Axes: z vertical (contact normal), x along, y thickness. The contact line is x = 0.
//   side = -1: lower body, curved face up;   side = +1: upper body, curved face down.
// Run through generate.sh, or by hand:
//   gmsh -3 -setnumber side -1 hertz_cylinder.geo -o hertz_lower.msh
//
// Blocks in the (x, z) plane, drawn for the lower body; every one is transfinite and recombined:
//
//            A---M---B            A..B  the fine arc: `contact`
//           /|in |in |\           A..P, B..Q  the rest of the arc: graded, free
//          / D---N---C \          D..C  bottom of the fine zone
//         /  |   |   |  \         M..N..O  the plane x = 0: `middle`
//        P---S---O---T---Q        P..Q  the diametral face: `flat`

DefineConstant[
  side = -1,            // -1 lower, +1 upper
  contact_facets = 44,  // facets on the whole contact arc, even
  half_width = 1.4,     // half-width of the contact arc, about twice the Hertz half-width 0.680778
  far_cells = 14,       // cells from the fine zone to the flat face
  grow_far = 1.22       // growth from one of these to the next
];

R = 8;
thickness = 0.1;
// The bodies overlap by this much at x = 0. Two chains of chords that only touch have a positive
// weighted gap at every node: no node would be closed and nothing would carry the upper body.
overlap = (side > 0) ? 0.005 : 0;

across = contact_facets / 2;  // cells from x = 0 to the edge of the fine zone
depth = 1.2;                  // of the fine zone
down = Ceil(0.6 * across);    // cells over that depth
grow_down = 1.06;
foot = 3;                     // half-length of S..T

Macro Vertex  // x, and the distance `deep` below the top of the arc
  z = side * deep - overlap;
  Point(point) = {x, 0, z};
Return

top = R - Sqrt(R * R - half_width * half_width);
point = 1;  x = -half_width; deep = top;         Call Vertex;  // A
point = 2;  x = 0;           deep = 0;           Call Vertex;  // M
point = 3;  x = half_width;  deep = top;         Call Vertex;  // B
point = 4;  x = -half_width; deep = top + depth; Call Vertex;  // D
point = 5;  x = 0;           deep = top + depth; Call Vertex;  // N
point = 6;  x = half_width;  deep = top + depth; Call Vertex;  // C
point = 7;  x = -R;          deep = R;           Call Vertex;  // P
point = 8;  x = -foot;       deep = R;           Call Vertex;  // S
point = 9;  x = 0;           deep = R;           Call Vertex;  // O, centre of the cylinder
point = 10; x = foot;        deep = R;           Call Vertex;  // T
point = 11; x = R;           deep = R;           Call Vertex;  // Q

Circle(1) = {1, 9, 2};  Circle(2) = {2, 9, 3};   // A M B
Circle(3) = {1, 9, 7};  Circle(4) = {3, 9, 11};  // A P, B Q
Line(5) = {1, 4};  Line(6) = {2, 5};  Line(7) = {3, 6};     // A D, M N, B C
Line(8) = {4, 5};  Line(9) = {5, 6};                        // D N C
Line(10) = {4, 8}; Line(11) = {5, 9}; Line(12) = {6, 10};   // D S, N O, C T
Line(13) = {7, 8}; Line(14) = {8, 9}; Line(15) = {9, 10}; Line(16) = {10, 11};  // P S O T Q

Transfinite Curve {1, 2, 8, 9, 14, 15} = across + 1;
Transfinite Curve {5, 6, 7, 13} = down + 1 Using Progression grow_down;
Transfinite Curve {-16} = down + 1 Using Progression grow_down;
Transfinite Curve {3, 4, 10, 11, 12} = far_cells + 1 Using Progression grow_far;

Curve Loop(1) = {1, 6, -8, -5};     Plane Surface(1) = {1};  // A M N D
Curve Loop(2) = {2, 7, -9, -6};     Plane Surface(2) = {2};  // M B C N
Curve Loop(3) = {5, 10, -13, -3};   Plane Surface(3) = {3};  // A D S P
Curve Loop(4) = {8, 11, -14, -10};  Plane Surface(4) = {4};  // D N O S
Curve Loop(5) = {9, 12, -15, -11};  Plane Surface(5) = {5};  // N C T O
Curve Loop(6) = {4, -16, -12, -7};  Plane Surface(6) = {6};  // B Q T C
Transfinite Surface {1:6};
Recombine Surface {1:6};

// out[] of one surface: its copy, the volume, then one lateral face per curve of the loop.
For s In {1:6}
  out[] = Extrude {0, thickness, 0} { Surface{s}; Layers{1}; Recombine; };
  back[s] = out[0];
  volume[s] = out[1];
  For k In {0:3}
    lateral[4 * s + k] = out[2 + k];
  EndFor
EndFor

Physical Volume("cylinder") = {volume[1], volume[2], volume[3], volume[4], volume[5], volume[6]};
Physical Surface("contact") = {lateral[4], lateral[8]};                       // A M, M B
Physical Surface("flat") = {lateral[14], lateral[18], lateral[22], lateral[25]};  // P S, S O, O T, T Q
Physical Surface("middle") = {lateral[5], lateral[17]};                       // M N, N O
Physical Surface("ymin") = {1:6};
Physical Surface("ymax") = {back[1], back[2], back[3], back[4], back[5], back[6]};
