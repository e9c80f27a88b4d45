#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <string_view>

#include "backend/base/error.h"
#include "backend/base/line_reader.h"
#include "backend/base/parse_number.h"
#include "backend/files/graph_file.h"

namespace loopgrid {

/// Reads a line of a graph file field by field. Whatever is wrong with the line is an Error
/// (kInput) that begins `file:line: `.
class GraphLine {
 public:
  GraphLine(const LineReader& lines, std::string_view text, const GraphReadOptions& options,
            GraphNotes* notes)
      : lines_(lines), fields_(text), options_(options), notes_(notes), tag_(fields_.Next()) {}

  std::string_view tag() const { return tag_; }
  std::int64_t number() const { return lines_.line_number(); }

  /// The fields that follow the tag, as messages show them: "id x y theta".
  void Expect(const char* fields) { expected_ = fields; }

  std::int64_t Id();

  template <int kCount>
  Eigen::Matrix<double, kCount, 1> Numbers() {
    Eigen::Matrix<double, kCount, 1> numbers;
    for (double& number : numbers) number = Number();
    return numbers;
  }

  /// A symmetric matrix from its upper triangle, row by row.
  template <int kSize>
  Eigen::Matrix<double, kSize, kSize> UpperTriangle() {
    Eigen::Matrix<double, kSize, kSize> matrix;
    for (int row = 0; row < kSize; ++row) {
      for (int column = row; column < kSize; ++column) {
        matrix(row, column) = matrix(column, row) = Number();
      }
    }
    return matrix;
  }

  bool AtEnd() { return fields_.AtEnd(); }
  /// Throws if anything follows the last field.
  void End();

  /// Makes the information matrix of the edge between two vertices, given by their ids, positive
  /// semi-definite. Eigenvalues that are negative by rounding (kInformationRounding) become zero.
  /// So do others in lenient reading, which is noted; otherwise they are refused.
  template <int kSize>
  void RequireInformation(std::int64_t from, std::int64_t to,
                          Eigen::Matrix<double, kSize, kSize>* matrix) const;

  GraphNotes* notes() const { return notes_; }
  /// Counts the line, and keeps a message about it if it is one of the first.
  void Note(GraphNotes::Kind* kind, const std::string& message) const;

  Error ErrorHere(const std::string& problem) const { return lines_.ErrorHere(problem); }

 private:
  double Number() {
    FieldCursor field = fields_;
    double number = 0.0;
    if (!fields_.NextDecimal(&number)) throw BadField(field.Next());
    return number;
  }
  Error BadField(std::string_view field) const;

  const LineReader& lines_;
  FieldCursor fields_;
  const GraphReadOptions& options_;
  GraphNotes* notes_;
  std::string_view tag_;
  const char* expected_ = "";
};

}  // namespace loopgrid
