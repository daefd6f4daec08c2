/// A chain as a line of text, as recordings carry it:
///
///   streamline scale=0.0025 fixtures=circle:0,0,0,0,0,1,2 stiffness=200 streamline.release=0.01 … field=NAME
///
/// The word fixtures= (mode/fixture.h) is there where there are some.
/// In place of a mode it may name a slider or knob that the hand holds (haptics/widget/dial_chain.h), in the
/// workspace. The settings are those of haptics/settings_text.h. Numbers read back to the same bits. The name
/// of the field comes last, since it may hold spaces.
#pragma once

#include <memory>
#include <span>
#include <string>

#include "common/hand/mode/haptic_mode.h"

namespace palpate {

/// A field with the name that tells it from the others of its input.
struct NamedField {
  std::shared_ptr<const VectorField> field;  ///< null for volumes of scalars and tensors
  std::string name;                          ///< field_key()
  std::shared_ptr<const ScalarField> scalar = nullptr;
  std::shared_ptr<const TensorField> tensor = nullptr;
  std::shared_ptr<const ScalarField> noise = nullptr;  ///< as HapticScene

  [[nodiscard]] bool empty() const noexcept { return !field && !scalar && !tensor; }
  /// @name Of the fields that are there. @pre !empty()
  /// @{
  [[nodiscard]] const LocalFrame& frame() const noexcept {
    return frame_of(field.get(), scalar.get(), tensor.get());
  }
  [[nodiscard]] const Box& bounds() const noexcept {
    if (tensor) return tensor->bounds();
    return field ? field->bounds() : scalar->bounds();
  }
  [[nodiscard]] double diagonal() const noexcept { return bounds().diagonal(); }
  /// @}
};

[[nodiscard]] std::string field_key(const std::string& label, std::size_t time_step);

[[nodiscard]] std::string describe_chain(const std::string& mode, double workspace_scale,
                                         const ChainSettings& settings, const std::string& field_name,
                                         const FixtureList& fixtures = {});

/// What a description says.
struct DescribedChain {
  std::string mode;
  double workspace_scale = 0.0;  ///< [m] per data unit
  std::string fixtures;          ///< fixture_word(); empty: none
  ChainSettings settings;
  std::string field_name;
};
/// @throws Error (bad input) where the description makes no sense.
[[nodiscard]] DescribedChain parse_chain(const std::string& description);

/// @param store of fixtures that have been read; null: they are read anew.
/// @throws Error (bad input) where the description makes no sense, or means another field, an unknown mode, or fixtures
/// that are not what they were.
[[nodiscard]] HapticChain build_chain(const std::string& description, std::span<const HapticMode> modes,
                                      const NamedField& open, int threads, FixtureStore* store = nullptr);

}  // namespace palpate
