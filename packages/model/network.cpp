#include "model/network.hpp"

#include "base/check.hpp"
#include "base/xml.hpp"

#include <filesystem>

namespace sprekk::model {

void Network::Points::describe(base::Section& s) {
  s.required(points, "points", "m", base::any(),
             "coordinates of all points: x0, y0, x1, y1, ... in 2D; x0, y0, z0, ... in 3D");
}

void Network::Body::describe(base::Section& s) {
  s.entry(lower_corner, "lower corner", "m", base::any(), "of a box: its lowest coordinates, 2 or 3");
  s.entry(upper_corner, "upper corner", "m", base::any(), "of a box: its highest coordinates");
  s.entry(corners, "corners", "m", base::any(), "of a polygon, 2D: x0, y0, x1, y1, ...");
  s.named_sections(faces, "faces", "of a polyhedron: its plane faces, each a polygon");
  const int n = (!lower_corner.empty() || !upper_corner.empty()) + !corners.empty() + !faces.empty();
  if (!s.complete()) return;
  if (n != 1) s.fail("give either \"lower corner\" and \"upper corner\", or \"corners\", or \"faces\"");
  if (lower_corner.size() != upper_corner.size())
    s.fail("upper corner",
           fmt::format("has {} coordinates, \"lower corner\" {}", upper_corner.size(), lower_corner.size()));
}

void Network::Domain::describe(base::Section& s) {
  s.entry(sides, "sides", "-",
          "of a polygon: names of its sides, the first from corner 0 to corner 1; sides of one name are one boundary; "
          "without them side 1, side 2, ...");
  Body::describe(s);
  if (s.complete() && !sides.empty() && 2 * sides.size() != corners.size())
    s.fail("sides", fmt::format("has {} names for {} corners", sides.size(), corners.size() / 2));
}

void Network::Ellipse::describe(base::Section& s) {
  s.required(centre, "centre", "m", base::any().size(3), "of the ellipse");
  s.required(radii, "radii", "m", base::positive().size(2),
             "half axes, the first along the rake; of a disc both are equal");
  s.entry(strike, "strike", "degree", base::any(),
          "clockwise from north, which is y; the plane dips to the right of it");
  s.entry(dip, "dip", "degree", base::between(0, 90), "from the horizontal");
  s.entry(rake, "rake", "degree", base::any(), "in the plane, from the strike upwards to the first axis");
}

void Network::Random::describe(base::Section& s) {
  s.required(number, "number", "-", base::between(1, 1000000),
             "of fractures, before they are clipped; centres are uniform in the domain");
  s.entry(seed, "seed", "-", base::at_least(0), "of the random numbers; the same seed gives the same fractures");
  s.required(shortest, "shortest", "m", base::positive(), "length (2D) or diameter (3D), at least");
  s.required(longest, "longest", "m", base::positive(), "length or diameter, at most");
  s.entry(exponent, "exponent", "-", base::any(),
          "a of the power law: the density of lengths L is proportional to L^-a");
  s.entry(strike, "strike", "degree", base::any(), "mean; in 2D the direction of fractures, clockwise from y");
  s.entry(dip, "dip", "degree", base::between(0, 90), "mean, 3D");
  s.entry(concentration, "concentration", "-", base::between(0, 1e6),
          "kappa of Fisher's distribution of the poles around the mean (2D: of von Mises' of the doubled angle); 0: "
          "all directions alike");
  s.entry(corners, "corners", "-", base::between(3, 100), "of the regular polygons, 3D");
  if (s.complete() && longest < shortest) s.fail("longest", fmt::format("is {}, \"shortest\" {}", longest, shortest));
}

void Network::Set::describe(base::Section& s) {
  s.entry(file, "file", "-", "CSV or .fab of FracMan; relative to the scene's file");
  s.choice(
      format, "format", {"points", "lines", "polygons", "ellipses", "fab"},
      "of the file, a line each: id,x,y (3D: id,x,y,z), a point of the fracture id; id,x0,y0,x1,y1; "
      "x0,y0,z0,x1,y1,z1,...; cx,cy,cz,r1,r2,rake,strike,dip in degree; without it fab by the ending .fab, points by "
      "their columns, else lines in 2D and polygons in 3D");
  s.entry(layers, "layers", "-", "of a drawing or a GeoPackage: those with the fractures; absent: all");
  s.entry(unit, "unit", "m", base::positive(), "of coordinates in the file, such as 1 mm; absent: 1 m");
  s.named_sections(lines, "lines", "2D: polylines");
  s.named_sections(polygons, "polygons", "3D: plane polygons, convex or not");
  s.named_sections(ellipses, "ellipses", "3D: ellipses and discs");
  s.section(random, "random", "fractures at random");
  if (s.complete() && !file && !random && lines.empty() && polygons.empty() && ellipses.empty())
    s.fail("is empty; give \"file\", \"lines\", \"polygons\", \"ellipses\" or \"random\"");
}

void Network::describe(base::Section& s) {
  s.section(domain, "domain", "the rock; a CSV of polygons may tell its box instead, in its first line");
  s.named_sections(fractures, "fractures", "sets of fractures by their names, which Fractures lists");
  s.named_sections(constraints, "constraints",
                   "lines (2D) or surfaces (3D) that cells keep to and that are no fractures");
  s.named_sections(regions, "regions", "parts of the domain with a material of their own; the rest is \"bulk\"");
  s.entry(relative_size, "relative size", "-", base::positive(),
          "edges of cells at a fracture / length (3D: diameter) of that fracture");
  s.entry(size, "size", "m", base::positive(), "edges of cells at most; absent: a tenth of the domain's diagonal");
  s.entry(size_at_tips, "size at tips", "m", base::positive(),
          "edges of cells where fractures end in the rock; absent: a twentieth (3D: a half) of that at the fracture");
  s.entry(size_at_intersections, "size at intersections", "m", base::positive(), "absent: as at the fractures");
  s.entry(size_at_boundary, "size at boundary", "m", base::positive(),
          "on the boundary of the domain; absent: as elsewhere");
  s.entry(growth, "growth", "-", base::positive(), "of edges per distance from where a size is given");
  s.entry(tolerance, "tolerance", "m", base::positive(),
          "what is closer is joined, and told: points and lines in 2D; in 3D corners of polygons, which are moved onto "
          "surfaces in their own plane; absent: 1e-6 of the domain's diagonal");
  s.entry(minimum_distance, "minimum distance", "m", base::at_least(0),
          "fractures that come closer without being joined are refused; absent: 1e-4 of the domain's diagonal");
  s.entry(minimum_angle, "minimum angle", "degree", base::between(0, 60),
          "fractures that meet at a smaller angle are refused");
  s.entry(most_cells, "most cells", "-", base::at_least(1),
          "sizes that ask for more cells than this, by estimate, are refused before the mesh is made");
  s.choice(unusable, "unusable fractures", {"refused", "left out"},
           "those outside of the domain, shorter than \"tolerance\" or \"minimum distance\", or without geometry in "
           "their file: an error, or left out and listed by the report");
  if (s.complete() && fractures.empty()) s.fail("fractures", "missing; a network needs a set of fractures");
}

void Network::resolve_files(const std::string& folder) {
  for (auto* sets : {&fractures, &constraints})
    for (auto& [name, set] : *sets)
      if (set.file)
        set.file = std::filesystem::absolute(std::filesystem::path(folder) / *set.file).lexically_normal().string();
}

std::string network_description(const Comm& comm, const std::string& path, const std::vector<std::string>& overrides) {
  auto list = base::read_xml(comm, path, "Sprekk", base::Defects::keep);
  const auto errors = base::apply_overrides(list, path, overrides);
  SPREKK_CHECK(list.isSublist("Mesh file") && list.sublist("Mesh file").isSublist("network"),
               "{}: has no section Sprekk > Mesh file > network", path);
  auto network =
      base::read<Network>(list.sublist("Mesh file").sublist("network"), path, "Sprekk > Mesh file > network", errors);
  network.resolve_files(std::filesystem::path(path).parent_path().string());
  return base::to_xml(base::effective(network, "network"));
}

}  // namespace sprekk::model
