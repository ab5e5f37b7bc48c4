#include "mesh/msh_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <unordered_map>

#include "base/check.hpp"
#include "base/file.hpp"
#include "mesh/msh_scanner.hpp"

namespace sprekk::mesh {
namespace {

class Parser {
 public:
  Parser(std::string_view text, const std::string& file) : in_(text, file), file_(file) {}

  /// Reads the first section, which is mandatory: version, format, and sizes.
  void read_start() {
    SPREKK_CHECK(!in_.at_end(), "{}: is empty, expected a gmsh mesh", file_);
    const auto header = in_.line();
    if (header == "$NOD" || header == "$NOE") in_.fail("is gmsh's format 1; Sprekk reads 2.2 and 4.1");
    if (header != "$MeshFormat")
      in_.fail(fmt::format("found \"{}\", expected $MeshFormat; is this a gmsh mesh?", printable(header)));
    read_section("MeshFormat");
  }

  MshFile parse() {
    read_start();
    while (!in_.at_end()) {
      const auto header = in_.line();
      if (header.empty() || header[0] != '$')
        in_.fail(fmt::format("found \"{}\", expected the start of a section like $Nodes", printable(header)));
      if (header == "$MeshFormat") in_.fail("$MeshFormat occurs twice");
      read_section(std::string(header.substr(1)));
    }
    SPREKK_CHECK(!mesh_.points.empty(), "{}: has no nodes in a section $Nodes", file_);
    SPREKK_CHECK(!mesh_.elements.empty(), "{}: has no elements in a section $Elements", file_);
    resolve_nodes();
    return std::move(mesh_);
  }

 private:
  MshScanner in_;
  std::string file_;
  bool is_version_4_ = false, has_entities_ = false;
  std::map<std::pair<int, int>, int> groups_of_entity_;  ///< by dimension and number; index into group_sets
  std::map<std::vector<int>, int> set_of_groups_;        ///< version 2.2; index into group_sets
  MshFile mesh_;

  void read_section(const std::string& name) {
    in_.enter(name);
    if (name == "MeshFormat") {
      read_format();
    } else if (name == "PhysicalNames") {
      read_names();
    } else if (name == "Fractures") {
      read_fractures();
    } else if (name == "Entities" && is_version_4_) {
      read_entities();
    } else if (name == "Nodes") {
      is_version_4_ ? read_nodes_4() : read_nodes_2();
    } else if (name == "Elements") {
      is_version_4_ ? read_elements_4() : read_elements_2();
    } else {
      in_.skip_behind("$End" + name);
      in_.line();
      in_.enter("");
      return;
    }
    in_.at_end();
    const auto end = in_.line();
    if (end != "$End" + name) in_.fail(fmt::format("found \"{}\", expected $End{}", printable(end), name));
    in_.enter("");
  }

  void read_format() {
    const auto line = std::string(in_.line());
    const auto version = line.substr(0, line.find(' '));
    if (version != "2.2" && version != "4.1")
      in_.fail(fmt::format("is gmsh's format {}; Sprekk reads 2.2 and 4.1 (gmsh -format msh41)", printable(version)));
    is_version_4_ = version == "4.1";
    if (line == version + " 0 8") return in_.set_format(false, is_version_4_);
    if (line != version + " 1 8")
      in_.fail(fmt::format("found \"{}\", expected the version, 0 (text) or 1 (binary), and 8", printable(line)));
    in_.set_format(true, is_version_4_);
    const auto one = in_.raw<std::int32_t>("the number 1 for the byte order");
    if (one == 0x01000000) in_.fail("was written on a machine with another order of bytes; save it as text there");
    if (one != 1) in_.fail(fmt::format("found {}, expected the number 1 for the byte order", one));
  }

