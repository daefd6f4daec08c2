/// Polynomials of curved cells: quadratic, Lagrange and Bezier cells of the VTK file format.
///
/// A cell of n nodes has the parameters xi in its reference cell, and f(xi) = sum_i N_i(xi) f_i, positions like
/// values. References: the cube [0, 1]^3, the triangle (0,0), (1,0), (0,1) times [0, 1], the tetrahedron with
/// corners at the origin and on the axes, the pyramid over [0, 1]^2 whose apex is (1/2, 1/2, 1).
/// Spaces. Lagrange: all monomials of the order (of each axis in cubes). Serendipity cells: those of which no
/// two exponents are 2. Pyramid of 13 nodes: P_2 and xy, x^2 y, x y^2 over 1 - z, about the axis (Bedrosian 1992).
/// Nodes are in VTK's order. Bezier cells have Bernstein polynomials of the same numbering; weights of rational
/// ones are taken as 1.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "common/math/vec.h"

namespace palpate {

class CurvedCell {
 public:
  /// That of cells of `type` with `nodes` points; null for linear cells and those that are not known.
  [[nodiscard]] static std::unique_ptr<CurvedCell> make(std::uint8_t type, std::size_t nodes);

  /// The linear cell at its corners: kHexahedron, kWedge, kTetrahedron or kPyramid.
  [[nodiscard]] std::uint8_t linear_type() const noexcept { return linear_; }
  [[nodiscard]] int order() const noexcept { return order_; }
  [[nodiscard]] std::size_t node_count() const noexcept { return nodes_.size(); }
  /// Parameters of the nodes.
  [[nodiscard]] const std::vector<Vec3>& nodes() const noexcept { return nodes_; }
  /// N_i at `xi`, one a node.
  void weights(const Vec3& xi, std::vector<double>& out) const;

 private:
  enum class Space : std::uint8_t { kMonomials, kPyramid, kBernstein };
  void basis(const Vec3& xi, std::vector<double>& out) const;
  void bernstein(const Vec3& xi, std::vector<double>& out) const;
  /// False where the nodes do not determine a polynomial of the space.
  [[nodiscard]] bool invert();

  std::uint8_t linear_ = 0;
  int order_ = 1;
  Space space_ = Space::kMonomials;
  std::vector<Vec3> nodes_;
  std::vector<std::array<int, 3>> exponents_;
  std::vector<double> inverse_;  ///< N = inverse * basis, row by row
};

}  // namespace palpate
