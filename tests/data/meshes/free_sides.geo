// The unit square in x, y (kinds 1 triangles, 2 quadrilaterals), and a slab of it in x, z (3 tetrahedra, 4 hexahedra), cut
// at half its height by a fracture; cells get smaller towards all corners, above all to the ends of the cut.
DefineConstant[ kind = 1 ];
up = kind > 2 ? 1 : 0;
Point(1) = {0, 0, 0};
Point(2) = {1, 0, 0};
Point(3) = {0, 0.5 * (1 - up), 0.5 * up};
Point(4) = {1, 0.5 * (1 - up), 0.5 * up};
Point(5) = {0, 1 - up, up};
Point(6) = {1, 1 - up, up};
Line(1) = {1, 2}; Line(2) = {3, 4}; Line(3) = {5, 6};
Line(4) = {1, 3}; Line(5) = {2, 4}; Line(6) = {3, 5}; Line(7) = {4, 6};
Curve Loop(1) = {1, 5, -2, -4}; Plane Surface(1) = {1};
Curve Loop(2) = {2, 7, -3, -6}; Plane Surface(2) = {2};
Transfinite Curve{1, 2, 3} = 21 Using Bump 0.03;
Transfinite Curve{4, 5, 6, 7} = 11 Using Bump 0.03;
Transfinite Surface{1, 2};
If (kind == 2 || kind == 4)
  Recombine Surface{1, 2};
EndIf
If (up == 0)
  Physical Curve("south") = {1}; Physical Curve("fracture") = {2}; Physical Curve("north") = {3};
  Physical Surface("rock") = {1, 2};
Else
  If (kind == 3)
    out[] = Extrude {0, 0.1, 0} { Surface{1, 2}; Layers{1}; };
  Else
    out[] = Extrude {0, 0.1, 0} { Surface{1, 2}; Layers{1}; Recombine; };
  EndIf
  Physical Surface("bottom") = {out[2]}; Physical Surface("fracture") = {out[4]}; Physical Surface("top") = {out[10]};
  Physical Surface("front") = {1, 2}; Physical Surface("back") = {out[0], out[6]};
  Physical Volume("rock") = {out[1], out[7]};
EndIf
