#include "common/render/slice/slice_raster.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>
#include <vector>

#include "common/base/index.h"
#include "common/base/parallel.h"
#include "common/render/volume/voxels/sign_bit.h"

namespace palpate {
namespace {

constexpr double kGridRounding = 1e-9;  // of a step: by which places computed on a point lie beside it

/// Numbers as they stand in memory.
template <typename T>
struct DenseNumbers {
  const std::byte* bytes;
  T sign{};  ///< sign_bit()

  [[nodiscard]] double operator[](std::size_t index) const noexcept {
    T value;
    std::memcpy(&value, bytes + index * sizeof(T), sizeof(T));
    if constexpr (std::is_integral_v<T>) value = static_cast<T>(value ^ sign);
    return static_cast<double>(value);
  }
};
struct SparseReader {
  const SparseNumbers* numbers;

  [[nodiscard]] double operator[](std::size_t index) const noexcept {
    return static_cast<double>((*numbers)[index]);
  }
};

/// The same number everywhere in a voxel, as labels are.
enum class Between : std::uint8_t { kLinear, kNearest };

/// Values of an image at places in mean coordinates.
template <typename Numbers>
class Sampler {
 public:
  Sampler(const VolumeImage& image, Numbers numbers)
      : between_(image.labels ? Between::kNearest : Between::kLinear),
        numbers_(numbers),
        points_(image.points),
        lower_(image.lower() - kGridRounding),
        upper_(image.upper() + kGridRounding),
        last_(image.points - 1),
        last_cell_(glm::max(image.points - 2, Index3(0))),
        steps_{1, as_size(image.points.x), as_size(image.points.x) * as_size(image.points.y)},
        scale_(image.scale),
        offset_(image.offset),
        lines_(image.lines.get()) {}

  /// NaN outside, and where a voxel that counts has no value.
  [[nodiscard]] double operator()(const Vec3& mean) const noexcept {
    const Vec3 g = lines_ != nullptr ? lines_->grid(mean) : mean;
    std::array<double, 3> part{};
    std::size_t at = 0;
    std::array<std::size_t, 3> beside{};
    for (int a = 0; a < 3; ++a) {
      if (!(g[a] >= lower_[a] && g[a] <= upper_[a])) return std::numeric_limits<double>::quiet_NaN();
      const double inside = std::clamp(g[a], 0.0, static_cast<double>(last_[a]));
      const int cell = std::min(static_cast<int>(inside), last_cell_[a]);
      double u = inside - cell;
      // On a point its neighbours have no say.
      if (between_ == Between::kNearest) u = u < 0.5 ? 0.0 : 1.0;
      if (u <= kGridRounding) u = 0.0;
      if (u >= 1.0 - kGridRounding) u = 1.0;
      const auto i = as_size(a);
      part[i] = u;
      at += steps_[i] * as_size(cell);
      beside[i] = cell < last_[a] ? steps_[i] : 0;
    }
    double sum = 0.0;
    for (unsigned corner = 0; corner < 8; ++corner) {
      const bool x = (corner & 1U) != 0, y = (corner & 2U) != 0, z = (corner & 4U) != 0;
      const double weight =
          (x ? part[0] : 1.0 - part[0]) * (y ? part[1] : 1.0 - part[1]) * (z ? part[2] : 1.0 - part[2]);
      if (!(weight > 0.0)) continue;
      sum += weight * numbers_[at + (x ? beside[0] : 0) + (y ? beside[1] : 0) + (z ? beside[2] : 0)];
    }
    return offset_ + scale_ * sum;
  }

