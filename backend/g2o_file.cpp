#include "backend/g2o_file.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <string_view>
#include <unordered_map>

#include "backend/base/atomic_file.h"
#include "backend/base/error.h"
#include "backend/base/line_reader.h"
#include "backend/base/parse_number.h"

namespace loopgrid {
namespace {

/// Up to rounding in the file: eigenvalues may be below zero by this share of the largest.
constexpr double kIndefiniteTolerance = 1e-9;

bool IsPositiveSemidefinite(const Eigen::Matrix3d& matrix) {
  if ((matrix.diagonal().array() < 0.0).any()) return false;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(matrix, Eigen::EigenvaluesOnly);
  const Eigen::Vector3d& values = solver.eigenvalues();  // ascending
  return values[0] >= -kIndefiniteTolerance * values[2];
}

/// A field as a message shows it: short, and on one line whatever bytes it holds.
std::string Quoted(std::string_view field) {
  constexpr std::size_t kLongest = 40;
  std::string text(field.substr(0, kLongest));
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return "'" + text + "'";
}

class G2oReader {
 public:
  explicit G2oReader(const std::string& path) : lines_(path) {}

  G2oGraph Read();

 private:
  /// A mention of a vertex, which may be defined later in the file.
  struct Mention {
    std::int64_t id;
    std::int64_t line;
  };

  void ReadVertex(FieldCursor* fields);
  void ReadEdge(FieldCursor* fields);
  void ReadFix(FieldCursor* fields);
  void RequireEnd(FieldCursor* fields) const;
  int Resolve(const Mention& mention) const;

  template <std::size_t kCount>
  std::array<double, kCount> ReadNumbers(FieldCursor* fields, const char* expected) const {
    std::array<double, kCount> numbers;
    for (double& number : numbers) {
      const std::string_view field = fields->Next();
      if (!ParseNumber(field, &number)) throw BadField(field, expected);
    }
    return numbers;
  }
  std::int64_t ReadId(FieldCursor* fields, const char* expected) const {
    std::int64_t id = 0;
    const std::string_view field = fields->Next();
    if (!ParseNumber(field, &id)) throw BadField(field, expected);
    return id;
  }
  Error BadField(std::string_view field, const char* expected) const {
    if (field.empty()) return lines_.ErrorHere(fmt::format("cut short, expected {}", expected));
    return lines_.ErrorHere(
        fmt::format("{} is not a finite number, expected {}", Quoted(field), expected));
  }

