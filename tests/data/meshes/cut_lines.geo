// A rectangle cut into blocks by straight lines, or the same drawn out in z. lines: which; kind: see make.sh.
SetFactory("OpenCASCADE");
DefineConstant[ lines = 1, kind = 1 ];
// The angle of each line, and a point on it.
x() = {0}; y() = {0};
If (lines == 1)
  a() = {0};
ElseIf (lines == 2)
  a() = {30};
ElseIf (lines == 3)
  a() = {45};
ElseIf (lines == 4)
  a() = {-90};
ElseIf (lines == 5)  // with the normal (0.31, -0.95)
  a() = {Atan2(-0.31, -0.95) * 180 / Pi};
ElseIf (lines == 6)
  a() = {0, 60}; x() = {0, 0.1}; y() = {0.05, 0};
ElseIf (lines == 7)  // three points of crossing, all inside
  a() = {10, 75, 130}; x() = {0, -0.2, 0.35}; y() = {0.05, 0, 0};
Else  // that cross on the southern side
  a() = {75, 130}; x() = {0.2, 0.2}; y() = {-0.5, -0.5};
EndIf
n = #a();
height = 0.6;
Rectangle(1) = {-0.9, -0.5, 0, 2, 1.2};
cuts() = {};
For k In {0 : n - 1}
  c = Cos(a(k) * Pi / 180); s = Sin(a(k) * Pi / 180);
  p = newp;
  Point(p) = {x(k) - 3 * c, y(k) - 3 * s, 0};
  Point(p + 1) = {x(k) + 3 * c, y(k) + 3 * s, 0};
  l = newl;
  Line(l) = {p, p + 1};
  cuts() += BooleanIntersection{ Curve{l}; Delete; }{ Surface{1}; };
EndFor
BooleanFragments{ Surface{1}; Delete; }{ Curve{cuts()}; Delete; }

Mesh.MeshSizeMin = kind % 2 == 1 ? 0.35 : 0.8; Mesh.MeshSizeMax = Mesh.MeshSizeMin;
If (kind % 2 == 0)
  Recombine Surface{:};
  Mesh.RecombinationAlgorithm = 0;
  Mesh.SubdivisionAlgorithm = kind / 2;  // each cell to four or eight, without triangles or prisms
EndIf
If (kind == 3)
  Extrude {0, 0, height} { Surface{:}; Layers{2}; }
ElseIf (kind == 4)
  Extrude {0, 0, height} { Surface{:}; Layers{1}; Recombine; }
EndIf

// Fractures f1, f2, ..; the boundary; and the blocks, named by their sides of the lines.
If (kind < 3)
  faces() = Curve{:}; blocks() = Surface{:};
Else
  faces() = Surface{:}; blocks() = Volume{:};
EndIf
For k In {0 : n}
  f~{k}() = {};
EndFor
For i In {0 : #faces() - 1}
  If (kind < 3)
    m() = CenterOfMass Curve{faces(i)};
  Else
    m() = CenterOfMass Surface{faces(i)};
  EndIf
  on = 0;
  For k In {0 : n - 1}
    d = (m(1) - y(k)) * Cos(a(k) * Pi / 180) - (m(0) - x(k)) * Sin(a(k) * Pi / 180);
    If (Abs(d) < 1e-9 && (kind < 3 || Abs(m(2) - height / 2) < 1e-9))
      on = k + 1;
    EndIf
  EndFor
  f~{on}() += {faces(i)};
EndFor
For k In {0 : n}
  If (k == 0)
    name = "boundary";
  Else
    name = Sprintf("f%g", k);
  EndIf
  If (kind < 3)
    Physical Curve(Str(name)) = f~{k}();
  Else
    Physical Surface(Str(name)) = f~{k}();
  EndIf
EndFor
For sides In {0 : 2 ^ n - 1}
  mine() = {};
  For i In {0 : #blocks() - 1}
    If (kind < 3)
      m() = CenterOfMass Surface{blocks(i)};
    Else
      m() = CenterOfMass Volume{blocks(i)};
    EndIf
    here = 0;
    For k In {0 : n - 1}
      d = (m(1) - y(k)) * Cos(a(k) * Pi / 180) - (m(0) - x(k)) * Sin(a(k) * Pi / 180);
      here += d > 0 ? 2 ^ k : 0;
    EndFor
    If (here == sides)
      mine() += {blocks(i)};
    EndIf
  EndFor
  name = "";
  For k In {0 : n - 1}
    If (Floor(sides / 2 ^ k) % 2 == 1)
      name = StrCat(name, "+");
    Else
      name = StrCat(name, "-");
    EndIf
  EndFor
  If (#mine() > 0 && kind < 3)
    Physical Surface(Str(name)) = mine();
  ElseIf (#mine() > 0)
    Physical Volume(Str(name)) = mine();
  EndIf
EndFor
