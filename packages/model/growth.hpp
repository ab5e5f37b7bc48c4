// Growth of fractures along free paths in 2D: section Growth of a scene, and changes of the mesh during a step.
#pragma once

#include "estimate/state_table.hpp"
#include "mesh/bisect.hpp"

#include <nlohmann/json_fwd.hpp>

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace sprekk::base {
class Section;
class Log;
}  // namespace sprekk::base
namespace sprekk::mesh {
struct Mesh;
}

namespace sprekk::model {

class Model;
class Steps;
struct Scene;
struct StepTaken;

/// Section Growth of a scene. The fractures that may grow have an entry of their physics, the toughness.
struct Growth {
  Real segment = 0;  ///< length of an extension, m
  int faces = 4;     ///< of an extension
  Real turn = 2;     ///< largest remaining angle between the last extension and the direction of growth, degree
  int largest = 20;  ///< number of rounds of extensions in a step
  void describe(base::Section& section);
};

/// Throws an Error if an extension is longer than the body, or if a toughness is out of bounds at a tip.
/// Collective.
void check_growth(const Scene& scene, const mesh::Mesh& mesh);

/// Growth of the tips of a model. A step is repeated on a changed mesh until no tip would grow. Collective.
///
/// Columns of a table of the physics define the growth: position x, y, intensity K_hoop, `toughness`, and direction
/// kink_x, kink_y of growth, of each tip. First the last extensions are turned until they agree with the direction of
/// growth at their new tips. Then all tips with K_hoop >= toughness grow by an extension, together with those of the
/// same ratio up to 2 %. A tip with a positive `crossing` crosses the fracture that its extension meets.
class Tips {
 public:
  /// Bisects the cells at the tips to the size of new faces, before the first step.
  void begin(Model& model);
  /// Takes the next step of the model. While fractures grow, the mesh is changed and the step repeated. The complete
  /// step contains extensions() and growth().
  StepTaken take(Model& model, Steps& steps, base::Log& log);
  /// Returns whether the mesh contains extensions of a step that is not complete.
  bool is_in_growth() const { return !segments_.empty(); }
  /// Extensions of the complete step: tip x, y, `length`, and in J/m `released`, `fracture_energy` and `lost_energy`.
  ///
  /// The energies are the length times the means of G = K_hoop^2/E' and G_c = toughness^2/E' before the extension and
  /// at its new tip, at the load of the end of the step; the values before it, if the new tip has no K. The growth of a
  /// fracture in the step is unstable if K/toughness rises in any extension; then the difference of both energies is
  /// lost. An extension that crosses a fracture has a row on each side.
  const estimate::StateTable& extensions() const { return extensions_; }
  /// Growth in the step: `added_by_growth`, integrals over new faces at their begin, by name, and `tips` in the order
  /// of their extensions. Each has the fracture, its old tip x, y, and its `state`: "grows", "crosses" or "ends at"
  /// another fracture `met`, with the `margin` of crossing, or "ends" without room.
  nlohmann::json growth() const;

 private:
  using Point = std::array<Real, 2>;
  struct Tip {
    Point x, direction;
    Real ratio;     ///< intensity/toughness
    Real crossing;  ///< above 0: the tip crosses the fracture that it meets
    int fracture;   ///< single fracture
    Real G_c;       ///< N/m
    Real G() const { return ratio > 0 ? ratio * ratio * G_c : 0; }
  };
  struct Event {
    std::string fracture, met;
    Point x;
    mesh::Extended::How how;
    Real margin;
  };
  struct Segment {
    Point begin, tip;
    Real angle = 0;   ///< to the direction of growth when last computed, rad
    Real turned = 0;  ///< sum of all turns, rad
    Real turn = 0;    ///< next one, rad
    int n_turns = 0;
    bool is_settled = false;
    Real slope = -1.25;                              ///< of -K_II/K_I over the sum of turns, 1/rad
    std::vector<std::array<Real, 2>> measured = {};  ///< sums of turns with -K_II/K_I
    Tip before = {};                                 ///< tip that grew
    std::optional<Tip> after = {};                   ///< new tip; empty before the next round, and without K
  };
  mesh::MeshChange for_step(Model& model, Real begin, base::Log& log);
  void apply(Model& model, const mesh::MeshChange& change, base::Log& log);
  std::vector<Tip> tips_of(Model& model) const;
  void note(const mesh::Mesh& mesh, const std::vector<mesh::Extended>& made, base::Log& log);
  void turn(const Growth& growth, const std::vector<Tip>& tips, base::Log& log);
  void warn_about(const Segment& one, base::Log& log) const;
  static Real next_turn(const Segment& one, bool is_measured);
  bool may_grow(const Point& tip) const;
  void extend(const Growth& growth, const std::vector<Tip>& tips);
  void measure(const Growth& growth, const std::vector<Tip>& tips);
  void complete(const Model& model, base::Log& log);

  std::optional<Real> begin_;      ///< of the step
  int n_rounds_ = 0;               ///< of extensions in the step
  std::vector<Segment> segments_;  ///< of the step
  std::vector<Point> arrested_;    ///< tips without room
  mesh::MeshChange change_;        ///< last one
  std::vector<Tip> growing_;       ///< of its extensions
  std::vector<Event> events_;      ///< of the step
  std::map<std::string, Real> added_;
  estimate::StateTable extensions_;  ///< of the complete step
  std::vector<std::size_t> turned_;  ///< segments of its turns
};

}  // namespace sprekk::model
