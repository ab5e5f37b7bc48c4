// Minimal host: runs all time steps of a scene and prints the slip of each fracture face.
#include "model/model.hpp"

#include <Tpetra_Core.hpp>

#include <iostream>

using namespace sprekk;

int main(int argc, char** argv) {
  Tpetra::ScopeGuard guard(&argc, &argv);  // initialises and finalises MPI and Kokkos
  const auto comm = Tpetra::getDefaultComm();
  try {
    model::Model model(model::read_scene(*comm, argc > 1 ? argv[1] : "scene.xml"), comm);
    for (Real t : model.scene().time.times()) {
      const auto report = model.step_to(t);
      if (!report.converged) throw Error(report.reason);
    }
    const auto slip = model.output("slip").values;  // faces of this rank
    for (std::size_t face = 0; face < slip.size(); ++face)
      std::cout << "face " << model.mesh().fracture_faces[face].id << ": " << slip[face] << " m\n";
    return 0;
  } catch (const Error& error) {  // thrown on every rank
    std::cerr << error.what() << '\n';
    return 1;
  }
}
