/// The catalogue of stiff and extreme cases: one table that tests, reports and documentation share.
///
/// A row is a name, a builder, a claim and a limit. Builders are formulas and draws of fixed seeds, so that a row is the same
/// on every machine. Which rows were seen to fail with a guard taken out stands in seen.def, written by scripts/guards_out.py
/// from the guards of guards.tsv, or is measured by the row itself; a row that no guard was seen for says so.
#pragma once

#include <cstdint>
#include <functional>
#include <initializer_list>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/progress.h"
#include "common/base/work_precision.h"

namespace palpate {

inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

enum class ExtremeKind : std::uint8_t { kField, kMesh, kTensor, kVolume, kLens, kCamera, kWall, kDevice };
inline constexpr int kExtremeKindCount = 8;
[[nodiscard]] std::string_view name_of(ExtremeKind kind) noexcept;  ///< "field"

struct Extreme {
  ExtremeKind kind = ExtremeKind::kField;
  std::string name;     ///< unique: "one fast rate, 2^40"
  std::string builder;  ///< how it is made
  std::string claim;    ///< what is measured
  double limit = 0.0;   ///< that it keeps
  std::string unit;     ///< "of the stated error"
  /// Infinite where the case comes to something else than it must. @throws Error (work failed) of pictures without OpenGL.
  std::function<double()> measure;
  /// Where the guard is one that can be left out as the program runs: what it is, and what the case comes to without it.
  std::string guard;
  std::function<double()> unguarded;
};

/// The rows of these kinds, in the order of the catalogue; without kinds all of them. Pictures share a context of OpenGL,
/// which lasts as long as their rows do: use them in one thread.
[[nodiscard]] std::vector<Extreme> extremes(std::initializer_list<ExtremeKind> kinds = {});

/// The guard without which the row was seen to fail; empty: none was seen.
[[nodiscard]] std::string guard_of(const Extreme& row);

[[nodiscard]] StabilityCase measured(const Extreme& row);
/// All rows of these kinds, measured. @throws Cancelled.
[[nodiscard]] std::vector<StabilityCase> run_extremes(std::initializer_list<ExtremeKind> kinds,
                                                      Progress* progress);

/// docs/extremes.md.
[[nodiscard]] std::string extremes_page();

/// @name What each file of the catalogue adds
/// @{
void add_field_rows(std::vector<Extreme>& rows);
void add_mesh_rows(std::vector<Extreme>& rows);
void add_stiff_rows(std::vector<Extreme>& rows);
void add_wall_mesh_rows(std::vector<Extreme>& rows);
void add_tensor_rows(std::vector<Extreme>& rows);
void add_picture_rows(std::vector<Extreme>& rows);
void add_wall_rows(std::vector<Extreme>& rows);
void add_device_rows(std::vector<Extreme>& rows);
/// @}

}  // namespace palpate
