#include "model/run.hpp"

#include "mesh/mesh_info.hpp"
#include "mesh/msh_reader.hpp"
#include "model/results.hpp"

#include <chrono>
#include <filesystem>
#include <memory>

namespace sprekk::model {

namespace {

/// A line per time step, for terminals.
class Progress {
 public:
  Progress(base::Log& log, std::size_t n_steps) : log_(log), n_steps_(n_steps) {
    log_.info("{:>12} {:>10} {:>6} {:>6} {:>5} {:>8} {:>8} {:>8} {:>9} {:>9}", "time", "dt", "Newton", "linear", "cuts",
              "open", "stick", "slip", "elapsed", "remaining");
  }

  void add(const solve::StepReport& report, Real dt, const std::array<long long, 3>& faces) {
    ++done_;
    const Real elapsed = std::chrono::duration<Real>(std::chrono::steady_clock::now() - begin_).count();
    log_.info("{:>12.5g} {:>10.3g} {:>6} {:>6} {:>5} {:>8} {:>8} {:>8} {:>8.1f}s {:>8.1f}s", report.time, dt,
              report.newton_iterations, report.linear_iterations, report.cuts, faces[0], faces[1], faces[2], elapsed,
              elapsed / done_ * static_cast<Real>(n_steps_ - done_));
  }

 private:
  base::Log& log_;
  std::size_t n_steps_, done_ = 0;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

/// Calls work(); the message of an Error opens with the scene's file, as those about its entries do.
template <class Work>
auto naming_file(const std::string& file, const Work& work) {
  try {
    return work();
  } catch (const Error& error) {
    const std::string message = error.what();
    if (message.compare(0, file.size() + 1, file + ":") == 0) throw;
    throw Error(file + ": " + message);
  }
}

}  // namespace

bool run(const RunOptions& options, RCP<const Comm> comm) {
  base::Log log(*comm, options.terminal ? base::Log::Level::normal : base::Log::Level::quiet);
  const Scene scene = read_scene(*comm, options.scene, options.overrides);
  const auto made = naming_file(options.scene, [&] { return std::make_unique<Model>(scene, comm); });
  Model& model = *made;
  log.info("{}: {} cells, {} nodes, {} fracture faces, {} ranks", options.scene, model.mesh().n_global_cells,
           model.mesh().n_global_nodes, model.mesh().n_global_fracture_faces, comm->getSize());
  log.info("linear solver: {}", model.newton().linear().solver().describe());
  const std::string directory =
      options.output.empty() ? "output/" + std::filesystem::path(options.scene).stem().string() : options.output;
  Results results(model, directory);
  const auto times = scene.time.times();
  Progress progress(log, times.size());
  for (std::size_t k = 0; k < times.size(); ++k) {
    const Real begin = model.time();
    const auto report = [&] {
      try {
        return naming_file(options.scene, [&] { return model.step_to(times[k]); });
      } catch (const Error& error) {  // of an expression; the same on every rank
        results.finish("failed", error.what());
        throw;
      }
    }();
    const auto faces = results.add_step(report, k + 1 == times.size() || !report.converged);
    progress.add(report, times[k] - begin, faces);
    if (report.converged) continue;
    results.finish("failed", report.reason);
    log.warning("step to t = {} failed at t = {} after {} cuts: {}", times[k], report.time, report.cuts, report.reason);
    return false;
  }
  results.finish("completed");
  log.info("results in {}", directory);
  return true;
}

void check(const RunOptions& options, RCP<const Comm> comm) {
  const Scene scene = read_scene(*comm, options.scene, options.overrides);
  naming_file(options.scene, [&] {
    Model model(scene, comm);
    model.system().set_time(scene.time.times().front(), scene.time.times().front() - scene.time.start);
  });
}

std::string mesh_info(const std::string& path, const std::vector<std::string>& fractures) {
  mesh::MshOptions options;
  for (const auto& name : fractures) options.fractures[name];
  return mesh::to_text(mesh::describe(mesh::read_msh(path, options)));
}

std::string reference() { return base::reference<Scene>("Sprekk"); }

}  // namespace sprekk::model
