#include "physics/mechanics/mechanics.hpp"

#include "base/entry_of_place.hpp"
#include "base/names.hpp"
#include "base/over_ranks.hpp"
#include "laws/joint_start.hpp"
#include "mesh/extents.hpp"
#include "mesh/tips.hpp"
#include "physics/mechanics/mechanics_error.hpp"
#include "physics/mechanics/modules.hpp"
#include "physics/mechanics/release.hpp"
#include "physics/mechanics/solid_pressure.hpp"
#include "physics/mechanics/unbroken.hpp"
#include "physics/mechanics/uniqueness.hpp"
#include "physics/poroelasticity/poroelasticity.hpp"
#include "physics/scene.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sprekk::physics {

namespace {

/// Mean over a fracture face. The cell on side minus must be local.
Real mean(const mesh::Mesh& mesh, const mesh::Mesh::FractureFace& face, const base::Expression& value) {
  return assembly::face_mean(mesh, face.cell[mesh::minus], face.local_face[mesh::minus],
                             [&](const auto&, const auto& x) { return value(x, 0); });
}

/// Unloaded joint of a face, from the aperture under its initial traction. A changed scene may describe a joint that
/// could not have been in the initial state.
laws::JointParameters unloaded(const Scene& scene, const mesh::Mesh& mesh, const Material& material,
                               const laws::JointParameters& measured, const mesh::Mesh::FractureFace& face,
                               const std::array<Real, 3>& traction) {
  try {
    const auto joint = laws::unloaded(measured, traction, mesh.dim());
    if (scene.is_continued) return joint;
    laws::check_start(joint, laws::start_of(joint, traction, mesh.dim()), traction);
    if (!has_fluid(scene)) return joint;
    const Real hydraulic = material.walls(face.centre).hydraulic(measured.initial_aperture);
    SPREKK_CHECK(hydraulic >= (1 - 1e-12) * measured.min_aperture,
                 "\"initial aperture\": the hydraulic aperture in situ is {:.6g} m; it must be at least the \"residual "
                 "aperture\", {:.6g} m",
                 hydraulic, measured.min_aperture);
    return joint;
  } catch (const Error& error) {
    throw Error(fmt::format("fracture \"{}\" at ({:.6g}, {:.6g}, {:.6g}): {}", mesh.single_fractures[face.single].name,
                            face.centre[0], face.centre[1], face.centre[2], error.what()));
  }
}

/// Joint parameters of faces: the law at the face centre, with the face means of the gap and of the initial plastic
/// jump, since jumps are means too. `tractions`: of owned faces, for joints in situ.
fields::Properties<laws::JointParameters> joints(const Scene& scene, const mesh::Mesh& mesh,
                                                 const std::vector<std::array<Real, 3>>& tractions) {
  const bool own = !scene.own_joints.empty();  // groups: single fractures or fracture sets
  const auto section = [&](int group) -> const Fracture& {
    return scene.fractures.at(mesh.fracture_names[own ? mesh.single_fractures[group].set : group]);
  };
  const auto material = [&](int group) -> const Material& {
    return own ? joint_of(scene, mesh, group) : scene.materials.at(section(group).material);
  };
  const auto rock = elasticity(scene, mesh);
  std::vector<int> group_of;
  for (LocalIndex f = 0; f < mesh.n_owned_fracture_faces; ++f)
    group_of.push_back(own ? mesh.fracture_faces[f].single : mesh.fracture_faces[f].fracture);
  auto result = fields::properties<laws::JointParameters>(
      static_cast<int>(own ? mesh.single_fractures.size() : mesh.fracture_names.size()), group_of,
      [&](int fracture) {
        const auto& jump = section(fracture).plastic_jump;
        return material(fracture).is_uniform() && !material(fracture).is_in_situ() &&
               material(fracture).bond != laws::SharpFrontBond::name &&
               material(fracture).residual_aperture.is_constant() && !section(fracture).unbroken &&
               std::all_of(jump.begin(), jump.end(), [](const auto& value) { return value.is_constant(); });
      },
      [&](int fracture, int f) {
        const auto& jump = section(fracture).plastic_jump;
        auto joint = at_place(scene, material(fracture), [&] {
          const auto x = f < 0 ? std::array<Real, 3>{} : mesh.fracture_faces[f].centre;
          auto joint = material(fracture).joint(x);
          if (has_fluid(scene)) joint.min_aperture = material(fracture).residual_aperture(x, 0);
          return joint;
        });
        for (std::size_t k = 0; k < jump.size(); ++k)
          joint.plastic_jump[k] = f < 0 ? jump[k]({}, 0) : mean(mesh, mesh.fracture_faces[f], jump[k]);
        if (f < 0) return joint;
        const auto& face = mesh.fracture_faces[f];
        if (const auto& gap = material(fracture).initial_gap; !gap.is_constant())
          joint.law.gap.initial = mean(mesh, face, gap);
        joint.law.bond = bond_of(joint.law.bond, mesh, face, rock);
        if (section(fracture).unbroken) set_bond(joint, is_unbroken(scene, mesh, face));
        if (!joint.in_situ) return joint;
        if (const auto& path = section(fracture).slip_path) joint.slip_path = mean(mesh, face, *path);
        return at_place(scene, material(fracture),
                        [&] { return unloaded(scene, mesh, material(fracture), joint, face, tractions[f]); });
      });
  if (own && result.number.empty()) result.number = group_of;
  return result;
}

/// Prescribed fluid pressure in fractures; with flow, the initial pressure.
FluidPressure fluid_pressure(const Scene& scene, const mesh::Mesh& mesh) {
  FluidPressure fluid{{}, filling_biot(scene, mesh)};
  if (has_fluid(scene)) {
    if (!is_zero(initial_pressure(scene)) || has_unknown_pressure(scene))
      fluid.value.assign(mesh.fracture_names.size(), initial_pressure(scene));
    return fluid;
  }
  bool any = false;
  for (const auto& name : mesh.fracture_names) {
    const auto& p = fluid.value.emplace_back(scene.fractures.at(name).fluid_pressure);
    any = any || !is_zero(p);
  }
  return any ? fluid : FluidPressure();
}

PrescribedSlips prescribed_slips(const Scene& scene, const std::vector<std::string>& fracture_names) {
  PrescribedSlips slips;
  for (const auto& name : fracture_names)
    if (const auto& slip = scene.fractures.at(name).prescribed_slip; slip && !slip->slip.empty()) slips[name] = *slip;
  return slips;
}

/// Field that receives the power of friction; empty: none.
std::string power_to(const Scene& scene) {
  std::string field;
  for_each_physics([&]<HasTransport P>(P) {
    if (auto one = P::Transport::friction_power(scene); !one.empty()) field = std::move(one);
  });
  return field;
}

/// Applies VolumetricSplit to all cells. Returns the remaining moduli.
fields::Properties<Real> split(fields::Properties<laws::Elasticity>& elasticity, int order) {
  fields::Properties<Real> modulus{{}, elasticity.number};
  for (auto& law : elasticity.values) {
    const VolumetricSplit split(law, order);
    law = split.elasticity;
    modulus.values.push_back(split.modulus);
  }
  return modulus;
}

MechanicsParameters parameters_of(const Setting& setting) {
  const auto& [scene, mesh, start] = setting;
  BulkMomentumParameters bulk{.elasticity = elasticity(scene, mesh),
                              .body_force = body_force(scene, mesh),
                              .initial_stress = initial_stress(scene, mesh),
                              .keeps_stress = scene.keeps_stress};
  const int order = mesh::order(mesh.shape);
  const auto modulus = has_solid_pressure(scene, order) ? split(bulk.elasticity, order) : fields::Properties<Real>();
  for (const auto& [name, condition] : scene.boundary_conditions)
    if (condition.is_loaded())
      bulk.tractions.push_back(
          {.boundary = base::index_of(mesh.boundary_names, condition.boundary),
           .value = condition.traction,
           .pressure = condition.confining_pressure,
           .region = condition.region ? base::index_of(mesh.region_names, *condition.region) : -1});
  std::map<std::string, ElasticFoundationParameters> foundations;
  for (const auto& [name, condition] : scene.boundary_conditions)
    if (const auto& k = condition.foundation_stiffness; !k.empty())
      foundations[name] = {.boundary = base::index_of(mesh.boundary_names, condition.boundary),
                           .stiffness = {k[0], k[k.size() / 2], k.back()},
                           .region = condition.region ? base::index_of(mesh.region_names, *condition.region) : -1,
                           .along_normal = k.size() == 1};
  if (mesh.fracture_names.empty()) return {.bulk = bulk, .foundations = foundations, .solid_modulus = modulus};
  const auto fluid = fluid_pressure(scene, mesh);
  const auto tractions = initial_tractions(mesh, bulk.initial_stress, fluid, start);
  const bool unknown = has_unknown_pressure(scene);
  return {.bulk = bulk,
          .foundations = foundations,
          .solid_modulus = modulus,
          .joints = joints(scene, mesh, tractions),
          .fluid_pressure = unknown ? FluidPressure() : fluid,
          .initial_pressure = unknown ? fluid : FluidPressure(),
          .start = start,
          .prescribed_slips = prescribed_slips(scene, mesh.fracture_names),
          .augmentation = scene.augmentation,
          .power_to = power_to(scene)};
}

std::vector<base::Expression> lithostatic_stress(const Scene& scene) {
  const auto& [surface, horizontal_ratio] = *scene.bulk.lithostatic_stress;
  const auto& gravity = scene.bulk.gravity;
  const int dim = static_cast<int>(gravity.size()), up = dim - 1;
  const Real weight = -(*scene.material_of("bulk").density)({0, 0, 0}, 0) * gravity[up];  // positive
  std::vector<base::Expression> stress(dim == 2 ? 4 : 6, base::Expression(0));
  for (int i = 0; i < 3; ++i) {
    const Real factor = weight * (i == up ? 1 : horizontal_ratio);
    stress[i] = base::Expression(fmt::format("{:.17g}*({}-({:.17g}))", factor, "xyz"[up], surface));
  }
  for (auto& component : stress) component.compile();
  return stress;
}

/// Returns whether fractures end inside of the rock; false if unknown (plain tips with periodic sides). Collective.
bool has_tips(const mesh::Mesh& mesh) {
  const auto has = [](const std::vector<char>& tips) { return std::find(tips.begin(), tips.end(), 1) != tips.end(); };
  if (base::any_rank(*mesh.comm, [&] { return has(mesh.tip); })) return true;
  if (base::any_rank(*mesh.comm, [&] { return !mesh.tied_to.empty(); })) return false;
  const auto tips = mesh::tip_nodes(mesh);
  return base::any_rank(*mesh.comm, [&] { return has(tips); });
}

}  // namespace

