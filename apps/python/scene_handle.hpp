// Scene shared by Python and models.
#pragma once

#include "bindings.hpp"
#include "model/scene.hpp"

#include <string>

namespace sprekk::python {

class SceneHandle {
 public:
  /// Checks the entries like model::read_scene; throws an Error likewise. Collective on `comm`.
  SceneHandle(Teuchos::ParameterList entries, std::string origin, std::string folder,
              const std::vector<std::string>& overrides, const Comm& comm);

  const Teuchos::ParameterList& entries() const { return entries_; }  ///< including overrides
  const std::string& origin() const { return origin_; }
  const std::string& folder() const { return folder_; }
  const model::Scene& scene() const { return scene_; }

 private:
  Teuchos::ParameterList entries_;
  std::string origin_, folder_;
  model::Scene scene_;
};

}  // namespace sprekk::python
