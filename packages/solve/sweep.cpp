#include "solve/sweep.hpp"

#include <algorithm>
#include <utility>

namespace sprekk::solve {
namespace {

using fields::Map;
using fields::MultiVector;
using fields::Operator;

/// Operator sum += B_f (x - A sum)_f for the groups in turn; in diagonal sweeps B_f x_f.
class SweepOperator : public Operator {
 public:
  struct Part {
    std::vector<int> blocks;
    RCP<const Operator> inverse;  // B_f; for one block, without its scale
  };

  SweepOperator(const LinearSystem& system, const std::string& type, std::vector<Part> parts)
      : joined_(system.joined), A_(system.joined_operator()), parts_(std::move(parts)), diagonal_(type == "diagonal") {
    const int n = static_cast<int>(parts_.size());
    for (int f = 0; f < n; ++f) turns_.push_back(f);
    for (int f = n - 2; f >= 0 && type == "symmetric"; --f) turns_.push_back(f);
  }
  RCP<const Map> getDomainMap() const override { return joined_->map(); }
  RCP<const Map> getRangeMap() const override { return joined_->map(); }

  void apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp, Real alpha, Real beta) const override {
    MultiVector sum(y.getMap(), y.getNumVectors()), rest(x, Teuchos::Copy);
    for (std::size_t turn = 0; turn < turns_.size(); ++turn) {
      if (turn > 0 && !diagonal_) {
        A_->apply(sum, rest);
        rest.update(1, x, -1);
      }
      add_correction(parts_[turns_[turn]], rest, sum);
    }
    y.update(alpha, sum, beta);
  }

 private:
  void add_correction(const Part& part, const MultiVector& rest, MultiVector& sum) const {
    const auto from = [&](int r) { return rest.offsetView(joined_->map(r), joined_->first(r)); };
    const auto to = [&](int r) { return sum.offsetViewNonConst(joined_->map(r), joined_->first(r)); };
    MultiVector z(part.inverse->getRangeMap(), rest.getNumVectors());
    if (part.blocks.size() == 1) {
      const int r = part.blocks.front();
      part.inverse->apply(*from(r), z);
      to(r)->update(1 / (joined_->scale(r) * joined_->scale(r)), z, 1);
      return;
    }
    MultiVector b(part.inverse->getDomainMap(), rest.getNumVectors());
    each(part,
         [&](int r, LocalIndex first) { Tpetra::deep_copy(*b.offsetViewNonConst(joined_->map(r), first), *from(r)); });
    part.inverse->apply(b, z);
    each(part, [&](int r, LocalIndex first) { to(r)->update(1, *z.offsetView(joined_->map(r), first), 1); });
  }

  /// Calls visit(block, its first position in vectors of the part).
  template <class Visit>
  void each(const Part& part, const Visit& visit) const {
    LocalIndex first = 0;
    for (const int r : part.blocks) {
      visit(r, first);
      first += static_cast<LocalIndex>(base::n_local_elements(*joined_->map(r)));
    }
  }

  std::shared_ptr<const Joined> joined_;
  RCP<const Operator> A_;
  std::vector<Part> parts_;
  bool diagonal_;
  std::vector<int> turns_;
};

}  // namespace

Sweep::Sweep(const SweepOptions& options, const std::vector<Block>& blocks, const std::vector<std::vector<int>>& groups,
             std::vector<std::unique_ptr<Preconditioner>> parts)
    : Preconditioner("sweep", blocks[groups.front().front()].name),
      type_(options.type),
      groups_(groups),
      parts_(std::move(parts)) {
  for (const auto& group : groups_) {
    std::vector<RCP<const Map>> maps;
    for (const int r : group) maps.push_back(blocks[r].map);
    joined_.push_back(std::make_shared<Joined>(maps));
  }
}

LinearSystem Sweep::part(int group, const LinearSystem& system) const {
  std::vector<Real> scales;
  // couplings between symmetric blocks may be nonsymmetric
  const bool alone = groups_[group].size() == 1;
  LinearSystem part{joined_[group], {}, alone || system.symmetric, {}, {}, system.reproducible};
  for (const int r : groups_[group]) {
    scales.push_back(system.joined->scale(r));
    part.diagonal.push_back(system.diagonal[r]);
    part.symmetric = part.symmetric && system.diagonal[r].symmetric;
    for (const int s : groups_[group]) part.blocks.push_back(system.blocks[r * system.joined->n_blocks() + s]);
  }
  joined_[group]->set_scales(scales);
  return part;
}

void Sweep::prepare(const LinearSystem& system, SolverCost&) {
  std::vector<SweepOperator::Part> parts;
  for (int f = 0; f < static_cast<int>(parts_.size()); ++f) {
    parts_[f]->setup(part(f, system));
    parts.push_back({groups_[f], parts_[f]->inverse()});
  }
  inverse_ = rcp(new SweepOperator(system, type_, std::move(parts)));
}

int Sweep::coarse_size() const {
  int smallest = 0;
  for (const auto& part : parts_)
    if (const int size = part->coarse_size(); size > 0) smallest = smallest == 0 ? size : std::min(smallest, size);
  return smallest;
}

std::vector<SolverCost> Sweep::costs() const {
  std::vector<SolverCost> all;
  for (const auto& part : parts_)
    for (const auto& cost : part->costs()) all.push_back(cost);
  return all;
}

void Sweep::describe(Teuchos::ParameterList& blocks) const {
  for (const auto& part : parts_) part->describe(blocks);
}

}  // namespace sprekk::solve
