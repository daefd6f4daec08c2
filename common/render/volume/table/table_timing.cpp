#include "common/render/volume/table/table_timing.h"

#include <algorithm>
#include <vector>

#include <epoxy/gl.h>

#include "common/base/clock.h"
#include "common/render/gl/context.h"
#include "common/render/volume/table/gpu_preintegration.h"
#include "common/render/volume/voxels/voxel_texture.h"

namespace palpate {

std::optional<double> compute_table_ms(std::span<const OpticalEntry> entries, std::size_t lengths,
                                       int repeats) {
  if (is_software_rasteriser() || !GpuPreintegration::possible(entries.size())) return std::nullopt;
  const auto side = static_cast<GLsizei>(entries.size());
  const GlTexture table = make_texture(GL_TEXTURE_2D_ARRAY, "table to be timed");
  glTextureStorage3D(table.name(), 1, GL_RGBA16, side, side, static_cast<GLsizei>(lengths));
  GpuPreintegration gpu;
  std::vector<double> times;
  for (int i = 0; i <= repeats; ++i) {
    const Stopwatch clock;
    gpu.fill(entries, lengths, table, 0, {0, entries.size() - 1});
    glFinish();
    if (i > 0 || repeats == 0) times.push_back(1e3 * clock.seconds());
  }
  std::sort(times.begin(), times.end());
  return times[times.size() / 2];
}

}  // namespace palpate
