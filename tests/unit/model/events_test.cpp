// Events of integrals with known histories.
#include "model/events.hpp"
#include "block.hpp"
#include "model/fracture_table.hpp"

#include <cmath>

namespace sprekk::model::test {
namespace {

using nlohmann::json;

const std::string titles = "fracture,start [min],end [min],slip [m],work [J],half [J],cumulated_work [J]\n";

/// Columns with events of "work" J, with the mean slip and half the work.
std::vector<FractureColumn> columns() {
  FractureColumn work = {"work", "", "J"};
  work.events = {"slip", {"half", "J", [](const std::vector<Real>& v) { return std::make_optional(v[0] / 2); }}};
  return {{"area", "", "m^2"}, work};
}

/// Results of fractures a, b, ... with these works at times in minutes; the mean slip is a tenth of the work.
json results(const std::vector<Real>& times, const std::vector<std::vector<Real>>& works) {
  json all = {{"time_unit", {{"name", "min"}, {"seconds", 60}}}, {"units", {{"mean_slip", "m"}}}};
  for (std::size_t k = 0; k < works.size(); ++k)
    all["single_fractures"].push_back({{"name", std::string(1, static_cast<char>('a' + k))}});
  for (std::size_t i = 0; i < times.size(); ++i) {
    json lists;
    for (const auto& work : works) {
      lists["work"].push_back(work[i]);
      lists["mean_slip"].push_back(work[i] / 10);
    }
    all["steps"].push_back({{"time", 60 * times[i]}, {"single_fractures", lists}});
  }
  return all;
}

/// Consecutive steps are one event. A decrease counts. A fracture with rounding errors has no event. Events are in the
/// order of their ends. A step without lists is ignored.
TEST(Events, HaveKnownChanges) {
  auto content = results({1, 2, 3, 4, 5}, {{0, 10, 10, 20, 40}, {0, 30, 0, 0, 0}, {0, 1e-8, 2e-8, 3e-8, 3e-8}});
  const std::string expected = titles + "a,1,2,1,10,5,10\nb,1,3,6,60,30,70\na,3,5,3,30,15,100\n";
  EXPECT_EQ(events_csv(content, columns(), 0), expected);
  content["steps"].push_back({{"time", 360}});
  EXPECT_EQ(events_csv(content, columns(), 0), expected);
}

/// Steady change is one event; a change much slower than the mean is none.
TEST(Events, DoNotDependOnTheNumberOfSteps) {
  for (const int n : {10, 1000}) {
    std::vector<Real> times, work;
    for (int i = 1; i <= n; ++i) {
      times.push_back(1 + 2. * i / n);
      work.push_back(16 * std::min(times.back() - 1, 1 + 1e-3 * (times.back() - 2)));
    }
    const auto text = events_csv(results(times, {work}), columns(), 60);
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 2) << text;
    EXPECT_EQ(text.rfind(titles + "a,1,2,", 0), 0) << text;
    EXPECT_NEAR(std::stod(text.substr(text.rfind(',') + 1)), 16, 1e-10);
  }
}

/// Rounding errors alone, compared with other quantities of the same unit, have no event.
TEST(Events, AreNotRoundingErrors) {
  auto content = results({1, 2}, {{0, 1e-12}});
  EXPECT_EQ(events_csv(content, columns(), 0), titles + "a,1,2,1e-13,1e-12,5e-13,1e-12\n");
  content["units"]["max_opening"] = "m";
  content["steps"][1]["single_fractures"]["max_opening"] = {-1e-3};
  EXPECT_EQ(events_csv(content, columns(), 0), titles);
  content["units"]["max_opening"] = "mm";
  EXPECT_NE(events_csv(content, columns(), 0), titles);
}

TEST(Events, AreNoneWithoutChanges) {
  EXPECT_EQ(events_csv(results({1, 2}, {{0, 0}, {0, 0}}), columns(), 0), titles);
  EXPECT_EQ(events_csv(results({1}, {{1}}), {{"area", "", "m^2"}}, 0), "");
}

}  // namespace
}  // namespace sprekk::model::test
