// Small BlockProblems for tests of the solvers.
#pragma once

#include <Teuchos_CommHelpers.hpp>
#include <algorithm>
#include <cmath>
#include <functional>

#include "fields/block_problem.hpp"

namespace sprekk::test {

using fields::Block;
using fields::BlockMatrix;
using fields::BlockProblem;
using fields::BlockVector;
using fields::CrsMatrix;
using fields::Evaluation;
using fields::LocalGroup;
using fields::Map;
using fields::Measure;
using fields::MultiVector;
using fields::Vector;
using fields::wrapped;

inline RCP<const Map> make_map(const std::vector<GlobalIndex>& indices, const RCP<const Comm>& comm) {
  const auto n = Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid();
  return rcp(new Map(n, Teuchos::arrayView(indices.data(), indices.size()), 0, comm));
}

/// Adds entries to a distributed matrix by (global row, global column); rows of other ranks are ignored.
class Filler {
 public:
  Filler(const RCP<const Map>& rows, const RCP<const Map>& columns)
      : columns_(columns), matrix_(rcp(new CrsMatrix(rows, 64))) {}
  void add(GlobalIndex i, GlobalIndex j, Real value) {
    if (matrix_->getRowMap()->isNodeGlobalElement(i))
      matrix_->insertGlobalValues(i, Teuchos::tuple<GlobalIndex>(j), Teuchos::tuple<Real>(value));
  }
  RCP<CrsMatrix> done() {
    matrix_->fillComplete(columns_, matrix_->getRowMap());
    return matrix_;
  }

 private:
  RCP<const Map> columns_;
  RCP<CrsMatrix> matrix_;
};

struct GridOptions {
  int d = 2, nx = 5, ny = 6;
  bool faces = true, constraints = true;
  int singular_face = -1;  ///< a face whose bubble has no stiffness
  bool eliminate = true;   ///< bubble and traction are a local group
  bool shares = false;     ///< shares the rows of the matrix of the springs (SavedRows)
  Real mix = 0;            ///< weight of other components of u in a component of the jump
};

/// Springs on a grid of nodes, cut by a row of faces between two rows of nodes. Unknowns: 'displacement' u at nodes;
/// 'bubble' a and 'traction' l at faces. The jump is w = Q (u_p - u_q) + beta a:
///   r_u = K u + (Q^T l at p, -Q^T l at q, eta a at p, -eta a at the node above)
///   r_a = alpha a + eta (u_p - u_above) + beta l
///   r_l = l_0 - min(l_0 + c w_0, 0) for the normal component, l_j - kt w_j for the others
/// The lowest row of nodes is fixed; the highest row moves by t top(i) in direction 0. With several ranks, the last
/// rank has no nodes, and faces are on other ranks than their nodes.
class GridProblem : public BlockProblem, public fields::Globalisation {
 public:
  static constexpr Real alpha = 3, eta = 0.4, beta = 0.7, c = 5, kt = 0.5;

  GridProblem(const RCP<const Comm>& comm, const GridOptions& options) : comm_(comm), o_(options) {
    const int d = o_.d, size = comm->getSize(), rank = comm->getRank(), with_nodes = std::max(1, size - 1);
    std::vector<GlobalIndex> nodes, faces;
    std::vector<GlobalIndex> unknowns, face_unknowns;
    for (int n = 0; n < o_.nx * o_.ny; ++n)
      if (n / 3 % with_nodes == rank)
        for (int j = 0; j < d; ++j) unknowns.push_back(n * d + j);
    for (int f = 0; o_.faces && f < o_.nx; ++f)
      if ((f + 1) % size == rank)
        for (int j = 0; j < d; ++j) face_unknowns.push_back(f * d + j);
    const auto u = make_map(unknowns, comm), z = make_map(face_unknowns, comm);
    add_node_block(u);
    if (o_.faces) {
      blocks_.push_back({"bubble", z, d, 1, 1, Teuchos::null, {}});
      blocks_.push_back({"traction", z, d, 1, 1, Teuchos::null, {}});
      if (o_.eliminate) groups_.push_back({"contact", {1, 2}});
    }
    constrained_ = View<char*>("constrained", unknowns.size());
    for (std::size_t i = 0; i < unknowns.size(); ++i) constrained_(i) = o_.constraints && row_of(unknowns[i] / d) >= 0;
    fill_matrices();
  }

