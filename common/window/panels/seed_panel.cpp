#include "common/window/panels/seed_panel.h"

#include <algorithm>
#include <string>
#include <vector>

#include <imgui.h>

#include "common/base/index.h"
#include "common/window/panels/panel_parts.h"

namespace palpate {

void draw_seeds(PanelState& state, bool speed) {
  static const std::vector<std::string> kKinds{"grid", "random", "speed", "other"};
  static const std::vector<std::string> kWithoutSpeed{"grid", "random", "other"};
  std::string kind = kKinds[as_size(state.seeds.kind)];
  if (choose_word("seeds", kind, speed ? kKinds : kWithoutSpeed)) {
    // `other` starts from the text of what was chosen before.
    state.seeds.text = seeds_text(state.seeds);
    state.seeds.kind =
        static_cast<SeedChoice::Kind>(std::find(kKinds.begin(), kKinds.end(), kind) - kKinds.begin());
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
