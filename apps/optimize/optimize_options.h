#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "apps/cli/choices.h"
#include "backend/global/best_start.h"
#include "backend/graph/parametrization.h"
#include "backend/solve/optimizer.h"

namespace loopgrid {

enum class LossChoice { kNone, kHuber, kCauchy, kGemanMcClure, kGraduated, kDcs };

/// Which constraints a robust loss applies to.
enum class RobustSet {
  kClosures,  ///< those that do not join a node to the next one by id, and observations of
              ///< landmarks
  kAll,
};

inline constexpr std::array kMethods = {Choice{"lm", Method::kLevenbergMarquardt},
                                        Choice{"gn", Method::kGaussNewton},
                                        Choice{"dogleg", Method::kDogLeg}};
inline constexpr std::array kParametrizations = {
    Choice{"manifold", Parametrization::kManifold},
    Choice{"exponential", Parametrization::kExponential}, Choice{"euler", Parametrization::kEuler}};
inline constexpr std::array kInitialGuesses = {Choice{"auto", InitialGuess::kAuto},
                                               Choice{"none", InitialGuess::kNone},
                                               Choice{"spanning-tree", InitialGuess::kSpanningTree},
                                               Choice{"chordal", InitialGuess::kChordal}};
inline constexpr std::array kLosses = {
    Choice{"none", LossChoice::kNone},     Choice{"huber", LossChoice::kHuber},
    Choice{"cauchy", LossChoice::kCauchy}, Choice{"geman-mcclure", LossChoice::kGemanMcClure},
    Choice{"gnc", LossChoice::kGraduated}, Choice{"dcs", LossChoice::kDcs}};
inline constexpr std::array kRobustSets = {Choice{"closures", RobustSet::kClosures},
                                           Choice{"all", RobustSet::kAll}};

/// Options of `loopgrid optimize`. An output with an empty name is not written.
struct OptimizeOptions {
  std::string graph;                        ///< the graph to read: g2o or TORO, 2D or 3D
  std::string out;                          ///< the optimised graph, TORO or g2o by its name
  std::string picture;                      ///< PNG: the graph before and after
  std::string trace;                        ///< CSV: F after every step
  std::string marginals;                    ///< CSV: covariances of nodes and landmarks
  std::optional<std::int64_t> relative_to;  ///< id of the node that the covariances are relative to
  Method method = Method::kLevenbergMarquardt;
  Parametrization parametrization = Parametrization::kManifold;
  InitialGuess init = InitialGuess::kAuto;
  LossChoice loss = LossChoice::kNone;
  std::optional<double> loss_width;  ///< standard deviations
  std::optional<RobustSet> robust;
  int max_iterations = OptimizerOptions().max_iterations;
  /// Share of F. It is smaller than the poses need, so that F can be compared with published optima
  /// digit by digit.
  double tolerance = 1e-10;
  int threads = AllCores();
  bool lenient = false;  ///< as in GraphReadOptions
  bool json = false;     ///< print JSON instead of text
  bool quiet = false;    ///< do not show progress

  /// Throws Error (kUsage) naming what is wrong. Messages of the library name its own fields;
  /// Execute() replaces them by the options.
  void Validate() const;

  OptimizerOptions Solver() const;
  RobustLoss Loss() const;
  /// `init`; but kNone instead of kAuto with Euler angles. They are for comparison, which needs the
  /// same start.
  InitialGuess Start() const;

  static int AllCores();
};

}  // namespace loopgrid
