#include "backend/files/graph_line.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cstddef>

namespace loopgrid {
namespace {

/// Up to rounding in the file: eigenvalues may be below zero by this share of the largest.
constexpr double kIndefiniteTolerance = 1e-9;

template <int kSize>
bool IsPositiveSemidefinite(const Eigen::Matrix<double, kSize, kSize>& matrix) {
  if ((matrix.diagonal().array() < 0.0).any()) return false;
  using Matrix = Eigen::Matrix<double, kSize, kSize>;
  const Eigen::LLT<Matrix> factor(matrix);  // definite in most files, and far faster
  if (factor.info() == Eigen::Success && factor.matrixLLT().allFinite()) return true;
  const Eigen::SelfAdjointEigenSolver<Matrix> solver(matrix, Eigen::EigenvaluesOnly);
  const auto& values = solver.eigenvalues();  // ascending
  return values[0] >= -kIndefiniteTolerance * values[kSize - 1];
}

}  // namespace

std::int64_t GraphLine::Id() {
  std::int64_t id = 0;
  const std::string_view field = fields_.Next();
  if (!ParseNumber(field, &id)) throw BadField(field);
  return id;
}

void GraphLine::End() {
  if (fields_.AtEnd()) return;
  throw ErrorHere(fmt::format("{} follows the last field, expected the end of the line",
                              Quoted(fields_.Next())));
}

template <int kSize>
void GraphLine::RequireInformation(const Eigen::Matrix<double, kSize, kSize>& matrix) const {
  if (!matrix.allFinite()) throw ErrorHere("the information matrix is not finite");
  if (IsPositiveSemidefinite(matrix)) return;
  throw ErrorHere("the information matrix is not positive semi-definite");
}

template void GraphLine::RequireInformation<2>(const Eigen::Matrix<double, 2, 2>&) const;
template void GraphLine::RequireInformation<3>(const Eigen::Matrix<double, 3, 3>&) const;
template void GraphLine::RequireInformation<6>(const Eigen::Matrix<double, 6, 6>&) const;

void GraphLine::Note(GraphNotes::Kind* kind, const std::string& message) const {
  ++kind->count;
  if (kind->messages.size() < GraphNotes::Kind::kMostMessages) {
    kind->messages.push_back(lines_.Where() + message);
  }
}

Error GraphLine::BadField(std::string_view field) const {
  const std::string expected = fmt::format("expected {} {}", tag_, expected_);
  if (field.empty()) return ErrorHere("cut short, " + expected);
  return ErrorHere(fmt::format("{} is not a finite number, {}", Quoted(field), expected));
}

}  // namespace loopgrid
