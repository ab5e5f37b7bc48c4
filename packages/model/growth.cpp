#include "model/growth.hpp"

#include "base/log.hpp"
#include "base/over_ranks.hpp"
#include "base/parameters.hpp"
#include "base/text.hpp"
#include "estimate/state_table.hpp"
#include "mesh/facets.hpp"
#include "mesh/fronts.hpp"
#include "model/json_keys.hpp"
#include "model/model.hpp"
#include "model/steps.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace sprekk::model {

namespace {

using Point = std::array<Real, 2>;

constexpr int max_turns = 8;
constexpr Real sliding = 2, largest_ratio = 10;  // of K_II to K_I
constexpr Real largest_turn = 0.35;              // rad
constexpr Real noise = 1.001;                    // largest rise of intensity/toughness that does not count
constexpr Real together = 0.98;                  // ratio to the largest intensity/toughness, of tips that grow together

Real distance(const Point& a, const Point& b) { return std::hypot(a[0] - b[0], a[1] - b[1]); }

/// Largest edge of the cells near new faces. Cells have right angles.
Real new_size(const Growth& growth) { return 1.45 * growth.segment / growth.faces; }

/// Angle from a - begin to a direction, rad.
Real angle_between(const Point& begin, const Point& tip, const Point& direction) {
  const Real x = tip[0] - begin[0], y = tip[1] - begin[1];
  return std::atan2(x * direction[1] - y * direction[0], x * direction[0] + y * direction[1]);
}

/// Integrals over all fracture faces, by name, and their area.
std::map<std::string, Real> integrals(Model& model) {
  const auto& mesh = model.mesh();
  std::map<std::string, Real> sums;
  const auto add = [&](const std::string& name, const auto& value) {
    Real sum = 0;
    for (LocalIndex f = 0; f < mesh.n_owned_fracture_faces; ++f) sum += mesh.fracture_faces[f].area * value(f);
    sums[name] += base::sum_over_ranks(*mesh.comm, sum);
  };
  add("area", [](LocalIndex) { return 1; });
  for (const auto& output : model.system().outputs(model.state()))
    if (output.summary.kind == assembly::Summary::integral && output.n_components == 1)
      add(with_underscores(output.summary.name), [&](LocalIndex f) { return output.values[f]; });
  return sums;
}

/// Obstacle within 1.3 faces of a tip without K: with the same rock everywhere, fractures and boundaries remain.
/// Collective.
std::string obstacle(const mesh::Mesh& mesh, const Point& tip) {
  const std::vector<char> all(mesh.fracture_names.size(), 1);
  for (const auto& front : mesh::find_fronts(mesh, all, [](LocalIndex) { return std::array<Real, 3>{}; }))
    if (front.radius == 0 && distance({front.x[0], front.x[1]}, tip) < 1e-9 * front.size) return front.nearest;
  return "another rock";
}

}  // namespace

void Growth::describe(base::Section& s) {
  s.required(segment, "segment", "m", base::positive(), "length of each extension of a fracture");
  s.entry(faces, "faces", "-", base::at_least(2), "number of faces of an extension");
  s.entry(turn, "largest angle", "degree", base::greater_than(0).to(20),
          "largest angle between an extension and the direction of growth at its new tip; extensions are turned until "
          "it is smaller");
  s.entry(largest, "extensions per step", "-", base::at_least(1),
          "maximum number of rounds of extensions in a time step; in a round, all tips at their toughness grow by a "
          "segment; a tip that would grow further causes a warning");
}

