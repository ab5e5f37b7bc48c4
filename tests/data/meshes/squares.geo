// A 4 x 4 square of unit squares, as triangles or quadrilaterals, or 2 units high as hexahedra. kind: see make.sh.
SetFactory("Built-in");
DefineConstant[ kind = 1 ];
n = 4;
height = 0;
If (kind >= 3)
  height = 2;
EndIf
If (kind == 4)
  n = 2;
EndIf
For j In {0 : n}
  For i In {0 : n}
    Point(100 + 10 * j + i) = {i, j, 0};
  EndFor
EndFor
For j In {0 : n}
  For i In {0 : n}
    If (i < n)
      Line(200 + 10 * j + i) = {100 + 10 * j + i, 100 + 10 * j + i + 1};
      Transfinite Curve {200 + 10 * j + i} = 2;
    EndIf
    If (j < n)
      Line(300 + 10 * j + i) = {100 + 10 * j + i, 100 + 10 * (j + 1) + i};
      Transfinite Curve {300 + 10 * j + i} = 2;
    EndIf
  EndFor
EndFor
For j In {0 : n - 1}
  For i In {0 : n - 1}
    Curve Loop(400 + 10 * j + i) = {200 + 10 * j + i, 300 + 10 * j + i + 1, -(200 + 10 * (j + 1) + i), -(300 + 10 * j + i)};
    Plane Surface(400 + 10 * j + i) = {400 + 10 * j + i};
    Transfinite Surface {400 + 10 * j + i};
    If (kind >= 2)
      Recombine Surface {400 + 10 * j + i};
    EndIf
  EndFor
EndFor

e = 0.01;
If (height == 0)  // a fracture through and one that ends on it
  Physical Curve("f1") = Curve In BoundingBox {-e, 2 - e, -e, 4 + e, 2 + e, e};
  Physical Curve("f2") = Curve In BoundingBox {2 - e, 2 - e, -e, 2 + e, 4 + e, e};
  Physical Curve("west") = Curve In BoundingBox {-e, -e, -e, e, 4 + e, e};
  Physical Surface("south rock") = Surface In BoundingBox {-e, -e, -e, 4 + e, 2 + e, e};
  Physical Surface("north rock") = Surface In BoundingBox {-e, 2 - e, -e, 4 + e, 4 + e, e};
Else
  Extrude {0, 0, height} { Surface {:}; Layers {height}; Recombine; }
  If (kind == 3)  // two immersed planes cross
    Physical Surface("f1") = Surface In BoundingBox {1 - e, 2 - e, -e, 3 + e, 2 + e, 2 + e};
    Physical Surface("f2") = Surface In BoundingBox {2 - e, 1 - e, -e, 2 + e, 3 + e, 2 + e};
  Else  // two planes through, which touch the bottom
    Physical Surface("f1") = Surface In BoundingBox {-e, 1 - e, -e, 2 + e, 1 + e, 2 + e};
    Physical Surface("f2") = Surface In BoundingBox {1 - e, -e, -e, 1 + e, 2 + e, 2 + e};
  EndIf
  Physical Surface("bottom") = Surface In BoundingBox {-e, -e, -e, n + e, n + e, e};
  Physical Volume("rock") = Volume In BoundingBox {-e, -e, -e, n + e, n + e, 2 + e};
EndIf