  int p(int face) const { return (o_.ny / 2) * o_.nx + face; }
  int q(int face) const { return (o_.ny / 2 - 1) * o_.nx + face; }
  Real top(int i) const { return std::sin(6.3 * (i + 0.6) / o_.nx) + 0.1; }
  int n_jacobians = 0, n_commits = 0;
  RCP<const Vector> added;  ///< proximal diagonal of the displacement

  fields::Globalisation& globalisation() override { return *this; }
  RCP<const Comm> comm() const override { return comm_; }
  const std::vector<Block>& blocks() const override { return blocks_; }
  const std::vector<LocalGroup>& local_groups() const override { return groups_; }
  void set_time(Real t, Real) override { t_ = t; }
  void commit(const Evaluation&) override { ++n_commits; }

  void raw_residual(const Evaluation& at, BlockVector& r) override {
    const auto& x = at.x();
    stiffness_->apply(*x[0], *r[0]);
    if (!o_.faces) return;
    matrix_(0, 1)->apply(*x[1], *r[0], Teuchos::NO_TRANS, 1, 1);
    matrix_(0, 2)->apply(*x[2], *r[0], Teuchos::NO_TRANS, 1, 1);
    const auto w = jump(*x[0]);
    matrix_(1, 0)->apply(*x[0], *r[1]);
    for (LocalIndex i = 0; i < LocalIndex(w->getLocalLength()); ++i) {
      const Real a = x[1]->getData()[i], l = x[2]->getData()[i], jump = w->getData()[i] + beta * a;
      r[1]->sumIntoLocalValue(i, alpha_of(i) * a + beta * l);
      r[2]->replaceLocalValue(i, i % o_.d == 0 ? l - std::min(l + c * jump, 0.0) : l - kt * jump);
    }
  }
  void residual(const Evaluation& at, BlockVector& r) override {
    raw_residual(at, r);
    const auto& x = at.x();
    for (LocalIndex i = 0; i < LocalIndex(constrained_.extent(0)); ++i)
      if (constrained_(i)) r[0]->replaceLocalValue(i, x[0]->getData()[i] - prescribed(i));
  }
  void jacobian(const Evaluation& at) override {
    const auto& x = at.x();
    ++n_jacobians;
    if (!o_.faces) return;
    const auto w = jump(*x[0]);
    const auto lu = matrix_(2, 0)->getLocalMatrixHost(), la = matrix_(2, 1)->getLocalMatrixHost(),
               ll = matrix_(2, 2)->getLocalMatrixHost();
    const auto bu = jump_->getLocalMatrixHost();
    for (LocalIndex i = 0; i < LocalIndex(w->getLocalLength()); ++i) {
      const Real l = x[2]->getData()[i], jump = w->getData()[i] + beta * x[1]->getData()[i];
      const bool normal = i % o_.d == 0, open = l + c * jump > 0;
      const Real dr_dw = normal ? (open ? 0 : -c) : -kt;
      ll.values(i) = normal && !open ? 0 : 1;
      la.values(i) = dr_dw * beta;
      for (auto k = bu.graph.row_map(i); k < bu.graph.row_map(i + 1); ++k) lu.values(k) = dr_dw * bu.values(k);
    }
  }
  const BlockMatrix& matrix() const override { return matrix_; }
  std::shared_ptr<fields::SavedRows> share(int block, const RCP<const fields::Matrix>& J) override {
    if (!o_.shares || block > 0) return nullptr;
    if (matrix_.saved(0))
      matrix_.saved(0)->restore(*J);
    else
      matrix_.share(0, std::make_shared<fields::SavedRows>(J));
    return matrix_.saved(0);
  }
  RCP<const Vector> proximal(int block) const override { return block == 0 ? added : Teuchos::null; }
  bool symmetric() const override { return o_.eliminate; }
  ConstView<char*> constrained(int block) const override {
    return block == 0 ? ConstView<char*>(constrained_) : ConstView<char*>();
  }
  std::vector<Measure> measures(const Evaluation&, const BlockVector& r) override {
    std::vector<Measure> all;
    for (std::size_t b = 0; b < r.size(); ++b) all.push_back({blocks_[b].name, r[b]->norm2()});
    return all;
  }
  Real merit(const Evaluation&, const BlockVector& r) override {
    Real sum = 0;
    for (const auto& v : r) sum += std::pow(v->norm2(), 2);
    return sum;
  }
  std::vector<char> states(const Evaluation& at) override {
    const auto& x = at.x();
    std::vector<char> states;
    if (!o_.faces) return states;
    const auto w = jump(*x[0]);
    for (LocalIndex i = 0; i < LocalIndex(w->getLocalLength()); i += o_.d)
      states.push_back(x[2]->getData()[i] + c * (w->getData()[i] + beta * x[1]->getData()[i]) > 0);
    return states;
  }
  std::size_t state_hash(const std::vector<char>& states) override {
    long long here = 0, all = 0;
    for (std::size_t k = 0; k < states.size(); ++k)
      if (states[k]) here += 1LL << (blocks_[2].map->getGlobalElement(LocalIndex(k) * o_.d) / o_.d % 60);
    Teuchos::reduceAll(*comm_, Teuchos::REDUCE_SUM, 1, &here, &all);
    return all;
  }
  BlockVector zero() const {
    BlockVector x;
    for (const auto& block : blocks_) x.push_back(rcp(new Vector(block.map)));
    return x;
  }
  RCP<Vector> jump(const Vector& u) const {
    const auto w = rcp(new Vector(blocks_[2].map));
    jump_->apply(u, *w);
    return w;
  }

