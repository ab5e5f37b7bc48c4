// A box that an inclined line cuts; h: edges.
If (!Exists(h)) h = 1; EndIf
Point(1) = {0, 0, 0, h};
Point(2) = {20, 0, 0, h};
Point(3) = {20, 2, 0, h};
Point(4) = {20, 10, 0, h};
Point(5) = {12, 10, 0, h};
Point(6) = {0, 10, 0, h};
For k In {1:6}
  Line(k) = {k, k % 6 + 1};
EndFor
Line(7) = {3, 5};
Curve Loop(1) = {1, 2, 7, 5, 6};
Curve Loop(2) = {3, 4, -7};
Plane Surface(1) = {1};
Plane Surface(2) = {2};
Physical Surface("rock") = {1, 2};
Physical Curve("south") = {1};
Physical Curve("east") = {2, 3};
Physical Curve("north") = {4, 5};
Physical Curve("west") = {6};
Physical Curve("joint") = {7};
