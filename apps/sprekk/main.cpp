// The program: starts MPI and Kokkos, reads the command line, runs.
#include "base/check.hpp"
#include "model/material_library.hpp"
#include "model/point.hpp"
#include "model/run.hpp"

#include <CLI/CLI.hpp>
#include <Tpetra_Core.hpp>

#include <csignal>
#include <cstdlib>
#include <iostream>

#ifndef SPREKK_VERSION
#define SPREKK_VERSION "unknown"
#endif

namespace {

int run_command(int argc, char** argv, sprekk::RCP<const sprekk::Comm> comm) {
  using namespace sprekk;
  const bool speaks = comm->getRank() == 0;
  model::RunOptions options;
  const char* terminal = std::getenv("SPREKK_TERMINAL");
  options.terminal = terminal && std::string(terminal) == "1";

  CLI::App app{"Sprekk: deformation of fractured rock", "sprekk"};
  app.set_version_flag("--version", std::string("sprekk ") + SPREKK_VERSION);
  app.require_subcommand(1);
  auto* run = app.add_subcommand("run", "run a scene");
  auto* check = app.add_subcommand("check", "read and check a scene without running it");
  auto* reference = app.add_subcommand("reference", "print all parameters of a scene");
  const auto* schema = reference->add_flag("--schema", "print a RELAX NG schema of scenes instead, for editors");
  auto* materials = app.add_subcommand("materials", "print the material library");
  auto* point = app.add_subcommand("point", "drive one point of a joint along a path, print CSV");
  std::string mesh_file;
  std::vector<std::string> fractures;
  auto* mesh_info = app.add_subcommand("mesh-info", "describe a mesh of gmsh");
  mesh_info->add_option("file", mesh_file, "gmsh file")->required();
  mesh_info->add_option("--fractures", fractures, "physical groups that are fractures, a,b,c")->delimiter(',');
  for (auto* command : {run, check, point}) {
    command->add_option("scene", options.scene, "XML file")->required();
    command->add_option("--set", options.overrides, "Path.To.Entry=value, replaces or adds an entry of the scene")
        ->allow_extra_args(false)
        ->check([](const std::string& text) {
          const auto equals = text.find('=');
          return equals != 0 && equals != text.npos ? "" : "\"" + text + "\" is not of the form Path.To.Entry=value";
        });
  }
  run->add_option("--output", options.output, "directory for the results; default output/SCENE");
  run->add_flag("--restart", options.restart, "go on from the last checkpoint in the output directory");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const bool asked_for_help = error.get_exit_code() == 0;
    if (speaks && asked_for_help) app.exit(error);
    if (speaks && !asked_for_help) std::cerr << "sprekk: " << error.what() << " (see sprekk --help)\n";
    return asked_for_help ? 0 : 2;
  }

  try {
    if (reference->parsed()) {
      if (speaks) std::cout << (schema->count() ? model::schema() : model::reference());
      return 0;
    }
    if (materials->parsed()) {
      if (speaks) std::cout << model::library_markdown();
      return 0;
    }
    if (mesh_info->parsed()) {
      base::collectively(*comm, [&] {
        if (speaks) std::cout << model::mesh_info(mesh_file, fractures);
      });
      return 0;
    }
    if (point->parsed()) {
      const auto states = model::drive_point(model::read_point_scene(*comm, options.scene, options.overrides));
      if (speaks) model::write_csv(std::cout, states);
      return 0;
    }
    if (check->parsed()) {
      model::check(options, comm);
      if (speaks) std::cout << options.scene << ": no errors\n";
      return 0;
    }
    return model::run(options, comm) ? 0 : 3;
  } catch (const Error& error) {  // thrown alike on all ranks
    if (speaks) std::cerr << "sprekk: " << error.what() << std::endl;
    return 1;
  } catch (const std::exception& error) {  // perhaps here alone: the others must not wait
    std::cerr << "sprekk: rank " << comm->getRank() << ": " << error.what() << std::endl;
    MPI_Abort(MPI_COMM_WORLD, 1);
    return 1;
  }
}

}  // namespace

int main(int argc, char** argv) {
  std::signal(SIGXFSZ, SIG_IGN);  // a limit on the size of files becomes an error of writing
  int n_libraries_may_read = 1;   // Kokkos would answer --help, too
  Tpetra::ScopeGuard guard(&n_libraries_may_read, &argv);
  return run_command(argc, argv, Tpetra::getDefaultComm());
}
