#include "apps/optimize/optimize_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <thread>

#include "apps/output/png_name.h"
#include "backend/base/error.h"

namespace loopgrid {
namespace {

void Require(bool good, const char* problem) {
  if (!good) throw Error(ErrorCode::kUsage, problem);
}

LossKind KindOf(LossChoice loss) {
  switch (loss) {
    case LossChoice::kNone:
      return LossKind::kQuadratic;
    case LossChoice::kHuber:
      return LossKind::kHuber;
    case LossChoice::kCauchy:
      return LossKind::kCauchy;
    case LossChoice::kGemanMcClure:
    case LossChoice::kGraduated:
      return LossKind::kGemanMcClure;
    case LossChoice::kDcs:
      return LossKind::kDcs;
  }
  return LossKind::kQuadratic;
}

}  // namespace

int OptimizeOptions::AllCores() {
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

RobustLoss OptimizeOptions::Loss() const {
  RobustLoss result;
  result.kind = KindOf(loss);
  result.width = loss_width.value_or(result.width);
  return result;
}

InitialGuess OptimizeOptions::Start() const {
  const bool is_comparison = parametrization == Parametrization::kEuler;
  return init == InitialGuess::kAuto && is_comparison ? InitialGuess::kNone : init;
}

OptimizerOptions OptimizeOptions::Solver() const {
  OptimizerOptions solver;
  solver.method = method;
  solver.parametrization = parametrization;
  solver.max_iterations = max_iterations;
  solver.relative_decrease = tolerance;
  solver.loss = Loss();
  solver.graduated = loss == LossChoice::kGraduated;
  solver.threads = threads;
  solver.trace = !trace.empty();
  return solver;
}

void OptimizeOptions::Validate() const {
  constexpr int kMostThreads = 1024;
  if (threads < 1 || threads > kMostThreads) {
    throw Error(ErrorCode::kUsage,
                fmt::format("--threads is {}, expected 1 to {}", threads, kMostThreads));
  }
  Require(loss != LossChoice::kNone || !loss_width.has_value(),
          "--loss-width without --loss: there is no loss to be that wide");
  Require(loss != LossChoice::kNone || !robust.has_value(),
          "--robust without --loss: there is no loss to apply");
  Require(!marginals.empty() || !relative_to.has_value(),
          "--relative-to without --marginals: no covariances are asked for");
  RequirePngName("--picture", picture);
  Solver().Validate();
}

}  // namespace loopgrid
