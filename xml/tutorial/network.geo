// A square of 200 m with four fractures: "crossing" crosses "fault", "branch" starts on it, "entry" comes from the
// boundary and ends on it. Where fractures meet they share a point; each piece between two such points is a line.
size = 8;
Point(1) = {-100, -100, 0, 2 * size};
Point(2) = {100, -100, 0, 2 * size};
Point(3) = {100, 100, 0, 2 * size};
Point(4) = {-100, 100, 0, 2 * size};
Point(5) = {-100, -20, 0, size};  // entry meets west
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 5};
Line(5) = {5, 1};
Curve Loop(1) = {1 : 5};
Plane Surface(1) = {1};

Point(10) = {-30, -60, 0, size / 2};  // fault
Point(11) = {-20, -40, 0, size / 2};  // where entry ends
Point(12) = {0, 0, 0, size / 2};      // where crossing crosses
Point(13) = {20, 40, 0, size / 2};    // where branch starts
Point(14) = {30, 60, 0, size / 2};
Point(20) = {-40, 20, 0, size / 2};   // crossing
Point(21) = {40, -20, 0, size / 2};
Point(30) = {65, 15, 0, size / 2};    // branch
Line(10) = {10, 11};
Line(11) = {11, 12};
Line(12) = {12, 13};
Line(13) = {13, 14};
Line(20) = {20, 12};
Line(21) = {12, 21};
Line(30) = {13, 30};
Line(40) = {5, 11};
Curve{10 : 13, 20, 21, 30, 40} In Surface{1};  // the mesh conforms to the fractures; Sprekk opens them

Physical Curve("fault") = {10 : 13};
Physical Curve("crossing") = {20, 21};
Physical Curve("branch") = {30};
Physical Curve("entry") = {40};
Physical Curve("west") = {4, 5};
Physical Curve("east") = {2};
Physical Curve("south") = {1};
Physical Curve("north") = {3};
Physical Surface("rock") = {1};