 private:
  /// Returns 0 in the fixed row, 1 in the moved row, else -1.
  int row_of(GlobalIndex node) const {
    const int j = node / o_.nx;
    return j == 0 ? 0 : j == o_.ny - 1 ? 1 : -1;
  }
  Real prescribed(LocalIndex i) const {
    const GlobalIndex g = blocks_[0].map->getGlobalElement(i);
    return g % o_.d == 0 && row_of(g / o_.d) == 1 ? t_ * top(g / o_.d % o_.nx) : 0;
  }
  Real alpha_of(LocalIndex i) const {
    return blocks_[1].map->getGlobalElement(i) / o_.d == o_.singular_face ? 0 : alpha;
  }

  void add_node_block(const RCP<const Map>& u) {
    const int d = o_.d, n = base::n_local_elements(*u);
    std::vector<GlobalIndex> nodes;
    for (int i = 0; i < n; i += d) nodes.push_back(u->getGlobalElement(i) / d);
    const auto coordinates = rcp(new MultiVector(make_map(nodes, comm_), d));
    const auto modes = rcp(new MultiVector(u, d));
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      coordinates->replaceLocalValue(i, 0, Real(nodes[i] % o_.nx));
      coordinates->replaceLocalValue(i, 1, Real(nodes[i] / o_.nx));
      for (int j = 0; j < d; ++j) modes->replaceLocalValue(i * d + j, j, 1.0);
    }
    blocks_.push_back({"displacement", u, d, 1, 1, coordinates, {static_cast<int>(modes->getNumVectors()), [modes] {
                                                                   return modes;
                                                                 }}});
  }

  void fill_matrices() {
    const int d = o_.d;
    const auto u = blocks_[0].map;
    Filler k(u, u);
    const auto spring = [&](int m, int n) {
      for (int i = 0; i < d; ++i)
        for (int j = 0; j < d; ++j) {
          const Real s = i == j ? 2 : 0.3;
          k.add(m * d + i, m * d + j, s);
          k.add(n * d + i, n * d + j, s);
          k.add(m * d + i, n * d + j, -s);
          k.add(n * d + i, m * d + j, -s);
        }
    };
    for (int j = 0; j < o_.ny; ++j)
      for (int i = 0; i < o_.nx; ++i) {
        if (i + 1 < o_.nx) spring(j * o_.nx + i, j * o_.nx + i + 1);
        if (j + 1 < o_.ny && !(o_.faces && j + 1 == o_.ny / 2)) spring(j * o_.nx + i, (j + 1) * o_.nx + i);
      }
    stiffness_ = k.done();
    matrix_ = BlockMatrix(blocks_.size());
    matrix_(0, 0) = stiffness_;
    if (!o_.faces) return;
    const auto z = blocks_[1].map;
    Filler ua(u, z), ul(u, z), au(z, u), aa(z, z), al(z, z), lu(z, u), la(z, z), ll(z, z), jump(z, u);
    for (int f = 0; f < o_.nx; ++f)
      for (int j = 0; j < d; ++j) {
        const GlobalIndex i = f * d + j;
        for (int side : {1, -1}) {
          const GlobalIndex n = (side == 1 ? p(f) : q(f)) * d + j, m = (side == 1 ? p(f) : p(f) + o_.nx) * d + j;
          ua.add(m, i, side * eta);
          au.add(i, m, side * eta);
          for (int k = 0; k < d; ++k) {
            const Real share = side * (k == j ? 1 : o_.mix);
            if (share == 0) continue;
            ul.add(n - j + k, i, share);
            lu.add(i, n - j + k, share);
            jump.add(i, n - j + k, share);
          }
        }
        aa.add(i, i, f == o_.singular_face ? 0 : alpha);
        al.add(i, i, beta);
        la.add(i, i, beta);
        ll.add(i, i, 1);
      }
    matrix_(0, 1) = ua.done();
    matrix_(0, 2) = ul.done();
    matrix_(1, 0) = au.done();
    matrix_(1, 1) = aa.done();
    matrix_(1, 2) = al.done();
    matrix_(2, 0) = lu.done();
    matrix_(2, 1) = la.done();
    matrix_(2, 2) = ll.done();
    jump_ = jump.done();
  }

