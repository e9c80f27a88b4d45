#include "apps/optimize/optimize_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "apps/cli/interrupt_watch.h"
#include "apps/cli/progress_bar.h"
#include "apps/optimize/graph_picture.h"
#include "apps/optimize/id_order.h"
#include "apps/optimize/optimize_report.h"
#include "apps/output/covariance_csv.h"
#include "apps/output/output_files.h"
#include "apps/output/peak_memory.h"
#include "apps/output/same_file.h"
#include "apps/output/standard_output.h"
#include "apps/output/trace_csv.h"
#include "backend/base/error.h"
#include "backend/base/gzip.h"
#include "backend/base/stopwatch.h"
#include "backend/files/graph_file.h"
#include "backend/global/best_start.h"
#include "backend/global/global_optimality.h"
#include "backend/graph/constraint_error.h"
#include "backend/solve/marginals.h"
#include "backend/solve/normal_equations.h"
#include "mapping/graph_drawing.h"
#include "mapping/pen.h"

namespace loopgrid {
namespace {

std::vector<std::string> WantedOutputs(const OptimizeOptions& options) {
  std::vector<std::string> paths;
  for (const std::string* path :
       {&options.out, &options.picture, &options.trace, &options.marginals}) {
    if (!path->empty()) paths.push_back(*path);
  }
  return paths;
}

void RequireGraphToStay(const OptimizeOptions& options) {
  RequireOtherThanInput("--picture", options.picture, options.graph);
  RequireOtherThanInput("--trace", options.trace, options.graph);
  RequireOtherThanInput("--marginals", options.marginals, options.graph);
}

/// One optimisation from file to files.
template <typename Pose>
class Optimization {
 public:
  Optimization(const OptimizeOptions& options, GraphFile<Pose> file, OptimizeReport* report)
      : options_(options),
        file_(std::move(file)),
        order_(file_.ids.nodes),
        components_(ConnectedComponents(file_.graph)),
        optimizer_(options.Solver()),
        report_(report) {}

  /// Throws Error if the options ask for something that this graph does not allow.
  void Prepare();

  void Optimize();

  void ComputeMarginals();

  void WriteOutputs(OutputFiles* outputs) const;

 private:
  PoseGraph<Pose>& graph() { return file_.graph; }
  const PoseGraph<Pose>& graph() const { return file_.graph; }
  void MarkRobust();
  void Describe();
  void RequireProgress() const;
  bool IsSumOfSquares() const;
  std::size_t CountOutliers() const;
  std::string DrawPicture() const;
  std::string FormatOutput() const;
  [[noreturn]] void Refuse(const std::string& problem) const {
    throw Error(ErrorCode::kInput, options_.graph + ": " + problem);
  }

