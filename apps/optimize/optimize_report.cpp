#include "apps/optimize/optimize_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <span>
#include <utility>

#include "apps/output/json_writer.h"

namespace loopgrid {
namespace {

/// "1 node", "2 nodes".
std::string Counted(std::size_t count, const std::string& what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

std::string InFull(InitialGuess start) {
  switch (start) {
    case InitialGuess::kSpanningTree:
      return "spanning tree";
    case InitialGuess::kChordal:
      return "chordal guess";
    case InitialGuess::kNone:
    case InitialGuess::kAuto:
      break;
  }
  return "poses in the file";
}

/// Why this start was the first one.
std::string WhyStart(const OptimizeReport& report) {
  const InitialGuess asked = report.options.init;
  const InitialGuess first = report.trials.front().start;
  if (asked == first) return "as asked for";
  if (report.options.Start() == first) return "Euler angles are compared from there";
  if (asked != InitialGuess::kAuto) return "there is no chordal guess: too little is measured";
  if (first == InitialGuess::kNone) {
    return report.file_error <= static_cast<double>(report.degrees_of_freedom)
               ? "F is there no more than expected"
               : "F is not lower at the chordal guess";
  }
  return "F is lower there than at the poses in the file";
}

std::string FormatTrial(const StartTrial& trial) {
  const OptimizerResult& result = trial.result;
  std::string text =
      fmt::format("F {:.12g} -> {:.12g} in {}", result.initial_error, result.final_error,
                  Counted(static_cast<std::size_t>(result.iterations), "iteration"));
  if (result.uphill_steps > 0) text += fmt::format(" ({} uphill)", result.uphill_steps);
  return fmt::format("{}, {}", text, ToString(result.termination));
}

void AddTrial(const StartTrial& trial, JsonWriter* json) {
  const OptimizerResult& result = trial.result;
  json->BeginObject();
  json->Field("start", ToString(trial.start))
      .Field("error_before", result.initial_error)
      .Field("error_after", result.final_error)
      .Field("iterations", result.iterations)
      .Field("uphill_steps", result.uphill_steps)
      .Field("termination", ToString(result.termination));
  json->EndObject();
}

void AddOptions(const OptimizeOptions& options, JsonWriter* json) {
  json->Key("options").BeginObject();
  json->Field("method", NameOf(kMethods, options.method))
      .Field("parametrization", NameOf(kParametrizations, options.parametrization))
      .Field("init", NameOf(kInitialGuesses, options.init))
      .Field("loss", NameOf(kLosses, options.loss))
      .Field("max_iterations", options.max_iterations)
      .Field("tolerance", options.tolerance)
      .Field("lenient", options.lenient);
  if (options.loss != LossChoice::kNone) {
    json->Field("loss_width", options.Loss().width)
        .Field("robust", NameOf(kRobustSets, options.robust.value_or(RobustSet::kClosures)));
  }
  if (options.relative_to) json->Field("relative_to", *options.relative_to);
  json->EndObject();
}

void AddNotes(const GraphNotes& notes, JsonWriter* json) {
  json->Key("notes").BeginObject();
  json->Field("data_lines", notes.data_lines.count)
      .Field("unknown_tags", notes.unknown_tags.count)
      .Field("indefinite_information", notes.indefinite_information.count)
      .Field("normalized_quaternions", notes.normalized_quaternions.count)
      .Field("guessed_nodes", notes.guessed_nodes)
      .Field("first_data_lines", notes.data_lines.messages)
      .Field("first_unknown_tags", notes.unknown_tags.messages)
      .Field("first_indefinite_information", notes.indefinite_information.messages)
      .Field("first_normalized_quaternions", notes.normalized_quaternions.messages);
  json->EndObject();
}

void AddGraph(const OptimizeReport& report, JsonWriter* json) {
  json->Key("graph").BeginObject();
  json->Field("file", report.options.graph)
      .Field("dimensions", report.dimensions)
      .Field("nodes", report.nodes)
      .Field("landmarks", report.landmarks)
      .Field("sequential_constraints", report.sequential)
      .Field("closures", report.closures)
      .Field("observations", report.observations)
      .Field("components", report.components)
      .Field("held", report.held)
      .Field("fixed_in_file", report.fixed)
      .Field("degrees_of_freedom", report.degrees_of_freedom);
  AddNotes(report.notes, json);
  json->EndObject();
}

void AddResult(const OptimizeReport& report, JsonWriter* json) {
  const OptimizerResult& result = report.result();
  json->Key("error").BeginObject();
  json->Field("before", report.file_error)
      .Field("after", result.final_error)
      .Field("chi2_after", report.final_chi2);
  json->EndObject();
  json->Field("iterations", result.iterations)
      .Field("uphill_steps", result.uphill_steps)
      .Field("termination", ToString(result.termination))
      .Field("converged", result.termination == Termination::kConverged);
}

void AddStarts(const OptimizeReport& report, JsonWriter* json) {
  json->Key("start").BeginObject();
  json->Field("used", ToString(report.trials[report.best].start))
      .Field("first_because", WhyStart(report));
  json->Key("trials").BeginArray();
  for (const StartTrial& trial : report.trials) AddTrial(trial, json);
  json->EndArray().EndObject();
}

void AddCertificate(const OptimizeReport& report, JsonWriter* json) {
  const auto& certificate = report.certificate;
  json->Key("optimality").BeginObject();
  json->Field("explanation", ExplainOptimality(report))
      .Field("is_global", certificate && certificate->kind == OptimalityCertificate::Kind::kGlobal)
      .Key("lower_bound");
  if (certificate) {
    json->Value(certificate->lower_bound);
  } else {
    json->Null();
  }
  json->EndObject();
}

void AddOptimizeTimings(const OptimizeReport& report, JsonWriter* json) {
  json->Key("timings").BeginObject();
  json->Field("total_s", report.total_seconds)
      .Field("reading_s", report.reading_seconds)
      .Field("optimizing_s", report.optimizing_seconds)
      .Field("marginals_s", report.marginals_seconds)
      .Field("writing_s", report.writing_seconds)
      .Field("threads", report.options.threads)
      .Field("peak_memory_mb", report.peak_memory_mb);
  json->EndObject();
}

class Lines {
 public:
  template <typename... Args>
  void Add(const char* name, fmt::format_string<Args...> format, Args&&... args) {
    fmt::format_to(std::back_inserter(text_), "{:<11}", name);
    fmt::format_to(std::back_inserter(text_), format, std::forward<Args>(args)...);
    text_ += '\n';
  }
  std::string Take() { return std::move(text_); }

 private:
  std::string text_;
};

void AddGraph(const OptimizeReport& report, Lines* lines) {
  std::string landmarks;
  if (report.landmarks > 0) {
    landmarks = fmt::format(", {} ({})", Counted(report.landmarks, "landmark"),
                            Counted(report.observations, "observation"));
  }
  lines->Add("graph", "{}D, {}, {} ({} sequential, {}){}", report.dimensions,
             Counted(report.nodes, "node"),
             Counted(report.sequential + report.closures, "constraint"), report.sequential,
             Counted(report.closures, "closure"), landmarks);
  constexpr std::size_t kMostIds = 8;
  const std::span<const std::int64_t> held(report.held);
  lines->Add("held", "{} {}{} ({} fixed in the file; {})", held.size() == 1 ? "node" : "nodes",
             fmt::join(held.first(std::min(kMostIds, held.size())), " "),
             held.size() > kMostIds ? fmt::format(" and {} more", held.size() - kMostIds) : "",
             report.fixed, Counted(report.components, "component"));
}

void AddNotes(const OptimizeReport& report, Lines* lines) {
  const GraphNotes& notes = report.notes;
  const auto add = [lines](const GraphNotes::Kind& kind, const char* one, const char* many) {
    if (kind.count == 0) return;
    lines->Add("note", "{} {}, the first:", kind.count, kind.count == 1 ? one : many);
    for (const std::string& message : kind.messages) lines->Add("", "{}", message);
  };
  add(notes.data_lines, "line with data that are no part of the graph was passed over",
      "lines with data that are no part of the graph were passed over");
  add(notes.unknown_tags, "line with an unknown tag was passed over",
      "lines with an unknown tag were passed over");
  add(notes.indefinite_information,
      "information matrix was replaced by the nearest that is positive semi-definite",
      "information matrices were replaced by the nearest that are positive semi-definite");
  add(notes.normalized_quaternions, "quaternion was not of length 1 and has been normalised",
      "quaternions were not of length 1 and have been normalised");
  if (notes.guessed_nodes > 0) {
    lines->Add("note", "{} got their poses from a spanning tree: the file has edges only",
               Counted(static_cast<std::size_t>(notes.guessed_nodes), "node"));
  }
}

void AddStarts(const OptimizeReport& report, Lines* lines) {
  lines->Add("start", "{}: {}", InFull(report.trials.front().start), WhyStart(report));
  if (report.trials.size() > 1) {
    lines->Add("", "others were tried because the first end {}",
               report.certificate ? "could not be told to be the global optimum"
                                  : "was higher than expected");
  }
  for (std::size_t i = 0; i < report.trials.size(); ++i) {
    const bool is_best = report.trials.size() > 1 && i == report.best;
    lines->Add("", "{:<18} {}{}", InFull(report.trials[i].start), FormatTrial(report.trials[i]),
               is_best ? "  <- kept" : "");
  }
}

void AddResult(const OptimizeReport& report, Lines* lines) {
  const OptimizerResult& result = report.result();
  lines->Add("F before", "{:.12g}", report.file_error);
  lines->Add("F after", "{:.12g}  ({} degrees of freedom)", result.final_error,
             report.degrees_of_freedom);
  if (report.robust > 0 || report.options.parametrization != Parametrization::kManifold) {
    lines->Add("chi2", "{:.12g}: the plain sum of e^T Omega e, e as g2o defines it",
               report.final_chi2);
  }
  if (report.robust > 0) {
    lines->Add("outliers", "{} of {} are off by more than {} sigma", report.outliers, report.robust,
               report.options.Loss().width);
  }
  const bool is_unfinished = result.termination == Termination::kMaxIterations;
  lines->Add("end", "{} after {}{}", ToString(result.termination),
             Counted(static_cast<std::size_t>(result.iterations), "iteration"),
             is_unfinished ? ": not converged, more of them (--max-iterations) may lower F" : "");
  lines->Add("optimum", "{}", ExplainOptimality(report));
}

}  // namespace

std::string ExplainOptimality(const OptimizeReport& report) {
  if (report.options.parametrization != Parametrization::kManifold) {
    return "not tested: the test is for errors on the manifold";
  }
  if (!report.certificate) return "not tested: the test is for sums of squares, not robust losses";
  const OptimalityCertificate& certificate = *report.certificate;
  const char* verdict = ToString(certificate.kind);
  switch (certificate.kind) {
    case OptimalityCertificate::Kind::kGlobal:
      return fmt::format("{}: by Lagrangian duality no poses have a lower F", verdict);
    case OptimalityCertificate::Kind::kBounded:
      return fmt::format("{}: by Lagrangian duality no poses have F below {:.12g}", verdict,
                         certificate.lower_bound);
    case OptimalityCertificate::Kind::kUnknown:
      break;
  }
  return fmt::format("{} (by Lagrangian duality, which proves but does not disprove)", verdict);
}

std::string FormatOptimizeJson(const OptimizeReport& report) {
  JsonWriter json(JsonWriter::Layout::kIndented);
  json.BeginObject().Field("program", "loopgrid").Field("version", LOOPGRID_VERSION);
  AddOptions(report.options, &json);
  AddGraph(report, &json);
  AddResult(report, &json);
  AddStarts(report, &json);
  AddCertificate(report, &json);
  if (report.robust > 0) {
    json.Key("robust").BeginObject();
    json.Field("constraints", report.robust).Field("outliers", report.outliers).EndObject();
  }
  json.Field("files", report.files);
  AddOptimizeTimings(report, &json);
  json.EndObject();
  return json.Take() + '\n';
}

std::string FormatOptimizeSummary(const OptimizeReport& report) {
  Lines lines;
  AddGraph(report, &lines);
  AddNotes(report, &lines);
  AddStarts(report, &lines);
  AddResult(report, &lines);
  lines.Add("time",
            "{:.3f} s: reading {:.3f}, optimising {:.3f}, covariances {:.3f}, writing {:.3f}",
            report.total_seconds, report.reading_seconds, report.optimizing_seconds,
            report.marginals_seconds, report.writing_seconds);
  for (std::size_t i = 0; i < report.files.size(); ++i) {
    lines.Add(i == 0 ? "files" : "", "{}", report.files[i]);
  }
  return lines.Take();
}

}  // namespace loopgrid