  RCP<const Comm> comm_;
  GridOptions o_;
  std::vector<Block> blocks_;
  std::vector<LocalGroup> groups_;
  View<char*> constrained_;
  RCP<CrsMatrix> stiffness_, jump_;
  BlockMatrix matrix_;
  Real t_ = 0;
};

/// n independent copies of f(x, t, dt) = 0; copy i is on rank i % size.
class ScalarProblem : public BlockProblem, public fields::Globalisation {
 public:
  using Function = std::function<Real(Real x, Real t, Real dt)>;

  ScalarProblem(const RCP<const Comm>& comm, int n, Function f, Function df_dx)
      : comm_(comm), f_(std::move(f)), df_(std::move(df_dx)), matrix_(1) {
    std::vector<GlobalIndex> mine;
    for (int i = comm->getRank(); i < n; i += comm->getSize()) mine.push_back(i);
    const auto map = make_map(mine, comm);
    blocks_.push_back({"x", map, 1, 1, 1, Teuchos::null, {}});
    Filler diagonal(map, map);
    for (auto i : mine) diagonal.add(i, i, 1);
    matrix_(0, 0) = diagonal.done();
  }

  std::vector<Real> committed_times;
  Real resistance = 0;      ///< derivative added by a damping of 1
  std::vector<Real> damps;  ///< sequence of requested dampings; for several faces, the largest
  std::string free_body;    ///< name of a floating body
  std::function<char(Real)> state_of;
  Real proximal_stiffness = 0;       ///< spring constant of a proximal term of 1; 0: none
  std::vector<Real> proximal_terms;  ///< sequence of requested proximal stiffnesses

  void damp(Real everywhere, const std::vector<Real>& here) override {
    const Real damping = here.empty() ? everywhere : std::max(everywhere, *std::max_element(here.begin(), here.end()));
    if (damps.empty() || damps.back() != damping) damps.push_back(damping);
  }
  bool has_contact = true, storing = false;
  bool stores() const override { return storing; }
  bool set_proximal_term(Real stiffness, const Evaluation& at) override {
    proximal_terms.push_back(stiffness);
    const auto values = at.x()[0]->getData();
    anchor_.assign(values.begin(), values.end());
    return has_contact;
  }
  std::vector<char> states(const Evaluation& at) override {
    const auto& x = at.x();
    std::vector<char> states;
    for (std::size_t i = 0; state_of && i < x[0]->getLocalLength(); ++i) states.push_back(state_of(x[0]->getData()[i]));
    return states;
  }
  std::string floating() const override { return free_body; }
  std::string balance(const Evaluation&, BlockVector&, Evaluation&) override { return free_body; }

  fields::Globalisation& globalisation() override { return *this; }
  RCP<const Comm> comm() const override { return comm_; }
  const std::vector<Block>& blocks() const override { return blocks_; }
  const std::vector<LocalGroup>& local_groups() const override { return groups_; }
  void set_time(Real t, Real dt) override { t_ = t, dt_ = dt; }
  void commit(const Evaluation&) override { committed_times.push_back(t_); }
  void residual(const Evaluation& at, BlockVector& r) override { raw_residual(at, r); }
  void raw_residual(const Evaluation& at, BlockVector& r) override {
    const auto& x = at.x();
    for (std::size_t i = 0; i < x[0]->getLocalLength(); ++i)
      r[0]->replaceLocalValue(i, f_(x[0]->getData()[i], t_, dt_) + pull(i, x[0]->getData()[i]));
  }
  void jacobian(const Evaluation& at) override {
    const auto& x = at.x();
    const auto local = matrix_(0, 0)->getLocalMatrixHost();
    for (std::size_t i = 0; i < x[0]->getLocalLength(); ++i)
      local.values(i) = df_(x[0]->getData()[i], t_, dt_) + (damps.empty() ? 0 : resistance * damps.back()) + spring();
  }
  const BlockMatrix& matrix() const override { return matrix_; }
  bool symmetric() const override { return true; }
  ConstView<char*> constrained(int) const override { return {}; }
  std::vector<Measure> measures(const Evaluation&, const BlockVector& r) override { return {{"r", r[0]->normInf()}}; }
  Real merit(const Evaluation&, const BlockVector& r) override { return std::pow(r[0]->norm2(), 2); }
  std::size_t state_hash(const std::vector<char>& states) override {
    long long here = 0, all = 0;
    for (char state : states) here += state;
    Teuchos::reduceAll(*comm_, Teuchos::REDUCE_SUM, 1, &here, &all);
    return all;
  }
  BlockVector constant(Real value) const {
    BlockVector x{rcp(new Vector(blocks_[0].map))};
    x[0]->putScalar(value);
    return x;
  }

