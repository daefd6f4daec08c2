/// An element of an EX model with its parameters gathered: places, tangents, fibre axes.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "common/math/vec.h"
#include "loaders/cardiac/ex/ex_basis.h"
#include "loaders/cardiac/ex/ex_model.h"

namespace palpate::ex {

/// A place in an element.
struct Place {
  Vec3 x{0.0};            ///< Cartesian
  Mat3 tangents{0.0};     ///< columns: dx/dxi_1 to dx/dxi_3
  Vec3 angles{0.0};       ///< [rad] fibre, imbrication, sheet; NaN in an element without fibres
  bool has_axes = false;  ///< false where dx/dxi_1 and dx/dxi_2 span no plane, or no angle is known
  Mat3 axes{0.0};         ///< columns: fibre, sheet, sheet normal; orthonormal
};

/// A component of a field in an element.
struct ElementFunction {
  std::array<Basis, 3> basis{};
  std::vector<double> parameters;
  std::optional<std::array<int, 3>> intervals;  ///< of a grid of which `parameters` are the values
  /// @pre 0 <= xi <= 1.
  [[nodiscard]] Interpolated at(const Vec3& xi) const;
};

/// The field that says where an element is: "coordinates", or the first of three components; null: there is
/// none.
[[nodiscard]] const ElementField* coordinates_of(const std::vector<ElementField>& header);

/// A field in an element: its components, whatever they mean.
class ElementValues {
 public:
  /// @throws Error as ElementShape().
  ElementValues(const Model& model, const Element& element, const ElementField& field,
                const std::string& file);
  /// Appends them. @pre 0 <= xi <= 1.
  void append_at(const Vec3& xi, std::vector<double>& to) const;
  /// Whether they are the same all over the element.
  [[nodiscard]] bool constant() const;

 private:
  std::vector<ElementFunction> components_;
};

class ElementShape {
 public:
  /// Gathers what the element's corners name. @param fibre_field of the header, or null.
  /// @throws Error (bad input) naming `file` and the element where a node, value or factor is missing.
  ElementShape(const Model& model, const Element& element, const ElementField& coordinates,
               const ElementField* fibres, const std::string& file);

  /// @pre 0 <= xi <= 1.
  ///
  /// Fibre axes: dx/dxi_1 is turned about the wall normal dx/dxi_1 x dx/dxi_2 by the fibre angle towards
  /// dx/dxi_2; the fibre is then turned about the axis across it by the imbrication angle, against the normal
  /// where that is positive; last the sheet about the fibre by the sheet angle, from across the fibre towards
  /// the normal. (Convention of OpenCMISS-Zinc's fibre axes; LeGrice et al. 1997.)
  [[nodiscard]] Place at(const Vec3& xi) const;
  [[nodiscard]] bool has_fibres() const noexcept { return !angles_.empty(); }

 private:
  System system_ = System::kCartesian;
  double focus_ = 1.0;
  std::array<ElementFunction, 3> coordinates_;
  std::vector<ElementFunction> angles_;  ///< up to three; none where there are no fibres
};

}  // namespace palpate::ex
