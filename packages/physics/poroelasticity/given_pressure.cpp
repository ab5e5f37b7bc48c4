#include "physics/poroelasticity/given_pressure.hpp"

#include "assembly/assembler.hpp"
#include "assembly/capabilities.hpp"
#include "base/check.hpp"
#include "base/host_table.hpp"
#include "fields/properties.hpp"
#include "physics/mechanics/displacements.hpp"

#include <algorithm>
#include <cmath>

namespace sprekk::physics {

using assembly::Loop;
using assembly::Slot;

namespace {

/// Forces of a prescribed pressure p on a volume V.
///
/// | symbol   | shape             | unit |                              |
/// | x        | displacements [m] | m    | unknowns                     |
/// | r        | forces [m]        | N    | -p dV/du                     |
/// | volume   | [entity, m]       | m^2  | dV/du                        |
/// | of       | [entity]          | -    | number of the pressure       |
/// | pressure | [number]          | Pa   |                              |
template <class... Displacements>
struct Push {
  using Columns = assembly::Slots<Displacements...>;
  using Rows = Columns;
  static constexpr int m = Columns::size;
  View<Real**> volume;
  ConstView<LocalIndex*> of;
  ConstView<Real*> pressure;

  KOKKOS_INLINE_FUNCTION void residual(int e, const Real (&)[m], Real (&r)[m]) const {
    for (int k = 0; k < m; ++k) r[k] = -volume(e, k) * pressure(of(e));
  }
};

/// Forces of the pressures of rock or fractures, over one loop.
class Part {
 public:
  explicit Part(bool is_of_rock) : is_of_rock(is_of_rock) {}
  virtual ~Part() = default;
  const bool is_of_rock;

  virtual void set(const ConstView<Real*>& pressure) = 0;
  virtual void add_residual(const assembly::State& state, const assembly::Rows& r) const = 0;
  /// Adds the volumes, [number of the pressure] m^3 (2D: m^2).
  virtual void add_volumes(const assembly::State& state, const View<Real*>& volumes) const = 0;
};

template <class Op>
class PartOf final : public Part {
 public:
  PartOf(bool is_of_rock, const assembly::Context& context, Loop loop, const std::vector<int>& fields,
         const View<Real**>& volume, const std::vector<LocalIndex>& of)
      : Part(is_of_rock),
        op_{volume, assembly::to_device(of, "number of the pressure"), {}},
        assembler_(context, loop, fields, fields, assembly::Assembler<Op>::Positions::once) {}

  void set(const ConstView<Real*>& pressure) override { op_.pressure = pressure; }
  void add_residual(const assembly::State& state, const assembly::Rows& r) const override {
    assembler_.add_residual(op_, state, r);
  }
  void add_volumes(const assembly::State& state, const View<Real*>& volumes) const override {
    const auto volume = op_.volume;
    const auto of = op_.of;
    assembler_.for_each(
        op_, state, KOKKOS_LAMBDA(int e, const Real(&x)[Op::m]) {
          for (int k = 0; k < Op::m; ++k) Kokkos::atomic_add(&volumes(of(e)), volume(e, k) * x[k]);
        });
  }

 private:
  Op op_;
  assembly::Assembler<Op> assembler_;
};

class Given final : public GivenPressure, public assembly::Loads {
 public:
  Given(const mesh::Mesh& mesh, GivenPressureParameters parameters)
      : parameters_(std::move(parameters)),
        fractures_(!mesh.fracture_names.empty()),
        tips_(mesh.n_global_enriched > 0) {}

  std::string name() const override { return "given pressure"; }

  assembly::Declaration declare(const mesh::Mesh& mesh) const override {
    assembly::Declaration d;
    for (const auto& part : assembly::divergence_fields(mesh, displacements))
      d.couplings.push_back({part.loop, part.field, {part.field}});
    d.outputs = {{{"gained pore volume", mesh.dim() == 2 ? "m^2" : "m^3", fields::Entity::cell, 1},
                  [this](const auto& state) { return volumes(state, true); }}};
    if (fractures_)
      d.outputs.push_back({{"widening", "m", fields::Entity::fracture_face, 1}, [this](const auto& state) {
                             auto widening = volumes(state, false);
                             for (std::size_t f = 0; f < widening.size(); ++f)
                               widening[f] /= mesh_->fracture_faces[f].area;
                             return widening;
                           }});
    d.linear = true;
    return d;
  }

