/// Where an exponential form leaves the positive numbers, for certain.
///
/// Between two zeros of f lies one of (D - nu) f for real nu (Rolle, applied to exp(-nu t) f). The chain
/// f, f' (0 is a node), (D - nu) f' ends with a function whose zeros are known in closed form: at most one
/// where all nodes are real, spaced by half periods where two are complex. Each function is monotone, up to
/// a positive factor, between the zeros of the next, so its own are bracketed for certain. Slow spirals cost
/// no work by the turn: where the lower envelope of the turns (a sum of three real exponentials) is positive
/// there is no zero, and the search jumps to where it ends.
///
/// A dip below zero that rounding may have made (kFaceRounding) is none: a line that starts on a face, runs
/// along it or touches it is not sent through it by the last digit of its coordinates.
#pragma once

#include <array>
#include <optional>

#include "common/base/inline_vector.h"
#include "common/trace/exact/exact_cell.h"
#include "common/trace/exact/exponential_form.h"

namespace palpate {

/// The fall of one face's coordinate.
class FirstZero {
 public:
  using Nodes = ExponentialNodes;
  using Form = ExponentialForm;
  using Complex = Nodes::Complex;
  /// Times: at most the zeros in two turns of a complex pair, one for each pair of nodes, and both ends; the
  /// zeros between so many of them.
  using Instants = InlineVector<double, 20>;

  /// @param position f, with node 0 (of value 0) in every set.  @param rate f'.
  /// @param last (D - nu) f' with `annihilated` the index of nu: the real node beside a complex pair, or any.
  FirstZero(const Nodes& nodes, const Form& position, const Form& rate, const Form& last, int annihilated,
            int face);

  [[nodiscard]] double value(double t) const { return position_.value(nodes_, t, face_); }

  struct Fall {
    bool falls = false;
    double time = 0.0;  ///< of the fall; else up to which there is none
  };
  /// Where f first falls below -kFaceRounding in (0, until]: the zero before, or where it passes -kFaceRounding if it was not
  /// positive before. @pre f(0) >= 0.
  [[nodiscard]] Fall find(double until) const;
  /// Where it does so in (from, until], f being -kFaceRounding or more at `from` and less at `until`: one such place.
  [[nodiscard]] double fall_between(double from, double until) const;

 private:
  /// Lower envelope sum_k c_k E[m_0 .. m_k] over three sorted real nodes.
  struct Envelope {
    bool usable = false;
    std::array<double, 3> m{}, c{};
    [[nodiscard]] double value(double t) const;
    [[nodiscard]] std::optional<double> first_zero(double from, double until) const;
  };

  [[nodiscard]] std::optional<double> scan(double from, double until, const Instants& last_zeros) const;
  [[nodiscard]] double fall_between(double from, double until, double at_from, double at_until) const;
  void add_outweighing(Instants& knots) const;
  [[nodiscard]] Fall find_real(double until) const;
  [[nodiscard]] Fall find_complex(double until) const;
  [[nodiscard]] Envelope make_envelope(const Complex& amplitude, const Complex& lambda, double gamma) const;

  const Nodes& nodes_;
  const Form& position_;
  const Form& rate_;
  const Form& last_;
  std::array<int, 2> others_{};  ///< nodes of `last`
  int annihilated_;
  std::size_t face_;
};

}  // namespace palpate
