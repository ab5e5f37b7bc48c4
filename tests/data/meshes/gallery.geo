// A disc in a disc; dim = 3: a slab of it.
If (!Exists(dim)) dim = 2; EndIf
If (!Exists(n)) n = 4; EndIf  // cells along a quarter of the wall
a = 1; R = 4; h = 0.25;
Point(1) = {0, 0, 0, a/n*1.5};
For k In {0:3}
  Point(10+k) = {a*Cos(k*Pi/2), a*Sin(k*Pi/2), 0};
  Point(20+k) = {R*Cos(k*Pi/2), R*Sin(k*Pi/2), 0};
EndFor
For k In {0:3}
  Circle(10+k) = {10+k, 1, 10+(k+1)%4};
  Circle(20+k) = {20+k, 1, 20+(k+1)%4};
  Line(30+k) = {10+k, 20+k};
  Transfinite Curve{10+k, 20+k} = n+1;
  Transfinite Curve{30+k} = n+1 Using Progression R^(1/n);
EndFor
Curve Loop(1) = {10, 11, 12, 13};
Plane Surface(1) = {1};
For k In {0:3}
  Curve Loop(10+k) = {30+k, 20+k, -(30+(k+1)%4), -(10+k)};
  Plane Surface(10+k) = {10+k};
  Transfinite Surface{10+k};
EndFor
If (dim == 2)
  Physical Surface("gallery") = {1};
  Physical Surface("rock") = {10:13};
  Physical Curve("far") = {20:23};
Else
  all[] = Extrude {0, 0, h} { Surface{1}; Layers{1}; };
  Physical Volume("gallery") = {all[1]};
  top[] = {all[0]};
  rock[] = {}; far[] = {};
  For k In {0:3}
    one[] = Extrude {0, 0, h} { Surface{10+k}; Layers{1}; };
    rock[] += {one[1]}; top[] += {one[0]}; far[] += {one[3]};
  EndFor
  Physical Volume("rock") = {rock[]};
  Physical Surface("far") = {far[]};
  Physical Surface("front") = {1, 10, 11, 12, 13};
  Physical Surface("back") = {top[]};
EndIf