BodyForce body_force(const Scene& scene, const mesh::Mesh& mesh) {
  BodyForce force{scene.bulk.body_force, scene.bulk.gravity, {}};
  if (force.gravity.empty()) return force;
  const auto density = by_cell(
      scene, mesh, [](const Material& rock) { return rock.density->is_constant(); },
      [](const Material& rock, const auto& x) { return rock.density_at(x); });
  for (LocalIndex cell = 0; cell < mesh.n_cells(); ++cell) force.density_of_cell.push_back(density.of_cell(mesh, cell));
  return force;
}

bool has_solid_pressure(const Scene& scene, int order) {
  bool alone = true;
  for_each_physics([&](auto physics) {
    if constexpr (!std::is_same_v<decltype(physics), Mechanics>)
      alone = alone && physics.needs_facets(scene) == Facets::none;
  });
  const auto needs = [&](const std::string& name) {
    const auto rock = scene.materials.find(name);
    if (rock == scene.materials.end() || !rock->second.has_elasticity() || !rock->second.is_uniformly_elastic())
      return false;
    try {
      return VolumetricSplit(rock->second.elasticity({}), order).modulus > 0;
    } catch (const Error&) {  // reported when materials are checked
      return false;
    }
  };
  return alone && (needs(scene.bulk.material) ||
                   std::any_of(scene.regions.begin(), scene.regions.end(), [&](const auto& region) {
                     return region.second.material && needs(*region.second.material);
                   }));
}

