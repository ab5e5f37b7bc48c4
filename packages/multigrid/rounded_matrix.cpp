#include "multigrid/rounded_matrix.hpp"

#include "multigrid/block_sizes.hpp"

namespace sprekk::multigrid {
namespace {

using Number = RoundedMatrix::Number;

constexpr Real largest_number = 32640;
constexpr Real exceeds_one = 1 + 1e-12;  // by more than round-off

KOKKOS_INLINE_FUNCTION Number nearest(Real x) {
  const Real within = x < largest_number ? (x > -largest_number ? x : -largest_number) : largest_number;
  return static_cast<Number>(static_cast<int>(within + 32768.5) - 32768);
}

}  // namespace

RoundedMatrix::RoundedMatrix(const NodeMatrix& A)
    : graph_(A.graph),
      value_("rounded", A.value.extent(0) + rounded::padded(A.height)),
      unit_("units", static_cast<std::size_t>(A.graph.n_rows()) * A.height) {}

void RoundedMatrix::update(const NodeMatrix& A, const View<Real*>& scale) {
  const auto start = graph_.start;
  const auto column = graph_.column;
  const auto a = A.value;
  const auto value = value_;
  const auto unit = unit_;
  with_sizes(A.height, A.height, [&](auto size, auto) {
    constexpr int b = size();
    Kokkos::parallel_for(
        "round", Kokkos::RangePolicy<Execution>(0, graph_.n_rows()), KOKKOS_LAMBDA(LocalIndex i) {
          const std::size_t begin = start(i), n = start(i + 1) - begin;
          for (int r = 0; r < b; ++r) {
            const auto store = [&](Real maximum) {  // returns the largest magnitude
              const Real factor = largest_number / maximum;
              Real largest = 0;
              for (std::size_t k = 0; k < n; ++k)
                for (int c = 0; c < b; ++c) {
                  const Real number =
                      a(b * b * begin + (r * n + k) * b + c) * (scale(i * b + r) * scale(column(begin + k) * b + c));
                  const Real size_of_it = number < 0 ? -number : number;
                  largest = size_of_it > largest || size_of_it != size_of_it ? size_of_it : largest;
                  value(b * b * (begin + k) + c * b + r) = nearest(factor * number);
                }
              unit(i * b + r) = static_cast<float>(maximum / largest_number);
              return largest;
            };
            if (const Real largest = store(1); !(largest <= exceeds_one)) store(largest);
          }
        });
  });
}

}  // namespace sprekk::multigrid