  void read_names() {
    const auto n = in_.text_integer("the number of physical names");
    for (GlobalIndex i = 0; i < n; ++i) {
      const auto dim = in_.text_integer("the dimension of a physical group");
      const auto number = in_.text_integer("the number of a physical group");
      const auto quoted = in_.line();
      if (dim < 0 || dim > 3 || std::abs(static_cast<Real>(number)) > std::numeric_limits<int>::max())
        in_.fail(fmt::format("physical group {} of dimension {} cannot be", number, dim));
      if (quoted.size() < 3 || quoted.front() != '"' || quoted.back() != '"')
        in_.fail(
            fmt::format("physical group {}: its name is {}, expected a name in quotes", number, printable(quoted)));
      if (base::where_not_utf8(quoted))
        in_.fail(fmt::format("physical group {}: its name {} is not UTF-8", number, printable(quoted)));
      mesh_.group_names[{static_cast<int>(dim), static_cast<int>(number)}] = quoted.substr(1, quoted.size() - 2);
    }
  }

  void read_fractures() {
    const auto n = in_.text_integer("the number of fractures");
    for (GlobalIndex i = 0; i < n; ++i) {
      MshFile::Fracture fracture;
      fracture.group = static_cast<int>(in_.text_integer("the number of a physical group"));
      fracture.entity = static_cast<int>(in_.text_integer("the number of an entity"));
      const auto texts = quoted_texts(in_.line());
      if (texts.size() % 2 == 0)
        in_.fail(fmt::format("fracture {}: has {} texts in quotes, expected its name and pairs of entries and values",
                             i + 1, texts.size()));
      fracture.name = texts[0];
      for (std::size_t k = 1; k < texts.size(); k += 2) fracture.properties[texts[k]] = texts[k + 1];
      mesh_.fractures.push_back(std::move(fracture));
    }
  }

  /// Returns the texts in quotation marks. Throws an Error for invalid UTF-8.
  std::vector<std::string> quoted_texts(std::string_view line) const {
    if (base::where_not_utf8(line)) in_.fail(fmt::format("{} is not UTF-8", printable(line)));
    std::vector<std::string> texts;
    for (auto begin = line.find('"'); begin != line.npos;) {
      const auto end = line.find('"', begin + 1);
      if (end == line.npos) in_.fail(fmt::format("{} lacks a quotation mark", printable(line)));
      texts.emplace_back(line.substr(begin + 1, end - begin - 1));
      begin = line.find('"', end + 1);
    }
    return texts;
  }

  void read_entities() {
    has_entities_ = true;
    GlobalIndex n[4];
    for (auto& count : n) count = in_.count("entities", 5);
    for (int dim = 0; dim < 4; ++dim)
      for (GlobalIndex i = 0; i < n[dim]; ++i) {
        const int number = in_.integer("the number of an entity");
        for (int k = 0; k < (dim == 0 ? 3 : 6); ++k) in_.skip_number("a bound of an entity");
        std::vector<int> groups(in_.count("physical groups"));
        for (int& group : groups) group = std::abs(in_.integer("the number of a physical group"));
        if (dim > 0)
          for (GlobalIndex k = in_.count("bounding entities"); k > 0; --k) in_.integer("a bounding entity");
        groups_of_entity_[{dim, number}] = add_set(std::move(groups));
      }
  }

  int add_set(std::vector<int> groups) {
    mesh_.group_sets.push_back(std::move(groups));
    return static_cast<int>(mesh_.group_sets.size()) - 1;
  }

  int groups_of_entity(int dim, int number) {
    const auto found = groups_of_entity_.find({dim, number});
    if (found != groups_of_entity_.end()) return found->second;
    if (has_entities_)
      in_.fail(fmt::format("the entity {} of dimension {} is not in $Entities; save the mesh without partitions",
                           number, dim));
    return groups_of_entity_[{dim, number}] = add_set({});
  }

  Vector read_point(GlobalIndex tag) {
    in_.about("node", tag);
    Vector x;
    for (int i = 0; i < 3; ++i) x[i] = in_.number(i == 0 ? "x" : i == 1 ? "y" : "z");
    return x;
  }

