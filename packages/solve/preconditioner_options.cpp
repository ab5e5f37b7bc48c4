#include "solve/preconditioner_options.hpp"

#include "base/parameters.hpp"

namespace sprekk::solve {
void MultigridOptions::describe(base::Section& section) {
  section.entry(degree, "degree", "-", base::at_least(1),
                "of Chebyshev's polynomial, the smoother; the finest level takes a higher one in flat cells");
  section.entry(coarse_size, "coarsest level", "-", base::at_least(1),
                "unknowns, at or below which a level is solved directly");
  section.entry(least_of_a_rank, "least of a rank", "-", base::at_least(1),
                "numbers of its matrix: a level of which ranks have fewer on average moves to fewer ranks");
}

void BlockOptions::describe(base::Section& section) {
  section.choice(
      type, "type", {"auto", "multigrid", "MueLu", "Ifpack2", "Gauss-Seidel", "direct"},
      "how the block, or the group that begins with it, is preconditioned; auto: multigrid where unknowns have "
      "places, MueLu where a flow carries them, else Gauss-Seidel, and groups without a method of their own directly");
  section.entry(with, "with", "-", "the block of whose group it is a part; absent: as the fields ask for");
  section.section(multigrid, "multigrid", "type multigrid, or auto: Sprekk's own");
  section.passthrough(muelu, "MueLu", "type MueLu: its parameters, over the defaults");
  section.passthrough(ifpack2, "Ifpack2", "type Ifpack2: its parameters; \"type\" names the method, e.g. ILUT");
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
                 "forward: each group sees the corrections of those before; symmetric: and then, backward, of those "
                 "after; diagonal: of none");
  section.entry(order, "order", "-",
                "the first block of every group, in the order of the sweep; absent: as the fields "
                "come");
}

const BlockOptions& PreconditionerOptions::of(const std::string& block) const {
  static const BlockOptions usual;
  const auto found = blocks.find(block);
  return found == blocks.end() ? usual : found->second;
}

}  // namespace sprekk::solve