 private:
  Between between_;
  Numbers numbers_;
  Index3 points_;
  Vec3 lower_, upper_;
  Index3 last_, last_cell_;
  std::array<std::size_t, 3> steps_;
  double scale_, offset_;
  const LatticeLines* lines_;
};

/// The lattice of the pixels' middles, and of the planes behind each.
struct Pixels {
  Vec3 first{0.0}, right{0.0}, down{0.0};  // data coordinates
  Vec3 back{0.0};                          // from plane to plane
  int planes = 1;
};

Pixels pixels_of(const VolumeImage& image, const SliceView& slice, const Camera& camera, int width,
                 int height) {
  const double pixel = camera.view_height / height;
  Pixels pixels;
  pixels.right = pixel * camera.axes[0];
  pixels.down = -pixel * camera.axes[1];
  pixels.first = camera.focal_point - 0.5 * (width - 1) * pixels.right - 0.5 * (height - 1) * pixels.down;
  if (!(slice.slab > 0.0) || image.labels) return pixels;  // of labels there is no mean
  // What of the slab the volume reaches, along the normal from the plane.
  const Vec3& back = camera.axes[2];
  const Box bounds = image.bounds();
  const double middle = glm::dot(bounds.center() - camera.focal_point, back),
               half = 0.5 * glm::dot(bounds.size(), glm::abs(back)),
               low = std::max(-0.5 * slice.slab, middle - half),
               high = std::min(0.5 * slice.slab, middle + half);
  if (!(low < high)) return pixels;
  const double most = image.lines ? 4096.0 : 1e6;
  const double wanted = std::ceil(2.0 * (high - low) / image.finest_step_along(back) - kGridRounding);
  pixels.planes = static_cast<int>(std::clamp(wanted, 1.0, slice.most_planes > 0 ? slice.most_planes : most));
  pixels.back = (high - low) / pixels.planes * back;
  pixels.first += low * back + 0.5 * pixels.back;
  return pixels;
}

/// One value out of those through the slab; those that are none have no say, unless all are.
class Gathered {
 public:
  explicit Gathered(SlabRule rule) : rule_(rule) {}
  void add(double value) noexcept {
    if (!std::isfinite(value)) return;
    if (count_ == 0) result_ = 0.0;
    result_ = count_ == 0 || rule_ == SlabRule::kMean ? result_ + value
              : rule_ == SlabRule::kHighest           ? std::max(result_, value)
                                                      : std::min(result_, value);
    ++count_;
  }
  [[nodiscard]] double value() const noexcept {
    return rule_ == SlabRule::kMean && count_ > 0 ? result_ / count_ : result_;
  }

 private:
  SlabRule rule_;
  double result_ = std::numeric_limits<double>::quiet_NaN();
  int count_ = 0;
};

template <typename Numbers>
void sample_values(const VolumeImage& image, Numbers numbers, const Pixels& pixels, SlabRule rule, int width,
                   int height, int threads, std::vector<double>& values) {
  const Sampler<Numbers> sample(image, numbers);
  const Vec3 first = image.mean_point(pixels.first), right = image.mean_direction(pixels.right),
             down = image.mean_direction(pixels.down), back = image.mean_direction(pixels.back);
  parallel_for(as_size(height), threads, [&](std::size_t from, std::size_t to) {
    for (std::size_t row = from; row < to; ++row) {
      const Vec3 start = first + static_cast<double>(row) * down;
      for (int x = 0; x < width; ++x) {
        const Vec3 g = start + static_cast<double>(x) * right;
        double value = 0.0;
        if (pixels.planes == 1) {
          value = sample(g);
        } else {
          Gathered gathered(rule);
          for (int plane = 0; plane < pixels.planes; ++plane)
            gathered.add(sample(g + static_cast<double>(plane) * back));
          value = gathered.value();
        }
        values[row * as_size(width) + as_size(x)] = value;
      }
    }
  });
}

/// The values of an image at the pixels, rows from the top; NaN where there is none.
std::vector<double> values_at(const VolumeImage& image, const Pixels& pixels, SlabRule rule, int width,
                              int height, int threads) {
  std::vector<double> values(as_size(width) * as_size(height));
  const auto sample = [&](auto numbers) {
    sample_values(image, numbers, pixels, rule, width, height, threads, values);
  };
  if (image.sparse) {
    sample(SparseReader{image.sparse.get()});
  } else if (image.type == ScalarType::kUint8) {
    sample(DenseNumbers<std::uint8_t>{image.bytes.data(), sign_bit<std::uint8_t>(image)});
  } else if (image.type == ScalarType::kUint16) {
    sample(DenseNumbers<std::uint16_t>{image.bytes.data(), sign_bit<std::uint16_t>(image)});
  } else {
    sample(DenseNumbers<float>{image.bytes.data()});
  }
  return values;
}

/// @pre part in [0, 1].
std::uint8_t byte_of_part(double part) { return static_cast<std::uint8_t>(255.0 * part + 0.5); }

/// Grey becomes as bright a shade of the colour of the point that is nearest to the middle of the slab.
void color_picture(const VolumeImage& image, const Pixels& pixels, int threads, Image& picture) {
  const Vec3 middle = pixels.first + 0.5 * (pixels.planes - 1) * pixels.back;
  const Vec3 first = image.mean_point(middle), right = image.mean_direction(pixels.right),
             down = image.mean_direction(pixels.down);
  parallel_for(as_size(picture.height), threads, [&](std::size_t from, std::size_t to) {
    for (std::size_t row = from; row < to; ++row) {
      for (int x = 0; x < picture.width; ++x) {
        std::uint8_t* const pixel = picture.rgba.data() + 4 * (row * as_size(picture.width) + as_size(x));
        if (pixel[3] == 0) continue;
        const Index3 at =
            glm::clamp(Index3(glm::round(image.grid_of_mean(first + static_cast<double>(row) * down +
                                                            static_cast<double>(x) * right))),
                       Index3(0), image.points - 1);
        const auto& color =
            (*image.colors)[as_size(at.x) + as_size(image.points.x) *
                                                (as_size(at.y) + as_size(image.points.y) * as_size(at.z))];
        for (std::size_t c = 0; c < 3; ++c)
          pixel[c] = static_cast<std::uint8_t>((pixel[c] * color[c] + 127) / 255);
      }
    }
  });
}

using Pixel = std::array<std::uint8_t, 4>;

/// Black where there is no part.
Pixel label_pixel(const LabelTable& labels, double value) {
  const Label* const label = labels.find(std::round(value));
  if (label == nullptr) return {0, 0, 0, 255};
  return {byte_of_part(label->color.r), byte_of_part(label->color.g), byte_of_part(label->color.b), 255};
}

/// Parts of one opacity, and nothing between them.
void blend_labels(const SliceBlend& blend, const std::vector<double>& values, Image& image) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values[i]) || std::round(values[i]) == 0.0) continue;
    const Pixel over = label_pixel(*blend.image->labels, values[i]);
    std::uint8_t* const pixel = image.rgba.data() + 4 * i;
    const double under = pixel[3] > 0 ? 1.0 : 0.0;
    for (std::size_t c = 0; c < 3; ++c)
      pixel[c] = byte_of_part((blend.opacity * over[c] + (1.0 - blend.opacity) * under * pixel[c]) / 255.0);
    pixel[3] = 255;
  }
}