Real usual_augmentation() { return ElasticPlasticJumpParameters().augmentation; }

bool Mechanics::is_in(const Scene& scene) { return !scene.bulk.rigid && !(scene.flow && scene.flow->rigid_rock); }

Facets Mechanics::needs_facets(const Scene& scene) {
  return is_in(scene) && has_solid_pressure(scene) ? Facets::all : Facets::none;
}

fields::Properties<laws::Elasticity> elasticity(const Scene& scene, const mesh::Mesh& mesh) {
  return by_cell(
      scene, mesh, [](const Material& rock) { return rock.is_uniformly_elastic(); },
      [](const Material& rock, const auto& x) { return rock.elasticity(x); });
}

Real largest_modulus(const Scene& scene, const mesh::Mesh& mesh) {
  Real here = 0;
  for (LocalIndex cell = 0; cell < mesh.n_owned_cells; ++cell) {
    const auto& material = scene.material_of(mesh.region_names[mesh.cell_region[cell]]);
    if (cell > 0 && material.is_uniformly_elastic() && mesh.cell_region[cell] == mesh.cell_region[cell - 1]) continue;
    here = std::max(here, material.elasticity(mesh::cell_centre(mesh, cell)).youngs_modulus());
  }
  return base::max_over_ranks(*mesh.comm, here);
}

