/// Pieces that JSON objects of several verbs share. The JSON library shows here alone: json_output.h has none
/// of it.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "common/base/json.h"
#include "common/cli/summaries.h"
#include "common/geometry/line.h"
#include "common/math/vec.h"

namespace palpate {

[[nodiscard]] Json vec_json(const Vec3& x);
[[nodiscard]] Json box_json(const Box& box);
/// Numbers of lines and points, and how long the lines are.
[[nodiscard]] Json lines_json(const LinesSummary& lines);
/// How many lines ended for each reason.
[[nodiscard]] Json ends_json(const std::array<std::size_t, kEndCount>& counts);

}  // namespace palpate
