/// Polynomials of curved cells: quadratic, Lagrange and Bezier cells of the VTK file format.
///
/// A cell of n nodes has the parameters xi in its reference cell, and f(xi) = sum_i N_i(xi) f_i, positions like
/// values. References: the cube [0, 1]^3, the triangle (0,0), (1,0), (0,1) times [0, 1], the tetrahedron with
/// corners at the origin and on the axes, the pyramid over [0, 1]^2 whose apex is (1/2, 1/2, 1).
/// Spaces. Lagrange: all monomials of the order (of each axis in cubes, of the axis and of the triangles in wedges). Serendipity cells: those of which no
/// two exponents are 2. Pyramid of 13 nodes: P_2 and xy, x^2 y, x y^2 over 1 - z, about the axis (Bedrosian 1992).
/// Nodes are in VTK's order. Bezier cells have Bernstein polynomials of the same numbering; rational ones
/// f = sum_i N_i w_i f_i / sum_i N_i w_i with a weight w_i of each control point.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "common/math/vec.h"

namespace palpate {

/// Arrays of a block by these names: the weights of points of Bezier cells, and for each cell its order along each axis.
inline constexpr const char* kRationalWeights = "RationalWeights";
inline constexpr const char* kHigherOrderDegrees = "HigherOrderDegrees";

[[nodiscard]] constexpr bool is_bezier(std::uint8_t type) noexcept { return type >= 78 && type <= 81; }

class CurvedCell {
 public:
  using Orders = std::array<int, 3>;  ///< along each axis of the reference cell

  /// That of cells of `type` with `nodes` points; null for linear cells and those that are not known.
  /// @param orders of Lagrange and Bezier cells; all zero: the one that has so many points, the same along all axes.
  [[nodiscard]] static std::unique_ptr<CurvedCell> make(std::uint8_t type, std::size_t nodes,
                                                        const Orders& orders = {});

  /// The linear cell at its corners: kHexahedron, kWedge, kTetrahedron or kPyramid.
  [[nodiscard]] std::uint8_t linear_type() const noexcept { return linear_; }
  /// The highest.
  [[nodiscard]] int order() const noexcept { return std::max({orders_[0], orders_[1], orders_[2]}); }
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
  Orders orders_{1, 1, 1};
  Space space_ = Space::kMonomials;
  std::vector<Vec3> nodes_;
  std::vector<std::array<int, 3>> exponents_;
  std::vector<double> inverse_;  ///< N = inverse * basis, row by row
};

}  // namespace palpate
