// Compiled twice, see fit_kernel.h: nothing here may be shared with other files.
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "common/field/tensor/fit_kernel.h"

namespace palpate {
inline namespace PALPATE_PACK {
namespace {

constexpr std::size_t kN = kFitUnknowns;
using Unknowns = std::array<Pack4, kN>;
/// Lower triangle, column after column: m[c][r - c].
using Triangle = std::array<Unknowns, kN>;

/// One column of the normal matrix, and its part of the right side.
template <std::size_t column>
void add_column(const FitFour& four, Triangle& matrix, Unknowns& right) {
  std::array<Pack4, kN - column> sum;
  Pack4 side;
  for (std::size_t i = 0; i < four.rows.size(); ++i) {
    const auto& row = four.rows[i];
    const Pack4 part = row[column] * Pack4::load(four.weights[i]);
    for (std::size_t r = column; r < kN; ++r) sum[r - column] += row[r] * part;
    side += part * Pack4::load(four.logs[i]);
  }
  for (std::size_t r = column; r < kN; ++r) matrix[column][r - column] = sum[r - column];
  right[column] = side;
  if constexpr (column + 1 < kN) add_column<column + 1>(four, matrix, right);
}

/// By factors L D L^T (Golub and Van Loan, Matrix Computations, sec. 4.1). Where a pivot is not above zero
/// the lane has no solution. All loops are of fixed length, for the compiler to unroll.
Mask4 solve(const FitFour& four, Unknowns& x) {
  Triangle m;
  add_column<0>(four, m, x);
  const Pack4 zero, one = Pack4::all(1.0);
  Unknowns inverse;
  Mask4 good = zero < one;
  for (std::size_t c = 0; c < kN; ++c) {
    good = good & (zero < m[c][0]);
    inverse[c] = one / m[c][0];
    for (std::size_t r = c + 1; r < kN; ++r) {
      const Pack4 factor = m[c][r - c] * inverse[c];
      for (std::size_t below = r; below < kN; ++below)
        m[r][below - r] = m[r][below - r] - factor * m[c][below - c];
      x[r] = x[r] - factor * x[c];
    }
  }
  Pack4 sum;
  for (std::size_t c = kN; c-- > 0;) {
    Pack4 rest = x[c];
    for (std::size_t r = c + 1; r < kN; ++r) rest = rest - m[c][r - c] * x[r];
    x[c] = rest * inverse[c];
    sum += x[c];
  }
  // Nothing times a number is nothing, unless that is infinite or none.
  return good & (zero * sum == zero);
}

/// The squares of the signals that the solution predicts, in units of the largest: nothing overflows.
void weigh_by_prediction(FitFour& four, const Unknowns& x) {
  Pack4 largest = Pack4::all(-std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < four.rows.size(); ++i) {
    Pack4 predicted;
    for (std::size_t r = 0; r < kN; ++r) predicted += four.rows[i][r] * x[r];
    largest = max(largest, predicted);
    predicted.store(four.weights[i]);
  }
  for (FitFour::Lanes& weights : four.weights) {
    (2.0 * (Pack4::load(weights) - largest)).store(weights);
    for (double& weight : weights) weight = std::exp(weight);
  }
}

}  // namespace

unsigned fit_four(FitFour& four) noexcept {
  Unknowns best;
  const Mask4 good = solve(four, best);
  Mask4 going = good;
  for (int n = 0; n < four.reweighted && bits(going) != 0; ++n) {
    weigh_by_prediction(four, best);
    Unknowns next;
    going = going & solve(four, next);
    for (std::size_t r = 0; r < kN; ++r) best[r] = select(going, next[r], best[r]);
  }
  for (std::size_t r = 0; r < kN; ++r) best[r].store(four.solution[r]);
  return bits(good);
}

}  // namespace PALPATE_PACK
}  // namespace palpate
