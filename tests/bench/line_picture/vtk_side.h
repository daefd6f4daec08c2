/// VTK's line and tube pictures, for the benchmark of lines. No VTK type crosses this header.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "common/geometry/line.h"
#include "common/render/camera.h"
#include "common/render/scene_view.h"

namespace palpate::bench {

enum class VtkLines : std::uint8_t {
  kPlain,    ///< wide lines, one sample a pixel
  kSampled,  ///< wide lines, four samples a pixel
  kTubes     ///< six sides, four samples a pixel
};

/// A window of VTK with the lines of a view, coloured by speed as Palpate colours them. Its OpenGL context serves
/// both sides.
class VtkSide {
 public:
  VtkSide(const SceneView& view, VtkLines how, int width, int height);
  ~VtkSide();

  void make_current();
  void look(const Camera& camera);
  /// Draws and waits for it. [ms], by the clock.
  double draw();
  [[nodiscard]] Image read();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace palpate::bench
