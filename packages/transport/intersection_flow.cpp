#include "transport/intersection_flow.hpp"

#include "assembly/assembler.hpp"
#include "base/host_table.hpp"
#include "base/over_ranks.hpp"
#include "mesh/exchange.hpp"
#include "mesh/intersections.hpp"
#include "transport/advected_flow.hpp"

#include <algorithm>
#include <string>
#include <utility>

namespace sprekk::transport {

namespace {

using mesh::operator-;

/// Flow between two edges at a point. Unknowns: their pressures.
using EdgeFlow = StoredFlow<1, assembly::Slots<assembly::Slot<2, 1>>>;

/// EdgeFlow of a fluid that depends on a field u. Unknowns: pressures of both edges, u of both edges.
struct ChangedEdgeFlow {
  static constexpr int n_ends = 1;
  using Columns = assembly::Slots<assembly::Slot<2, 1>, assembly::Slot<2, 1>>;
  using Rows = EdgeFlow::Rows;
  ChangedFlow<EdgeFlow> of_mean;

  KOKKOS_INLINE_FUNCTION void flow(int e, const Real (&x)[4], Real (&q)[1]) const {
    const Real y[3] = {x[0], x[1], (x[2] + x[3]) / 2};
    of_mean.flow(e, y, q);
  }
  KOKKOS_INLINE_FUNCTION void dflow(int e, const Real (&x)[4], Real (&dq)[1][4]) const {
    const Real y[3] = {x[0], x[1], (x[2] + x[3]) / 2};
    Real by_y[1][3];
    of_mean.dflow(e, y, by_y);
    for (int k = 0; k < 2; ++k) {
      dq[0][k] = by_y[0][k];
      dq[0][2 + k] = by_y[0][2] / 2;
    }
  }
  KOKKOS_INLINE_FUNCTION void residual(int e, const Real (&x)[4], Real (&r)[2]) const {
    Real q[1];
    flow(e, x, q);
    balance(q, r);
  }
  KOKKOS_INLINE_FUNCTION void jacobian(int e, const Real (&x)[4], Real (&J)[2][4]) const {
    Real dq[1][4];
    dflow(e, x, dq);
    balance(dq, J);
  }
};

/// Module of an operator on the pairs of Loop::junctions, with the rows of one field on facets.
template <class Op>
class BetweenEdges : public assembly::Module {
 public:
  struct Description {
    std::string name, row;
    std::vector<std::string> columns;
    bool linear, carries;
  };
  BetweenEdges(Description description, Op op) : description_(std::move(description)), op_(std::move(op)) {}

  std::string name() const override { return description_.name; }
  assembly::Declaration declare(const mesh::Mesh&) const override {
    assembly::Declaration d;
    d.couplings = {{assembly::Loop::junctions, description_.row, description_.columns}};
    if (description_.carries) d.carries = {description_.row};
    d.linear = description_.linear;
    return d;
  }
  void bind(const assembly::Context& context) override {
    std::vector<int> columns;
    for (const auto& name : description_.columns) columns.push_back(context.field(name));
    using Positions = typename assembly::Assembler<Op>::Positions;
    assembler_ = std::make_unique<assembly::Assembler<Op>>(context, assembly::Loop::junctions,
                                                           std::vector{context.field(description_.row)}, columns,
                                                           description_.linear ? Positions::once : Positions::keep);
  }
  void residual(const assembly::State& state, const assembly::Rows& r) const override {
    assembler_->add_residual(op_, state, r);
  }
  void jacobian(const assembly::State& state, fields::BlockMatrix& J) const override {
    assembler_->add_jacobian(op_, state, J);
  }
  bool symmetric(const assembly::State&) const override { return description_.linear; }

 protected:
  Description description_;
  Op op_;
  std::unique_ptr<assembly::Assembler<Op>> assembler_;
};

/// Flow between edges, with the flow along them as output.
template <class Op>
class FlowBetweenEdges final : public BetweenEdges<Op> {
 public:
  using BetweenEdges<Op>::BetweenEdges;

