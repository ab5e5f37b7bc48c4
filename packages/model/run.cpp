#include "model/run.hpp"

#include "base/memory.hpp"
#include "base/over_ranks.hpp"
#include "base/text.hpp"
#include "contact/constraint.hpp"
#include "io/directory_lock.hpp"
#include "io/file.hpp"
#include "laboratory/point.hpp"
#include "mesh/mesh_info.hpp"
#include "mesh/msh_reader.hpp"
#include "model/adaptation.hpp"
#include "model/checkpointing.hpp"
#include "model/steps.hpp"

#include <fmt/ranges.h>
#include <zlib.h>

#include <cctype>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <memory>
#include <new>
#include <optional>
#include <stdexcept>
#include <utility>

namespace sprekk::model {

namespace {

/// Table of time steps in the log, one line per step.
class Progress {
 public:
  Progress(base::Log& log, const physics::Setting& setting, const Steps& steps, const Results& results)
      : log_(log), steps_(steps), results_(results), share_before_(steps.share_done()) {
    physics::for_each_physics([&]<physics::HasLog P>(P) {
      const auto columns = P::Log::columns(setting);
      columns_.insert(columns_.end(), columns.begin(), columns.end());
    });
    std::string titles;
    for (const auto& column : columns_) titles += fmt::format(" {:>9}", column.title);
    log_.info("{:>12} {:>10} {:>6} {:>6} {:>5} {:>8} {:>8} {:>8}{} {:>9} {:>9}", "time", "dt", "Newton", "linear",
              "cuts", contact::state_names[0], contact::state_names[1], contact::state_names[2], titles, "elapsed",
              "remaining");
  }

  void add(const StepTaken& step, const std::array<long long, 3>& faces) {
    const auto& report = step.report;
    ++done_;
    const Real elapsed = std::chrono::duration<Real>(std::chrono::steady_clock::now() - begin_).count();
    const Real share = steps_.share_done();
    const Real remaining = steps_.n_left() > 0 || share == share_before_
                               ? elapsed / done_ * steps_.n_left()
                               : elapsed * (1 - share) / (share - share_before_);
    std::string values;
    for (const auto& column : columns_) {
      const Real value = results_.value_of(column);
      values += std::isnan(value) ? fmt::format(" {:>9}", "-") : fmt::format(" {:>9.3g}", value);
    }
    log_.info("{:>12.5g} {:>10.3g} {:>6} {:>6} {:>5} {:>8} {:>8} {:>8}{} {:>8.1f}s {:>8.1f}s", report.time,
              report.time - step.begin, report.newton_iterations, solve::iterations(report.linear_solves), report.cuts,
              faces[0], faces[1], faces[2], values, elapsed, remaining);
  }

