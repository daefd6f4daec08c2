#include "common/render/volume/estimate/saving_estimate.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include <epoxy/gl.h>

#include "common/base/index.h"
#include "common/math/power_of_two.h"

namespace palpate {
namespace {

using Color = std::array<double, 3>;

// RMS of differences of colours, of those that show some of a lens and of the others.
class PartSum {
 public:
  void add(bool focus, const Color& off) noexcept {
    Part& part = focus ? focus_ : context_;
    for (const double d : off) part.squares += d * d;
    ++part.pixels;
  }
  [[nodiscard]] PartError error() const noexcept { return {rms(focus_), rms(context_)}; }

 private:
  struct Part {
    double squares = 0.0;
    std::size_t pixels = 0;
  };
  static double rms(const Part& part) noexcept {
    constexpr double kFull = 255.0;
    return part.pixels == 0 ? 0.0
                            : std::sqrt(part.squares / (3.0 * static_cast<double>(part.pixels))) / kFull;
  }
  Part focus_, context_;
};

// Where between pixels k and k + 1 of `count` a place lies.
struct Between {
  int below = 0, above = 0;
  double part = 0.0;  // of the way
  Between(double place, int count) {
    const double kept = std::clamp(place, 0.0, count - 1.0);
    below = static_cast<int>(kept);
    above = std::min(below + 1, count - 1);
    part = kept - below;
  }
};

template <typename Pixel>
Color bilinear(const Between& x, const Between& y, const Pixel& pixel) {
  const Color a = pixel(x.below, y.below), b = pixel(x.above, y.below), c = pixel(x.below, y.above),
              d = pixel(x.above, y.above);
  Color mixed{};
  for (std::size_t k = 0; k < mixed.size(); ++k)
    mixed[k] = std::lerp(std::lerp(a[k], b[k], x.part), std::lerp(c[k], d[k], x.part), y.part);
  return mixed;
}

Color minus(const Color& a, const Color& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

Color color_at(const Image& image, const Image* without, int x, int y) {
  const auto color = [&](const Image& of) {
    const auto pixel = of.pixel(x, y);
    return Color{static_cast<double>(pixel[0]), static_cast<double>(pixel[1]), static_cast<double>(pixel[2])};
  };
  return without == nullptr ? color(image) : minus(color(image), color(*without));
}

}  // namespace

std::array<double, 3> coarsened_pixel(const Image& image, const Image* without, double share, int x, int y) {
  const auto coarse = [&](int fine) { return std::max(1, static_cast<int>(std::lround(share * fine))); };
  const int width = coarse(image.width), height = coarse(image.height);
  const double across = static_cast<double>(image.width) / width;
  const double down = static_cast<double>(image.height) / height;
  return bilinear(Between((x + 0.5) / across - 0.5, width), Between((y + 0.5) / down - 0.5, height),
                  [&](int i, int j) {
                    return bilinear(Between((i + 0.5) * across - 0.5, image.width),
                                    Between((j + 0.5) * down - 0.5, image.height),
                                    [&](int k, int l) { return color_at(image, without, k, l); });
                  });
}

std::vector<bool> lens_pixels(const VolumeView& view, const SceneFrame& frame, const FrameBlock& block,
                              const PixelLattice& lattice) {
  const auto vec = [](const glm::vec4& v) { return Vec3(v.x, v.y, v.z); };
  const Vec3 eye = vec(block.eye), right = vec(block.right), up = vec(block.up), back = vec(block.back);
  const Vec3 off_axis = static_cast<double>(block.right.w) * right + static_cast<double>(block.up.w) * up;
  const bool perspective = block.eye.w > 0.5F;
  const double data_from_scene = power_of_two(frame.exponent);
  const Box bounds = view.image->bounds();
  const Vec3 half = 0.5 * (bounds.upper - bounds.lower);
  const ConvexShape volume =
      make_box(bounds.center(), Mat3(half.x, 0.0, 0.0, 0.0, half.y, 0.0, 0.0, 0.0, half.z));
  std::vector<bool> inside;
  for (int j = 0; j < lattice.rows; ++j) {
    for (int i = 0; i < lattice.columns; ++i) {
      const double x = lattice.place(i) + 0.5 - 0.5 * block.size.x;
      const double y = lattice.place(j) + 0.5 - 0.5 * block.size.y;
      const Vec3 across = static_cast<double>(block.size.z) * (x * right + y * up);
      const Vec3 from = frame.center + data_from_scene * (perspective ? eye : eye + across);
      const Vec3 along = perspective ? across - off_axis - static_cast<double>(block.size.w) * back : -back;
      const LineInterval matter = clip_line(volume, from, along);
      inside.push_back(std::ranges::any_of(view.lenses, [&](const Lens& lens) {
        if (lens.screen && !lens.screen->holds(x / block.size.y, y / block.size.y)) return false;
        const LineInterval met = clip_line(lens.shape, from, along);
        const double last = std::min(met.last, matter.last);
        return std::max(met.first, matter.first) < last && (!perspective || last > 0.0);
      }));
    }
  }
  return inside;
}

SavingEstimate::SavingEstimate(std::shared_ptr<const StillPicture> picture, const SceneFrame& frame,
                               double asked)
    : picture_(std::move(picture)),
      frame_(frame),
      lattice_(PixelLattice::of(picture_->shown.width, picture_->shown.height, 0)) {
  errors_.asked = {asked, asked};
}

bool SavingEstimate::add(VolumePass& pass, const OpaquePart& opaque_part) {
  const VolumeView& view = pass.drawn_view();
  const bool lenses = !view.lenses.empty();
  const auto rays = [&](double context, double focus) {
    return cast_sparse_rays(pass, sampled_view(view, context, focus), *picture_, lattice_);
  };
  std::size_t step = steps_++;
  if (step == 0) {
    in_lens_ = lens_pixels(view, frame_, picture_->block, lattice_);
    errors_.focus_share = static_cast<double>(std::count(in_lens_.begin(), in_lens_.end(), true)) /
                          static_cast<double>(std::max<std::size_t>(1, in_lens_.size()));
    if (lenses) look_at_context();
    all_samples_ = rays(1.0, 1.0);
    return true;
  }
  --step;
  if (step < kResolutionShares.size()) {
    look_at_resolution(step, opaque_part);
    return true;
  }
  step -= kResolutionShares.size();
  if (step < kContextShares.size()) {
    errors_.context[step] = difference(rays(kContextShares[step], 1.0), all_samples_);
    return lenses || step + 1 < kContextShares.size();
  }
  step -= kContextShares.size();
  errors_.focus[step] = difference(rays(1.0, kFocusShares[step]), all_samples_);
  return step + 1 < kFocusShares.size();
}

template <typename Change>
PartError SavingEstimate::error_of(const Change& change) const {
  const Image& image = picture_->shown;
  PartSum sum;
  for (std::size_t at = 0; at < in_lens_.size(); ++at) {
    const int x = lattice_.place(static_cast<int>(at) % lattice_.columns);
    const int y = image.height - 1 - lattice_.place(static_cast<int>(at) / lattice_.columns);
    sum.add(in_lens_[at], change(x, y));
  }
  return sum.error();
}

void SavingEstimate::look_at_context() {
  const Image& image = picture_->shown;
  const Image* const behind = &picture_->behind;
  for (std::size_t k = 0; k < kViewportShares.size(); ++k) {
    const PartError error = error_of([&](int x, int y) {
      return minus(coarsened_pixel(image, behind, kViewportShares[k], x, y), color_at(image, behind, x, y));
    });
    errors_.viewport[k] = {0.0, error.context};
  }
}

void SavingEstimate::look_at_resolution(std::size_t k, const OpaquePart& opaque_part) {
  const Image& image = picture_->shown;
  if (k == 0) opaque_ = opaque_part(image, 1.0);
  const double share = kResolutionShares[k];
  const Image coarse = opaque_part(image, share);
  errors_.resolution[k] = error_of([&](int x, int y) {
    const Color rest = minus(coarsened_pixel(image, &opaque_, share, x, y), color_at(image, &opaque_, x, y));
    return minus(rest, color_at(opaque_, &coarse, x, y));
  });
  if (k + 1 == kResolutionShares.size()) opaque_ = {};
}

PartError SavingEstimate::difference(const std::vector<std::uint8_t>& a,
                                     const std::vector<std::uint8_t>& b) const {
  PartSum sum;
  for (std::size_t at = 0; at < in_lens_.size(); ++at) {
    Color off{};
    for (std::size_t k = 0; k < off.size(); ++k)
      off[k] = static_cast<double>(a[4 * at + k]) - static_cast<double>(b[4 * at + k]);
    sum.add(in_lens_[at], off);
  }
  return sum.error();
}

}  // namespace palpate
