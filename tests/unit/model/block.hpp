// Block of rock under tension, as a scene for the tests of packages/model.
#pragma once

#include "base/check.hpp"
#include "base/xml.hpp"
#include "model/model.hpp"

#include <Tpetra_Core.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace sprekk::model::test {

using Entries = std::vector<std::string>;  ///< "Path.To.Entry=value"

inline RCP<const Comm> world() { return Tpetra::getDefaultComm(); }

/// Returns the entries of a block, 2 m x 1 m, 8 squares, E = 10 Pa, Poisson's ratio 0, and changes of them. The west
/// side is fixed, the traction on the east side is 5 t Pa. The displacement is t x / 2 in the direction x.
inline Teuchos::ParameterList block_entries(const Entries& changes = {}) {
  Teuchos::ParameterList list("Sprekk");
  for (const char* entry :
       {"Mesh.cell=quadrilateral", "Mesh.lower corner={0, 0}", "Mesh.upper corner={2, 1}", "Mesh.cells={4, 2}",
        "Materials.rock.type=elastic", "Materials.rock.Young's modulus=10.0", "Materials.rock.Poisson's ratio=0.0",
        "Bulk.material=rock", "Boundary conditions.held.boundary=west", "Boundary conditions.held.displacement={0, 0}",
        "Boundary conditions.pull.boundary=east", "Boundary conditions.pull.traction={5*t, 0}"})
    base::apply_override(list, entry);
  for (const auto& entry : changes) base::apply_override(list, entry);
  return list;
}

/// Returns the block with changes; its messages begin with "block.xml".
inline Scene block(const Entries& changes = {}) {
  return scene_of(*world(), block_entries(changes), "block.xml", "/scenes");
}

/// Returns entries for a frictional fracture across the block, at x = 1 m.
inline Entries with_fault(const Entries& changes = {}) {
  Entries all = {"Mesh.fractures.fault.lower corner={1, 0}",
                 "Mesh.fractures.fault.upper corner={1, 1}",
                 "Materials.joint.type=joint",
                 "Materials.joint.tangential stiffness=10.0",
                 "Materials.joint.friction coefficient=0.5",
                 "Fractures.fault.material=joint",
                 "Boundary conditions.pull.traction={-5*t, 0}"};
  all.insert(all.end(), changes.begin(), changes.end());
  return all;
}

/// Returns the message of the Error of a call; the test fails if there is none.
template <class Call>
std::string message_of(const Call& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  ADD_FAILURE() << "no error";
  return "";
}

/// Returns the message about the block with changes.
inline std::string refusal(const Entries& changes) {
  return message_of([&] { block(changes); });
}

inline long n_lines(const std::string& text) { return std::count(text.begin(), text.end(), '\n') + !text.empty(); }

}  // namespace sprekk::model::test
