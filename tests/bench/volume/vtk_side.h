/// VTK's GPU volume mapper on the volumes of the benchmark. No VTK type crosses this header.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "common/render/camera.h"
#include "common/render/volume/volume_view.h"

namespace palpate::bench {

/// sRGB bytes over black, rows from the bottom: 3 * width * height.
struct Picture {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb;
};

/// An off-screen window of VTK with one volume; its OpenGL context serves both sides.
class VtkSide {
 public:
  VtkSide(const VolumeView& view, const Camera& camera, int width, int height);
  ~VtkSide();

  void make_current();
  /// Draws with `samples` a voxel and waits for it. [ms], by the clock.
  double draw(double samples);
  [[nodiscard]] Picture read();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// A volume of a .nhdr or NIfTI file, read by VTK, in its own type.
[[nodiscard]] std::shared_ptr<const VolumeImage> read_sample(const std::string& file);

}  // namespace palpate::bench
