// A square with fractures along straight arms from one point, with triangles. kind: see make.sh.
SetFactory("Built-in");
DefineConstant[ kind = 1 ];
Mesh.MeshSizeMax = 4;
Mesh.MeshSizeExtendFromBoundary = 0;
Point(1) = {0, 0, 0}; Point(2) = {4, 0, 0}; Point(3) = {4, 4, 0}; Point(4) = {0, 4, 0}; Point(5) = {0, 2, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 5}; Line(5) = {5, 1};
Curve Loop(1) = {1, 2, 3, 4, 5};
Plane Surface(1) = {1};

// Ends of the arms and the fracture of each.
centre() = {2, 2};
n_segments = 2;
If (kind == 1)  // immersed
  centre() = {1, 2}; x() = {3}; y() = {2}; of() = {1}; n_segments = 4;
ElseIf (kind == 2)  // X
  x() = {0.4, 3.6, 2, 2}; y() = {2, 2, 0.4, 3.6}; of() = {1, 1, 2, 2};
ElseIf (kind == 3)  // T
  x() = {0.4, 3.6, 2}; y() = {2, 2, 3.6}; of() = {1, 1, 2};
ElseIf (kind == 4)  // L
  x() = {0.4, 2}; y() = {2, 3.6}; of() = {1, 2};
ElseIf (kind == 5)  // Y
  x() = {0.4, 3, 3}; y() = {2, 2.8, 1.2}; of() = {1, 2, 3};
ElseIf (kind == 6)  // three lines through one point
  x() = {0.4, 3.6, 1.2, 2.8, 1.2, 2.8}; y() = {2, 2, 1, 3, 3, 1}; of() = {1, 1, 2, 2, 3, 3};
Else  // to the boundary
  x() = {0}; y() = {2}; of() = {1};
EndIf

Point(10) = {centre(0), centre(1), 0};
For i In {0 : #x() - 1}
  If (x(i) == 0)
    Line(20 + i) = {10, 5};
  Else
    Point(20 + i) = {x(i), y(i), 0};
    Line(20 + i) = {10, 20 + i};
  EndIf
  Transfinite Curve {20 + i} = n_segments + 1;
  Curve {20 + i} In Surface {1};
EndFor
For f In {1 : 3}
  mine() = {};
  For i In {0 : #x() - 1}
    If (of(i) == f)
      mine() += {20 + i};
    EndIf
  EndFor
  If (#mine() > 0)
    Physical Curve(Sprintf("f%g", f)) = mine();
  EndIf
EndFor
Physical Curve("south") = {1}; Physical Curve("east") = {2}; Physical Curve("north") = {3}; Physical Curve("west") = {4, 5};
Physical Surface("rock") = {1};
