#include <CLI/CLI.hpp>
#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "apps/cli/arguments.h"

namespace loopgrid {
namespace {

constexpr const char* kFooter =
    "Files, all of them or none; an output that cannot be written is found out first:\n"
    "  --out        the graph with its new poses: TORO if the name ends in .graph or .toro, else\n"
    "               g2o; .gz at the end packs it\n"
    "  --picture    constraints before and after, landmarks as dots\n"
    "  --trace      iteration, F, chi2 (F without losses and Euler angles), damping, step, "
    "seconds\n"
    "  --marginals  id and the upper triangle of the covariance; nodes in their own frame, order\n"
    "               (x, y, theta) or (x, y, z, vector part of the quaternion), landmarks in the\n"
    "               map's; metres and radians; 0: held, inf: not joined to it";

/// An option that takes one of a few words.
template <typename Value, std::size_t kCount>
CLI::Option* AddChoice(CLI::App* command, const std::string& name, Value preset, auto* field,
                       const std::array<Choice<Value>, kCount>& choices,
                       const std::string& description) {
  std::vector<std::string> names;
  for (const Choice<Value>& choice : choices) names.emplace_back(choice.name);
  const auto set = [field, &choices](const std::string& text) {
    for (const Choice<Value>& choice : choices) {
      if (choice.name == text) *field = choice.value;
    }
  };
  return command->add_option_function<std::string>(name, set, description)
      ->check(CLI::IsMember(names))
      ->default_str(std::string(NameOf(choices, preset)))
      ->type_name("");
}

void AddOutputs(CLI::App* optimize, OptimizeOptions* options) {
  const auto add = [optimize](const char* name, std::string* path, const char* description) {
    RequireName(optimize->add_option(name, *path, description))->type_name("FILE");
  };
  add("--out", &options->out, "Write the optimised graph here");
  add("--picture", &options->picture, "Draw the graph before and after, PNG");
  add("--trace", &options->trace, "Write F after every iteration, CSV (see loopgrid plot)");
  add("--marginals", &options->marginals, "Write the covariances of nodes and landmarks, CSV");
  optimize
      ->add_option("--relative-to", options->relative_to,
                   "Covariances relative to this node [default: to the held node of each part]")
      ->type_name("ID");
}

void AddSolver(CLI::App* optimize, OptimizeOptions* options) {
  AddChoice(optimize, "--method", options->method, &options->method, kMethods,
            "Levenberg-Marquardt, Gauss-Newton or Powell's dog leg");
  AddChoice(optimize, "--parametrization", options->parametrization, &options->parametrization,
            kParametrizations,
            "On the manifold (the tutorial's Algorithm 2), by the exponential map, or as if\n"
            "angles were Euclidean (Algorithm 1)");
  AddChoice(
      optimize, "--init", options->init, &options->init, kInitialGuesses,
      "Where to start; none: at the poses in the file; auto: wherever it takes to get to the\n"
      "optimum, but with euler as none");
  optimize->add_option("--max-iterations", options->max_iterations, "At most so many a start")
      ->capture_default_str()
      ->type_name("N");
  optimize
      ->add_option("--tolerance", options->tolerance,
                   "Done when a step promises to lower F by a smaller share")
      ->capture_default_str()
      ->type_name("SHARE");
  optimize
      ->add_option("--threads", options->threads,
                   "The result does not depend on it [default: all cores]")
      ->type_name("N");
}

void AddLosses(CLI::App* optimize, OptimizeOptions* options) {
  AddChoice(optimize, "--loss", options->loss, &options->loss, kLosses,
            "Robust loss for constraints that may be wrong; gnc: geman-mcclure, graduated");
  optimize
      ->add_option("--loss-width", options->loss_width,
                   "Up to this error the loss is (nearly) the square, standard deviations "
                   "[default: 3]")
      ->type_name("SIGMA");
  AddChoice(optimize, "--robust", RobustSet::kClosures, &options->robust, kRobustSets,
            "What it applies to; closures: what does not join a node to the next one by id");
}

}  // namespace

void AddOptimize(CLI::App* program, OptimizeOptions* options) {
  CLI::App* optimize = program->add_subcommand("optimize", "Find the best poses of a pose graph");
  optimize
      ->add_option("GRAPH", options->graph,
                   "The graph: g2o or TORO, 2D or 3D, may be gzipped; known by content")
      ->required()
      ->type_name("");
  AddOutputs(optimize, options);
  AddSolver(optimize, options);
  AddLosses(optimize, options);
  optimize->add_flag(
      "--lenient", options->lenient,
      "Pass over lines with an unknown tag, and set negative eigenvalues of information\n"
      "matrices to zero [default: refuse the file]");
  optimize->add_flag("--json", options->json, "Print JSON [default: text]");
  optimize->add_flag("--quiet", options->quiet,
                     "Do not show what is going on [default: if standard error is a terminal]");
  optimize->footer(kFooter);
}

}  // namespace loopgrid