std::vector<Tips::Tip> Tips::tips_of(Model& model) const {
  std::vector<Tip> tips;
  physics::for_each_physics([&]<physics::HasTables P>(P) {
    const auto make = P::Tables::table(model.setting(), model.system());
    if (!make) return;
    const auto table = (*make)({model.state(), model.time(), model.system().outputs(model.state())});
    const auto column = [&](const std::string& name) -> const std::vector<Real>* {
      for (const auto& one : table.columns)
        if (one.name == name) return &one.values;
      return nullptr;
    };
    const auto *x = column("x"), *y = column("y"), *K = column("K_hoop"), *toughness = column("toughness"),
               *kink_x = column("kink_x"), *kink_y = column("kink_y"), *K_I = column("K_I"), *K_II = column("K_II"),
               *G = column("G"), *crossing = column("crossing");
    if (!K || !toughness || !kink_x || !kink_y) return;
    for (std::size_t k = 0; k < K->size(); ++k) {
      const Real K_c = (*toughness)[k], compliance = (*G)[k] / ((*K_I)[k] * (*K_I)[k] + (*K_II)[k] * (*K_II)[k]);
      if (!std::isnan(K_c))
        tips.push_back({{(*x)[k], (*y)[k]},
                        {(*kink_x)[k], (*kink_y)[k]},
                        (*K)[k] / K_c,
                        crossing ? (*crossing)[k] : std::nan(""),
                        table.fractures[k],
                        std::isnan(compliance) ? 0 : K_c * K_c * compliance});
    }
  });
  return tips;
}

void Tips::begin(Model& model) {
  const auto& growth = model.scene().growth;
  if (!growth) return;
  const auto& mesh = model.mesh();
  arrested_ = model.tips_without_room();
  mesh::MeshChange change;
  for (const auto& tip : tips_of(model)) {
    if (std::isnan(tip.ratio) && model.time() > model.scene().time.start) arrested_.push_back(tip.x);
    const bool is_coarse = base::any_rank(*mesh.comm, [&] {
      for (LocalIndex f = 0; f < mesh.n_owned_fracture_faces; ++f)
        for (const int k : {0, 1}) {
          const auto x = mesh::face_corner(mesh, f, k);
          if (mesh.fracture_faces[f].area > new_size(*growth) && distance({x[0], x[1]}, tip.x) < 1e-9 * growth->segment)
            return true;
        }
      return false;
    });
    if (is_coarse) change.extensions.push_back({tip.x, {0, 0}, growth->segment, new_size(*growth)});
  }
  if (!change.is_none()) model.change_mesh(change);
}

StepTaken Tips::take(Model& model, Steps& steps, base::Log& log) {
  for (;;) {
    auto taken = steps.take();
    if (!taken.report.converged || taken.report.stopped) return taken;
    const auto change = for_step(model, taken.begin, log);
    if (change.is_none()) {
      taken.extensions = extensions_;
      taken.growth = growth();
      return taken;
    }
    steps.take_back();
    apply(model, change, log);
    const auto n = change.turns.size();
    log.info("t = {:.6g}: the step to {:.6g} is repeated on a mesh of {} cells{}", taken.begin, taken.end,
             model.mesh().n_global_cells,
             n == 0 ? "" : fmt::format(", after {} of extensions", base::counted(n, "turn")));
  }
}

/// Returns the change of the mesh with which the step from `begin` is repeated; none: the step is complete.
mesh::MeshChange Tips::for_step(Model& model, Real begin, base::Log& log) {
  change_ = {};
  growing_.clear();
  turned_.clear();
  const auto& growth = model.scene().growth;
  if (!growth) return change_;
  const auto scope = model.timers().scope("growth");
  if (begin_ != begin) {
    segments_.clear();
    events_.clear();
    added_.clear();
    n_rounds_ = 0;
  }
  begin_ = begin;
  const auto tips = tips_of(model);
  turn(*growth, tips, log);
  if (change_.is_none()) {
    measure(*growth, tips);
    extend(*growth, tips);
  }
  for (const auto& tip : tips)
    if (change_.is_none() && std::isnan(tip.ratio) && may_grow(tip.x)) {
      arrested_.push_back(tip.x);
      log.warning("t = {:.6g}: the tip at ({:.6g}, {:.6g}) cannot grow: it has no K, because {} is too near",
                  model.time(), tip.x[0], tip.x[1], obstacle(model.mesh(), tip.x));
    }
  if (!change_.extensions.empty() && n_rounds_++ == growth->largest) {
    const auto& tip = change_.extensions[0].tip;
    log.warning(
        "t = {:.6g}: the tip at ({:.6g}, {:.6g}) would grow further than the \"extensions per step\": growth is "
        "unstable at this load",
        model.time(), tip[0], tip[1]);
    change_ = {};
  }
  for (const auto& one : change_.extensions)
    log.info("t = {:.6g}: the tip at ({:.6g}, {:.6g}) grows by {:.4g} m along ({:.4f}, {:.4f})", model.time(),
             one.tip[0], one.tip[1], one.length, one.direction[0], one.direction[1]);
  if (change_.is_none()) complete(model, log);
  return change_;
}

