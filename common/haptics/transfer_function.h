/// Haptic transfer functions (Ikits 2006, sec. 6.5): from a measure of the data to a stiffness factor kappa
/// or a drag threshold tau.
///
/// A value of fixed size, without storage of its own. Between knots (m_i, y_i) with rising m_i it is linear,
/// or smooth: the monotone cubic of Fritsch and Carlson (1980) with the slopes of Fritsch and Butland (1984),
///
///   1 / d_i = (w_1 / s_(i-1) + w_2 / s_i) / (w_1 + w_2),   w_1 = h_(i-1) + 2 h_i,   w_2 = 2 h_(i-1) + h_i
///   (1)
///
/// with s the slopes of the chords and h their widths, and d_i = 0 where s changes sign: it never leaves the
/// range of the two knots beside it. It is constant outside the knots, and smooth ones have no slope there.
/// One knot is a constant.
///
/// As text: `y`, or `m:y,m:y,…`, then `,smooth`; m in the units of the measure, y in SI units.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace palpate {

class HapticTransferFunction {
 public:
  static constexpr int kMaxKnots = 8;

  struct Knot {
    double measure = 0.0;
    double value = 0.0;

    bool operator==(const Knot&) const = default;
  };

  /// The same everywhere.
  HapticTransferFunction(double constant = 0.0) noexcept {  // NOLINT: a constant is a transfer function
    knots_[0].value = constant;
  }
  /// Straight from one knot to the other. @pre low.measure < high.measure.
  HapticTransferFunction(Knot low, Knot high) noexcept : knots_{low, high}, count_(2) {}

  /// From knots with rising measures. @return as read().
  [[nodiscard]] static std::optional<std::string> make(std::span<const Knot> knots, bool smooth,
                                                       HapticTransferFunction& function);
  /// Reads the grammar above; every y is multiplied by `unit` [SI], which options in millimetres make use of.
  /// @return what is wrong, in a few words; nothing where `function` has been read.
  [[nodiscard]] static std::optional<std::string> read(std::string_view text,
                                                       HapticTransferFunction& function, double unit = 1.0);
  /// Reads back to the same bits with the same unit of 1.
  [[nodiscard]] std::string text(double unit = 1.0) const;

  /// The value at `measure`, which is not NaN. @rt Safe.
  [[nodiscard]] double operator()(double measure) const noexcept;

  [[nodiscard]] std::span<const Knot> knots() const noexcept { return {knots_.data(), count_}; }
  [[nodiscard]] bool smooth() const noexcept { return smooth_; }
  [[nodiscard]] bool constant() const noexcept { return count_ == 1; }
  [[nodiscard]] double lowest() const noexcept;   ///< value anywhere; NaN if a knot is
  [[nodiscard]] double highest() const noexcept;  ///< value anywhere; NaN if a knot is

  [[nodiscard]] bool rising() const noexcept;  ///< it falls nowhere

  bool operator==(const HapticTransferFunction&) const = default;

 private:
  [[nodiscard]] std::optional<std::string> problem() const;
  [[nodiscard]] double slope(std::size_t knot) const noexcept;

  std::array<Knot, kMaxKnots> knots_{};
  std::uint32_t count_ = 1;
  bool smooth_ = false;
};

}  // namespace palpate
