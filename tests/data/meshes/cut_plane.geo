// A box about the origin cut by a plane through it. plane: which; kind: see make.sh.
SetFactory("OpenCASCADE");
DefineConstant[ plane = 1, kind = 1 ];
height = 1;
If (plane == 1)
  n() = {1, 2, 3};
  height = 2;
ElseIf (plane == 2)
  n() = {0, 0, 1};
Else
  n() = {-0.2, 0.9, 0.1};
EndIf
Box(1) = {-0.5, -0.45, -0.55 * height, 1, 0.9, 1.1 * height};
Rectangle(100) = {-3, -3, 0, 6, 6};
length = Hypot(n(0), n(1));
If (length > 0)
  Rotate {{-n(1), n(0), 0}, {0, 0, 0}, Atan2(length, n(2))} { Surface{100}; }
EndIf
cut() = BooleanIntersection{ Surface{100}; Delete; }{ Volume{1}; };
BooleanFragments{ Volume{1}; Delete; }{ Surface{cut()}; Delete; }

Mesh.MeshSizeMin = 0.55; Mesh.MeshSizeMax = 0.55;
If (kind == 2)
  Transfinite Curve{:} = 4;
  Transfinite Surface{:};
  Recombine Surface{:};
  Transfinite Volume{:};
ElseIf (kind == 3)
  Mesh.MeshSizeMin = 1.2; Mesh.MeshSizeMax = 1.2;
  Mesh.SubdivisionAlgorithm = 2;  // each tetrahedron to four hexahedra
EndIf

faces() = Surface{:}; blocks() = Volume{:};
boundary() = {};
For i In {0 : #faces() - 1}
  m() = CenterOfMass Surface{faces(i)};
  If (Abs(n(0) * m(0) + n(1) * m(1) + n(2) * m(2)) < 1e-9)
    Physical Surface("f1") = {faces(i)};
  Else
    boundary() += {faces(i)};
  EndIf
EndFor
Physical Surface("boundary") = boundary();
For i In {0 : #blocks() - 1}
  m() = CenterOfMass Volume{blocks(i)};
  If (n(0) * m(0) + n(1) * m(1) + n(2) * m(2) < 0)
    Physical Volume("-") = {blocks(i)};
  Else
    Physical Volume("+") = {blocks(i)};
  EndIf
EndFor
