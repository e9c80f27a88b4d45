#include "apps/output/closure_fields.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>

namespace loopgrid {
namespace {

Closure SomeClosure() {
  Closure closure;
  closure.from = 3;
  closure.to = 41;
  closure.timestamp = 976052857.375;
  closure.distance_sigmas = 1.234567;
  closure.score = 0.654321;
  closure.T_from_to = SE2(3.0, -4.0, 1.0);
  closure.chi2 = 2.0 / 3.0;
  closure.outcome = ClosureOutcome::kLowScore;
  return closure;
}

std::string ObjectOf(const Closure& closure,
                     void (*add)(const Closure& closure, JsonWriter* writer)) {
  JsonWriter writer(JsonWriter::Layout::kOneLine);
  writer.BeginObject();
  add(closure, &writer);
  return writer.EndObject().Take();
}

TEST(ClosureFields, OfAnEvent) {
  EXPECT_EQ(ObjectOf(SomeClosure(), AddClosureEventFields),
            R"({"from":3,"to":41,"outcome":"low-score","score":0.6543,"chi2":0.6667,)"
            R"("reason":"the scans do not fit well enough"})");
}

TEST(ClosureFields, OfThePage) {
  EXPECT_EQ(ObjectOf(SomeClosure(), AddClosurePageFields),
            R"({"from":3,"to":41,"time":976052857.375,"outcome":"low-score",)"
            R"("reason":"the scans do not fit well enough","score":0.654,"distance":5.00,)"
            R"("distance_sigmas":1.23})");
}

TEST(ClosureFields, NumbersThatJsonDoesNotHaveAreNullAndInCsvAreWords) {
  Closure closure = SomeClosure();
  closure.chi2 = std::numeric_limits<double>::infinity();
  EXPECT_NE(ObjectOf(closure, AddClosureEventFields).find(R"("chi2":null)"), std::string::npos);
  EXPECT_NE(ClosureCsvLine(closure).find(",inf,low-score"), std::string::npos);
}

}  // namespace
}  // namespace loopgrid