void Tips::warn_about(const Segment& one, base::Log& log) const {
  log.warning("the extension to ({:.6g}, {:.6g}) differs by {:.3g} degrees from the direction of growth at its tip",
              one.tip[0], one.tip[1], std::abs(one.angle) * 180 / M_PI);
}

namespace {

/// Ratio of -K_II to K_I for an angle to the direction of growth, see laws::largest_hoop. It is approximately
/// proportional to the turn of an extension. Bounded: closed faces have no K_I.
Real ratio_of_modes(Real angle) {
  const Real m = std::tan(std::clamp<Real>(angle, -1.5, 1.5) / 2);
  return std::clamp(m / std::max<Real>(1 - 2 * m * m, 0.02), -largest_ratio, largest_ratio);
}

}  // namespace

/// Returns the next turn of an extension, by the secant method. If the direction of growth has changed its side, the
/// sum of turns remains between those on both sides. An extension without K (closed faces that stick) turns back by
/// half.
Real Tips::next_turn(const Segment& one, bool is_measured) {
  const auto& all = one.measured;
  const auto& [last, ratio] = all.back();
  if (!is_measured) return (last - one.turned) / 2;
  Real low = -largest_ratio, high = largest_ratio;  // sums of turns
  for (const auto& [turned, of] : all) (of > 0 ? low : high) = of > 0 ? std::max(low, turned) : std::min(high, turned);
  Real next = last - ratio / one.slope;
  if (const Real width = high - low; width > 0 && width < largest_ratio)
    next = std::abs(ratio) > sliding ? (low + high) / 2 : std::clamp(next, low + width / 10, high - width / 10);
  return std::clamp(next - one.turned, -largest_turn, largest_turn);
}

/// Adds turns of the extensions that disagree with the direction of growth at their tips. After the last turn, the
/// extension returns to the direction with the smallest disagreement. The slope of the angle between both directions
/// over the turn is -1 for straight cracks under tension, about -3 for wings of a flaw that slides, and about -20 under
/// a deviatoric load that is large compared with the load that opens the crack.
void Tips::turn(const Growth& growth, const std::vector<Tip>& tips, base::Log& log) {
  const Real tolerance = growth.turn * M_PI / 180;
  for (std::size_t k = 0; k < segments_.size(); ++k) {
    auto& one = segments_[k];
    const auto tip = std::min_element(tips.begin(), tips.end(), [&](const Tip& a, const Tip& b) {
      return distance(a.x, one.tip) < distance(b.x, one.tip);
    });
    const bool found = tip != tips.end() && distance(tip->x, one.tip) < 1e-3 * growth.segment;
    const bool is_measured = found && tip->ratio > 0;
    if (one.is_settled || !found || (!is_measured && one.measured.empty())) {
      one.is_settled = true;
      continue;
    }
    auto& all = one.measured;
    if (is_measured) {
      one.angle = angle_between(one.begin, one.tip, tip->direction);
      one.is_settled = std::abs(one.angle) <= tolerance;
      const Real ratio = ratio_of_modes(one.angle);
      if (!all.empty() && all.back()[0] != one.turned)
        one.slope = std::clamp<Real>((ratio - all.back()[1]) / (one.turned - all.back()[0]), -50, -0.35);
      all.push_back({one.turned, ratio});
    }
    const auto best =
        *std::min_element(all.begin(), all.end(), [](auto& a, auto& b) { return std::abs(a[1]) < std::abs(b[1]); });
    const bool is_last = one.n_turns >= max_turns;
    one.is_settled = one.is_settled || one.n_turns > max_turns || (is_last && std::abs(best[0] - one.turned) < 1e-9);
    if (one.is_settled && std::abs(one.angle) > tolerance) warn_about(one, log);
    if (one.is_settled) continue;
    one.turn = is_last ? best[0] - one.turned : next_turn(one, is_measured);
    ++one.n_turns;
    change_.turns.push_back({one.begin, one.tip, one.turn});
    turned_.push_back(k);
  }
}