  const OptimizeOptions& options_;
  GraphFile<Pose> file_;
  IdOrder order_;
  Components components_;
  Optimizer<Pose> optimizer_;
  OptimizeReport* report_;
  PoseGraph<Pose> before_;  // only for a picture
  int reference_ = -1;      // the node that covariances are relative to; -1: the held ones
  std::vector<typename Marginals<Pose>::Covariance> covariances_;
  std::vector<typename Marginals<Pose>::PointCovariance> landmark_covariances_;
};

template <typename Pose>
void Optimization<Pose>::Prepare() {
  if (GraphFormatOf(options_.out) == GraphFormat::kToro && !options_.out.empty() &&
      !graph().landmarks.empty()) {
    throw Error(ErrorCode::kUsage, options_.out + ": the TORO format has no landmarks");
  }
  if (options_.relative_to) {
    const auto& ids = file_.ids.nodes;
    const auto found = std::find(ids.begin(), ids.end(), *options_.relative_to);
    if (found == ids.end()) {
      throw Error(ErrorCode::kUsage, fmt::format("--relative-to is {}, but {} has no such node",
                                                 *options_.relative_to, options_.graph));
    }
    reference_ = static_cast<int>(found - ids.begin());
  }
  MarkRobust();
  Describe();
  if (!options_.picture.empty()) before_ = graph();
}

template <typename Pose>
void Optimization<Pose>::MarkRobust() {
  if (options_.loss == LossChoice::kNone) return;
  const bool all = options_.robust.value_or(RobustSet::kClosures) == RobustSet::kAll;
  for (Constraint<Pose>& constraint : graph().constraints) {
    constraint.robust = all || !order_.AreConsecutive(constraint.from, constraint.to);
    report_->robust += constraint.robust ? 1 : 0;
  }
  for (LandmarkObservation<Pose>& observation : graph().observations) observation.robust = true;
  report_->robust += graph().observations.size();
}

template <typename Pose>
void Optimization<Pose>::Describe() {
  report_->dimensions = Pose::kDof == 3 ? 2 : 3;
  report_->nodes = graph().poses.size();
  report_->landmarks = graph().landmarks.size();
  report_->observations = graph().observations.size();
  for (const Constraint<Pose>& constraint : graph().constraints) {
    ++(order_.AreConsecutive(constraint.from, constraint.to) ? report_->sequential
                                                             : report_->closures);
  }
  const int nodes = static_cast<int>(graph().poses.size());
  for (int node = 0; node < nodes; ++node) {
    if (components_.of_node[static_cast<std::size_t>(node)] == node) ++report_->components;
  }
  for (int node : HeldNodes(graph(), components_)) {
    report_->held.push_back(file_.ids.nodes[static_cast<std::size_t>(node)]);
  }
  report_->fixed = graph().fixed.size();
  report_->degrees_of_freedom = DegreesOfFreedom(graph(), components_);
  report_->file_error = TotalError(graph(), {options_.Loss(), options_.parametrization});
}

template <typename Pose>
void Optimization<Pose>::Optimize() {
  BestStartResult best = OptimizeFromBestStart(&graph(), &optimizer_, options_.Start());
  report_->trials = std::move(best.trials);
  report_->best = best.best;
  RequireProgress();
  report_->certificate = best.certificate;
  if (!report_->certificate && IsSumOfSquares()) report_->certificate = CertifyOptimality(graph());
  report_->final_chi2 = TotalChi2(graph());
  report_->outliers = CountOutliers();
}

template <typename Pose>
void Optimization<Pose>::RequireProgress() const {
  const OptimizerResult& result = report_->result();
  if (!std::isfinite(result.final_error)) Refuse("F is not finite, neither at the start nor later");
  if (result.termination == Termination::kIndefinite && result.iterations == 0) {
    Refuse("cannot be optimised: the Hessian is not positive definite however strongly damped");
  }
}

/// Whether F is TotalChi2. CertifyOptimality works only for that.
template <typename Pose>
bool Optimization<Pose>::IsSumOfSquares() const {
  return options_.parametrization == Parametrization::kManifold && report_->robust == 0;
}

template <typename Pose>
std::size_t Optimization<Pose>::CountOutliers() const {
  const double width = options_.Loss().width;
  std::size_t count = 0;
  const auto look_at = [&](const auto& edges) {
    for (const auto& edge : edges) {
      if (edge.robust && Chi2(graph(), edge) > width * width) ++count;
    }
  };
  look_at(graph().constraints);
  look_at(graph().observations);
  return count;
}

template <typename Pose>
void Optimization<Pose>::ComputeMarginals() {
  const auto marginals = optimizer_.ComputeMarginals(graph());
  if (!marginals) {
    Refuse("there are no covariances: some node or landmark may move without changing F");
  }
  if (reference_ >= 0) {
    auto relative = marginals->RelativeTo(reference_);
    covariances_ = std::move(relative.nodes);
    landmark_covariances_ = std::move(relative.landmarks);
    return;
  }
  covariances_ = marginals->covariances();
  landmark_covariances_ = marginals->landmark_covariances();
  for (std::size_t i = 0; i < landmark_covariances_.size(); ++i) {
    if (components_.of_landmark[i] >= 0) continue;  // an observation joins it to a node
    landmark_covariances_[i].diagonal().setConstant(std::numeric_limits<double>::infinity());
  }
}

template <typename Pose>
std::string Optimization<Pose>::FormatOutput() const {
  const std::string text = FormatGraph(graph(), file_.ids, GraphFormatOf(options_.out));
  return options_.out.ends_with(".gz") ? Gzip(text) : text;
}

template <typename Pose>
std::string Optimization<Pose>::DrawPicture() const {
  const auto title = [](const char* when, double error) {
    return fmt::format("{}: F = {:.9g}", when, error);
  };
  return DrawGraphBeforeAfter(StateOf(before_, title("before", report_->file_error)),
                              StateOf(graph(), title("after", report_->result().final_error)),
                              EdgesOf(graph(), order_), ViewpointFor<Pose>());
}

template <typename Pose>
void Optimization<Pose>::WriteOutputs(OutputFiles* outputs) const {
  const auto write = [outputs](const std::string& path, const auto& format) {
    if (!path.empty()) outputs->Write(path, format());
  };
  write(options_.out, [this] { return FormatOutput(); });
  write(options_.picture, [this] { return DrawPicture(); });
  write(options_.trace, [this] { return FormatTraceCsv(report_->result().trace); });
  write(options_.marginals, [this] {
    return FormatCovarianceCsv<Pose>(file_.ids, covariances_, landmark_covariances_);
  });
}

template <typename Pose>
void Run(const OptimizeOptions& options, GraphFile<Pose> file, OutputFiles* outputs,
         ProgressBar* bar, OptimizeReport* report) {
  Optimization<Pose> optimization(options, std::move(file), report);
  optimization.Prepare();
  outputs->Open();  // if a file cannot be written, fail now and not after a long optimisation

  bar->ShowStage("optimising");
  const Stopwatch optimizing;
  optimization.Optimize();
  report->optimizing_seconds = optimizing.seconds();
  if (!options.marginals.empty()) {
    bar->ShowStage("computing covariances");
    const Stopwatch marginals;
    optimization.ComputeMarginals();
    report->marginals_seconds = marginals.seconds();
  }
  bar->ShowStage("drawing and writing");
  const Stopwatch writing;
  optimization.WriteOutputs(outputs);
  outputs->Commit();
  report->files = outputs->paths();
  report->writing_seconds = writing.seconds();
}

}  // namespace

void OptimizeCommand(const OptimizeOptions& options) {
  const Stopwatch total;
  options.Validate();
  RequireGraphToStay(options);
  OutputFiles outputs(WantedOutputs(options));
  // Made before the threads of the optimiser, and before any file is opened: see InterruptWatch.
  const InterruptWatch watch([&outputs] { outputs.Discard(); });
  if (!options.picture.empty()) DrawingPen();  // if pictures cannot be drawn, fail now
  ProgressBar bar(options.quiet);
  OptimizeReport report;
  report.options = options;
  bar.ShowStage("reading");
  AnyGraphFile file = ReadGraph(options.graph, {.lenient = options.lenient}, &report.notes);
  report.reading_seconds = total.seconds();
  std::visit([&](auto& graph) { Run(options, std::move(graph), &outputs, &bar, &report); }, file);
  report.total_seconds = total.seconds();
  report.peak_memory_mb = PeakMemoryMb();
  bar.Clear();
  PrintToStandardOutput(options.json ? FormatOptimizeJson(report) : FormatOptimizeSummary(report));
}

}  // namespace loopgrid
