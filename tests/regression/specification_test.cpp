#include "base/units.hpp"
#include "model/scene.hpp"

#include <gtest/gtest.h>

namespace sprekk::model {
namespace {

void expect_units(const base::SectionSpecification& section) {
  for (const auto& entry : section.entries)
    EXPECT_TRUE(entry.unit == "-" || base::defect_of_unit(entry.unit).empty()) << entry.name << ": " << entry.unit;
  for (const auto& inner : section.sections) expect_units(inner);
}

TEST(Specification, every_unit_can_be_converted) {
  const auto scene = base::specification<Scene>("Sprekk");
  EXPECT_GE(scene.sections.size(), 10u);
  expect_units(scene);
}

}  // namespace
}  // namespace sprekk::model
