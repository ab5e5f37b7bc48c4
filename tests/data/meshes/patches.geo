// A cube with fractures made of squares of 3/4, each two triangles, about its middle; tetrahedra. kind: see make.sh.
SetFactory("Built-in");
DefineConstant[ kind = 1 ];
Mesh.MeshSizeMin = 3;
Mesh.MeshSizeMax = 3;
Mesh.MeshSizeExtendFromBoundary = 0;
For k In {0 : 2}
  For j In {0 : 2}
    For i In {0 : 2}
      Point(100 * k + 10 * j + i + 1) = {0.25 + 0.75 * i, 0.25 + 0.75 * j, 0.25 + 0.75 * k};
    EndFor
  EndFor
EndFor
a() = {1000, 1001, 1002, 1003, 1004, 1005, 1006, 1007};
For c In {0 : 7}
  Point(1000 + c) = {2 * (c % 2), 2 * (Floor(c / 2) % 2), 2 * Floor(c / 4)};
EndFor
Line(1) = {1000, 1001}; Line(2) = {1001, 1003}; Line(3) = {1003, 1002}; Line(4) = {1002, 1000};
Line(5) = {1004, 1005}; Line(6) = {1005, 1007}; Line(7) = {1007, 1006}; Line(8) = {1006, 1004};
Line(9) = {1000, 1004}; Line(10) = {1001, 1005}; Line(11) = {1003, 1007}; Line(12) = {1002, 1006};
Curve Loop(1) = {1, 2, 3, 4}; Curve Loop(2) = {5, 6, 7, 8}; Curve Loop(3) = {1, 10, -5, -9};
Curve Loop(4) = {2, 11, -6, -10}; Curve Loop(5) = {3, 12, -7, -11}; Curve Loop(6) = {4, 9, -8, -12};
For s In {1 : 6}
  Plane Surface(s) = {s};
EndFor
Surface Loop(1) = {1 : 6};
Volume(1) = {1};

// Lines of the lattice of 3 x 3 x 3 points: 2000 + point in x, 3000 + in y, 4000 + in z.
For k In {0 : 2}
  For j In {0 : 2}
    For i In {0 : 2}
      p = 100 * k + 10 * j + i + 1;
      If (i < 2)
        Line(2000 + p) = {p, p + 1};
      EndIf
      If (j < 2)
        Line(3000 + p) = {p, p + 10};
      EndIf
      If (k < 2)
        Line(4000 + p) = {p, p + 100};
      EndIf
    EndFor
  EndFor
EndFor
// Squares at a point: 5000 + point normal to x, 6000 + to y, 7000 + to z.
f1() = {}; f2() = {}; f3() = {};
For u In {0 : 1}
  For v In {0 : 1}
    p = 100 * v + 10 * u + 2;  // x = 1
    Curve Loop(5000 + p) = {3000 + p, 4000 + p + 10, -(3000 + p + 100), -(4000 + p)};
    Plane Surface(5000 + p) = {5000 + p};
    f1() += {5000 + p};
    p = 100 * v + u + 11;  // y = 1
    Curve Loop(6000 + p) = {2000 + p, 4000 + p + 1, -(2000 + p + 100), -(4000 + p)};
    Plane Surface(6000 + p) = {6000 + p};
    f2() += {6000 + p};
    p = 10 * v + u + 101;  // z = 1
    Curve Loop(7000 + p) = {2000 + p, 3000 + p + 1, -(2000 + p + 10), -(3000 + p)};
    Plane Surface(7000 + p) = {7000 + p};
    f3() += {7000 + p};
  EndFor
EndFor
If (kind == 1)  // one square of two triangles, all of whose corners are on the tip line
  f1() = {5012}; f2() = {}; f3() = {};
ElseIf (kind == 2)  // two planes cross
  f3() = {};
EndIf
all() = {f1(), f2(), f3()};
Transfinite Curve {2000 : 4999} = 2;
Transfinite Surface {all()};
Surface {all()} In Volume {1};
Physical Surface("f1") = f1();
If (#f2() > 0)
  Physical Surface("f2") = f2();
EndIf
If (#f3() > 0)
  Physical Surface("f3") = f3();
EndIf
Physical Surface("bottom") = {1}; Physical Surface("top") = {2};
Physical Volume("rock") = {1};
