/// The tables of settings, a function each: setting.h puts them together.
#pragma once

#include <span>

#include "common/scene/document/setting.h"

namespace palpate {

inline constexpr Kinds kFlows{FieldKind::kVector}, kVolumes{FieldKind::kScalar}, kTensors{FieldKind::kTensor},
    kHearts{FieldKind::kFibre}, kDevices{FieldKind::kNone},
    kVolumesAndTensors{FieldKind::kScalar, FieldKind::kTensor},
    kFlowsAndVolumes{FieldKind::kVector, FieldKind::kScalar},
    kFlowsAndHearts{FieldKind::kVector, FieldKind::kFibre},
    kAllButHearts{FieldKind::kVector, FieldKind::kScalar, FieldKind::kTensor};

/// @name Places in the structs of a document
/// @{
template <auto... M>
inline constexpr Place kCommonAt = kAt<&Document::common, M...>;
template <auto... M>
inline constexpr Place kInputAt = kAt<&Document::input, M...>;
template <auto... M>
inline constexpr Place kRawAt = kInputAt<&InputOptions::raw_spec, M...>;
template <auto... M>
inline constexpr Place kTensorReadingAt = kInputAt<&InputOptions::tensor, M...>;
template <auto... M>
inline constexpr Place kLineAt = kAt<&Document::tracing, M...>;
template <auto... M>
inline constexpr Place kTractAt = kAt<&Document::tracts, M...>;
template <auto... M>
inline constexpr Place kHeartAt = kAt<&Document::heart, M...>;
template <auto... M>
inline constexpr Place kSeriesAt = kAt<&Document::series, M...>;
template <auto... M>
inline constexpr Place kViewAt = kAt<&Document::view, M...>;
template <auto... M>
inline constexpr Place kVolumeAt = kAt<&Document::volume, M...>;
template <auto... M>
inline constexpr Place kPanesAt = kAt<&Document::panes, M...>;
template <auto... M>
inline constexpr Place kSliceAt = kAt<&Document::slice, M...>;
template <auto... M>
inline constexpr Place kTensorLookAt = kAt<&Document::tensors, M...>;
template <auto... M>
inline constexpr Place kTractAppearanceAt = kAt<&Document::tract_appearance, M...>;
template <auto... M>
inline constexpr Place kTouchAt = kAt<&Document::touch, M...>;
template <auto... M>
inline constexpr Place kLinearAt = kTouchAt<&TouchOptions::linear, M...>;
template <auto... M>
inline constexpr Place kGridAt = kTouchAt<&TouchOptions::grid, M...>;
template <auto... M>
inline constexpr Place kPlanesAt = kTouchAt<&TouchOptions::planes, M...>;
template <auto... M>
inline constexpr Place kFixtureAt = kTouchAt<&TouchOptions::fixtures, M...>;
template <auto... M>
inline constexpr Place kHandAt = kAt<&Document::hand, M...>;
template <auto... M>
inline constexpr Place kOutputAt = kAt<&Document::output, M...>;
/// @}

/// Of all verbs, and of inputs.
[[nodiscard]] std::span<const Setting> input_settings();
/// Of what is traced and measured.
[[nodiscard]] std::span<const Setting> tracing_settings();
/// Of pictures.
[[nodiscard]] std::span<const Setting> view_settings();
/// Of volumes.
[[nodiscard]] std::span<const Setting> volume_settings();
/// Of slices beside a volume.
[[nodiscard]] std::span<const Setting> panes_settings();
/// Of what all modes of touch share.
[[nodiscard]] std::span<const Setting> touch_settings();
/// Of single modes.
[[nodiscard]] std::span<const Setting> mode_settings();
/// Of devices in a window, paths and recordings, and of what a hand makes.
[[nodiscard]] std::span<const Setting> hand_settings();
/// Of what is written.
[[nodiscard]] std::span<const Setting> output_settings();
/// Of experiments with participants.
[[nodiscard]] std::span<const Setting> study_settings();
/// Of verbs of devices.
[[nodiscard]] std::span<const Setting> device_settings();

}  // namespace palpate
