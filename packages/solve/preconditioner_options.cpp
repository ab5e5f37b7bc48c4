#include "solve/preconditioner_options.hpp"

#include "base/parameters.hpp"

namespace sprekk::solve {

multigrid::Options MultigridOptions::of_nodes(int dim) const {
  multigrid::Options options;
  options.degree = degree.value_or(options.degree);
  options.coarse_size = coarsest.value_or(options.coarse_size);
  if (dim == 2 && !coarsest) options.below_finest = 100000;
  options.minimum_per_rank = minimum_per_rank;
  return options;
}

multigrid::Options MultigridOptions::of_corners(int dim) const {
  auto options = of_nodes(dim);
  options.degree = degree.value_or(dim == 2 ? 8 : 6);
  options.coarse_size = coarsest.value_or(dim == 2 ? 200000 : 4000);
  options.raise = 1e-12;
  options.strong = dim == 2 ? 0.7 : 0;
  return options;
}

void MultigridOptions::describe(base::Section& section) {
  section.entry(degree, "degree", "-", base::at_least(1),
                "degree of the Chebyshev smoother (Adams et al. 2003); higher on the finest level in flat cells; "
                "absent: 4, for fields on facets 8 in 2D and 6 in 3D");
  section.entry(coarsest, "coarsest level", "-", base::at_least(1),
                "number of unknowns up to which a level is solved directly; absent: 300, in 2D 100000 below the finest "
                "level, for fields on facets 200000 in 2D and 4000 in 3D");
  section.hint({"least of a rank"}, "Did you mean \"minimum per rank\"?");
  section.entry(minimum_per_rank, "minimum per rank", "-", base::at_least(1),
                "minimum mean number of matrix entries per rank; a smaller level moves to fewer ranks");
}

void BlockOptions::describe(base::Section& section) {
  section.choice(
      type, "type", {"auto", "multigrid", "MueLu", "Ifpack2", "Gauss-Seidel", "ILU", "direct"},
      "preconditioner of the block or of the group that begins with it; ILU: incomplete factors in the order of a "
      "flow; auto: multigrid for unknowns with coordinates, with ILU as smoother for unknowns that a flow carries, "
      "else Gauss-Seidel, and direct for groups without their own method");
  section.entry(with, "with", "-", "name of the block whose group contains this block; empty: as the fields require");
  section.section(multigrid, "multigrid", "multigrid method of Sprekk, for type multigrid or auto");
  section.passthrough(muelu, "MueLu", "parameters of MueLu in place of the defaults, for type MueLu");
  section.passthrough(ifpack2, "Ifpack2",
                      "parameters of Ifpack2, for type Ifpack2; \"type\" selects the method, e.g. ILUT");
  const bool names_method = ifpack2.isType<std::string>("type");
  if (type != "auto" && type != "multigrid" && multigrid)
    section.fail("multigrid", "is given, but \"type\" is neither multigrid nor auto");
  if (type != "MueLu" && muelu.numParams() > 0) section.fail("MueLu", "is given, but \"type\" is not MueLu");
  if (type != "Ifpack2" && ifpack2.numParams() > 0) section.fail("Ifpack2", "is given, but \"type\" is not Ifpack2");
  if (type == "Ifpack2" && !names_method)
    section.fail("Ifpack2", "must name a method of Ifpack2 by a string \"type\", e.g. RELAXATION, ILUT or CHEBYSHEV");
}

void SweepOptions::describe(base::Section& section) {
  section.choice(type, "type", {"forward", "symmetric", "diagonal"},
                 "type of sweep; forward: each group uses the corrections of earlier groups; symmetric: forward, then "
                 "backward; diagonal: no corrections of other groups");
  section.entry(order, "order", "-",
                "first blocks of all groups, in the order of the sweep; empty: rate balances, then other fields");
}

const BlockOptions& PreconditionerOptions::of(const std::string& block) const {
  static const BlockOptions usual;
  const auto found = blocks.find(block);
  return found == blocks.end() ? usual : found->second;
}

}  // namespace sprekk::solve
