#include "apps/dtmri/slice_images.h"

#include <algorithm>
#include <utility>

#include "common/field/tensor/tensor_measure.h"
#include "common/field/value_histogram.h"

namespace palpate {
namespace {

ValueWindow window_of_values(const VolumeImage& image, int threads) {
  constexpr std::size_t kBins = 1024;
  if (!(image.lowest < image.highest)) return {};
  return default_window(count_values(
      image.point_count(), [&image](std::size_t i) { return image.value(i); }, image.lowest, image.highest,
      kBins, threads));
}

}  // namespace

std::vector<SliceImage> slice_images_of(const TensorImage& made,
                                        const std::shared_ptr<const VolumeImage>& anisotropy,
                                        const std::string& file, int threads) {
  const ValueWindow whole{.width = 1.0, .level = 0.5};
  std::vector<SliceImage> images{{.name = "direction", .image = anisotropy, .window = whole, .colored = true},
                                 {.name = "fa", .image = anisotropy, .window = whole}};
  DataSet block;
  block.topology = made.image.topology;
  block.arrays.push_back(make_array("md", Association::kPoint, 1,
                                    measure_tensors(made.image, made.choice, TensorMeasure::kMd, threads)));
  for (const auto& [name, array] : {std::pair{"b0", kBaselineArray}, std::pair{"cone", kConeArray}}) {
    const DataArray* const found = made.image.find(std::string(array), Association::kPoint);
    if (found == nullptr) continue;
    block.arrays.push_back(*found);
    block.arrays.back().name = name;
  }
  for (const DataArray& array : block.arrays) {
    SliceImage one{.name = array.name, .image = make_volume_image(block, array.name, file), .window = {}};
    one.window = window_of_values(*one.image, threads);
    images.push_back(std::move(one));
  }
  return images;
}

SliceImage slice_image_of(const UnderlayView& underlay) {
  return {.name = "underlay", .image = underlay.image, .window = underlay.window};
}

std::vector<SliceImage> slice_images_in(const std::optional<VolumeView>& volume,
                                        const std::optional<TensorView>& tensors) {
  if (volume) return volume->slice_images;
  if (tensors && tensors->underlay) return {slice_image_of(*tensors->underlay)};
  return {};
}

const SliceImage* find_slice_image(const std::vector<SliceImage>& images, const std::string& name) {
  const auto at = std::ranges::find(images, name, &SliceImage::name);
  return at == images.end() ? nullptr : &*at;
}

}  // namespace palpate