bool Tips::may_grow(const Point& x) const {
  return std::none_of(arrested_.begin(), arrested_.end(), [&](const Point& one) { return distance(one, x) < 1e-9; });
}

void Tips::extend(const Growth& growth, const std::vector<Tip>& tips) {
  Real largest = 0;
  for (const auto& tip : tips)
    if (may_grow(tip.x) && tip.ratio > largest) largest = tip.ratio;
  if (largest < 1) return;
  for (const auto& tip : tips)
    if (may_grow(tip.x) && tip.ratio >= std::min<Real>(1, together * largest)) {
      change_.extensions.push_back(
          {tip.x, tip.direction, growth.segment, new_size(growth), tip.crossing > 0 ? growth.segment : 0});
      growing_.push_back(tip);
    }
}

/// Notes the tips of the last round of extensions, which have their final direction.
void Tips::measure(const Growth& growth, const std::vector<Tip>& tips) {
  for (auto& one : segments_)
    for (const auto& tip : tips)
      if (!one.after && !std::isnan(tip.ratio) && distance(tip.x, one.tip) < 1e-3 * growth.segment) one.after = tip;
}

/// Makes the table of the extensions of the step. Warns if the ratio of K to the toughness rises as tips grow at
/// constant load.
void Tips::complete(const Model& model, base::Log& log) {
  extensions_ = {{},
                 {{"x", "m"},
                  {"y", "m"},
                  {"length", "m"},
                  {"released", "J/m"},
                  {"fracture_energy", "J/m"},
                  {"lost_energy", "J/m"}}};
  std::map<int, std::array<Real, 2>> unstable;  // by single fracture: length, lost energy
  for (const auto& one : segments_)
    if (one.after && one.after->ratio > noise * one.before.ratio) unstable[one.before.fracture] = {};
  std::vector<std::array<Real, 6>> rows;
  for (const auto& one : segments_) {
    const auto& after = one.after ? *one.after : one.before;
    const Real length = distance(one.begin, one.tip), released = length * (one.before.G() + after.G()) / 2,
               dissipated = length * (one.before.G_c + after.G_c) / 2;
    log.info("\"{}\" has grown by {:.4g} m to ({:.6g}, {:.6g})",
             model.mesh().single_fractures[one.before.fracture].name, length, one.tip[0], one.tip[1]);
    rows.push_back({one.tip[0], one.tip[1], length, released, dissipated, released - dissipated});
    if (const auto found = unstable.find(one.before.fracture); found != unstable.end())
      found->second = {found->second[0] + length, found->second[1] + released - dissipated};
  }
  std::erase_if(unstable, [](const auto& one) { return one.second[1] <= 0; });
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const int fracture = segments_[k].before.fracture;
    if (!unstable.count(fracture)) rows[k].back() = 0;
    extensions_.fractures.push_back(fracture);
    for (std::size_t c = 0; c < rows[k].size(); ++c) extensions_.columns[c].values.push_back(rows[k][c]);
  }
  for (const auto& [fracture, of] : unstable)
    log.warning("t = {:.6g}: unstable growth of \"{}\" by {:.4g} m loses {:.4g} J/m", model.time(),
                model.mesh().single_fractures[fracture].name, of[0], of[1]);
  segments_.clear();
}

