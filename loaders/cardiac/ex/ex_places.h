/// Where an element of an EX model is sampled, and the cells between these places.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "common/math/vec.h"
#include "loaders/cardiac/ex/ex_model.h"

namespace palpate::ex {

/// Equidistant places in an element: of two elements that share a face, whatever their shapes, those on it are the same.
struct ElementPlaces {
  std::vector<Vec3> xi;
  std::vector<bool> inside;                                ///< whether a place is no other element's
  std::vector<std::pair<std::size_t, std::size_t>> edges;  ///< places beside each other along an axis
  std::uint8_t type = 0;                                   ///< VTK's number of the cells' type
  std::vector<std::size_t> corners;                        ///< of all cells, as many each as corner_count
  std::size_t corner_count = 0;
};

/// Hexahedra of a cube, wedges of a wedge, tetrahedra of a tetrahedron. @param refine cells along each axis.
[[nodiscard]] ElementPlaces element_places(const Linked& linked, int refine);

/// "4 x 4 x 4 hexahedra", "64 tetrahedra"
[[nodiscard]] std::string cells_text(const Linked& linked, int refine);

/// A place of the unit cube brought into the element, and by how much volumes shrink there: for quadrature.
[[nodiscard]] std::pair<Vec3, double> from_cube(const Linked& linked, Vec3 xi);

}  // namespace palpate::ex
