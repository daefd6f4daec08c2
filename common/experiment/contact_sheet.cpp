#include "common/experiment/contact_sheet.h"

#include <algorithm>

#include "common/base/index.h"
#include "common/render/render_image.h"
#include "common/study/study_appearance.h"

namespace palpate {

Image contact_sheet(const StudyTasks& tasks, int stimuli, Progress& progress) {
  constexpr int kTile = 220, kGap = 4, kColumns = 10, kBytes = 4;
  const int rows = (stimuli + kColumns - 1) / kColumns, columns = std::min(stimuli, kColumns);
  Image sheet;
  sheet.width = columns * (kTile + kGap) + kGap;
  sheet.height = static_cast<int>(tasks.size()) * rows * (kTile + kGap) + kGap;
  sheet.rgba.assign(as_size(sheet.width) * as_size(sheet.height) * kBytes, 255);
  progress.begin("drawing stimuli", tasks.size() * as_size(stimuli));
  int top = kGap;
  for (const auto& task : tasks) {
    for (int s = 0; s < stimuli; ++s) {
      progress.check();
      const std::unique_ptr<StudyTrial> trial = task->open(s);
      const Vec3 start = trial->start();
      SceneView view = trial->view(&start, 1.0);
      // A tile is a quarter of the window's height: lines become thinner with it, the start stays to be seen.
      constexpr double kThinner = 0.4, kMark = 2.2;
      view.style.width *= kThinner;
      StudyAppearance(view).disc(start, StudyAppearance::kBlue, kMark);
      if (s == 0) view.title = task->info().title;
      const Image tile = render_image(view, kTile, kTile).image;
      const int x = kGap + (s % kColumns) * (kTile + kGap), y = top + (s / kColumns) * (kTile + kGap);
      for (int row = 0; row < kTile; ++row) {
        const auto from = tile.rgba.begin() + static_cast<std::ptrdiff_t>(row) * kTile * kBytes;
        std::copy_n(from, kTile * kBytes,
                    sheet.rgba.begin() + (static_cast<std::ptrdiff_t>(y + row) * sheet.width + x) * kBytes);
      }
      progress.advance();
    }
    top += rows * (kTile + kGap);
  }
  return sheet;
}

}  // namespace palpate
