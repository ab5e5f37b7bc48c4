// Names of output directories.
#include "model/run.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace sprekk::model::test {
namespace {

using ::testing::MatchesRegex;

std::string directory(const std::vector<std::string>& overrides) {
  RunOptions options;
  options.scene = "xml/new/block.xml";
  options.overrides = overrides;
  return default_directory(options);
}

TEST(Directory, HasTheNamesOfSceneAndOverrides) {
  EXPECT_EQ(directory({}), "output/block");
  EXPECT_EQ(directory({"Time.steps=4", "Time.end=1e-3"}), "output/block-Time.steps=4-Time.end=1e-3");
  EXPECT_EQ(directory({"Bulk.initial pressure=2"}), "output/block-Bulk.initial_pressure=2");
}

TEST(Directory, HasAChecksumIfTheNameIsAmbiguous) {
  const auto braces = directory({"Mesh.cells={2}"}), brackets = directory({"Mesh.cells=[2]"});
  EXPECT_THAT(braces, MatchesRegex("output/block-Mesh.cells=_2_-[0-9a-f]+"));
  EXPECT_THAT(brackets, MatchesRegex("output/block-Mesh.cells=_2_-[0-9a-f]+"));
  EXPECT_NE(braces, brackets);
  const std::string path(200, 'a');
  EXPECT_EQ(directory({path + "=1"}).size(), std::string("output/block").size() + 100 + 9);
  EXPECT_NE(directory({path + "=1"}), directory({path + "=2"}));
}

}  // namespace
}  // namespace sprekk::model::test