  void read_nodes_2() {
    for (auto n = in_.text_count("nodes", words(7, 4)); n > 0; --n) {
      mesh_.node_tags.push_back(in_.tag("the number of a node"));
      mesh_.points.push_back(read_point(mesh_.node_tags.back()));
    }
  }

  /// Minimum number of words of an item: four-byte words if binary, numbers if text.
  GlobalIndex words(GlobalIndex words, GlobalIndex numbers) const { return in_.is_binary() ? words : numbers; }

  /// Reads the numbers of blocks and of items; skips the minimum and maximum tag.
  std::array<GlobalIndex, 2> read_block_header(const char* what) {
    const auto n_blocks = in_.count("blocks", 4), n = in_.count(what);
    for (int i = 0; i < 2; ++i) in_.long_integer("the smallest or largest number");
    return {n_blocks, n};
  }

  void check_total(const char* what, GlobalIndex expected, std::size_t found) const {
    if (static_cast<std::size_t>(expected) != found)
      in_.fail(fmt::format("has {} {} although it announces {}", found, what, expected));
  }

  void read_nodes_4() {
    const auto [n_blocks, n_all] = read_block_header("nodes");
    for (GlobalIndex block = 0; block < n_blocks; ++block) {
      in_.about("block", block + 1);
      const int dim = in_.integer("the dimension of an entity");
      in_.integer("the number of an entity");
      const int is_parametric = in_.integer("whether nodes have parameters");
      if (dim < 0 || dim > 3) in_.fail(fmt::format("the dimension of an entity is {}, must be 0 to 3", dim));
      const auto n = in_.count("nodes", words(8, 4));
      for (GlobalIndex i = 0; i < n; ++i) mesh_.node_tags.push_back(in_.tag("the number of a node"));
      for (GlobalIndex i = 0; i < n; ++i) {
        mesh_.points.push_back(read_point(mesh_.node_tags[mesh_.points.size()]));
        for (int k = 0; is_parametric != 0 && k < dim; ++k) in_.skip_number("a parameter of a node");
      }
    }
    check_total("nodes", n_all, mesh_.points.size());
  }

  const MshElementType* element_type(int number, GlobalIndex element) {
    if (const auto* type = find_msh_element_type(number)) return type;
    in_.about("element", element);
    in_.fail(
        fmt::format("is a {}; Sprekk reads lines, triangles, quadrilaterals, tetrahedra and hexahedra of order 1, and "
                    "of order 2 with "
                    "3, 6, 9, 10 and 27 nodes",
                    msh_element_name(number)));
  }

  void add_element(const MshElementType* type, GlobalIndex tag, int groups, int entity) {
    in_.about("element", tag);
    mesh_.elements.push_back({type, tag, groups, entity, mesh_.element_nodes.size()});
    for (int k = 0; k < type->n_nodes; ++k) mesh_.element_nodes.push_back(in_.tag("the number of a node"));
  }

  void read_elements_2() {
    const auto n = in_.text_count("elements", words(2, 4));
    for (GlobalIndex i = 0; i < n;) {
      GlobalIndex tag = in_.is_binary() ? 0 : in_.tag("the number of an element");
      const int number = in_.integer("the type of an element");
      const auto n_here = in_.is_binary() ? in_.count("elements", 2) : 1;
      const auto n_tags = in_.count("tags of an element");
      if (n_here == 0 || n_here > n - i)
        in_.fail(fmt::format("has a block of {} elements where {} of {} are left", n_here, n - i, n));
      for (GlobalIndex k = 0; k < n_here; ++k) {
        if (in_.is_binary()) tag = in_.tag("the number of an element");
        int group = 0, entity = 0;
        for (GlobalIndex t = 0; t < n_tags; ++t) {
          const int value = in_.integer("a tag of an element");
          if (t == 0) group = std::abs(value);
          if (t == 1) entity = value;
        }
        add_element(element_type(number, tag), tag, set_of(group == 0 ? std::vector<int>{} : std::vector{group}),
                    entity);
        join_repeated();
      }
      i += n_here;
    }
  }

