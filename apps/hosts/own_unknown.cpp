// Host that adds an unknown to a scene: the pressure of grout in a fracture, solved together with the rock. A column is
// compressed. At first the grout alone transmits the load, then the sides of the fracture come into contact.
#include "grout.hpp"

#include <Tpetra_Core.hpp>

#include <iostream>

using namespace sprekk;

int main(int argc, char** argv) {
  Tpetra::ScopeGuard guard(&argc, &argv);
  const auto comm = Tpetra::getDefaultComm();
  constexpr Real E = 10e9, squeeze = 5e-4;  // column.xml: Pa, m
  constexpr Real h = 0.02, K = 0.5e9;       // grout: m, Pa
  const auto grout = [=](const mesh::Mesh& mesh) {
    std::vector<std::unique_ptr<assembly::Module>> modules;
    modules.push_back(hosts::make_grout(mesh, h, K));
    return modules;
  };
  try {
    model::Model model(model::read_scene(*comm, argc > 1 ? argv[1] : "column.xml"), comm, grout);
    bool good = true;
    for (Real t : {1, 3}) {
      good = model.step_to(t).converged && good;
      // Analytical solution: springs in series, d = p (1 m/E + h/K). After contact of the sides, only the rock deforms.
      const Real d = 1e-3 * t, alone = d / (1 / E + h / K), full = squeeze * K / h;
      const Real by_hand = std::min(alone, full), contact = alone > full ? (d - squeeze) * E - full : 0;
      const auto p = model.field("grout pressure").values, lambda = model.field("traction").values;
      Real off = 0;  // largest error on the faces of this rank, Pa
      for (std::size_t face = 0; face < p.extent(0); ++face)
        off = std::max({off, std::abs(p(face, 0) - by_hand), std::abs(lambda(face, 0) + contact)});
      std::cout << fmt::format("{} m: grout {} Pa, walls {} Pa, error {} Pa\n", d, by_hand, contact, off);
      good = good && off < 1e-9 * by_hand;
    }
    return good ? 0 : 1;
  } catch (const Error& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
}
