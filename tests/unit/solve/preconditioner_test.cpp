// Preconditioners of blocks and groups, compared with the systems that they invert approximately. The systems are so
// small that multigrid solves its part directly.
#include "solve/minimal_residual.hpp"
#include "solve/preconditioner.hpp"

#include <Tpetra_Core.hpp>
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "base/check.hpp"

namespace sprekk::test {
namespace {

using fields::CrsMatrix;
using fields::Map;
using fields::MultiVector;
using fields::Vector;
using fields::wrapped;
using solve::LinearSystem;
using solve::make_preconditioner;
using solve::PreconditionerOptions;

/// Chain over all ranks: faces with a pressure each, cells between them, and as many nodes with displacements as
/// faces. Every row couples to its neighbours, except cells to cells.
struct Chain {
  enum Which { nodes, faces, cells };

  /// `order` of the blocks; without `back`, rows of nodes do not couple to other blocks.
  Chain(const std::vector<Which>& order_, bool back, bool schur) : order(order_) {
    const auto comm = Tpetra::getDefaultComm();
    const GlobalIndex n = 5 * comm->getSize() + 2;
    std::vector<RCP<const Map>> maps;
    for (const Which which : order) {
      fields::Block block;
      block.name = std::array{"nodes", "faces", "cells"}[which];
      block.map = rcp(new Map(which == cells ? n - 1 : n, 0, comm));
      block.n_components = 1;
      if (which == cells) block.condensed_into = "faces";
      const auto places = rcp(new MultiVector(block.map, 2));
      for (std::size_t i = 0; i < base::n_local_elements(*block.map); ++i)
        places->replaceLocalValue(i, 0, Real(block.map->getGlobalElement(i)));
      if (which != cells) block.coordinates = places;
      blocks.push_back(block);
      maps.push_back(block.map);
    }
    const auto joined = std::make_shared<solve::Joined>(maps);
    joined->set_scales({0.5, 4, 0.01});
    system.joined = joined;
    for (std::size_t r = 0; r < order.size(); ++r)
      for (std::size_t s = 0; s < order.size(); ++s) {
        const bool absent = !back && order[r] == nodes && order[s] != nodes;
        system.blocks.push_back(absent ? Teuchos::null : matrix(r, s));
      }
    for (std::size_t r = 0; r < order.size(); ++r) {
      system.diagonal.push_back({blocks[r], system.blocks[r * order.size() + r], {}, false});
      if (schur && order[r] != nodes) {
        const auto more = rcp(new Vector(maps[r]));
        more->randomize(1, 2);
        system.diagonal.back().schur = more;
      }
    }
  }

  /// Returns a block: faces couple to the adjacent cells and vice versa; other pairs to neighbours at a distance of
  /// one. The values are unsymmetric.
  RCP<const fields::Matrix> matrix(int r, int s) const {
    const auto result = rcp(new CrsMatrix(blocks[r].map, 3));
    const auto& rows = *blocks[r].map;
    const bool down = order[r] != cells && order[s] == cells, up = order[r] == cells && order[s] != cells;
    for (std::size_t i = 0; i < base::n_local_elements(rows); ++i) {
      const GlobalIndex row = rows.getGlobalElement(i), n = blocks[s].map->getGlobalNumElements();
      for (GlobalIndex k = up ? 0 : -1; k <= (down ? 0 : 1); ++k) {
        const GlobalIndex column = row + k;
        if (column < 0 || column >= n || (order[r] == cells && order[s] == cells && k != 0)) continue;
        const Real value = (r == s && k == 0 ? 4 : 0) + 0.5 * std::cos(1.0 + row + 7 * column + 100 * r + 1000 * s);
        result->insertGlobalValues(row, 1, &value, &column);
      }
    }
    result->fillComplete(blocks[s].map, blocks[r].map);
    return wrapped(result);
  }

