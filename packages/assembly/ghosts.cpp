#include "assembly/ghosts.hpp"

#include "assembly/rows.hpp"

namespace sprekk::assembly {

Ghosts::Ghosts(const Structure& structure) : structure_(structure) {
  for (const auto& layout : structure.layouts) vectors_.push_back(rcp(new fields::Vector(layout.ghosted())));
}

void Ghosts::exchange(const fields::BlockVector& x, Which which) {
  const auto scope = structure_.timers->scope("ghost exchange");
  for (std::size_t b = 0; b < x.size(); ++b) {
    if (which == Which::all || structure_.exchanged[b]) {
      vectors_[b]->doImport(*x[b], *structure_.layouts[b].import(), Tpetra::REPLACE);
    } else {
      const auto from = const_view_of(*x[b]);
      const auto to = view_of(*vectors_[b]);
      Kokkos::deep_copy(Kokkos::subview(to, Kokkos::make_pair(std::size_t(0), from.extent(0))), from);
    }
  }
}

void Ghosts::set_zero() {
  for (const auto& v : vectors_) v->putScalar(0);
}

std::vector<ConstView<Real*>> Ghosts::views() const {
  std::vector<ConstView<Real*>> views;
  for (const auto& v : vectors_) views.push_back(const_view_of(*v));
  return views;
}

}  // namespace sprekk::assembly