  void bind(const assembly::Context& context) override {
    mesh_ = context.mesh();
    const auto biot = [&](LocalIndex cell) { return parameters_.biot.of_cell(*mesh_, cell); };
    std::vector<LocalIndex> faces, faces_of_tips;
    for (const auto& [f, side] : assembly::fracture_sides(*mesh_)) faces.push_back(f);
    for (const LocalIndex s : assembly::tip_sides(*mesh_)) faces_of_tips.push_back(faces[s]);
    mesh::for_shape(mesh_->shape, [&](auto shape) {
      using Nodes = Slot<mesh::n_nodes(shape()), mesh::dimension(shape())>;
      using Bubble = Slot<1, mesh::dimension(shape())>;
      for (const auto& part : assembly::divergence(*mesh_, displacements, biot))
        if (part.loop == Loop::fracture_sides)
          add<Push<Bubble>>(true, context, part.loop, {context.field(part.field)}, part.volume, part.cells);
        else
          add<Push<Nodes>>(true, context, part.loop, {context.field(part.field)}, part.volume, part.cells);
      if (fractures_)
        add<Push<Nodes, Bubble>>(false, context, Loop::fracture_sides,
                                 {context.field("displacement"), context.field("side bubble")},
                                 assembly::side_volumes(*mesh_), faces);
      if (tips_)
        add<Push<Nodes>>(false, context, Loop::tip_sides, {context.field("tip displacement")},
                         assembly::tip_side_volumes(*mesh_), faces_of_tips);
    });
    set(std::vector<Real>(mesh_->n_cells(), 0), std::vector<Real>(mesh_->n_fracture_faces(), 0));
  }

  std::string fingerprint() const override { return fmt::format("{}", initial()); }
  Real initial() const override { return parameters_.initial; }

  void set(const std::vector<Real>& rock, const std::vector<Real>& fractures) override {
    largest_ = 0;
    for (const auto* all : {&rock, &fractures})
      for (const Real p : *all) largest_ = std::max(largest_, std::abs(p));
    auto bearing = fractures;
    for (std::size_t f = 0; f < bearing.size(); ++f) bearing[f] *= parameters_.of_fillings[f];
    const auto in_rock = assembly::to_device(rock, "pressure"), in_fractures = assembly::to_device(bearing, "pressure");
    for (const auto& part : parts_) part->set(part->is_of_rock ? in_rock : in_fractures);
  }

  void residual(const assembly::State& state, const assembly::Rows& r) const override {
    for (const auto& part : parts_) part->add_residual(state, r);
  }
  void jacobian(const assembly::State&, fields::BlockMatrix&) const override {}
  bool constant_load() const override { return false; }
  assembly::Scales loads(Real) const override { return {{"stress", largest_}}; }

 private:
  /// Computes V_K of owned cells, or W_f of owned fracture faces.
  std::vector<Real> volumes(const assembly::State& state, bool of_rock) const {
    const View<Real*> sums("volumes", of_rock ? mesh_->n_cells() : mesh_->n_fracture_faces());
    for (const auto& part : parts_)
      if (part->is_of_rock == of_rock) part->add_volumes(state, sums);
    const auto host = base::to_host(sums);
    return {host.data(), host.data() + (of_rock ? mesh_->n_owned_cells : mesh_->n_owned_fracture_faces)};
  }

  template <class Op>
  void add(bool is_of_rock, const assembly::Context& context, Loop loop, const std::vector<int>& fields,
           const View<Real**>& volume, const std::vector<LocalIndex>& of) {
    parts_.push_back(std::make_unique<PartOf<Op>>(is_of_rock, context, loop, fields, volume, of));
  }

  GivenPressureParameters parameters_;
  bool fractures_, tips_;  // the mesh has fractures; enriched tips
  RCP<const mesh::Mesh> mesh_;
  Real largest_ = 0;  // largest pressure on this rank, Pa
  std::vector<std::unique_ptr<Part>> parts_;
};

}  // namespace

std::unique_ptr<GivenPressure> make_given_pressure(const mesh::Mesh& mesh, GivenPressureParameters parameters) {
  return std::make_unique<Given>(mesh, std::move(parameters));
}

void set_fluid_pressure(assembly::System& system, const std::vector<Real>& rock, const std::vector<Real>& fractures) {
  const auto& mesh = system.mesh();
  GivenPressure* given = nullptr;
  for (const auto& module : system.modules())
    if (auto* found = dynamic_cast<GivenPressure*>(module.module.get())) given = found;
  SPREKK_CHECK(given, "the pressure of a fluid is set, but the scene has no host_fluid whose pressure is given");
  base::collectively(*mesh.comm, [&] {
    const std::size_t n_cells = mesh.n_owned_cells, n_faces = mesh.n_owned_fracture_faces;
    SPREKK_CHECK(rock.size() == n_cells && fractures.size() == n_faces,
                 "pressures of {} cells and {} fracture faces are given, a rank has {} and {}", rock.size(),
                 fractures.size(), n_cells, n_faces);
    for (const auto* values : {&rock, &fractures})
      for (const Real p : *values) SPREKK_CHECK(std::isfinite(p), "a given pressure is {}", p);
  });
  const auto above = [&](std::vector<Real> values, fields::Entity entity) {
    for (Real& p : values) p -= given->initial();
    return with_ghosts(mesh, entity, values);
  };
  given->set(above(rock, fields::Entity::cell), above(fractures, fields::Entity::fracture_face));
}

}  // namespace sprekk::physics
