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