std::vector<base::Expression> PrincipalStress::stress(int dim) const {
  const char up = "xyz"[dim - 1];
  const Real s = std::sin(azimuth * M_PI / 180), c = std::cos(azimuth * M_PI / 180);
  /// Returns -(a largest + b smallest + v vertical) as an expression.
  const auto sum = [&](Real a, Real b, Real v) {
    const Real value = a * largest.value + b * smallest.value + v * vertical.value,
               gradient = a * largest.gradient + b * smallest.gradient + v * vertical.gradient;
    base::Expression component(fmt::format("-({:.17g}) - ({:.17g})*({:.17g} - {})", value, gradient, datum, up));
    component.compile();
    return component;
  };
  const auto east = sum(s * s, c * c, 0), north = sum(c * c, s * s, 0), along_up = sum(0, 0, 1);
  if (dim == 2) return {east, along_up, north, base::Expression(0)};
  return {east, north, along_up, sum(s * c, -s * c, 0), base::Expression(0), base::Expression(0)};
}

InitialStress initial_stress(const Scene& scene, const mesh::Mesh& mesh) {
  const auto& bulk = scene.bulk;
  const auto common = bulk.lithostatic_stress ? lithostatic_stress(scene)
                      : bulk.in_situ_stress   ? bulk.in_situ_stress->stress(mesh.dim())
                                              : bulk.initial_stress;
  InitialStress stress;
  std::size_t n_components = 0;
  for (const auto& name : mesh.region_names) {
    const auto region = scene.regions.find(name);
    const bool own = region != scene.regions.end() && !region->second.initial_stress.empty();
    n_components =
        std::max(n_components, stress.value.emplace_back(own ? region->second.initial_stress : common).size());
  }
  if (n_components == 0) return {};
  for (auto& components : stress.value) components.resize(n_components, base::Expression(0));
  for (const auto& name : mesh.fracture_names) stress.of_fracture.push_back(scene.fractures.at(name).initial_traction);
  return stress;
}

