#!/bin/sh
# Makes the meshes in this folder again, with the program gmsh (4.8.4): name, geometry, kind, dimension, then its options.
set -eu
cd "$(dirname "$0")"
mesh() {
  name=$1 geometry=$2 kind=$3 dim=$4
  shift 4
  gmsh "$geometry.geo" -"$dim" -setnumber kind "$kind" -v 2 -nt 1 "$@" -o "$name.msh"
}
for order in 1 2; do
  for version in 22 41; do
    mesh "x_order${order}_v$version" lines 2 2 -order $order -format msh$version
    mesh "x_order${order}_v${version}_binary" lines 2 2 -order $order -format msh$version -bin
  done
done
mesh immersed lines 1 2 -order 1 -format msh41
mesh immersed_order2 lines 1 2 -order 2 -format msh22
mesh t lines 3 2 -order 1 -format msh41
mesh t_order2 lines 3 2 -order 2 -format msh41 -bin
mesh l lines 4 2 -order 1 -format msh22
mesh l_order2 lines 4 2 -order 2 -format msh41
mesh y lines 5 2 -order 1 -format msh41
mesh y_order2 lines 5 2 -order 2 -format msh22 -bin
mesh star lines 6 2 -order 1 -format msh22 -bin
mesh star_order2 lines 6 2 -order 2 -format msh41
mesh reach lines 7 2 -order 1 -format msh41
mesh reach_order2 lines 7 2 -order 2 -format msh22
mesh triangles squares 1 2 -order 1 -format msh41
mesh triangles_order2 squares 1 2 -order 2 -format msh22
mesh squares squares 2 2 -order 1 -format msh22
mesh squares_order2 squares 2 2 -order 2 -format msh41
mesh hexahedra squares 3 3 -order 1 -format msh41
mesh hexahedra_order2 squares 3 3 -order 2 -format msh22 -bin
mesh cubes squares 4 3 -order 1 -format msh22
mesh cubes_order2 squares 4 3 -order 2 -format msh41
mesh patch patches 1 3 -order 1 -format msh22
mesh patch_order2 patches 1 3 -order 2 -format msh41 -bin
mesh planes patches 2 3 -order 1 -format msh41
mesh planes_order2 patches 2 3 -order 2 -format msh41
mesh triple patches 3 3 -order 1 -format msh22
mesh triple_order2 patches 3 3 -order 2 -format msh22 -bin
for lines in 1 2 3 4 5 6 7 8; do
  mesh cut_lines${lines}_triangle cut_lines 1 2 -setnumber lines $lines -format msh22
  mesh cut_lines${lines}_quadrilateral cut_lines 2 2 -setnumber lines $lines -format msh41
done
for lines in 6 7; do
  mesh cut_lines${lines}_tetrahedron cut_lines 3 3 -setnumber lines $lines -format msh41 -bin
  mesh cut_lines${lines}_hexahedron cut_lines 4 3 -setnumber lines $lines -format msh22 -bin
done
for plane in 1 2 3; do
  mesh cut_plane${plane}_tetrahedron cut_plane 1 3 -setnumber plane $plane -format msh22 -bin
done
mesh cut_plane1_hexahedron cut_plane 2 3 -setnumber plane 1 -format msh41
mesh cut_plane2_hexahedron cut_plane 3 3 -setnumber plane 2 -format msh41 -bin
mesh cut_plane3_hexahedron cut_plane 2 3 -setnumber plane 3 -format msh22
mesh free_sides_triangle free_sides 1 2 -format msh41 -bin
mesh free_sides_quadrilateral free_sides 2 2 -format msh22 -bin
mesh free_sides_tetrahedron free_sides 3 3 -format msh22 -bin
mesh free_sides_hexahedron free_sides 4 3 -format msh41 -bin
mesh slope1 slope 0 2 -setnumber h 2 -order 1 -format msh22
mesh slope2 slope 0 2 -setnumber h 1 -order 1 -format msh22
mesh slope3 slope 0 2 -setnumber h 0.5 -order 1 -format msh22
