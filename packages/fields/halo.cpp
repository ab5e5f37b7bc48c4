#include "fields/halo.hpp"

#include <Tpetra_Distributor.hpp>

#include "base/check.hpp"

namespace sprekk::fields {

Halo::Halo(RCP<const Map> owned, RCP<const Map> all) : owned_(owned), all_(all) {
  if (all->getGlobalNumElements() == owned->getGlobalNumElements()) return;
  import_ = rcp(new Import(owned, all));
  SPREKK_CHECK(import_->getNumSameIDs() == base::n_local_elements(*owned), "owned nodes must come first");
}

std::vector<LocalIndex> Halo::sent_nodes() const {
  if (import_.is_null()) return {};
  const auto nodes = import_->getExportLIDs();
  return {nodes.begin(), nodes.end()};
}

std::size_t Halo::n_messages() const { return import_.is_null() ? 0 : import_->getDistributor().getNumReceives(); }

template <class T>
void Halo::exchange(const View<T*>& x, int width) const {
  static_assert(sizeof(T) <= sizeof(Real));
  if (import_.is_null()) return;
  const auto sent_nodes = import_->getExportLIDs(), received_nodes = import_->getRemoteLIDs();
  const std::size_t n_sent = width * sent_nodes.size(), n_received = width * received_nodes.size();
  if (sent_.extent(0) < n_sent) sent_ = View<Real*>("sent", n_sent);
  if (received_.extent(0) < n_received) received_ = View<Real*>("received", n_received);
  const View<T*> sent(reinterpret_cast<T*>(sent_.data()), n_sent),
      received(reinterpret_cast<T*>(received_.data()), n_received);
  for (LocalIndex k = 0; k < sent_nodes.size(); ++k)
    for (int c = 0; c < width; ++c) sent(k * width + c) = x(static_cast<std::size_t>(sent_nodes[k]) * width + c);
  import_->getDistributor().doPostsAndWaits(View<const T*>(sent), width, received);
  for (LocalIndex k = 0; k < received_nodes.size(); ++k)
    for (int c = 0; c < width; ++c)
      x(static_cast<std::size_t>(received_nodes[k]) * width + c) = received(k * width + c);
}

template <class T>
void Halo::exchange_rows(const View<std::size_t*>& start, const View<T*>& x, int width) const {
  if (import_.is_null()) return;
  const auto lengths = [&](const Teuchos::ArrayView<const LocalIndex>& nodes, std::size_t& sum) {
    std::vector<std::size_t> n;
    sum = 0;
    for (const LocalIndex node : nodes) {
      n.push_back(width * (start(node + 1) - start(node)));
      sum += n.back();
    }
    return n;
  };
  const auto sent_nodes = import_->getExportLIDs(), received_nodes = import_->getRemoteLIDs();
  std::size_t n_sent = 0, n_received = 0;
  const auto of_sent = lengths(sent_nodes, n_sent), of_received = lengths(received_nodes, n_received);
  const View<T*> sent("sent rows", n_sent), received("received rows", n_received);
  std::size_t at = 0;
  for (const LocalIndex node : sent_nodes)
    for (std::size_t k = width * start(node); k < width * start(node + 1); ++k) sent(at++) = x(k);
  using Teuchos::arrayViewFromVector;
  import_->getDistributor().doPostsAndWaits(View<const T*>(sent), arrayViewFromVector(of_sent), received,
                                            arrayViewFromVector(of_received));
  at = 0;
  for (const LocalIndex node : received_nodes)
    for (std::size_t k = width * start(node); k < width * start(node + 1); ++k) x(k) = received(at++);
}

template void Halo::exchange(const View<Real*>&, int) const;
template void Halo::exchange(const View<float*>&, int) const;
template void Halo::exchange(const View<GlobalIndex*>&, int) const;
template void Halo::exchange_rows(const View<std::size_t*>&, const View<Real*>&, int) const;
template void Halo::exchange_rows(const View<std::size_t*>&, const View<float*>&, int) const;
template void Halo::exchange_rows(const View<std::size_t*>&, const View<GlobalIndex*>&, int) const;

}  // namespace sprekk::fields