  assembly::Declaration declare(const mesh::Mesh& mesh) const override {
    auto d = BetweenEdges<Op>::declare(mesh);
    d.outputs = {{{"channel flow", "m^3/s", fields::Entity::facet, 3},
                  [this](const assembly::State& state) { return along_edges(state); }}};
    return d;
  }
  void bind(const assembly::Context& context) override {
    BetweenEdges<Op>::bind(context);
    n_owned_ = context.mesh()->facets->n_owned;
    for (const auto& edges : mesh::junctions(*context.mesh()))
      mesh::for_each_pair(edges, [&](const auto& a, const auto& b) {
        ends_.push_back({End{a.facet, half_unit(a.to_point)}, End{b.facet, half_unit(b.to_point)}});
      });
  }

  /// Returns the flow along owned edges, [facet, direction].
  std::vector<Real> along_edges(const assembly::State& state) const {
    const View<Real*> flows("flows", ends_.size());
    const auto op = this->op_;
    this->assembler_->for_each(
        op, state, KOKKOS_LAMBDA(int e, const Real(&x)[Op::Columns::size]) {
          Real q[1];
          op.flow(e, x, q);
          flows(e) = q[0];
        });
    const auto q = base::to_host(flows);
    std::vector<Real> values(3 * static_cast<std::size_t>(n_owned_), 0);
    for (std::size_t e = 0; e < ends_.size(); ++e)
      for (const int k : {0, 1})
        if (const auto& end = ends_[e][k]; end.facet < n_owned_)
          for (int c = 0; c < 3; ++c) values[3 * end.facet + c] += (k == 0 ? q(e) : -q(e)) * end.half[c];
    return values;
  }

 private:
  struct End {
    LocalIndex facet;
    mesh::Vector half;  // unit vector from the edge to its end, divided by 2
  };

  static mesh::Vector half_unit(const mesh::Vector& along) { return (0.5 / mesh::norm(along)) * along; }

  std::vector<std::array<End, 2>> ends_;  // [pair]
  LocalIndex n_owned_ = 0;
};

/// Returns whether a channel is in an intersection of these fractures.
bool passes(const Channel& channel, const std::vector<int>& fractures) {
  return std::includes(fractures.begin(), fractures.end(), channel.fractures.begin(), channel.fractures.end());
}

/// [facet] 1: border of a fracture with a prescribed pressure. Collective.
std::vector<int> constrained_borders(const mesh::Mesh& mesh,
                                     const std::vector<assembly::DirichletCondition>& conditions) {
  std::vector<int> constrained(mesh.facets->id.size(), 0);
  for (const auto& rim : mesh.facets->rims)
    for (const auto& condition : conditions)
      if (condition.boundary == rim.boundary && condition.region < 0 &&
          (condition.fracture < 0 || condition.fracture == mesh.fracture_faces[rim.face].fracture))
        constrained[mesh.facets->ridge[rim.face * mesh::n_face_corners(mesh.shape) + rim.ridge]] = 1;
  mesh::GhostExchange(mesh.facets->id, mesh.facets->n_owned,
                      mesh.comm)(constrained);  // owners have all cells at their ridges
  return constrained;
}

/// Conductances of the edges at one point.
class Point {
 public:
  Point(const std::vector<mesh::EdgeAtPoint>& edges, const std::vector<Channel>& channels,
        const std::vector<int>& constrained)
      : channels_(channels), constrained_(constrained) {
    for (const auto& edge : edges) {
      if (is_open(edge))
        ++n_open_;
      else
        sum_ += to_point(edge);
    }
  }

  /// T between two edges, m^3/(Pa s).
  Real between(const mesh::EdgeAtPoint& a, const mesh::EdgeAtPoint& b) const {
    if (n_open_ == 0) return sum_ > 0 ? to_point(a) * to_point(b) / sum_ : 0;
    if (is_open(a) == is_open(b)) return 0;
    return to_point(is_open(a) ? b : a) / n_open_;
  }

 private:
  bool is_open(const mesh::EdgeAtPoint& edge) const { return !edge.is_intersection() && constrained_[edge.facet] == 1; }
  /// t between the middle of an edge and the point.
  Real to_point(const mesh::EdgeAtPoint& edge) const {
    Real C = 0;
    for (const auto& channel : channels_)
      if (edge.is_intersection() && passes(channel, edge.fractures)) C += channel.conductance;
    return C / mesh::norm(edge.to_point);
  }

