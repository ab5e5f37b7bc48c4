// The program: starts MPI and Kokkos, reads the command line, runs.
#include "base/check.hpp"
#include "base/heap.hpp"
#include "base/memory.hpp"
#include "base/over_ranks.hpp"
#include "base/text.hpp"
#include "laboratory/point.hpp"
#include "model/factor_of_safety.hpp"
#include "model/network.hpp"
#include "model/run.hpp"
#include "physics/material_library.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <Teuchos_DefaultSerialComm.hpp>
#include <Tpetra_Core.hpp>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <optional>
#include <sys/stat.h>
#include <unistd.h>

extern const char* const sprekk_commit;  // cmake/Commit.cmake

namespace {

using namespace sprekk;

volatile std::sig_atomic_t stop_asked = 0;

void handle_stop_signals(void (*handler)(int)) {
  for (int signal : {SIGINT, SIGTERM, SIGUSR1}) std::signal(signal, handler);  // mpirun hands on SIGUSR1
}

/// The first signal asks to stop, a second one ends the program.
void ask_to_stop(int) {
  handle_stop_signals(SIG_DFL);
  stop_asked = 1;
}

void ask_to_stop_aloud(int signal) {
  ask_to_stop(signal);
  constexpr char words[] = "sprekk: stopping; a second signal stops at once\n";
  [[maybe_unused]] const auto ignored = ::write(STDERR_FILENO, words, sizeof words - 1);
}

struct Arguments {
  model::RunOptions options;
  std::string mesh_file;
  std::vector<std::string> fractures;
  bool schema = false, json = false, quiet = false;
  model::SafetyOptions safety;
};

/// Numbers from `low` to `high`. CLI::Range accepts nan.
auto between(double low, double high) {
  return [low, high](const std::string& text) {
    double value = 0;
    if (CLI::detail::lexical_cast(text, value) && value >= low && value <= high) return std::string();
    return fmt::format("is {}, must be a number from {:g} to {:g}", text, low, high);
  };
}

void declare(CLI::App& app, Arguments& arguments) {
  auto& options = arguments.options;
  app.set_version_flag("--version", fmt::format("sprekk {} (commit {})", model::version(), sprekk_commit));
  app.require_subcommand(1);
  auto* run = app.add_subcommand("run", "run a scene");
  auto* check = app.add_subcommand("check", "read and check a scene without running it");
  auto* reference = app.add_subcommand("reference", "print all parameters of a scene");
  reference->add_flag("--schema", arguments.schema, "print a RELAX NG schema of scenes instead, for editors");
  reference->add_flag("--json", arguments.json, "print the parameters as JSON instead, for programs");
  app.add_subcommand("materials", "print the material library");
  auto* point = app.add_subcommand("point", "drive one point of a joint along a path, print CSV");
  auto* mesh_info = app.add_subcommand("mesh-info", "describe a mesh of gmsh");
  mesh_info->add_option("file", arguments.mesh_file, "gmsh file")->required();
  mesh_info->add_option("--fractures", arguments.fractures, "physical groups that are fractures, a,b,c")
      ->delimiter(',');
  auto* network = app.add_subcommand("network", "print a scene's fracture network, checked and with all defaults");
  auto* safety = app.add_subcommand("safety", "reduce the strength of joints until a scene has no equilibrium");
  safety->add_option("--tolerance", arguments.safety.tolerance, "of the factor, relative; default 1e-3")
      ->check(between(1e-12, 1));
  safety
      ->add_option("--first", arguments.safety.first,
                   "factor that the scene is run with; default 1, less for joints too "
                   "weak for it")
      ->check(between(1e-6, 1e6));
  safety->add_option("--max,--most", arguments.safety.maximum, "factor that is of interest; default 100")
      ->check(between(1, 1e6));
  auto* directory = app.add_subcommand("directory", "print the directory that run writes to without --output");
  for (auto* command : {run, check, point, network, safety, directory}) {
    command->add_option("scene", options.scene, "XML file")->required();
    command->add_option("--set", options.overrides, "Path.To.Entry=value, replaces or adds an entry of the scene")
        ->allow_extra_args(false);
  }
  for (auto* command : {run, check})
    command->add_flag("--strict", options.strict,
                      "take warnings of the scene as errors; and end with status 3 where Accuracy is not reached");
  run->add_flag("--quiet", arguments.quiet, "print nothing on standard output");
  safety->add_flag("--quiet", arguments.quiet, "print the factor alone, not what was tried");
  run->add_option("--output", options.output, "directory for the results; default output/SCENE and the values of --set")
      ->check([](const std::string& name) { return name.empty() ? "is empty, must name a directory" : ""; });
  run->add_flag("--restart", options.restart, "continue from the last checkpoint in the output directory");
}

/// What is wrong with the command line, and where the shell may have split an argument.
std::string message(const CLI::ParseError& error, const Arguments& arguments) {
  const bool split = dynamic_cast<const CLI::ExtrasError*>(&error) && !arguments.options.overrides.empty();
  return std::string(error.what()) + (split ? "; blanks and braces need quotes: --set \"Mesh.cells={8, 8}\"" : "");
}

/// Runs the scene until a signal asks to stop; the exit status.
int run_scene(const Arguments& arguments, RCP<const Comm> comm) {
  if (!stop_asked) handle_stop_signals(comm->getRank() == 0 ? ask_to_stop_aloud : ask_to_stop);
  auto options = arguments.options;
  options.prints_log = !arguments.quiet;
  options.should_stop = [] { return stop_asked != 0; };
  const auto ending = model::run(options, comm);
  if (ending == model::Ending::interrupted) return 4;
  return ending == model::Ending::failed || (ending == model::Ending::inaccurate && options.strict) ? 3 : 0;
}

/// Prints the curves, then where slip jumped, and ends with an error if a step had no state.
void drive_points(const model::RunOptions& options, const Comm& comm) {
  const auto curves = laboratory::drive_points(laboratory::read_point_scene(comm, options.scene, options.overrides));
  const bool speaks = comm.getRank() == 0;
  if (speaks) laboratory::write_csv(std::cout, curves);
  std::cout.flush();
  std::string failures;
  for (const auto& curve : curves) {
    for (const auto& state : curve.states)
      if (speaks && !state.remark.empty())
        std::cerr << "sprekk: " << (curve.specimen.empty() ? "" : curve.specimen + ": ") << "t = " << state.t << ": "
                  << state.remark << '\n';
    if (!curve.failure.empty()) failures += (failures.empty() ? "" : "\n") + curve.failure;
  }
  SPREKK_CHECK(failures.empty(), "{}", failures);
}

/// Prints each factor that is tried, and at last between which two the factor of safety is.
void find_safety(const Arguments& arguments, RCP<const Comm> comm) {
  auto options = arguments.safety;
  options.scene = arguments.options.scene;
  options.overrides = arguments.options.overrides;
  const bool speaks = comm->getRank() == 0;
  const auto found = model::factor_of_safety(options, comm, [&](const model::Reduction& one) {
    if (speaks && !arguments.quiet)
      fmt::print("{:<14.10g} {}\n", one.factor,
                 one.stands ? fmt::format("equilibrium after {} Newton iterations", one.iterations)
                            : "none found: " + one.reason);
    std::fflush(stdout);
  });
  if (!speaks) return;
  if (!arguments.quiet)
    for (const auto& line : found.states) fmt::print("{}\n", line);
  if (found.lost)
    fmt::print("factor of safety: {:.8g} (equilibrium at {:.10g}, none found at {:.10g})\n",
               (found.stable + *found.lost) / 2, found.stable, *found.lost);
  else
    fmt::print("factor of safety: at least {:.8g}\n", found.stable);
}

/// Runs the command; the exit status.
int execute(const std::string& command, const Arguments& arguments, RCP<const Comm> comm) {
  const auto& options = arguments.options;
  const bool speaks = comm->getRank() == 0;
  if (command == "run") return run_scene(arguments, comm);
  if (command == "reference" && speaks)
    std::cout << (arguments.schema ? model::schema() : arguments.json ? model::specification() : model::reference());
  if (command == "materials" && speaks) std::cout << physics::library_markdown();
  if (command == "mesh-info")
    base::collectively(*comm, [&] {
      if (speaks) std::cout << model::mesh_info(arguments.mesh_file, arguments.fractures);
    });
  if (command == "point") drive_points(options, *comm);
  if (command == "safety") find_safety(arguments, comm);
  if (command == "network") {
    const auto description = model::network_description(*comm, options.scene, options.overrides);
    if (speaks) std::cout << description;
  }
  if (command == "directory" && speaks) std::cout << model::default_directory(options) << '\n';
  if (command == "check") {
    const auto n = model::check(options, comm);
    if (speaks) fmt::print("{}: no errors{}\n", options.scene, n == 0 ? "" : ", " + base::counted(n, "warning"));
  }
  return 0;
}

/// Whether a write to standard output failed, for example on a full disk. A pipe whose reader has ended is no failure.
bool output_is_lost() {
  std::cout.flush();
  const bool failed = std::fflush(stdout) != 0 || std::ferror(stdout) || !std::cout;
  struct stat is {};
  return failed && !(::fstat(STDOUT_FILENO, &is) == 0 && (S_ISFIFO(is.st_mode) || S_ISSOCK(is.st_mode)));
}

int run_command(int argc, char** argv, RCP<const Comm> comm) {
  const bool speaks = comm->getRank() == 0;
  Arguments arguments;
  const char* reserved = std::getenv("SPREKK_RESERVED");
  arguments.options.reserved = reserved && std::string(reserved) == "1";  // ./sprekk holds the lock of the directory
  CLI::App app{"Sprekk: deformation of fractured rock", "sprekk"};
  declare(app, arguments);
  try {
    app.parse(argc, argv);
    return execute(app.get_subcommands().front()->get_name(), arguments, comm);
  } catch (const CLI::ParseError& error) {
    const bool asked_for_help = error.get_exit_code() == 0;
    if (speaks && asked_for_help) app.exit(error);
    if (speaks && !asked_for_help) std::cerr << "sprekk: " << message(error, arguments) << " (see sprekk --help)\n";
    return asked_for_help ? 0 : 2;
  } catch (const Error& error) {  // thrown alike on all ranks
    if (speaks) std::cerr << "sprekk: " << error.what() << std::endl;
    return 1;
  } catch (const std::exception& error) {  // perhaps here alone: the others must not wait
    const bool no_memory = dynamic_cast<const std::bad_alloc*>(&error);
    std::cerr << "sprekk: rank " << comm->getRank() << ": " << (no_memory ? base::out_of_memory() : error.what())
              << std::endl;
    MPI_Abort(MPI_COMM_WORLD, 1);
    return 1;
  }
}

}  // namespace