  int set_of(const std::vector<int>& groups) {
    const auto [set, is_new] = set_of_groups_.emplace(groups, static_cast<int>(mesh_.group_sets.size()));
    if (is_new) add_set(groups);
    return set->second;
  }

  /// Merges repeated elements. In version 2.2, gmsh writes an element of several groups once per group, with different
  /// numbers.
  void join_repeated() {
    if (mesh_.elements.size() < 2) return;
    const auto& last = mesh_.elements.back();
    auto& before = *(mesh_.elements.end() - 2);
    const auto groups = mesh_.group_sets[last.groups];
    auto joined = mesh_.group_sets[before.groups];
    const auto nodes = mesh_.element_nodes.begin();
    if (last.type != before.type || last.entity != before.entity || groups.empty() || joined.empty() ||
        std::find(joined.begin(), joined.end(), groups[0]) != joined.end() ||
        !std::equal(nodes + before.first_node, nodes + last.first_node, nodes + last.first_node))
      return;
    joined.push_back(groups[0]);
    before.groups = set_of(joined);
    mesh_.element_nodes.resize(last.first_node);
    mesh_.elements.pop_back();
  }

  void read_elements_4() {
    const auto n_before = mesh_.elements.size();
    const auto [n_blocks, n_all] = read_block_header("elements");
    for (GlobalIndex block = 0; block < n_blocks; ++block) {
      in_.about("block", block + 1);
      const int dim = in_.integer("the dimension of an entity"), entity = in_.integer("the number of an entity");
      const int groups = groups_of_entity(dim, entity), number = in_.integer("the type of elements");
      const auto n = in_.count("elements", 2);
      for (GlobalIndex i = 0; i < n; ++i) {
        const auto tag = in_.tag("the number of an element");
        const auto* type = element_type(number, tag);
        if (type->dim != dim)
          in_.fail(fmt::format("element {} is a {} in an entity of dimension {}", tag, type->name, dim));
        add_element(type, tag, groups, entity);
      }
    }
    check_total("elements", n_all, mesh_.elements.size() - n_before);
  }

  /// Replaces the tags of nodes by indices.
  void resolve_nodes() {
    std::unordered_map<GlobalIndex, GlobalIndex> index;
    index.reserve(mesh_.node_tags.size());
    for (std::size_t i = 0; i < mesh_.node_tags.size(); ++i)
      SPREKK_CHECK(index.emplace(mesh_.node_tags[i], static_cast<GlobalIndex>(i)).second,
                   "{}: $Nodes: node {} occurs twice", file_, mesh_.node_tags[i]);
    for (const auto& element : mesh_.elements)
      for (int k = 0; k < element.type->n_nodes; ++k) {
        auto& node = mesh_.element_nodes[element.first_node + k];
        const auto found = index.find(node);
        SPREKK_CHECK(found != index.end(), "{}: $Elements: element {} has node {}, which is not in $Nodes", file_,
                     element.tag, node);
        node = found->second;
      }
  }
};

}  // namespace

std::string MshFile::group_name(int dim, int number) const {
  const auto found = group_names.find({dim, number});
  return found == group_names.end() ? std::to_string(number) : found->second;
}

MshFile parse_msh_file(std::string_view text, const std::string& file) { return Parser(text, file).parse(); }

MshFile read_msh_file(const std::string& path) {
  const auto text = base::read_file(path, "a gmsh mesh", std::numeric_limits<std::size_t>::max(),
                                    [&](std::string_view start) { Parser(start, path).read_start(); });
  return parse_msh_file(text, path);
}

}  // namespace sprekk::mesh