  const std::vector<Channel>& channels_;
  const std::vector<int>& constrained_;
  int n_open_ = 0;  // borders with a prescribed pressure
  Real sum_ = 0;    // of t
};

/// Flows of the pairs of edges of Loop::junctions. Collective.
EdgeFlow edge_flow(const mesh::Mesh& mesh, const IntersectionFlowParameters& parameters) {
  const auto constrained = constrained_borders(mesh, parameters.constrained);
  std::vector<std::array<Real, 2>> pairs;  // T, lift
  for (const auto& edges : mesh::junctions(mesh)) {
    const Point point(edges, parameters.channels, constrained);
    mesh::for_each_pair(edges, [&](const auto& a, const auto& b) {
      pairs.push_back({point.between(a, b), mesh::dot(parameters.weight, a.to_point - b.to_point)});
    });
  }
  const base::HostTable<Real**> T("T", pairs.size(), 1), lift("lift", pairs.size(), 1);
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    T(k, 0) = pairs[k][0];
    lift(k, 0) = pairs[k][1];
  }
  return {.T = T.on_device(), .lift = lift.on_device(), .fluid = parameters.fluid};
}

/// Fields on which the flow depends, in the order of its unknowns.
std::vector<std::string> drivers(const IntersectionFlowParameters& parameters) {
  std::vector<std::string> fields = {"face pressure"};
  if (parameters.change) fields.push_back("face " + parameters.change->field);
  return fields;
}

/// Returns make(flow) for the flow of a constant or a changing fluid. Collective.
template <class Make>
auto with_fluid(const mesh::Mesh& mesh, const IntersectionFlowParameters& parameters, const Make& make) {
  const auto flow = edge_flow(mesh, parameters);
  return parameters.change ? make(ChangedEdgeFlow{{flow, parameters.change->response}}) : make(flow);
}

}  // namespace

Real length_of(const Channel& channel, const mesh::Mesh& mesh) {
  Real length = 0;
  for (const auto& edge : mesh::intersection_edges(mesh))
    if (passes(channel, edge.fractures)) length += mesh::ridge_length(mesh, edge.face, edge.ridge);
  return base::sum_over_ranks(*mesh.comm, length);
}

std::vector<EdgeCapacity> stored_in(const std::vector<Channel>& channels, const Capacity& of_fluid,
                                    const mesh::Mesh& mesh) {
  std::vector<EdgeCapacity> all;
  for (const auto& edge : mesh::intersection_edges(mesh)) {
    Real area = 0;
    for (const auto& channel : channels)
      if (passes(channel, edge.fractures)) area += channel.area;
    if (area > 0)
      all.push_back({.facet = edge.facet,
                     .length = mesh::ridge_length(mesh, edge.face, edge.ridge),
                     .capacity = {.room = area * of_fluid.room, .growth = area * of_fluid.growth},
                     .centre = mesh::ridge_centre(mesh, edge.face, edge.ridge)});
  }
  return all;
}

std::unique_ptr<assembly::Module> make_intersection_flow(const mesh::Mesh& mesh,
                                                         const IntersectionFlowParameters& parameters) {
  return with_fluid(mesh, parameters, [&]<class Op>(const Op& op) -> std::unique_ptr<assembly::Module> {
    const bool linear = parameters.fluid.compressibility == 0 && !parameters.change;
    return std::make_unique<FlowBetweenEdges<Op>>(
        typename BetweenEdges<Op>::Description{"intersection flow", "face pressure", drivers(parameters), linear,
                                               false},
        op);
  });
}

std::unique_ptr<assembly::Module> make_intersection_advection(const mesh::Mesh& mesh,
                                                              const IntersectionFlowParameters& parameters,
                                                              const Carried& carried) {
  return with_fluid(mesh, parameters, [&]<class Flow>(const Flow& flow) -> std::unique_ptr<assembly::Module> {
    using Op = Advection<Flow, EdgeFlow::Columns>;
    const std::string row = "face " + carried.field;
    auto columns = drivers(parameters);
    columns.push_back(row);
    return std::make_unique<BetweenEdges<Op>>(
        typename BetweenEdges<Op>::Description{"advection of " + carried.field + " along intersections", row, columns,
                                               false, true},
        Op{flow, carried.capacity});
  });
}

}  // namespace sprekk::transport
