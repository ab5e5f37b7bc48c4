#include "model/network.hpp"

#include "base/check.hpp"
#include "base/xml.hpp"
#include "physics/scene.hpp"

#include <filesystem>

namespace sprekk::model {

void Network::Points::describe(base::Section& s) {
  s.required(points, "points", "m", base::any(),
             "coordinates of all points: x0, y0, x1, y1, ... in 2D; x0, y0, z0, ... in 3D");
}

void Network::Body::describe(base::Section& s) {
  s.entry(lower_corner, "lower corner", "m", base::any(), "lowest coordinates of a box, 2 or 3");
  s.entry(upper_corner, "upper corner", "m", base::any(), "highest coordinates of a box");
  s.entry(corners, "corners", "m", base::any(), "corners of a polygon in 2D: x0, y0, x1, y1, ...");
  s.named_sections(faces, "faces", "plane faces of a polyhedron, each a polygon");
  const int n = (!lower_corner.empty() || !upper_corner.empty()) + !corners.empty() + !faces.empty();
  if (!s.complete()) return;
  if (n != 1) s.fail("give either \"lower corner\" and \"upper corner\", or \"corners\", or \"faces\"");
  if (lower_corner.size() != upper_corner.size())
    s.fail("upper corner",
           fmt::format("has {} coordinates, \"lower corner\" {}", upper_corner.size(), lower_corner.size()));
}

void Network::Domain::describe(base::Section& s) {
  s.entry(sides, "sides", "-",
          "names of the sides of a polygon, the first from corner 0 to corner 1; sides with one name form one "
          "boundary; empty: side 1, side 2, ...");
  Body::describe(s);
  if (s.complete() && !sides.empty() && 2 * sides.size() != corners.size())
    s.fail("sides", fmt::format("has {} names for {} corners", sides.size(), corners.size() / 2));
}

void Network::Ellipse::describe(base::Section& s) {
  s.required(centre, "centre", "m", base::any().size(3), "centre of the ellipse");
  s.required(radii, "radii", "m", base::positive().size(2), "half axes, the first along the rake; equal for a disc");
  s.entry(strike, "strike", "degree", base::any(),
          "strike angle, clockwise from north (y); the plane dips to the right of the strike");
  s.entry(dip, "dip", "degree", base::between(0, 90), "dip angle from the horizontal");
  s.entry(rake, "rake", "degree", base::any(),
          "rake angle of the first half axis in the plane, from the strike upwards");
}

void Network::Random::describe(base::Section& s) {
  s.required(number, "number", "-", base::between(1, 1000000),
             "number of fractures before clipping at the domain; the centres are uniformly distributed");
  s.entry(seed, "seed", "-", base::at_least(0), "seed of the random numbers; equal seeds give equal fractures");
  s.required(shortest, "shortest", "m", base::positive(), "minimum length (3D: diameter) of the fractures");
  s.required(longest, "longest", "m", base::positive(), "maximum length (3D: diameter) of the fractures");
  s.entry(exponent, "exponent", "-", base::any(),
          "exponent a of the power law: the density of lengths L is proportional to L^-a; typical: 2 to 3");
  s.entry(strike, "strike", "degree", base::any(),
          "mean strike; in 2D the mean direction of the fractures, clockwise from y");
  s.entry(dip, "dip", "degree", base::between(0, 90), "mean dip in 3D");
  s.entry(concentration, "concentration", "-", base::between(0, 1e6),
          "concentration kappa of the Fisher distribution of poles about the mean (in 2D the von Mises distribution of "
          "the doubled angle); 0: uniform directions; typical: 5 to 50");
  s.entry(corners, "corners", "-", base::between(3, 100), "number of corners of the regular polygons in 3D");
  if (s.complete() && longest < shortest) s.fail("longest", fmt::format("is {}, \"shortest\" {}", longest, shortest));
}

void Network::Set::describe(base::Section& s) {
  s.entry(file, "file", "-",
          "file of the fractures, relative to the folder of the scene: CSV, .fab of FracMan, .dat of dfnWorks, .ts of "
          "GOCAD, .geojson, .json, .shp, .gpkg or .dxf");
  s.choice(
      format, "format", {"points", "lines", "polygons", "ellipses", "discs", "fab", "dfnworks", "gocad"},
      "format of the file; points: id,x,y (3D: id,x,y,z), one point of the fracture id per line; lines: "
      "id,x0,y0,x1,y1; polygons: x0,y0,z0,x1,y1,z1,...; ellipses: cx,cy,cz,r1,r2,rake,strike,dip in degrees; "
      "discs: titles x,y,z,dip,dip direction or strike,radius; fab: FracMan; dfnworks: polygons.dat; gocad: TSurf; "
      "absent: by the ending .fab, .dat or .ts, by the titles, else lines in 2D and polygons in 3D");
  s.entry(layers, "layers", "-", "layers with the fractures, in a drawing or a GeoPackage; empty: all layers");
  s.entry(unit, "unit", "m", base::positive(), "unit of the coordinates in the file, such as 1 mm; absent: 1 m");
  s.entry(window, "window", "m", base::any(),
          "box that crops the fractures of the file: lowest, then highest coordinates, 4 in 2D, 6 in 3D; empty: the "
          "domain");
  s.entry(corners, "corners", "-", base::between(3, 100),
          "number of corners of the polygon of an ellipse or a disc; absent: at most 16 of a disc, by \"relative "
          "size\"; 32 of an ellipse, or with repairs as of a disc");
  s.named_sections(lines, "lines", "polylines in 2D");
  s.named_sections(polygons, "polygons", "plane polygons in 3D, convex or not");
  s.named_sections(ellipses, "ellipses", "ellipses and discs in 3D");
  s.section(random, "random", "random fractures by statistics");
  if (s.complete() && !window.empty() && window.size() != 4 && window.size() != 6)
    s.fail("window", fmt::format("has {} numbers, must have 4 in 2D or 6 in 3D", window.size()));
  if (s.complete() && !file && !random && lines.empty() && polygons.empty() && ellipses.empty())
    s.fail("is empty; give \"file\", \"lines\", \"polygons\", \"ellipses\" or \"random\"");
}

void Network::describe(base::Section& s) {
  s.section(domain, "domain", "domain of the rock; a CSV of polygons may contain a box as domain in its first line");
  s.named_sections(fractures, "fractures",
                   "sets of fractures by their names; the section Fractures assigns their joints");
  s.named_sections(constraints, "constraints",
                   "lines (2D) or surfaces (3D) that the mesh follows and that are no fractures");
  s.named_sections(regions, "regions", "parts of the domain with their own material; the rest is \"bulk\"");
  s.entry(relative_size, "relative size", "-", base::positive(),
          "ratio of the edge length of cells at a fracture to the length (3D: diameter) of the fracture");
  s.entry(size, "size", "m", base::positive(),
          "maximum edge length of cells; absent: 1/10 of the diagonal of the domain");
  s.entry(
      size_at_tips, "size at tips", "m", base::positive(),
      "edge length of cells at fracture tips in the rock; absent: 1/20 (in 3D 1/2) of the edge length at the fracture");
  s.entry(size_at_intersections, "size at intersections", "m", base::positive(),
          "edge length of cells at intersections of fractures; absent: the edge length at the fractures");
  s.entry(size_at_boundary, "size at boundary", "m", base::positive(),
          "edge length of cells at the boundary of the domain; absent: no refinement at the boundary");
  s.entry(growth, "growth", "-", base::positive(),
          "growth of the edge length per distance from a place with a given size");
  s.entry(tolerance, "tolerance", "m", base::positive(),
          "distance below which parts of fractures are joined and reported: points and lines in 2D; in 3D corners of "
          "polygons, moved onto surfaces within their own plane; absent: 1e-6 of the diagonal of the domain");
  s.entry(minimum_distance, "minimum distance", "m", base::at_least(0),
          "minimum distance between separate fractures, an error below; absent: 1e-4 of the diagonal of the domain");
  s.entry(minimum_angle, "minimum angle", "degree", base::between(0, 60),
          "minimum angle between fractures at an intersection, an error below");
  s.hint({"most cells"}, "Did you mean \"maximum cells\"?");
  s.entry(maximum_cells, "maximum cells", "-", base::at_least(1),
          "maximum number of cells, by an estimate before the generation of the mesh, an error above");
  s.choice(unusable, "unusable fractures", {"refused", "left out"},
           "treatment of fractures outside of the domain, shorter than \"tolerance\" or \"minimum distance\", or "
           "without geometry in their file; refused: an error; left out: omitted and listed in the report");
  s.choice(
      repair, "repair", {"report", "join", "drop"},
      "treatment of fractures that cannot be meshed together; report: an error for each; join: gaps, near misses, "
      "small angles and short features below \"tolerance\" are closed, merged or cut off; drop: the smaller fracture "
      "of each conflict is left out; join and drop also leave out unusable and duplicate fractures, and list all "
      "changes in FILE.msh.csv");
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
  list = base::effective(network, "network");
  Teuchos::Array<std::string> entries;
  auto& choices = list.sublist("choices of joints");
  for (const auto& entry : base::specification<physics::Material>("").entries) {
    entries.push_back(entry.name);
    if (!entry.choices.empty()) choices.set(entry.name, Teuchos::Array<std::string>(entry.choices));
  }
  list.set("entries of joints", entries);
  return base::to_xml(list);
}

}  // namespace sprekk::model
