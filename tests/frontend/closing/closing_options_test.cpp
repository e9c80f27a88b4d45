#include "frontend/closing/closing_options.h"

#include <gtest/gtest.h>

#include <string>

#include "backend/base/error.h"

namespace loopgrid {
namespace {

template <typename Options>
std::string ClosingRefusal(const Options& options) {
  try {
    options.Validate();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kUsage);
    return error.what();
  }
  return {};
}

TEST(ClosingOptions, TheDefaultsAreGood) { EXPECT_EQ(ClosingRefusal(ClosingOptions()), ""); }

TEST(ClosingOptions, NamesTheFieldItsValueAndItsBounds) {
  ClosureGateOptions gate;
  gate.gate_sigmas = 0.0;
  EXPECT_EQ(ClosingRefusal(gate), "gate_sigmas is 0, expected 0.1 to 100");
  ClosureVerifierOptions verifier;
  verifier.min_agreeing = 0;
  EXPECT_EQ(ClosingRefusal(verifier), "min_agreeing is 0, expected 1 to 1e+06");
  ClosureGraphOptions graph;
  graph.relative_decrease = 1.5;
  EXPECT_EQ(ClosingRefusal(graph), "relative_decrease is 1.5, expected 0 to 1");
}

}  // namespace
}  // namespace loopgrid