/// Changes the mesh at the begin of the step, and notes the results and the integrals that they add.
void Tips::apply(Model& model, const mesh::MeshChange& change, base::Log& log) {
  const auto before = integrals(model);
  const auto made = model.change_mesh(change);
  note(model.mesh(), made, log);
  for (const auto& [name, sum] : integrals(model))
    if (const Real more = sum - before.at(name); std::abs(more) > 1e-13 * std::abs(sum)) added_[name] += more;
}

nlohmann::json Tips::growth() const {
  nlohmann::json growth = nlohmann::json::object();
  if (!added_.empty()) growth["added_by_growth"] = added_;
  for (const auto& [fracture, met, x, how, margin] : events_) {
    constexpr const char* states[] = {"ends", "grows", "ends at", "crosses"};
    nlohmann::json event = {{"fracture", fracture}, {"x", x[0]}, {"y", x[1]}, {"state", states[how]}};
    if (!met.empty()) event["met"] = met;
    if (!met.empty() && !std::isnan(margin)) event["margin"] = margin;
    growth["tips"].push_back(event);
  }
  return growth;
}

void Tips::note(const mesh::Mesh& mesh, const std::vector<mesh::Extended>& made, base::Log& log) {
  using mesh::Extended;
  const auto name = [&](int single) { return single < 0 ? "" : mesh.single_fractures[single].name; };
  std::size_t k = 0;
  for (const auto& one : change_.extensions) {
    const auto& result = made[k];
    const auto met = name(result.met);
    const auto& tip = growing_[k++];
    events_.push_back({name(tip.fracture), result == Extended::none ? "" : met, tip.x, result.how,
                       result.is_ahead ? tip.crossing : std::nan("")});
    const bool crosses = result == Extended::crossing;
    if (crosses) segments_.push_back({.begin = tip.x, .tip = result.begin, .is_settled = true, .before = tip});
    if (result.begin != result.end)
      segments_.push_back(
          {.begin = result.begin, .tip = result.end, .is_settled = result == Extended::junction, .before = tip});
    if (crosses)
      log.info("\"{}\" crosses the fracture \"{}\" at ({:.6g}, {:.6g})", name(tip.fracture), met, result.begin[0],
               result.begin[1]);
    else if (result == Extended::junction)
      log.info("\"{}\" meets {} and ends there", name(tip.fracture),
               met.empty() ? "another extension"
                           : fmt::format("the fracture \"{}\" at ({:.6g}, {:.6g})", met, result.end[0], result.end[1]));
    if (result != Extended::none) continue;
    arrested_.push_back(one.tip);
    const std::string near = " is nearer than half of the \"segment\"";
    const std::string reasons[] = {"cells would be too flat", "a boundary" + near,
                                   "another part of the fracture" + near,
                                   fmt::format("the fracture \"{}\"", met) + near};
    log.warning("the tip at ({:.6g}, {:.6g}) ends its growth: {}", one.tip[0], one.tip[1], reasons[result.obstacle]);
  }
  for (const std::size_t s : turned_) {
    auto& one = segments_[s];
    if (made[k++] == Extended::none) {
      one.is_settled = true;
      warn_about(one, log);
      continue;
    }
    one.turned += one.turn;
    const Real c = std::cos(one.turn), s_ = std::sin(one.turn), x = one.tip[0] - one.begin[0],
               y = one.tip[1] - one.begin[1];
    one.tip = {one.begin[0] + c * x - s_ * y, one.begin[1] + s_ * x + c * y};
  }
}

}  // namespace sprekk::model
