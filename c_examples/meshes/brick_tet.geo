// Brick 1 x 1 x 0.5 of tet4, faces tri3: one body of a patch test that mixes cell kinds.
//   side = -1: z in [-0.5, 0];   side = +1: z in [0, 0.5].   The interface is z = 0 in both.
// The unstructured faces match nothing, so any partner gives a non-matching interface.
DefineConstant[ side = -1, cells = 4 ];  // cells along an edge of length 1

low = (side < 0) ? -0.5 : 0;
size = 1 / cells;
Point(1) = {0, 0, low, size};  Point(2) = {1, 0, low, size};
Point(3) = {1, 1, low, size};  Point(4) = {0, 1, low, size};
Line(1) = {1, 2};  Line(2) = {2, 3};  Line(3) = {3, 4};  Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
out[] = Extrude {0, 0, 0.5} { Surface{1}; };  // top, volume, then the face over each curve

Physical Volume("brick") = {out[1]};
Physical Surface("zmin") = {1};
Physical Surface("zmax") = {out[0]};
Physical Surface("ymin") = {out[2]};
Physical Surface("xmax") = {out[3]};
Physical Surface("ymax") = {out[4]};
Physical Surface("xmin") = {out[5]};
