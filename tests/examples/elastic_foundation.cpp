#include "examples/elastic_foundation.hpp"

#include "assembly/assembler.hpp"

namespace sprekk::examples {

using assembly::Loop;
using mesh::Shape;

namespace {

/// The springs under one boundary face.
///
/// | symbol | shape              | unit |                                                             |
/// | x      | u [node, dim]      | m    | displacement of the face's nodes                            |
/// | r      | [node, dim]        | N    | forces                                                      |
/// | mass   | [face, node, node] | m^2  | integral N_a N_b; zero where the boundary is another one    |
/// | k      | [dim]              | Pa/m | stiffness                                                   |
template <Shape shape>
struct SprungFace {
  static constexpr int dim = mesh::dimension(shape), n = mesh::n_face_nodes(shape);
  using Columns = assembly::Slots<assembly::Slot<n, dim>>;
  using Rows = Columns;

  View<Real***> mass;
  Kokkos::Array<Real, 3> k;

  KOKKOS_INLINE_FUNCTION void residual(int face, const Real (&x)[Columns::size], Real (&r)[Rows::size]) const {
    for (int a = 0; a < n; ++a)
      for (int i = 0; i < dim; ++i) {
        r[a * dim + i] = 0;
        for (int b = 0; b < n; ++b) r[a * dim + i] += k[i] * mass(face, a, b) * x[b * dim + i];
      }
  }

  KOKKOS_INLINE_FUNCTION void jacobian(int face, const Real (&)[Columns::size],
                                       Real (&J)[Rows::size][Columns::size]) const {
    for (auto& row : J)
      for (Real& value : row) value = 0;
    for (int a = 0; a < n; ++a)
      for (int b = 0; b < n; ++b)
        for (int i = 0; i < dim; ++i) J[a * dim + i][b * dim + i] = k[i] * mass(face, a, b);
  }
};

template <Shape shape>
class ElasticFoundation final : public assembly::Module {
 public:
  using Op = SprungFace<shape>;
  using Assembler = assembly::Assembler<Op>;

  explicit ElasticFoundation(ElasticFoundationParameters parameters) : parameters_(parameters) {}

  std::string name() const override { return "elastic foundation"; }

  assembly::Declaration declare() const override {
    assembly::Declaration d;
    d.couplings = {{Loop::boundary_faces, "displacement", {"displacement"}}};
    d.linear = true;
    return d;
  }

  void bind(const assembly::Context& context) override {
    const auto& mesh = *context.mesh();
    const int u = context.field("displacement");
    faces_ = std::make_unique<Assembler>(context, Loop::boundary_faces, std::vector<int>{u}, std::vector<int>{u},
                                         Assembler::Positions::once);
    View<Real***> mass("mass", mesh.boundary_faces.size(), Op::n, Op::n);
    const auto host = Kokkos::create_mirror_view(mass);
    for (std::size_t f = 0; f < mesh.boundary_faces.size(); ++f) {
      const auto& face = mesh.boundary_faces[f];
      if (face.boundary != parameters_.boundary) continue;
      const auto add = [&](const auto& N, Real area, const auto&) {
        for (int a = 0; a < Op::n; ++a)
          for (int b = 0; b < Op::n; ++b) host(f, a, b) += area * N[a] * N[b];
      };
      assembly::for_each_face_point<shape>(mesh, face.cell, face.local_face, add);
    }
    Kokkos::deep_copy(mass, host);
    const auto& k = parameters_.stiffness;
    op_ = std::make_unique<Op>(Op{mass, {k[0], k[1], k[2]}});
  }

  void residual(const assembly::State& state, const assembly::Rows& r) const override {
    faces_->add_residual(*op_, state, r);
  }
  void jacobian(const assembly::State& state, fields::BlockMatrix& J) const override {
    faces_->add_jacobian(*op_, state, J);
  }
  bool holds_bodies() const override { return true; }

 private:
  ElasticFoundationParameters parameters_;
  std::unique_ptr<Op> op_;
  std::unique_ptr<Assembler> faces_;
};

}  // namespace

std::unique_ptr<assembly::Module> make_elastic_foundation(Shape shape, ElasticFoundationParameters parameters) {
  return mesh::for_shape(shape, [&](auto s) -> std::unique_ptr<assembly::Module> {
    return std::make_unique<ElasticFoundation<s()>>(parameters);
  });
}

}  // namespace sprekk::examples