void blend_over(const SliceBlend& blend, const std::vector<double>& values, Image& image) {
  if (blend.image->labels) return blend_labels(blend, values, image);
  const double low = blend.window.level - 0.5 * blend.window.width, range = blend.window.width;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double value = values[i];
    if (!std::isfinite(value) || !(range > 0.0)) continue;
    const double part = std::clamp((value - low) / range, 0.0, 1.0), opacity = blend.opacity * part;
    const Rgb color = map_color(blend.map, part);
    const std::array<double, 3> over{static_cast<double>(color.r), static_cast<double>(color.g),
                                     static_cast<double>(color.b)};
    std::uint8_t* const pixel = image.rgba.data() + 4 * i;
    const double under = pixel[3] > 0 ? 1.0 : 0.0;
    for (std::size_t c = 0; c < 3; ++c)
      pixel[c] = byte_of_part(opacity * over[c] + (1.0 - opacity) * under * pixel[c] / 255.0);
    if (opacity > 0.0) pixel[3] = 255;
  }
}

}  // namespace

bool same_pixels(const SliceView& a, const SliceView& b) {
  return a.image == b.image && a.window == b.window && a.colored == b.colored && a.slab == b.slab &&
         a.rule == b.rule && a.most_planes == b.most_planes && a.blend == b.blend;
}

Image slice_raster(const SliceView& slice, const Camera& camera, int width, int height, int threads) {
  const VolumeImage& image = *slice.image;
  const auto all_values = [&](const VolumeImage& of) {
    return values_at(of, pixels_of(of, slice, camera, width, height), slice.rule, width, height, threads);
  };
  const std::vector<double> values = all_values(image);
  Image picture{width, height, std::vector<std::uint8_t>(4 * values.size())};
  const double black = slice.window.level - 0.5 * slice.window.width;
  parallel_for(values.size(), threads, [&](std::size_t from, std::size_t to) {
    for (std::size_t i = from; i < to; ++i) {
      const double value = values[i];
      if (!std::isfinite(value)) continue;
      Pixel pixel{};
      if (image.labels) {
        pixel = label_pixel(*image.labels, value);
      } else {
        const std::uint8_t grey = byte_of_part(std::clamp((value - black) / slice.window.width, 0.0, 1.0));
        pixel = {grey, grey, grey, 255};
      }
      std::memcpy(picture.rgba.data() + 4 * i, pixel.data(), pixel.size());
    }
  });
  if (slice.colored && image.colors)
    color_picture(image, pixels_of(image, slice, camera, width, height), threads, picture);
  if (slice.blend && slice.blend->opacity > 0.0)
    blend_over(*slice.blend, all_values(*slice.blend->image), picture);
  return picture;
}

}  // namespace palpate
