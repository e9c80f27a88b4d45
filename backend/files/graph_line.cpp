#include "backend/files/graph_line.h"

#include <fmt/format.h>

#include <cstddef>
#include <optional>

#include "backend/graph/information.h"

namespace loopgrid {

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
void GraphLine::RequireInformation(std::int64_t from, std::int64_t to,
                                   Eigen::Matrix<double, kSize, kSize>* matrix) const {
  const auto is = [from, to](const std::string& what) {
    return fmt::format("the information matrix between {} and {} is {}", from, to, what);
  };
  if (!matrix->allFinite()) throw ErrorHere(is("not finite"));
  if (const std::optional<double> eigenvalue = NegativeEigenvalue(*matrix)) {
    const std::string problem = is(
        fmt::format("not positive semi-definite: its smallest eigenvalue is {:.6g}", *eigenvalue));
    if (!options_.lenient) throw ErrorHere(problem);
    Note(&notes_->indefinite_information, problem + "; negative ones set to zero");
  }
  *matrix = NearestSemidefinite(*matrix);
  if (!matrix->allFinite()) throw ErrorHere(is("too large"));
}

template void GraphLine::RequireInformation<2>(std::int64_t, std::int64_t, Eigen::Matrix2d*) const;
template void GraphLine::RequireInformation<3>(std::int64_t, std::int64_t, Eigen::Matrix3d*) const;
template void GraphLine::RequireInformation<6>(std::int64_t, std::int64_t,
                                               Eigen::Matrix<double, 6, 6>*) const;

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
