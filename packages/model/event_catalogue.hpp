// Events of single fractures by the rate of change on their faces.
#pragma once

#include "assembly/module.hpp"
#include "io/hdf5.hpp"

#include <nlohmann/json.hpp>

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace sprekk::model {

struct FractureColumn;

/// Catalogue of events, computed during a run. The rate of a face in a step is |change of the tangential path|/dt, with
/// the outputs of physics::EventSource. An event of a single fracture is a sequence of consecutive steps in which the
/// largest rate of its faces exceeds a threshold. Events have one number if they belong to a sequence of consecutive
/// steps in each of which a fracture exceeds the threshold.
///
/// Faces that exceed the threshold in a step of the event are its area. Path and drop of a face are net changes since
/// the begin of the event: |change of the path|, and the decrease of the force along this change. Means are over the
/// area. The place of the event is the centre of the fastest face in its first step, of equally fast ones that with the
/// lowest number.
///
/// Memory: some numbers for each owned face, nothing for each step.
class EventCatalogue {
 public:
  /// Begins at time t with these outputs. `rate`: threshold, unit of the path per second.
  EventCatalogue(const mesh::Mesh& mesh, Real rate, Real t, const std::vector<assembly::OutputField>& outputs);

  /// Continues after the steps of Results::journal(), with memory() of that time. Collective.
  void resume(const mesh::Mesh& mesh, const std::vector<nlohmann::json>& journal, const io::NamedVectors& memory);
  /// Data of the faces in events that may continue, for the present mesh. Collective.
  io::NamedVectors memory(const mesh::Mesh& mesh) const;

  /// Adds the step that ends at t, perhaps with another mesh after a change of the model. Returns a row for each event
  /// of the step, with its state at t: row number, event number, fracture, start, end and values. Equal on all ranks.
  /// Collective.
  nlohmann::json add(const mesh::Mesh& mesh, Real t, const std::vector<assembly::OutputField>& outputs);

 private:
  using Tangent = std::array<Real, 2>;
  struct Face {
    Tangent path{}, force{};  ///< at the end of the last step
    Real density = 0;
    Tangent first_path{}, first_force{};  ///< at the begin of the event
    bool beyond = false;                  ///< exceeded the threshold in the event
  };

  static std::vector<Face> faces_of(const mesh::Mesh& mesh, const std::vector<assembly::OutputField>& outputs);
  std::vector<Face> moved_to(const mesh::Mesh& mesh, std::vector<Face> now) const;

  Real threshold_, time_;
  std::vector<Face> faces_;           // [owned face]
  std::vector<GlobalIndex> ids_;      // [owned face] numbers in the whole mesh
  std::vector<nlohmann::json> rows_;  // [single fracture] row of the event that may continue; else null
  int n_rows_ = 0, number_ = 0;       // of all events so far
  bool any_ = false;                  // an event may continue
};

/// Returns the table of the rows in the steps of results.json as CSV text, in the order of ends and starts. It begins
/// with the columns of events_csv(). Not collective.
std::string catalogue_csv(const nlohmann::json& results, const std::vector<FractureColumn>& columns);

}  // namespace sprekk::model
