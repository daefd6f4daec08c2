#include "common/render/volume/error_estimate.h"

#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include <epoxy/gl.h>

#include "common/base/check.h"
#include "common/base/clock.h"
#include "common/render/gl/framebuffer.h"
#include "common/render/volume/volume_bindings.h"

namespace palpate {
namespace {

constexpr int kMostRounds = 8;
constexpr double kKnown = 0.1;  // spread that is good enough, of the error

// The pixels of a lattice as OpenGL has them, from the bottom.
std::vector<std::uint8_t> pixels_of(const Image& image, const PixelLattice& lattice) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(4 * static_cast<std::size_t>(lattice.columns) * static_cast<std::size_t>(lattice.rows));
  for (int j = 0; j < lattice.rows; ++j) {
    for (int i = 0; i < lattice.columns; ++i) {
      for (const int component : image.pixel(lattice.place(i), image.height - 1 - lattice.place(j)))
        bytes.push_back(static_cast<std::uint8_t>(component));
    }
  }
  return bytes;
}

}  // namespace

ErrorEstimate::ErrorEstimate(Image behind, Image shown, const FrameBlock& block, double resolution)
    : behind_(std::move(behind)), shown_(std::move(shown)), block_(block), resolution_(resolution) {
  PALPATE_CHECK(behind_.width == shown_.width && behind_.height == shown_.height);
}

bool ErrorEstimate::add(VolumePass& pass, std::uint32_t opaque_depth) {
  glFinish();
  const Stopwatch clock;
  const FramebufferGuard before;
  const PixelLattice lattice = PixelLattice::of(shown_.width, shown_.height, rounds_);
  const GlTexture picture =
      make_picture_texture(GL_RGBA8, lattice.columns, lattice.rows, "pixels looked at again");
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTextureSubImage2D(picture.name(), 0, 0, 0, lattice.columns, lattice.rows, GL_RGBA, GL_UNSIGNED_BYTE,
                      pixels_of(behind_, lattice).data());
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  const GlFramebuffer framebuffer = make_framebuffer();
  glNamedFramebufferTexture(framebuffer.name(), GL_COLOR_ATTACHMENT0, picture.name(), 0);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.name());
  glViewport(0, 0, lattice.columns, lattice.rows);

  // The same view in pixels k times as large, the middle in the middle; their middles are those of the
  // picture's.
  const auto step = static_cast<float>(lattice.step);
  FrameBlock larger = block_;
  larger.size.x /= step;
  larger.size.y /= step;
  larger.size.z *= step;
  const GlBuffer block = volume_shader::make_block_buffer(larger);
  glBindBufferBase(GL_UNIFORM_BUFFER, volume_shader::kFrameBlock, block.name());
  pass.draw_converged(opaque_depth, static_cast<float>(lattice.step * resolution_));

  const std::vector<std::uint8_t> shown = pixels_of(shown_, lattice);
  std::vector<std::uint8_t> converged(shown.size());
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, lattice.columns, lattice.rows, GL_RGBA, GL_UNSIGNED_BYTE, converged.data());
  const auto pixel = [](const std::vector<std::uint8_t>& bytes, std::size_t i) {
    return std::array<int, 4>{bytes[i], bytes[i + 1], bytes[i + 2], bytes[i + 3]};
  };
  for (std::size_t i = 0; i < shown.size(); i += 4) sum_.add(pixel(shown, i), pixel(converged, i));
  ++rounds_;
  milliseconds_ += 1e3 * clock.seconds();

  const ImageError now = sum_.error();
  const bool again = PixelLattice::of(shown_.width, shown_.height, rounds_).step > lattice.step;
  return lattice.step > 1 && again && rounds_ < kMostRounds && now.spread > kKnown * now.rms;
}

ImageError ErrorEstimate::error() const noexcept {
  ImageError error = sum_.error();
  error.milliseconds = milliseconds_;
  return error;
}

}  // namespace palpate
