// From the start of `grid open` to its first picture, of a volume or a folder of DICOM images, and the memory that the
// window and its helper take.
//
//   xvfb-run -a -s '-screen 0 1600x1024x24' volume_open_bench FILE [--repeat N] [--memory FRAMES]
//
// What is printed is described in opening.h. Of a CT of 512 x 512 x 512 voxels of 16 bits the bars are
//   <= 2 s of the wall clock on two cores, <= 1.3 times the voxels without files.

#include <cstdio>
#include <functional>

#include "apps/grid/grid_model.h"
#include "common/hand/mode/haptic_mode.h"
#include "common/window/panels/volume/volume_panel.h"
#include "common/window/window.h"
#include "tests/bench/opening.h"

namespace palpate::bench {
namespace {

void open_volume(const char* file, int frames, const std::function<void()>& shown) {
  Document options;
  options.input.files = {file};
  options.input.kind = FieldKind::kScalar;
  GridModel model(options, "grid");
  WindowOptions window{.program = "grid"};
  window.panels = {draw_volume};
  window.touch.modes = modes_of(FieldKind::kScalar);
  window.frames = frames;
  (void)run_window(model, window);
  shown();
}

}  // namespace
}  // namespace palpate::bench

int main(int argc, char** argv) {
  return palpate::bench::open_and_say("volume_open_bench", argc, argv, palpate::bench::open_volume);
}
