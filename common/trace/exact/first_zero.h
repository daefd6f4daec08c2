/// The first zero of an exponential form, for certain.
///
/// Between two zeros of f lies one of (D - nu) f for real nu (Rolle, applied to exp(-nu t) f). The chain
/// f, f' (0 is a node), (D - nu) f' ends with a function whose zeros are known in closed form: at most one
/// where all nodes are real, spaced by half periods where two are complex. Each function is monotone, up to
/// a positive factor, between the zeros of the next, so its own are bracketed for certain. Slow spirals cost
/// no work by the turn: where the lower envelope of the turns (a sum of three real exponentials) is positive
/// there is no zero, and the search jumps to where it ends.
#pragma once

#include <array>
#include <optional>

#include "common/base/inline_vector.h"
#include "common/trace/exact/exponential_form.h"

namespace palpate {

/// Finds zeros of one face's coordinate. `R` is double or long double.
template <class R>
class FirstZero {
 public:
  using Nodes = ExponentialNodes<R>;
  using Form = ExponentialForm<R>;
  using Real = R;
  using Complex = typename Nodes::Complex;
  /// Times: at most the zeros in two turns of a complex pair, one for each pair of nodes, and both ends; the
  /// zeros between so many of them.
  using Instants = InlineVector<Real, 20>;

  /// @param position f, with node 0 (of value 0) in every set.  @param rate f'.
  /// @param last (D - nu) f' with `annihilated` the index of nu: the real node beside a complex pair, or any.
  FirstZero(const Nodes& nodes, const Form& position, const Form& rate, const Form& last, int annihilated,
            int face);

  [[nodiscard]] Real value(Real t) const { return position_.value(nodes_, t, face_); }

  /// The first zero in (from, until]. f is positive at `from`, or on the face: then `from` itself is reported
  /// if f is negative right after.
  [[nodiscard]] std::optional<Real> find(Real from, Real until) const;

 private:
  /// Lower envelope sum_k c_k E[m_0 .. m_k] over three sorted real nodes.
  struct Envelope {
    bool usable = false;
    std::array<Real, 3> m{}, c{};
    [[nodiscard]] Real value(Real t) const;
    [[nodiscard]] std::optional<Real> first_zero(Real from, Real until) const;
  };

  [[nodiscard]] std::optional<Real> scan(Real from, Real until, const Instants& last_zeros) const;
  void add_outweighing(Instants& knots) const;
  [[nodiscard]] std::optional<Real> find_real(Real from, Real until) const;
  [[nodiscard]] std::optional<Real> find_complex(Real from, Real until) const;
  [[nodiscard]] Envelope make_envelope(const Complex& amplitude, const Complex& lambda, Real gamma) const;

  const Nodes& nodes_;
  const Form& position_;
  const Form& rate_;
  const Form& last_;
  std::array<int, 2> others_{};  ///< nodes of `last`
  int annihilated_;
  std::size_t face_;
};

}  // namespace palpate