  LineReader lines_;
  G2oGraph result_;
  std::unordered_map<std::int64_t, int> node_of_id_;
  std::vector<std::array<Mention, 2>> ends_;  // of the edges
  std::vector<Mention> fixed_;
};

G2oGraph G2oReader::Read() {
  std::string_view line;
  while (lines_.Next(&line)) {
    if (lines_.too_long()) throw lines_.ErrorHere("the line is too long for a g2o file");
    FieldCursor fields(line);
    const std::string_view tag = fields.Next();
    if (tag.empty() || tag.front() == '#') continue;
    if (tag == "EDGE_SE2") {
      ReadEdge(&fields);
    } else if (tag == "VERTEX_SE2") {
      ReadVertex(&fields);
    } else if (tag == "FIX") {
      ReadFix(&fields);
    } else {
      throw lines_.ErrorHere(
          fmt::format("unknown tag {}, expected VERTEX_SE2, EDGE_SE2 or FIX", Quoted(tag)));
    }
  }
  if (result_.ids.empty()) {
    throw Error(ErrorCode::kInput, lines_.path() + ": no VERTEX_SE2 line, expected a g2o file");
  }
  PoseGraph<SE2>& graph = result_.graph;
  for (std::size_t k = 0; k < ends_.size(); ++k) {
    graph.constraints[k].from = Resolve(ends_[k][0]);
    graph.constraints[k].to = Resolve(ends_[k][1]);
  }
  for (const Mention& mention : fixed_) graph.fixed.push_back(Resolve(mention));
  std::sort(graph.fixed.begin(), graph.fixed.end());
  graph.fixed.erase(std::unique(graph.fixed.begin(), graph.fixed.end()), graph.fixed.end());
  return std::move(result_);
}

void G2oReader::ReadVertex(FieldCursor* fields) {
  constexpr const char* kExpected = "VERTEX_SE2 id x y theta";
  const std::int64_t id = ReadId(fields, kExpected);
  const auto [x, y, theta] = ReadNumbers<3>(fields, kExpected);
  RequireEnd(fields);
  if (!node_of_id_.emplace(id, static_cast<int>(result_.ids.size())).second) {
    throw lines_.ErrorHere(fmt::format("vertex {} for the second time", id));
  }
  result_.ids.push_back(id);
  result_.graph.poses.emplace_back(x, y, theta);
}

void G2oReader::ReadEdge(FieldCursor* fields) {
  constexpr const char* kExpected = "EDGE_SE2 from to x y theta I11 I12 I13 I22 I23 I33";
  const std::int64_t from = ReadId(fields, kExpected);
  const std::int64_t to = ReadId(fields, kExpected);
  const auto [x, y, theta] = ReadNumbers<3>(fields, kExpected);
  const auto upper = ReadNumbers<6>(fields, kExpected);
  RequireEnd(fields);
  if (from == to) throw lines_.ErrorHere(fmt::format("the edge joins vertex {} to itself", from));
  Constraint<SE2> constraint;
  constraint.T_from_to = SE2(x, y, theta);
  constraint.information << upper[0], upper[1], upper[2],  //
      upper[1], upper[3], upper[4],                        //
      upper[2], upper[4], upper[5];
  if (!IsPositiveSemidefinite(constraint.information)) {
    throw lines_.ErrorHere("the information matrix is not positive semi-definite");
  }
  result_.graph.constraints.push_back(constraint);
  ends_.push_back({Mention{from, lines_.line_number()}, Mention{to, lines_.line_number()}});
}

void G2oReader::ReadFix(FieldCursor* fields) {
  do {
    fixed_.push_back({ReadId(fields, "FIX id ..."), lines_.line_number()});
  } while (!fields->AtEnd());
}

void G2oReader::RequireEnd(FieldCursor* fields) const {
  if (fields->AtEnd()) return;
  throw lines_.ErrorHere(fmt::format("{} follows the last field, expected the end of the line",
                                     Quoted(fields->Next())));
}

int G2oReader::Resolve(const Mention& mention) const {
  const auto place = node_of_id_.find(mention.id);
  if (place != node_of_id_.end()) return place->second;
  throw Error(ErrorCode::kInput, fmt::format("{}:{}: vertex {} is not in the file", lines_.path(),
                                             mention.line, mention.id));
}

}  // namespace

G2oGraph ReadG2o(const std::string& path) { return G2oReader(path).Read(); }

std::string FormatG2o(const PoseGraph<SE2>& graph, const std::vector<std::int64_t>& ids) {
  const auto id = [&](int node) {
    return ids.empty() ? std::int64_t{node} : ids[static_cast<std::size_t>(node)];
  };
  std::string text;
  auto out = std::back_inserter(text);
  for (int node = 0; node < static_cast<int>(graph.poses.size()); ++node) {
    const SE2& pose = graph.poses[static_cast<std::size_t>(node)];
    fmt::format_to(out, "VERTEX_SE2 {} {} {} {}\n", id(node), pose.x(), pose.y(), pose.theta());
  }
  for (int node : graph.fixed) fmt::format_to(out, "FIX {}\n", id(node));
  for (const Constraint<SE2>& constraint : graph.constraints) {
    const SE2& T = constraint.T_from_to;
    const Eigen::Matrix3d& I = constraint.information;
    fmt::format_to(out, "EDGE_SE2 {} {} {} {} {} {} {} {} {} {} {}\n", id(constraint.from),
                   id(constraint.to), T.x(), T.y(), T.theta(), I(0, 0), I(0, 1), I(0, 2), I(1, 1),
                   I(1, 2), I(2, 2));
  }
  return text;
}

void WriteG2o(const std::string& path, const PoseGraph<SE2>& graph,
              const std::vector<std::int64_t>& ids) {
  WriteFileAtomically(path, FormatG2o(graph, ids));
}

}  // namespace loopgrid
