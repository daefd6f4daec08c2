/// Sums of divided differences of exponentials: the functions of time that an affine flow is made of.
///
///   f(t) = sum_S c_S E[S](t)                                                                       (1)
///
/// over subsets S of four nodes nu, with E[S](t) the divided difference of exp(nu t) on S (McCurdy, Ng,
/// Parlett 1984). It is defined for equal nodes, and has no cancellation where nodes are far apart.
/// Differentiation maps such sums to such sums:
///
///   (D - nu_a) E[S] = E[S without a]                            if a is in S,
///                   = (nu_s - nu_a) E[S] + E[S without s]         for any s in S                       (2)
#pragma once

#include <array>
#include <complex>

namespace palpate {

/// Four nodes, real or with one complex pair.
struct ExponentialNodes {
  using Complex = std::complex<double>;

  std::array<Complex, 4> nu{};
  bool complex = false;  ///< if not, all imaginary parts are zero
};

/// Divided differences at one time, computed when asked for.
class DividedDifferences {
 public:
  using Nodes = ExponentialNodes;
  using Complex = Nodes::Complex;

  DividedDifferences(const Nodes& nodes, double t) : nodes_(nodes), t_(t) {}

  /// E[S], S given by its bits. `Number` is double where the nodes are real, else Complex.
  template <class Number>
  [[nodiscard]] Number get(unsigned set);

 private:
  template <class Number>
  [[nodiscard]] Number node(int k) const;
  template <class Number>
  [[nodiscard]] Number compute(unsigned set);
  template <class Number>
  [[nodiscard]] Number series(const std::array<int, 4>& index, int count) const;

  const Nodes& nodes_;
  double t_;
  unsigned known_ = 0u;
  std::array<Complex, 16> values_{};
};

/// Four functions (1), one a face, over the same nodes.
class ExponentialForm {
 public:
  using Nodes = ExponentialNodes;
  using Complex = Nodes::Complex;
  using Four = std::array<double, 4>;

  [[nodiscard]] std::array<Complex, 4>& operator[](unsigned set) { return coefficient_[set]; }
  [[nodiscard]] const std::array<Complex, 4>& operator[](unsigned set) const { return coefficient_[set]; }
  /// Adds c to the coefficient of `set`, face by face.
  void add(unsigned set, const std::array<Complex, 4>& c);

  /// (D - nu_node) f, by (2).
  [[nodiscard]] ExponentialForm annihilated(const Nodes& nodes, int node) const;

  [[nodiscard]] Four value(const Nodes& nodes, double t) const;
  /// Of one face.
  [[nodiscard]] double value(const Nodes& nodes, double t, std::size_t face) const;
  /// The sum of the terms of (1) without their signs, of the face where it is largest: in units of 2^-53 that is what
  /// rounding leaves open of value() (running error, Higham 2002, 3.3).
  [[nodiscard]] double magnitude(const Nodes& nodes, double t) const;

 private:
  std::array<std::array<Complex, 4>, 16> coefficient_{};
  unsigned used_ = 0u;  ///< sets with a coefficient
};

}  // namespace palpate