 private:
  Real spring() const { return proximal_terms.empty() ? 0 : proximal_stiffness * proximal_terms.back(); }
  Real pull(LocalIndex i, Real x) const { return spring() > 0 ? spring() * (x - anchor_[i]) : 0; }

  std::vector<Real> anchor_;  // [unknown] x at the last proximal term
  RCP<const Comm> comm_;
  Function f_, df_;
  std::vector<Block> blocks_;
  std::vector<LocalGroup> groups_;
  BlockMatrix matrix_;
  Real t_ = 0, dt_ = 0;
};

/// A flow p = t and a quantity T that it carries, on each rank: p - t = 0, T + p (T - 1) = 0. With `heats`, the flow
/// also depends on T: p - t (1 + T/1e7) = 0.
class CarriedProblem : public BlockProblem {
 public:
  CarriedProblem(const RCP<const Comm>& comm, bool heats) : comm_(comm), feedback_(heats ? 1e-7 : 0), matrix_(2) {
    const GlobalIndex rank = comm->getRank();
    const auto map = make_map({rank}, comm);
    blocks_.push_back({"p", map, 1, 1, 1, Teuchos::null, {}});
    blocks_.push_back({"T", map, 1, 1, 1, Teuchos::null, {}});
    blocks_.back().advected = true;
    for (auto& block : blocks_) {
      block.balance = true;
      block.quantity = block.name;
    }
    for (int i = 0; i < 2; ++i)
      for (int j = 0; j < 2; ++j) {
        Filler one(map, map);
        one.add(rank, rank, 1);
        matrix_(i, j) = one.done();
      }
  }
  RCP<const Comm> comm() const override { return comm_; }
  const std::vector<Block>& blocks() const override { return blocks_; }
  const std::vector<LocalGroup>& local_groups() const override { return groups_; }
  void set_time(Real t, Real) override { t_ = t; }
  void commit(const Evaluation&) override {}
  void residual(const Evaluation& at, BlockVector& r) override { raw_residual(at, r); }
  void raw_residual(const Evaluation& at, BlockVector& r) override {
    const Real p = at.x()[0]->getData()[0], T = at.x()[1]->getData()[0];
    r[0]->putScalar(p - t_ * (1 + feedback_ * T));
    r[1]->putScalar(T + p * (T - 1));
  }
  void jacobian(const Evaluation& at) override {
    const Real p = at.x()[0]->getData()[0], T = at.x()[1]->getData()[0];
    const auto set = [&](int i, int j, Real value) { matrix_(i, j)->getLocalMatrixHost().values(0) = value; };
    set(0, 0, 1);
    set(0, 1, -t_ * feedback_);
    set(1, 0, T - 1);
    set(1, 1, 1 + p);
  }
  const BlockMatrix& matrix() const override { return matrix_; }
  bool symmetric() const override { return false; }
  ConstView<char*> constrained(int) const override { return {}; }
  std::vector<Measure> measures(const Evaluation&, const BlockVector& r) override {
    return {{"p", r[0]->normInf() / (0.01 * t_)}, {"T", r[1]->normInf() / t_}};
  }
  Real merit(const Evaluation&, const BlockVector& r) override {
    return std::pow(r[0]->norm2(), 2) + 1e-12 * std::pow(r[1]->norm2(), 2);
  }
  BlockVector zero() const { return {rcp(new Vector(blocks_[0].map)), rcp(new Vector(blocks_[1].map))}; }

 private:
  RCP<const Comm> comm_;
  Real feedback_;
  std::vector<Block> blocks_;
  std::vector<LocalGroup> groups_;
  BlockMatrix matrix_;
  Real t_ = 0;
};

}  // namespace sprekk::test
