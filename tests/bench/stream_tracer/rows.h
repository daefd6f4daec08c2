/// One row of the comparison, and what both sides share.
#pragma once

#include <string>
#include <vector>

namespace palpate::bench {

inline constexpr double kLength = 10.0;  ///< of a line at most, diagonals

/// A way of tracing with its setting, and what it reached.
struct Row {
  std::string method, parameter;
  double error = 0.0;  // quantile, of the diagonal
  double lines_per_second = 0.0;
};

/// Processor time of this process: what one thread takes, whatever else the machine does.
[[nodiscard]] double processor_seconds();

void print(const Row& row);

/// The fastest row under `error`, or null.
[[nodiscard]] const Row* best(const std::vector<Row>& rows, double error);

}  // namespace palpate::bench