std::vector<StartOfFace> starts_of_faces(const Setting& setting) {
  std::vector<StartOfFace> starts;
  const auto& mesh = setting.mesh;
  base::collectively(*mesh.comm, [&] {
    const auto parameters = jump_parameters(mesh, parameters_of(setting));
    const auto rock = elasticity(setting.scene, mesh);
    const auto tractions =
        initial_tractions(mesh, parameters.initial_stress, parameters.fluid_pressure, parameters.start);
    for (LocalIndex f = 0; f < mesh.n_owned_fracture_faces; ++f) {
      const auto& joint = parameters.joints.of_face(mesh, f);
      const auto start = laws::start_of(joint, tractions[f], mesh.dim());
      const auto& face = mesh.fracture_faces[f];
      const auto& of_face = rock.of_cell(mesh, face.cell[mesh::minus]);
      starts.push_back({.traction = tractions[f],
                        .bound = start.bound,
                        .depends_on_rate = joint.law.depends_on_rate(),
                        .unloaded_aperture = joint.initial_aperture,
                        .opening = parameters.initial_stress.empty() ? 0 : start.jump[0],
                        .least_opening = laws::least_opening(joint.law),
                        .overlap = std::numeric_limits<Real>::infinity(),
                        .smaller_aperture = 0,
                        .cohesive_zone = laws::cohesive_zone(joint.law, of_face, -tractions[f][0], mesh.dim()),
                        .compliance = 1 / (1 / laws::normal_compliance(joint.law, start) +
                                           of_face.plane_strain_modulus() / (4 * mesh::length_of(mesh, face)))});
      if (!joint.in_situ) continue;
      starts.back().overlap = laws::overlap_compression(joint, start);
      starts.back().smaller_aperture = laws::smaller_aperture(joint, start);
    }
  });
  return starts;
}

void Mechanics::add_modules(const Setting& setting, Modules& modules) {
  if (!is_in(setting.scene)) return;
  MechanicsParameters parameters;
  base::collectively(*setting.mesh.comm, [&] { parameters = parameters_of(setting); });
  for (auto& module : make_mechanics(setting.mesh, parameters)) modules.push_back(std::move(module));
  if (const auto& release = setting.scene.bulk.release; !release.empty())
    modules.push_back(make_release(release[0], release[1]));
}

std::vector<std::string> Mechanics::warnings(const Setting& setting) {
  const auto& mesh = setting.mesh;
  if (!is_in(setting.scene)) return {};
  auto all = process_zone_warnings(setting);
  if (auto one = notch_doubt(setting.scene); !one.empty()) all.push_back(std::move(one));
  if (mesh.dim() == 3 && mesh::order(mesh.shape) == 1 && has_tips(mesh))
    all.push_back(fmt::format(
        "{}: fractures end inside of the rock: in 3D their slip and opening are too small with "
        "cells of \"order\" 1; 2 is more accurate, also with the same number of unknowns. The fewer faces a "
        "fracture has, the larger is the difference",
        setting.scene.origin));
  return all;
}

std::vector<std::string> Mechanics::Warnings::of_state(const Setting& setting, const std::vector<Real>&,
                                                       const std::vector<assembly::OutputField>& outputs) {
  const auto& [scene, mesh, start] = setting;
  if (!is_in(scene)) return {};
  std::vector<int> ran(mesh.fracture_names.size());
  for (const auto& output : outputs)
    for (LocalIndex f = 0; output.name == "runaway slip" && f < mesh.n_owned_fracture_faces; ++f)
      if (output.values[f] > 0) ran[mesh.fracture_faces[f].fracture] = 1;
  ran = base::max_over_ranks(*mesh.comm, ran);
  std::vector<std::string> warnings;
  for (std::size_t k = 0; k < ran.size(); ++k)
    if (ran[k])
      warnings.push_back(
          fmt::format("{}: unstable slip on \"{}\": the friction bound decreased faster with slip than rock and joint "
                      "unload. The state satisfies the law, states in between may do so, too; \"max_runaway_slip\" in "
                      "results.json is the largest such slip",
                      scene.origin, mesh.fracture_names[k]));
  return warnings;
}

std::vector<LogColumn> Mechanics::Log::columns(const Setting& setting) {
  if (!is_in(setting.scene) || setting.mesh.fracture_names.empty()) return {};
  return {{"slip [m]", "fractures", "max_slip"}};
}

