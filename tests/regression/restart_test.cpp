// Continuation of runs from a checkpoint on another number of ranks.
#include "base/check.hpp"
#include "io/checkpoints.hpp"
#include "model/run.hpp"
#include "source_dir.hpp"

#include <gtest/gtest.h>
#include <Teuchos_DefaultSerialComm.hpp>
#include <Tpetra_Core.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <numeric>
#include <string>
#include <unistd.h>
#include <vector>

namespace sprekk::tests {
namespace {

using Values = std::map<std::string, std::map<GlobalIndex, Real>>;  ///< [vector] [global number] value

/// Runs on the first `ranks` of all ranks; the others wait. Collective.
void run(int ranks, const std::string& output, std::vector<std::string> overrides, bool restart) {
  const auto world = Tpetra::getDefaultComm();
  std::vector<int> members(ranks);
  std::iota(members.begin(), members.end(), 0);
  const auto comm = world->createSubcommunicator(members);
  if (!comm.is_null()) {
    overrides.insert(overrides.end(), {"Output.checkpoints.steps=1", "Output.vtu=false", "Solver.tolerance=1e-13"});
    model::RunOptions options;
    options.scene = source_dir() + "/xml/verification/crossing_3d.xml";
    options.output = output;
    options.overrides = overrides;
    options.restart = restart;
    EXPECT_EQ(model::run(options, comm), model::Ending::completed);
  }
  world->barrier();
}

Values last_checkpoint(const std::string& output, int ranks) {
  std::vector<std::string> damaged;
  const auto checkpoint = io::Checkpoints(rcp(new Teuchos::SerialComm<int>), output + "/checkpoints").read(damaged);
  EXPECT_TRUE(damaged.empty());
  EXPECT_TRUE(std::filesystem::exists(fmt::format("{}/checkpoints/3/piece_{}.h5", output, ranks - 1)));
  EXPECT_FALSE(std::filesystem::exists(fmt::format("{}/checkpoints/3/piece_{}.h5", output, ranks)));
  Values values;
  for (const auto& [name, vector] : checkpoint.vectors) {
    const auto view = vector->getData();
    for (LocalIndex i = 0; i < view.size(); ++i)
      EXPECT_TRUE(values[name].emplace(vector->getMap()->getGlobalElement(i), view[i]).second) << "held twice";
  }
  return values;
}

using Checkpoint = decltype(last_checkpoint("", 1));

/// Compares two checkpoints; on one rank.
void expect_values_to_agree(const Checkpoint& whole, const Checkpoint& parts, std::size_t n_vectors) {
  ASSERT_EQ(whole.size(), n_vectors);
  ASSERT_EQ(parts.size(), whole.size());
  for (const auto& [name, values] : whole) {
    SCOPED_TRACE(name);
    const auto& others = parts.at(name);
    ASSERT_EQ(others.size(), values.size());
    Real largest = 0, difference = 0;
    for (const auto& [number, value] : values) {
      ASSERT_TRUE(others.count(number)) << number;
      largest = std::max(largest, std::abs(value));
      difference = std::max(difference, std::abs(value - others.at(number)));
    }
    if (name.find("runaway slip") == name.npos) EXPECT_GT(largest, 0);  // no runaway slip in this scene
    EXPECT_LE(difference, 1e-10 * largest) << "largest " << largest;
  }
}

/// Compares restarts between numbers of ranks, also of history variables for joint laws with a history.
void expect_values_to_agree(const std::vector<std::string>& laws, std::size_t n_vectors) {
  const auto world = Tpetra::getDefaultComm();
  int id = static_cast<int>(::getpid());
  Teuchos::broadcast(*world, 0, 1, &id);
  const auto folder = std::filesystem::temp_directory_path() / fmt::format("sprekk_restart_{}", id);
  const auto output = [&](int before, int after) { return (folder / fmt::format("{}_{}", before, after)).string(); };
  const auto with = [&](std::vector<std::string> overrides) {
    overrides.insert(overrides.end(), laws.begin(), laws.end());
    return overrides;
  };
  run(1, output(1, 1), laws, false);
  for (const auto& [before, after] : std::vector<std::array<int, 2>>{{1, 2}, {2, 1}, {1, 3}, {3, 2}}) {
    if (std::max(before, after) > world->getSize()) continue;
    SCOPED_TRACE(fmt::format("from {} ranks to {}", before, after));
    run(before, output(before, after), with({"Time.end=2", "Time.steps=2"}), false);
    run(after, output(before, after), laws, true);
    if (world->getRank() == 0)
      expect_values_to_agree(last_checkpoint(output(1, 1), 1), last_checkpoint(output(before, after), after),
                             n_vectors);
  }
  world->barrier();
  if (world->getRank() == 0) std::filesystem::remove_all(folder);
}

TEST(Restart, OnOtherNumbersOfRanksEveryValueAgrees) {
  expect_values_to_agree({}, 6);
  expect_values_to_agree(
      {"Materials.joint.damage=isotropic", "Materials.joint.damage length of friction=0.02",
       "Materials.joint.residual part of friction=0.5", "Materials.joint.closure=Barton-Bandis with memory",
       "Materials.joint.irrecoverable part of closure=0.3"},
      8);
}

}  // namespace
}  // namespace sprekk::tests
