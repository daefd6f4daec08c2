/// Pieces that JSON objects of several verbs share. The JSON library shows here alone: json_output.h has none
/// of it.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "common/base/needs.h"
#include "common/cli/summaries.h"
#include "common/geometry/line.h"
#include "common/math/vec.h"
#include "common/scene/plan.h"

namespace palpate {

using Json = nlohmann::ordered_json;

/// Indented text, whatever bytes file names are made of: they need not be UTF-8, JSON does.
[[nodiscard]] std::string json_text(const Json& json);
[[nodiscard]] Json vec_json(const Vec3& x);
[[nodiscard]] Json box_json(const Box& box);
[[nodiscard]] Json needs_json(const Needs& needs);
[[nodiscard]] Json measured_json(const std::vector<MeasuredCost>& measured);
/// Adds the plan with its estimates, and what the work took in the end; nothing where there is no plan.
void add_plan(Json& json, const Needs& plan, const std::vector<MeasuredCost>& measured);
/// Numbers of lines and points, and how long the lines are.
[[nodiscard]] Json lines_json(const LinesSummary& lines);
/// How many lines ended for each reason.
[[nodiscard]] Json ends_json(const std::array<std::size_t, kEndCount>& counts);

}  // namespace palpate