  /// Applies the operator that the sweep inverts approximately, with the given Schur complements.
  void apply(const Vector& x, Vector& y) const {
    system.joined_operator()->apply(x, y);
    for (std::size_t r = 0; r < order.size(); ++r) {
      if (system.diagonal[r].schur.is_null()) continue;
      const auto& joined = *system.joined;
      y.offsetViewNonConst(joined.map(r), joined.first(r))
          ->elementWiseMultiply(joined.scale(r) * joined.scale(r), *system.diagonal[r].schur,
                                *x.offsetView(joined.map(r), joined.first(r)), 1);
    }
  }

  std::vector<Which> order;
  std::vector<fields::Block> blocks;
  LinearSystem system;
};

constexpr Real rounding = 1e-6;  // multigrid adds 1e-8 times the diagonal to its coarsest matrix

/// Returns y = M x, with the preconditioner M after `times` set-ups.
Vector swept(const Chain& chain, const Vector& x, const PreconditionerOptions& options = {}, int times = 2) {
  const auto preconditioner = make_preconditioner(options, chain.blocks);
  for (int k = 0; k < times; ++k) preconditioner->setup(chain.system);
  Vector y(x.getMap());
  y.putScalar(3);
  preconditioner->inverse()->apply(x, y);
  return y;
}

Vector random_vector(const Chain& chain) {
  Vector x(chain.system.joined->map());
  x.randomize(-1, 1);
  return x;
}

/// Returns the largest |y| among the unknowns of block r, over all ranks. Collective.
Real largest(const Chain& chain, const Vector& y, int r) {
  return y.offsetView(chain.system.joined->map(r), chain.system.joined->first(r))->getVector(0)->normInf();
}

/// Returns the options as a parameter tree of a scene.
Teuchos::ParameterList tree(const PreconditionerOptions& options, const std::vector<fields::Block>& blocks) {
  Teuchos::ParameterList list;
  make_preconditioner(options, blocks)->describe(list);
  return list;
}

std::string type_of(Teuchos::ParameterList& list, const std::string& block) {
  return list.sublist(block).get<std::string>("type", "");
}

TEST(Preconditioner, GroupsBlocksWithWhatIsCondensedIntoThem) {
  const Chain chain({Chain::cells, Chain::nodes, Chain::faces}, true, false);
  auto list = tree({}, chain.blocks);
  EXPECT_EQ(type_of(list, "nodes"), "multigrid");
  EXPECT_EQ(type_of(list, "faces"), "multigrid");
  EXPECT_EQ(list.sublist("cells").get<std::string>("with"), "faces");
}

/// The Schur complement of the eliminated cells fits into the graph of the faces, so nothing is omitted.
TEST(Preconditioner, OfACondensedPairIsTheInverseOfBothBlocks) {
  for (const bool schur : {false, true})
    for (const auto& order : {std::vector{Chain::faces, Chain::cells}, std::vector{Chain::cells, Chain::faces}}) {
      const Chain chain(order, true, schur);
      const auto x = random_vector(chain);
      const auto y = swept(chain, x);
      Vector back(x.getMap());
      chain.apply(y, back);
      back.update(-1, x, 1);
      EXPECT_LT(back.normInf(), rounding) << schur;
    }
}

/// If rows of nodes do not couple to pressures, one sweep is the exact inverse.
TEST(Preconditioner, SweepIsTheInverseOfATriangularSystem) {
  const Chain chain({Chain::nodes, Chain::faces, Chain::cells}, false, false);
  const auto x = random_vector(chain);
  const auto y = swept(chain, x);
  Vector back(x.getMap());
  chain.apply(y, back);
  back.update(-1, x, 1);
  EXPECT_LT(back.normInf(), rounding);
}

/// The rows of the last group are satisfied; those of the first group only without couplings to later groups.
TEST(Preconditioner, SweepSolvesOneGroupAfterTheOther) {
  const Chain chain({Chain::nodes, Chain::faces, Chain::cells}, true, false),
      triangular({Chain::nodes, Chain::faces, Chain::cells}, false, false);
  const auto x = random_vector(chain);
  const auto y = swept(chain, x);
  Vector back(x.getMap()), own(x.getMap());
  chain.apply(y, back);
  triangular.apply(y, own);
  back.update(-1, x, 1);
  own.update(-1, x, 1);
  EXPECT_LT(largest(chain, own, 0), rounding);
  EXPECT_GT(largest(chain, back, 0), 1e-3);
  for (const int r : {1, 2}) EXPECT_LT(largest(chain, back, r), rounding);
}

TEST(Preconditioner, SweepAddsToWhatIsThere) {
  const Chain chain({Chain::faces, Chain::nodes, Chain::cells}, true, false);
  const auto x = random_vector(chain);
  const auto once = swept(chain, x);
  const auto preconditioner = make_preconditioner({}, chain.blocks);
  preconditioner->setup(chain.system);
  Vector y(x, Teuchos::Copy);
  preconditioner->inverse()->apply(x, y, Teuchos::NO_TRANS, 2, -3);
  y.update(-2, once, 1);
  y.update(3, x, 1);
  EXPECT_LT(y.normInf(), 1e-13 * once.normInf());
}

/// Returns options with a direct solver for each of the blocks: B_f = (S A S)_ff^-1.
PreconditionerOptions direct(const std::vector<std::string>& blocks) {
  PreconditionerOptions options;
  for (const auto& name : blocks) options.blocks[name].type = "direct";
  return options;
}

RCP<MultiVector> part(const Chain& chain, Vector& x, int r) {
  return x.offsetViewNonConst(chain.system.joined->map(r), chain.system.joined->first(r));
}

/// Returns the largest |x - A y| in the rows of block r.
Real residual(const Chain& chain, const Vector& x, const Vector& y, int r) {
  Vector rest(x.getMap());
  chain.apply(y, rest);
  rest.update(1, x, -1);
  return largest(chain, rest, r);
}

TEST(Preconditioner, DirectGroupIsTheInverse) {
  const Chain chain({Chain::nodes, Chain::faces, Chain::cells}, true, false);
  auto options = direct({"faces"});
  options.blocks["nodes"].with = "faces";
  const auto x = random_vector(chain);
  const auto y = swept(chain, x, options);
  for (const int r : {0, 1, 2}) EXPECT_LT(residual(chain, x, y, r), 1e-9);
}

/// The rows of each block are satisfied with its own unknowns only.
TEST(Preconditioner, DiagonalSweepSeesNoOtherGroup) {
  const Chain chain({Chain::nodes, Chain::faces}, true, false);
  auto options = direct({"nodes", "faces"});
  options.sweep.type = "diagonal";
  const auto x = random_vector(chain);
  auto y = swept(chain, x, options);
  for (const int r : {0, 1}) {
    Vector alone(x.getMap());
    alone.putScalar(0);
    Tpetra::deep_copy(*part(chain, alone, r), *part(chain, y, r));
    EXPECT_LT(residual(chain, x, alone, r), 1e-9);
  }
  EXPECT_GT(residual(chain, x, y, 0), 1e-3);
}

/// The group solved last is satisfied: the second of a forward sweep, the first of a reversed sweep. Symmetric sweeps
/// also reduce the residual of the other group.
TEST(Preconditioner, SweepsGoAsAskedFor) {
  const Chain chain({Chain::nodes, Chain::faces}, true, false);
  auto forward = direct({"nodes", "faces"}), reversed = forward, symmetric = forward;
  reversed.sweep.order = {"faces", "nodes"};
  symmetric.sweep.type = "symmetric";
  const auto x = random_vector(chain);
  const auto y = swept(chain, x, forward), of_reversed = swept(chain, x, reversed), both = swept(chain, x, symmetric);
  EXPECT_LT(residual(chain, x, y, 1), 1e-9);
  EXPECT_GT(residual(chain, x, y, 0), 1e-3);
  EXPECT_LT(residual(chain, x, of_reversed, 0), 1e-9);
  EXPECT_GT(residual(chain, x, of_reversed, 1), 1e-3);
  EXPECT_LT(residual(chain, x, both, 0), 1e-9);
  EXPECT_LT(residual(chain, x, both, 1), residual(chain, x, of_reversed, 1));
}

/// Without dropping, the factors of ILUT are exact on one rank; on several ranks they omit couplings between ranks.
TEST(Preconditioner, Ifpack2TakesItsParameters) {
  const Chain chain({Chain::nodes, Chain::faces}, false, false);
  const auto x = random_vector(chain);
  const auto of_ilut = [&](double fill, double drop) {
    PreconditionerOptions options;
    options.blocks["nodes"].type = "direct";
    options.blocks["faces"].type = "Ifpack2";
    auto& list = options.blocks["faces"].ifpack2;
    list.set("type", "ILUT").set("fact: ilut level-of-fill", fill).set("fact: drop tolerance", drop);
    return residual(chain, x, swept(chain, x, options), 1);
  };
  if (chain.system.joined->map()->getComm()->getSize() == 1) {
    EXPECT_LT(of_ilut(20, 0), 1e-9);
    EXPECT_GT(of_ilut(1, 0.5), 1e-3);
  } else {
    EXPECT_GT(std::abs(of_ilut(20, 0) - of_ilut(1, 0.5)), 1e-6);
  }
}

/// Upwind advection, conduction and small storage on a square of cells. The flow is locally 1e4 times the conductance
/// and consists of large and small eddies of random stream functions.
RCP<CrsMatrix> advection(const RCP<const Map>& map, int n) {
  const auto eddy = [](int i, int j) { return std::sin(12.9898 * i + 78.233 * j + 3 * std::sin(0.3 * i * j)); };
  const auto psi = [&](int i, int j) {
    const bool outside = i == 0 || j == 0 || i == n || j == n;
    return outside ? 0 : 1e4 * (eddy(i / 8, j / 8) + 0.1 * eddy(i, j)) * std::pow(10, 2 * eddy(i / 20, j / 20) - 2);
  };
  const auto result = rcp(new CrsMatrix(map, 5));
  for (const GlobalIndex row : base::local_elements(*map)) {
    const int i = row % n, j = row / n;
    const std::array<std::array<int, 2>, 4> away = {{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};
    const std::array<Real, 4> out = {psi(i + 1, j + 1) - psi(i + 1, j), psi(i, j) - psi(i, j + 1),
                                     psi(i, j + 1) - psi(i + 1, j + 1), psi(i + 1, j) - psi(i, j)};
    Real sum = 1e-3;
    for (int k = 0; k < 4; ++k) {
      const int to_i = i + away[k][0], to_j = j + away[k][1];
      if (to_i < 0 || to_j < 0 || to_i == n || to_j == n) continue;
      const Real value = -1 - std::max(-out[k], 0.0);
      const GlobalIndex column = to_i + n * to_j;
      result->insertGlobalValues(row, 1, &value, &column);
      sum -= value;
    }
    result->insertGlobalValues(row, 1, &sum, &row);
  }
  result->fillComplete();
  return result;
}

/// Returns a block with one unknown for each cell of a square.
fields::Block of_cells(const std::string& name, int n) {
  fields::Block block;
  block.name = name;
  block.map = rcp(new Map(n * n, 0, Tpetra::getDefaultComm()));
  block.n_components = 1;
  const auto places = rcp(new MultiVector(block.map, 2));
  for (std::size_t i = 0; i < base::n_local_elements(*block.map); ++i)
    for (const int k : {0, 1}) {
      const GlobalIndex cell = block.map->getGlobalElement(i);
      places->replaceLocalValue(i, k, Real(k == 0 ? cell % n : cell / n));
    }
  block.coordinates = places;
  return block;
}

/// Advected quantities: cycles of MueLu do not diverge for strong flow, and those with factors in the order of the
/// flow, the default, reduce the residual in strong circulation.
TEST(Preconditioner, OfAdvectedBlocksConverge) {
  const int n = 100;
  auto block = of_cells("temperature", n);
  block.advected = true;
  const auto A = advection(block.map, n);
  for (const std::string type : {"MueLu", "auto"}) {
    PreconditionerOptions options;
    options.blocks["temperature"].type = type;
    const auto preconditioner = make_preconditioner(options, {block});
    preconditioner->setup(solve::alone({block, wrapped(A), {}, false}));
    Vector e(block.map), z(block.map), rest(block.map);
    e.randomize(-1, 1);
    A->apply(e, rest);
    const Real start = type == "MueLu" ? e.norm2() : rest.norm2();
    auto inverse = preconditioner->inverse();
    if (type == "auto") inverse = solve::minimal_residual(wrapped(A), inverse, 4);  // storage hardly holds the mean
    for (int k = 0; k < 20; ++k) {
      A->apply(e, rest);
      inverse->apply(rest, z);
      e.update(-1, z, 1);
    }
    A->apply(e, rest);
    EXPECT_LT(type == "MueLu" ? e.norm2() : rest.norm2(), (type == "MueLu" ? 0.1 : 1e-4) * start) << type;
  }
}

/// Conduction between cells of a square with small storage; the conductance between two cells is the harmonic mean.
template <class Conductivity>
RCP<CrsMatrix> conduction(const RCP<const Map>& map, int n, const Conductivity& of) {
  const auto result = rcp(new CrsMatrix(map, 5));
  for (const GlobalIndex row : base::local_elements(*map)) {
    const int i = row % n, j = row / n;
    const Real own = of(i, j);
    Real sum = 1e-6;
    for (const auto& [a, b] : {std::pair(i + 1, j), std::pair(i - 1, j), std::pair(i, j + 1), std::pair(i, j - 1)}) {
      const bool inside = a >= 0 && b >= 0 && a < n && b < n;
      const Real value = inside ? -2 / (1 / own + 1 / of(a, b)) : 0;
      const GlobalIndex column = inside ? a + n * b : row;
      result->insertGlobalValues(row, 1, &value, &column);
      sum -= value;
    }
    result->insertGlobalValues(row, 1, &sum, &row);
  }
  result->fillComplete();
  return result;
}

/// After parts of a channel network close, cells are aggregated again. A preconditioner set up for open channels
/// before is then as good as a new one.
TEST(Preconditioner, FollowsWhatConducts) {
  const int n = 96;
  const auto block = of_cells("pressure", n);
  const auto is_channel = [](int i, int j) { return i % 6 == 3 || j % 6 == 3; };
  const auto closed = [](int i, int j) {
    return std::fmod(std::fabs(std::sin(12.9898 * i + 78.233 * j)) * 43758.5, 1);
  };
  const auto open = conduction(block.map, n, [&](int i, int j) { return is_channel(i, j) ? 1e6 : 1.0; });
  const auto now = conduction(
      block.map, n, [&](int i, int j) { return is_channel(i, j) ? std::pow(10, 6 - 12 * closed(i / 3, j / 3)) : 1.0; });
  const auto left = [&](const std::vector<RCP<CrsMatrix>>& matrices) {
    const auto preconditioner = make_preconditioner({}, {block});
    for (const auto& A : matrices) preconditioner->setup(solve::alone({block, wrapped(A), {}, true}));
    Vector e(block.map), z(block.map), rest(block.map);
    for (std::size_t i = 0; i < base::n_local_elements(*block.map); ++i)
      e.replaceLocalValue(i, std::sin(0.7 * block.map->getGlobalElement(i)));
    const Real start = e.norm2();
    for (int k = 0; k < 20; ++k) {
      now->apply(e, rest);
      preconditioner->inverse()->apply(rest, z);
      e.update(-1, z, 1);
    }
    return e.norm2() / start;
  };
  const Real rebuild = left({now});
  EXPECT_LT(rebuild, 0.2);  // 0.4 with the aggregates of the open network
  EXPECT_LT(left({open, now}), 1.01 * rebuild);
}

/// Every type accepts any block: without coordinates, and several joined blocks.
TEST(Preconditioner, EveryTypeTakesEveryBlock) {
  const Chain chain({Chain::nodes, Chain::faces, Chain::cells}, false, false);
  const auto x = random_vector(chain);
  for (const std::string type : {"MueLu", "Gauss-Seidel", "direct", "Ifpack2"})
    for (const std::string with : {"", "nodes"}) {
      SCOPED_TRACE(type + " " + with);
      PreconditionerOptions options;
      options.blocks["nodes"].type = type;
      if (type == "Ifpack2") options.blocks["nodes"].ifpack2.set("type", "RILUK");
      options.blocks["faces"].with = with;
      const auto y = swept(chain, x, options);
      EXPECT_LT(residual(chain, x, y, 0), 0.9 * largest(chain, x, 0));
      auto list = tree(options, chain.blocks);
      EXPECT_EQ(type_of(list, "nodes"), type);
    }
}

std::string error_of(const std::function<void(PreconditionerOptions&)>& change) {
  const Chain chain({Chain::nodes, Chain::faces, Chain::cells}, false, false);
  PreconditionerOptions options;
  change(options);
  try {
    make_preconditioner(options, chain.blocks);
  } catch (const Error& error) {
    return error.what();
  }
  return "none";
}

TEST(Preconditioner, ErrorsNameTheEntry) {
  const std::string names = "\"nodes\", \"faces\", \"cells\"", blocks = "Sprekk > Solver > Blocks > ";
  EXPECT_EQ(error_of([](auto& o) { o.blocks["node"]; }),
            blocks + "\"node\": no such block is left after elimination; there are " + names);
  EXPECT_EQ(error_of([](auto& o) { o.blocks["faces"].with = "node"; }),
            blocks + "faces > \"with\": is \"node\", must be one of " + names);
  EXPECT_EQ(error_of([](auto& o) { o.blocks["faces"].with = "cells"; }),
            blocks + "faces > \"with\": leads in a circle");
  EXPECT_EQ(
      error_of([](auto& o) { o.blocks["cells"].type = "direct"; }),
      blocks + "cells > \"type\": cannot be chosen, for the block is in the group of \"faces\", whose type it takes");
  EXPECT_EQ(error_of([](auto& o) { o.sweep.order = {"faces"}; }),
            "Sprekk > Solver > Sweep > \"order\": is faces, must name each of \"nodes\", \"faces\" once");
  EXPECT_EQ(error_of([](auto& o) {
              o.sweep.order = {"faces", "faces"};
            }),
            "Sprekk > Solver > Sweep > \"order\": is faces, faces, must name each of \"nodes\", \"faces\" once");
  EXPECT_EQ(error_of([](auto& o) { o.blocks["cells"].multigrid.emplace(); }),
            blocks + "cells > \"multigrid\": has no effect: the block is in the group of \"faces\"");
  const auto of_ifpack2 = [&](const std::string& method, const std::string& entry) {
    return error_of([&](auto& o) {
      o.blocks["nodes"].type = "Ifpack2";
      o.blocks["nodes"].ifpack2.set("type", method).set(entry, 2.0);
    });
  };
  EXPECT_NE(of_ifpack2("ILU", "fact: drop tolerance").find(blocks + "nodes > Ifpack2: "), std::string::npos);
  EXPECT_EQ(of_ifpack2("ILUT", "fact: drop"), blocks +
                                                  "nodes > Ifpack2 > \"fact: drop\": ILUT does not read this "
                                                  "parameter; see the manual of Ifpack2 for its parameters");
  const auto of_relaxation = of_ifpack2("RELAXATION", "relaxation: swep");
  EXPECT_NE(of_relaxation.find("relaxation: swep"), std::string::npos) << of_relaxation;
  const auto of_muelu = error_of([](auto& o) {
    o.blocks["nodes"].type = "MueLu";
    o.blocks["nodes"].muelu.set("smother: type", "CHEBYSHEV");
  });
  EXPECT_NE(of_muelu.find("nodes > MueLu > \"smother: type\": no such parameter. Did you mean \"smoother: type\"?"),
            std::string::npos)
      << of_muelu;
  EXPECT_NE(error_of([](auto& o) {
              o.blocks["cells"].with = "nodes";
              o.blocks["nodes"].type = "multigrid";
            }).find("nodes > \"type\": multigrid requires blocks of unknowns with coordinates"),
            std::string::npos);
}

}  // namespace
}  // namespace sprekk::test
