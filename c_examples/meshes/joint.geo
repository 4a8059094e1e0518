// A lug (part 1) between the cheeks of a fork (2), and a pin (3) through both with clearance. In a chain a link (4) with two holes is in place of
// the lug, with another pin (3, at = 6) and a fork the other way round (5). Twenty facets round each circle.
SetFactory("OpenCASCADE");
If (!Exists(part)) part = 1; EndIf
If (!Exists(at)) at = 0; EndIf
hole = 1.01;
If (part == 1)
  Box(1) = {0, -2, -0.5, 6, 4, 1};
  Cylinder(2) = {0, 0, -0.5, 0, 0, 1, 2};
  BooleanUnion(3) = { Volume{1}; Delete; }{ Volume{2}; Delete; };
  Cylinder(4) = {0, 0, -0.5, 0, 0, 1, hole};
  BooleanDifference(5) = { Volume{3}; Delete; }{ Volume{4}; Delete; };
  Physical Volume("lug") = {5};
  Physical Surface("pull") = Surface In BoundingBox {5.99, -3, -1, 6.01, 3, 1};
  Physical Surface("hole") = Surface In BoundingBox {-1.1, -1.1, -0.6, 1.1, 1.1, 0.6};
ElseIf (part == 2)
  Box(1) = {-7, -2, 0.55, 7, 4, 0.55};
  Box(2) = {-7, -2, -1.1, 7, 4, 0.55};
  Box(3) = {-7, -2, -0.55, 1.5, 4, 1.1};
  Cylinder(4) = {0, 0, 0.55, 0, 0, 0.55, 2};
  Cylinder(5) = {0, 0, -1.1, 0, 0, 0.55, 2};
  BooleanUnion(6) = { Volume{1}; Delete; }{ Volume{2:5}; Delete; };
  Cylinder(7) = {0, 0, -1.1, 0, 0, 2.2, hole};
  BooleanDifference(8) = { Volume{6}; Delete; }{ Volume{7}; Delete; };
  Physical Volume("fork") = {8};
  Physical Surface("root") = Surface In BoundingBox {-7.01, -3, -2, -6.99, 3, 2};
  Physical Surface("holes") = Surface In BoundingBox {-1.1, -1.1, -1.2, 1.1, 1.1, 1.2};
ElseIf (part == 4)
  Box(1) = {0, -2, -0.5, 6, 4, 1};
  Cylinder(2) = {0, 0, -0.5, 0, 0, 1, 2};
  Cylinder(3) = {6, 0, -0.5, 0, 0, 1, 2};
  BooleanUnion(4) = { Volume{1}; Delete; }{ Volume{2:3}; Delete; };
  Cylinder(5) = {0, 0, -0.5, 0, 0, 1, hole};
  Cylinder(6) = {6, 0, -0.5, 0, 0, 1, hole};
  BooleanDifference(7) = { Volume{4}; Delete; }{ Volume{5:6}; Delete; };
  Physical Volume("link") = {7};
  Physical Surface("left") = Surface In BoundingBox {-1.1, -1.1, -0.6, 1.1, 1.1, 0.6};
  Physical Surface("right") = Surface In BoundingBox {4.9, -1.1, -0.6, 7.1, 1.1, 0.6};
ElseIf (part == 5)
  Box(1) = {6, -2, 0.55, 7, 4, 0.55};
  Box(2) = {6, -2, -1.1, 7, 4, 0.55};
  Box(3) = {11.5, -2, -0.55, 1.5, 4, 1.1};
  Cylinder(4) = {6, 0, 0.55, 0, 0, 0.55, 2};
  Cylinder(5) = {6, 0, -1.1, 0, 0, 0.55, 2};
  BooleanUnion(6) = { Volume{1}; Delete; }{ Volume{2:5}; Delete; };
  Cylinder(7) = {6, 0, -1.1, 0, 0, 2.2, hole};
  BooleanDifference(8) = { Volume{6}; Delete; }{ Volume{7}; Delete; };
  Physical Volume("end") = {8};
  Physical Surface("pull") = Surface In BoundingBox {12.99, -3, -2, 13.01, 3, 2};
  Physical Surface("holes") = Surface In BoundingBox {4.9, -1.1, -1.2, 7.1, 1.1, 1.2};
Else
  Cylinder(1) = {at, 0, -1.2, 0, 0, 2.4, 1};
  Physical Volume("pin") = {1};
  Physical Surface("side") = {1};
EndIf
Mesh.MeshSizeFromCurvature = 20;
Mesh.MeshSizeMax = 0.8;
