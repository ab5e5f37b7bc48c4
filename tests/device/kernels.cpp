// kernels FILE [--time N]              evaluates the kernels on random faces and cells, times N of each, writes FILE
// kernels FILE --against [--time N]    uses the inputs of FILE and compares with its results; exit status 1: different
//
// Kernels are local operators of packages/physics with their laws, in loops of the execution space of the build.
#include "report.hpp"

#include <cstdio>
#include <cstring>
#include <fstream>
#include <iostream>
#include <stdexcept>

namespace {

using namespace sprekk;
using device::Report;
using Numbers = std::vector<Real>;

constexpr Real bound = 1e-12;  // bound on relative differences

void write(std::ofstream& file, const std::string& name, const Numbers& numbers) {
  const std::size_t sizes[] = {name.size(), numbers.size()};
  file.write(reinterpret_cast<const char*>(sizes), sizeof sizes);
  file.write(name.data(), sizes[0]);
  file.write(reinterpret_cast<const char*>(numbers.data()), sizes[1] * sizeof(Real));
}

void write(const std::string& path, const Report& report) {
  std::ofstream file(path, std::ios::binary);
  for (const auto& [name, numbers] : report.inputs) write(file, "input " + name, numbers);
  for (const auto& [name, one] : report.cases) {
    write(file, "value " + name, one.value);
    write(file, "scale " + name, one.scale);
    write(file, "seconds " + name, {one.seconds});
  }
  if (!file) throw std::runtime_error(path + ": not written");
}

std::map<std::string, Numbers> read(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error(path + ": not there");
  std::map<std::string, Numbers> all;
  std::size_t sizes[2];
  while (file.read(reinterpret_cast<char*>(sizes), sizeof sizes)) {
    std::string name(sizes[0], ' ');
    file.read(name.data(), sizes[0]);
    Numbers& numbers = all[name];
    numbers.resize(sizes[1]);
    file.read(reinterpret_cast<char*>(numbers.data()), sizes[1] * sizeof(Real));
  }
  return all;
}

/// Returns the largest difference relative to the scale; infinite if sizes differ or a value is not finite.
Real difference(const Numbers& a, const Numbers& b, const Numbers& scale) {
  Real maximum = a.size() == b.size() && b.size() == scale.size() ? 0 : HUGE_VAL;
  for (std::size_t k = 0; k < a.size() && maximum < HUGE_VAL; ++k) {
    const Real apart = std::abs(a[k] - b[k]);
    if (!(apart <= HUGE_VAL)) return HUGE_VAL;
    if (apart > 0) maximum = std::max(maximum, apart / (scale[k] > 0 ? scale[k] : 1));
  }
  return maximum;
}

/// Compares and prints all cases; returns whether all differences are within the bound.
bool compare(const Report& report, std::map<std::string, Numbers> reference) {
  bool same = true;
  std::printf("%-36s %9s %10s %12s %12s %7s\n", "", "numbers", "difference", "1/s", "1/s there", "ratio");
  for (const auto& [name, one] : report.cases) {
    const Real apart = difference(one.value, reference["value " + name], reference["scale " + name]);
    std::printf("%-36s %9zu %10.1e", name.c_str(), one.value.size(), apart);
    const Real there = reference["seconds " + name].empty() ? 0 : reference["seconds " + name][0];
    if (one.seconds > 0 && there > 0)
      std::printf(" %12.3g %12.3g %7.1f", 1 / one.seconds, 1 / there, there / one.seconds);
    std::printf("%s\n", apart <= bound ? "" : "  differs");
    same = same && apart <= bound;
  }
  return same;
}

int run(int argc, char** argv) {
  Report report;
  const std::string path = argc > 1 ? argv[1] : "";
  bool against = false;
  for (int k = 2; k < argc; ++k) {
    if (std::strcmp(argv[k], "--against") == 0) against = true;
    if (std::strcmp(argv[k], "--time") == 0 && k + 1 < argc) report.n_timed = std::atoi(argv[k + 1]);
  }
  if (path.empty()) throw std::runtime_error("usage: kernels FILE [--against] [--time N]");
  std::map<std::string, Numbers> reference;
  if (against) {
    reference = read(path);
    report.has_inputs = true;
    for (const auto& [name, numbers] : reference)
      if (name.rfind("input ", 0) == 0) report.inputs[name.substr(6)] = numbers;
  }
  std::printf("kernels on %s\n", Execution::name());
  device::add_faces(report);
  device::add_cells(report);
  if (!against) {
    write(path, report);
    return 0;
  }
  const bool same = compare(report, reference);
  std::printf("same=%s bound=%.0e\n", same ? "yes" : "no", bound);
  return same ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  Kokkos::initialize(argc, argv);
  int status = 1;
  try {
    status = run(argc, argv);
  } catch (const std::exception& error) {
    std::cerr << "kernels: " << error.what() << '\n';
  }
  Kokkos::finalize();
  return status;
}
