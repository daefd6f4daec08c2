#include "common/window/panels/seed_panel.h"

#include <algorithm>
#include <string>
#include <vector>

#include <imgui.h>

#include "common/base/index.h"
#include "common/base/text.h"
#include "common/window/panels/panel_parts.h"

namespace palpate {
namespace {

/// Seeds in a row through the middle of the bounds, along an axis: what timelines need.
std::string row_along(int axis, const Box& bounds) {
  constexpr double kMargin = 0.1;
  constexpr int kSeeds = 50;
  Vec3 from = bounds.center(), to = from;
  from[axis] = bounds.lower[axis] + kMargin * bounds.size()[axis];
  to[axis] = bounds.upper[axis] - kMargin * bounds.size()[axis];
  std::string text = "line:";
  for (const Vec3& end : {from, to})
    for (int a = 0; a < 3; ++a) text += exact_number(end[a]) + ",";
  return text + std::to_string(kSeeds);
}

}  // namespace

void draw_seeds(PanelState& state, bool speed) {
  static const std::vector<std::string> kKinds{"grid", "random", "speed", "other"};
  static const std::vector<std::string> kRows{"row along x", "row along y", "row along z"};
  static const auto words = [](const std::string& left_out) {
    std::vector<std::string> out = kKinds;
    std::erase(out, left_out);
    out.insert(out.end(), kRows.begin(), kRows.end());
    return out;
  };
  static const std::vector<std::string> kAll = words(""), kWithoutSpeed = words("speed");
  std::string kind = kKinds[as_size(state.seeds.kind)];
  if (choose_word("seeds", kind, speed ? kAll : kWithoutSpeed)) {
    if (const auto row = std::find(kRows.begin(), kRows.end(), kind); row != kRows.end()) {
      state.seeds.text = row_along(static_cast<int>(row - kRows.begin()), state.scene->info->bounds);
      state.seeds.kind = SeedChoice::Kind::kText;
    } else {
      // `other` starts from the text of what was chosen before.
      state.seeds.text = seeds_text(state.seeds);
      state.seeds.kind =
          static_cast<SeedChoice::Kind>(std::find(kKinds.begin(), kKinds.end(), kind) - kKinds.begin());
    }
  }
  explain("seeds", false);
  constexpr int kMost = 1'000'000, kMostAcross = 200;
  switch (state.seeds.kind) {
    case SeedChoice::Kind::kGrid:
      drag_int("along x y z", state.seeds.grid.data(), 3, 0.1F, 1, kMostAcross, 0);
      hint("seeds along each axis of the bounds: drag, or Ctrl+click and type");
      break;
    case SeedChoice::Kind::kRandom:
    case SeedChoice::Kind::kSpeed:
      drag_int("number", &state.seeds.count, 1, 2.0F, 1, kMost, ImGuiSliderFlags_Logarithmic);
      hint("of seeds: drag, or Ctrl+click and type");
      break;
    case SeedChoice::Kind::kText:
      // Half a word is no seeds: taken when it is complete.
      input_text("as --seeds", &state.seeds.text);
      if (ImGui::IsItemActive()) return;
      break;
  }
  state.document.tracing.seeds = seeds_text(state.seeds);
}

}  // namespace palpate