EventSource Mechanics::Events::source() {
  return {.path = "plastic jump local",
          .force = "traction local",
          .density = "moment density",
          .drop = "stress_drop",
          .drop_unit = "Pa"};
}

std::string Mechanics::Estimate::missing(const Scene& scene) {
  if (!is_in(scene)) return "";
  const auto& conditions = scene.boundary_conditions;
  if (std::any_of(conditions.begin(), conditions.end(),
                  [](const auto& condition) { return !condition.second.foundation_stiffness.empty(); }))
    return "requires boundaries with given tractions or displacements; not available with \"foundation stiffness\"";
  if (scene.keeps_stress) return "is not available after changes of elastic constants or a backfill";
  return has_solid_pressure(scene) ? "is not available in nearly incompressible rock" : "";
}

std::vector<estimate::QuantityKind> Mechanics::Estimate::quantities() {
  return {{"slip", "m", "m", "mean plastic slip over the area of fractures"},
          {"opening", "m", "m", "mean normal jump over the area of fractures"},
          {"normal force", "N", "N/m", "integral of compression over fractures"},
          {"shear force", "N", "N/m", "integral of the magnitude of shear traction over fractures"},
          {.name = "reaction",
           .unit = "N",
           .unit_in_2d = "N/m",
           .text = "force on a boundary with prescribed displacements",
           .has_component = true},
          {.name = "stress",
           .unit = "sqrt(J)",
           .unit_in_2d = "sqrt(J/m)",
           .text = "square root of the integral of s : C^-1 s, twice the elastic energy",
           .is_norm = true}};
}

std::unique_ptr<estimate::MeshError> Mechanics::Estimate::mesh_error(const Setting& setting, assembly::System& system) {
  return is_in(setting.scene) ? make_mechanics_error(setting, system) : nullptr;
}

std::string Mechanics::Estimate::refuses(const Scene& scene, const estimate::Functional& J) {
  if (!J.well.empty()) return fmt::format("\"well\": must be absent: \"{}\" takes none", J.what);
  const bool of_boundary = J.what == "reaction", of_all = of_boundary || J.what == "stress";
  if (of_all && !J.fractures.empty()) return fmt::format("\"fractures\": must be absent: \"{}\" takes none", J.what);
  if (of_boundary && J.boundary.empty()) return "\"boundary\": missing; it is required of a reaction";
  const auto& conditions = scene.boundary_conditions;
  if (of_boundary && std::none_of(conditions.begin(), conditions.end(), [&](const auto& one) {
        return one.second.boundary == J.boundary && !one.second.displacement.empty();
      }))
    return fmt::format("\"boundary\": is \"{}\", where no displacement is prescribed; it has no reaction", J.boundary);
  return of_boundary || J.boundary.empty() ? ""
                                           : fmt::format("\"boundary\": must be absent: \"{}\" takes none", J.what);
}

std::vector<std::string> Mechanics::Solvability::doubts(const Setting& setting, bool oscillates) {
  if (!is_in(setting.scene)) return {};
  const auto& [scene, mesh, start] = setting;
  std::vector<std::string> all = {friction_doubt(scene, mesh), weakening_doubt(scene, mesh), bond_doubt(scene, mesh)};
  if (oscillates)
    for (const auto& doubt : {cohesion_doubt(scene, mesh), dilation_doubt(scene, mesh)}) all.push_back(doubt);
  all.erase(std::remove(all.begin(), all.end(), ""), all.end());
  return all;
}

std::vector<const base::Expression*> varying_gaps(const Scene& scene, const mesh::Mesh& mesh) {
  std::vector<const base::Expression*> gaps;
  for (LocalIndex f = 0; f < mesh.n_owned_fracture_faces; ++f) {
    const auto& face = mesh.fracture_faces[f];
    const auto& material = scene.own_joints.empty()
                               ? scene.materials.at(scene.fractures.at(mesh.fracture_names[face.fracture]).material)
                               : joint_of(scene, mesh, face.single);
    gaps.push_back(material.initial_gap.is_constant() ? nullptr : &material.initial_gap);
  }
  return gaps;
}

}  // namespace sprekk::physics