 private:
  base::Log& log_;
  const Steps& steps_;
  const Results& results_;
  std::vector<physics::LogColumn> columns_;
  Real share_before_;
  int done_ = 0;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

/// Calls work(). Messages of Errors get the scene file as prefix, like those about its entries.
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

/// Calls work(). An Error, the same on every rank (an expression, a full disk), also finishes the results with its
/// message.
template <class Work>
auto or_finished(Results& results, const Work& work) {
  try {
    return work();
  } catch (const Error& error) {
    try {
      results.finish("failed", error.what());
    } catch (const Error&) {  // full disk: the first message is used
    }
    throw;
  }
}

/// Reads the scene and sets its stop function, which can end a run within a step.
Scene scene_of(const RunOptions& options, const Comm& comm) {
  Scene scene = read_scene(comm, options.scene, options.overrides);
  scene.solver.should_stop = options.should_stop;
  return scene;
}

/// Reads the scene and makes its model. After a failure, results of a previous run are replaced by the reason, except
/// for a restart. `reserve` makes the directory and prevents other runs in it.
std::unique_ptr<Model> make_model(const RunOptions& options, const std::string& directory,
                                  const std::function<void()>& reserve, Adaptation& adaptation, RCP<const Comm> comm) {
  bool has_scene = false;
  try {
    return naming_file(options.scene, [&] {
      Scene scene = scene_of(options, *comm);
      has_scene = true;
      if (scene.accuracy) {
        SPREKK_CHECK(
            !options.restart || scene.accuracy->refines_during_run(),
            "--restart: not available with \"repeated runs\" of the section \"Accuracy\"; run the scene without "
            "--restart");
        adaptation.prepare(scene, comm);
      }
      auto model = std::make_unique<Model>(scene, comm);
      const Probes probes(*model);  // checks that the places exist
      if (options.strict) base::throw_errors(model->warnings());
      return model;
    });
  } catch (const Error& error) {
    try {
      if (has_scene && !options.restart) reserve();
      if (!options.restart) write_failure(*comm, directory, error.what(), !has_scene);
    } catch (const Error&) {  // the first message is used
    }
    throw;
  }
}

void describe(const Model& model, base::Log& log) {
  const auto& mesh = model.mesh();
  const int n_ranks = mesh.comm->getSize();
  log.info("mesh: {} cells, {} nodes, {} fracture faces", mesh.n_global_cells, mesh.n_global_nodes,
           mesh.n_global_fracture_faces);
  const auto& partition = mesh.partition;
  if (n_ranks > 1)
    log.info("partition: {} to {} cells per rank (largest/mean {:.3f}), {} to {} fracture faces ({:.3f}); {} cut edges",
             partition.cells[0], partition.cells[1], partition.cell_imbalance, partition.fracture_faces[0],
             partition.fracture_faces[1], partition.fracture_face_imbalance, partition.edge_cut);
  std::vector<std::string> modules;
  for (const auto& module : model.system().modules()) modules.push_back(module->name());
  log.info("modules: {}", fmt::join(modules, "; "));
  log.info("linear solver: {}", model.newton().linear().solver().reason);
}

/// Logs the cost of each part of the preconditioner on this rank.
void report_costs(const Model& model, base::Log& log) {
  for (const auto& cost : model.newton().linear().solver().solver->costs()) {
    const auto multigrid = cost.operator_complexity > 0 ? fmt::format("; operator complexity {:.2f}, {:.0f} MB",
                                                                      cost.operator_complexity, 1e-6 * cost.bytes)
                                                        : "";
    log.info("{}: {} set-ups in {:.3g} s, {} applications in {:.3g} s{}", cost.name, cost.n_setups, cost.setup_seconds,
             cost.n_applications, cost.application_seconds, multigrid);
  }
}

/// Warns if the floating blocks have changed.
void report_floating(base::Log& log, Real t, const std::string& before, const std::string& now) {
  if (now == before) return;
  if (now.empty())
    log.info("t = {:.6g}: all rock is constrained again", t);
  else
    log.warning("t = {:.6g}: {}, and nothing constrains it; of all such states the one nearest to the last is taken", t,
                now);
}

/// Ends an interrupted run, with the results of all complete steps. The mesh of a step with growth is not saved: a
/// restart repeats the step from the last checkpoint.
Ending interrupt(const Model& model, Results& results, Checkpointing& checkpoints, bool is_in_growth, base::Log& log) {
  if (!is_in_growth) checkpoints.at_the_end(results);
  results.finish("interrupted");
  const bool none = results.n_steps() == 0;
  log.warning("interrupted {}; {}", none ? "in the first step" : fmt::format("after the step to t = {}", model.time()),
              none                               ? "there is no checkpoint to continue from"
              : model.scene().output.checkpoints ? "--restart continues from the last checkpoint"
                                                 : "the scene has no section \"checkpoints\"");
  return Ending::interrupted;
}

/// Evaluates the accuracy of the last state, if the scene has the section Accuracy and a step was taken.
void judge(const Model& model, Results& results, Adaptation& adaptation, base::Log& log) {
  if (!model.scene().accuracy || results.goals().estimates().empty()) return;
  adaptation.judge(model, results.goals());
  results.add_accuracy(adaptation.summary());
  for (const auto& verdict : adaptation.verdicts()) log.info("{}", verdict.line());
}

/// Takes the next step. While its errors exceed the tolerances of Accuracy, the mesh is refined and the step repeated.
StepTaken take_step(Model& model, Steps& steps, Results& results, Adaptation& adaptation, Tips& tips, base::Log& log) {
  const auto& accuracy = model.scene().accuracy;
  for (;;) {
    auto taken = tips.take(model, steps, log);
    if (!taken.report.converged || taken.report.stopped) return taken;
    if (!accuracy || !accuracy->refines_during_run()) return taken;
    const auto cells = adaptation.cells_for_step(model, taken.begin, results.estimates());
    if (cells.empty()) return taken;
    steps.take_back();
    model.refine(cells);
    log.info("t = {:.6g}: the step to {:.6g} is repeated on a mesh of {} cells", taken.begin, taken.end,
             model.mesh().n_global_cells);
  }
}

/// Takes the remaining steps of the model until one fails or the run is stopped.
Ending take_steps(Model& model, Steps& steps, Results& results, Checkpointing& checkpoints, Adaptation& adaptation,
                  base::Log& log, const std::function<bool()>& should_stop) {
  const Scene& scene = model.scene();
  if (!steps.any()) log.info("nothing to do: the checkpoint at t = {} is at or after the last step", model.time());
  Progress progress(log, model.setting(), steps, results);
  Tips tips;
  or_finished(results, [&] { tips.begin(model); });
  std::string floating;
  while (steps.any()) {
    bool interrupted = false;
    const auto taken = or_finished(results, [&] {
      auto taken = naming_file(scene.origin, [&] { return take_step(model, steps, results, adaptation, tips, log); });
      const auto& step = taken.report;
      bool last = !steps.any();
      interrupted = step.stopped || (!last && step.converged && base::any_rank(*model.mesh().comm, should_stop));
      last = last || interrupted;
      if (step.stopped) {
        model.take_back();
        return taken;
      }
      const auto faces = results.add_step(taken, last || !step.converged);
      progress.add(taken, faces);
      if (!taken.warning.empty()) log.warning("t = {:.6g}: {}", step.time, taken.warning);
      for (const auto& warning : results.take_warnings()) log.warning("t = {:.6g}: {}", step.time, warning);
      if (step.converged) report_floating(log, step.time, std::exchange(floating, step.floating), step.floating);
      if (step.converged) checkpoints.after_step(results, last);
      log.check_file();
      return taken;
    });
    const auto& report = taken.report;
    if (interrupted) return interrupt(model, results, checkpoints, tips.is_in_growth(), log);
    if (report.converged) continue;
    results.finish("failed", report.reason);
    log.warning("step to t = {} failed at t = {} after {} cuts: {}", taken.end, report.time, report.cuts,
                report.reason);
    return Ending::failed;
  }
  for (const auto& [name, bound] : results.error_bounds()) log.info("{}: known to +-{:.2g} %", name, 100 * bound);
  judge(model, results, adaptation, log);
  results.finish("completed");
  return adaptation.reached() ? Ending::completed : Ending::inaccurate;
}

/// Converts a text to a part of a file name. The flag is true if the conversion loses no characters except blanks.
std::pair<std::string, bool> file_name(const std::string& text) {
  std::string name;
  bool same = true;
  for (const char c : text) {
    const bool plain = std::isalnum(static_cast<unsigned char>(c)) || std::string(".=+-").find(c) != std::string::npos;
    name += plain ? c : '_';
    same = same && (plain || c == ' ');
  }
  return {name, same};
}

}  // namespace

std::string version() { return SPREKK_VERSION; }

std::string default_directory(const RunOptions& options) {
  std::string all, variant;
  bool same = true;
  for (const auto& text : options.overrides) {
    const auto [name, is_same] = file_name(text);
    all += text + '\n';
    variant += '-' + name;
    same = same && is_same;
  }
  constexpr std::size_t longest = 100;
  if (!same || variant.size() > longest) {
    const auto checksum = crc32_z(0, reinterpret_cast<const Bytef*>(all.data()), all.size());
    variant = fmt::format("{}-{:08x}", variant.substr(0, longest), checksum);
  }
  return "output/" + std::filesystem::path(options.scene).stem().string() + variant;
}

namespace {

/// Runs the scene once on one mesh. Afterwards `adaptation` refines the mesh if another run follows. `task` is set to
/// the present activity, for messages.
Ending run_once(const RunOptions& options, const std::string& directory, const std::function<void()>& reserve,
                Adaptation& adaptation, base::Log& log, RCP<const Comm> comm, std::string& task) {
  const auto model = make_model(options, directory, reserve, adaptation, comm);
  if (!options.restart) reserve();
  task =
      fmt::format("{}: solving for {} cells on {} ranks", options.scene, model->mesh().n_global_cells, comm->getSize());
  describe(*model, log);
  if (adaptation.is_first())
    for (const auto& warning : model->warnings()) log.warning("{}", warning);
  Steps steps(*model);
  Checkpointing checkpoints(*model, steps, adaptation, directory, log);
  if (!options.restart) checkpoints.remove_checkpoints();
  const Scene as_read = model->scene();  // without the changes of stages
  std::optional<EarlierResults> earlier;
  if (options.restart) earlier = naming_file(options.scene, [&] { return checkpoints.restore(); });
  Results results(*model, as_read, directory, earlier);
  const auto ending = take_steps(*model, steps, results, checkpoints, adaptation, log, options.should_stop);
  if (ending == Ending::inaccurate && adaptation.goes_on()) {
    adaptation.refine(*comm);
    return ending;
  }
  report_costs(*model, log);
  for (const auto& line : results.fracture_digest()) log.info("{}", line);
  return ending;
}

/// Runs the scene, repeatedly with Accuracy. The log file is opened once the directory is reserved for this run.
Ending run(const RunOptions& options, const std::string& directory, io::DirectoryLock& lock, base::Log& log,
           RCP<const Comm> comm, std::string& task) {
  const int n_ranks = comm->getSize();
  log.info("sprekk {}: {} on {} {}", version(), options.scene, n_ranks, n_ranks == 1 ? "rank" : "ranks");
  const bool reserved = base::any_rank(*comm, [&] { return options.reserved; });  // perhaps not set on other ranks
  const auto reserve = [&] {
    if (reserved)
      io::make_directory(*comm, directory);
    else if (const auto why = lock.take(); !why.empty())
      log.warning("{}: its file system has no locks ({}): ensure that no other run writes there", directory, why);
    log.open(directory + "/log.txt", options.restart);
  };
  if (lock.has_directory()) reserve();
  Adaptation adaptation;
  auto ending = run_once(options, directory, reserve, adaptation, log, comm, task);
  while (ending == Ending::inaccurate && adaptation.goes_on())
    ending = run_once(options, directory, reserve, adaptation, log, comm, task);
  for (const auto& verdict : adaptation.verdicts())
    if (!verdict.reached) log.warning("{}: not reached, for {}", verdict.line(), adaptation.why());
  log.info("results in {}", directory);
  log.check_file();
  return ending;
}

}  // namespace

Ending run(const RunOptions& options, RCP<const Comm> comm) {
  base::Log log(*comm, options.prints_log);
  const std::string directory = options.output.empty() ? default_directory(options) : options.output;
  io::DirectoryLock lock(comm, directory);
  std::string task = options.scene + ": making the mesh and the equations";
  try {
    return run(options, directory, lock, log, comm, task);
  } catch (const std::bad_alloc&) {  // perhaps on this rank only
    const auto message = fmt::format("{}: {}", task, base::out_of_memory());
    log.error(message);
    throw std::runtime_error(message);
  } catch (const std::exception& error) {
    log.error(error.what());
    throw;
  }
}

std::size_t check(const RunOptions& options, RCP<const Comm> comm) {
  const Scene scene = read_scene(*comm, options.scene, options.overrides);
  return naming_file(options.scene, [&] {
    Model model(scene, comm);
    model.system().set_time(scene.time.times().front(), scene.time.times().front() - scene.time.start);
    const Probes probes(model);
    const auto warnings = model.warnings();
    if (options.strict) base::throw_errors(warnings);
    base::Log log(*comm, false);
    for (const auto& warning : warnings) log.warning("{}", warning);
    return warnings.size();
  });
}

std::string mesh_info(const std::string& path, const std::vector<std::string>& fractures) {
  mesh::MshOptions options;
  for (const auto& name : fractures) options.fractures[std::string(base::trimmed(name))];
  try {
    return mesh::to_text(mesh::describe(mesh::read_msh(path, options)));
  } catch (const Error& error) {
    const std::string message = error.what();
    if (message.find("among the fractures") == std::string::npos) throw;
    throw Error(message + "; this command lists fractures by --fractures a,b");
  }
}

std::string reference() {
  auto point = base::specification<laboratory::PointPath>("Point");
  point.meaning =
      "path of a joint at one point, for `sprekk point` only; several points: sections with these entries in "
      "`Specimens`";
  return "# All parameters\n\nPrinted by `./sprekk reference`. Numbers with a unit may be given in any unit "
         "of the same quantity.\n\n" +
         base::to_markdown(base::specification<Scene>("Sprekk"), "Sprekk") + base::to_markdown(point, "Sprekk > Point");
}

std::string specification() { return base::to_json(base::specification<Scene>("Sprekk")); }

std::string schema() {
  return base::to_relax_ng(
      {base::specification<Scene>("Sprekk"), base::specification<laboratory::PointScene>("Sprekk")});
}

}  // namespace sprekk::model