int main(int argc, char** argv) {
  base::keep_heap();
  std::signal(SIGXFSZ, SIG_IGN);  // a limit on the size of files becomes an error of writing
  std::signal(SIGPIPE, SIG_IGN);  // a run goes on, with log.txt, when the reader of its log ends
  if (argc > 1 && std::string(argv[1]) == "run") handle_stop_signals(ask_to_stop);  // while MPI starts, too
  int n_libraries_may_read = 1;                                                     // Kokkos would answer --help, too
  const bool needs_ranks = argc < 2 || std::string(argv[1]) != "reference";  // a build runs it where MPI may not start
  std::optional<Tpetra::ScopeGuard> guard;
  if (needs_ranks) guard.emplace(&n_libraries_may_read, &argv);
  const auto comm = needs_ranks ? Tpetra::getDefaultComm() : RCP<const Comm>(new Teuchos::SerialComm<int>());
  int status = run_command(argc, argv, comm);
  if (base::on_any_rank(*comm, output_is_lost()) && status == 0) {
    if (comm->getRank() == 0)
      std::cerr << "sprekk: standard output cannot be written, what was printed is incomplete; is the disk full?\n";
    status = 1;
  }
  handle_stop_signals(SIG_DFL);  // mpirun ends the ranks that are still there when one has ended with an error
  return status;
}
