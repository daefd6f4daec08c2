#include "lab/data/volume_extremes.h"

#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "common/render/lens/lens.h"
#include "common/render/volume/volume_picture.h"
#include "lab/extremes/picture_stage.h"

namespace palpate {
namespace {

constexpr int kValueExponent = 60, kLengthExponent = 20;

class Extremes {
 public:
  explicit Extremes(Progress* progress) : progress_(progress) {}

  /// A picture in which nothing is to be seen.
  void nothing(const std::string& name, const std::string& meaning, const VolumeView& view,
               const Camera& camera) {
    add(name, brightest(draw(view, camera)), 0.0, meaning);
  }

  /// Two pictures that are to be the same.
  void same(const std::string& name, const std::string& meaning, const VolumeView& view, const Camera& camera,
            const VolumeView& other, const Camera& other_camera) {
    const FloatImage picture = draw(view, camera);
    add(name, worst_difference(picture, draw(other, other_camera)), PictureStage::kStep, meaning);
  }

  /// A picture of numbers from 0 to 1.
  void sound(const std::string& name, const std::string& meaning, const VolumeView& view,
             const Camera& camera) {
    constexpr double kRounding = 1e-5;
    add(name, brightest(draw(view, camera)), 1.0 + kRounding, meaning);
  }

  [[nodiscard]] std::vector<StabilityCase> take() { return std::move(cases_); }

 private:
  FloatImage draw(const VolumeView& view, const Camera& camera) {
    if (progress_) progress_->check();
    return picture_.draw(view, camera);
  }
  void add(const std::string& name, double measured, double limit, const std::string& meaning) {
    cases_.push_back(make_case("volume, " + name, measured, limit, "of full scale", meaning));
  }

  Progress* progress_;
  PictureStage picture_;
  std::vector<StabilityCase> cases_;
};

/// Symmetries of the data at hand.
void own_data(Extremes& extremes, VolumeView view) {
  view.lenses.clear();
  view.cuts.clear();
  view.planes = {};
  view.panes = {};
  const Camera camera = make_camera(view.image->bounds(), {}, 1.0);
  const auto altered = [&](const std::function<void(VolumeImage&)>& alter) {
    VolumeView other = view;
    auto image = std::make_shared<VolumeImage>(*view.image);
    alter(*image);
    other.image = std::move(image);
    return other;
  };
  if (!view.regions && !view.colored) {
    const double factor = std::ldexp(1.0, kValueExponent);
    VolumeView values = altered([&](VolumeImage& image) {
      for (double* number : {&image.scale, &image.offset, &image.lowest, &image.highest}) *number *= factor;
    });
    std::vector<ColorPoint> points = view.transfer.points();
    for (ColorPoint& point : points) point.value *= factor;
    values.transfer = ColorTransfer(std::move(points));
    extremes.same("this data, values by 2^60", "with its transfer function: the same picture", view, camera,
                  values, camera);
  }
  const double length = std::ldexp(1.0, kLengthExponent);
  VolumeView larger = altered([&](VolumeImage& image) {
    image.origin *= length;
    image.axes *= length;
  });
  larger.opacity_length = length * opacity_length_of(view);
  extremes.same("this data, lengths by 2^20", "the same picture", view, camera, larger,
                make_camera(larger.image->bounds(), {}, 1.0));

  const Box bounds = view.image->bounds();
  VolumeView lens = view;
  lens.lenses.push_back({.shape = make_sphere(bounds.lower, 0.5 * bounds.diagonal())});
  lens.lenses.back().samples_per_voxel = view.samples_per_voxel;
  lens.lenses.back().shading = view.shading;
  lens.lenses.back().colored = view.colored;
  extremes.same("this data, a lens on its corner", "that shows what is shown without it", view, camera, lens,
                camera);
  const Vec3 normal{1.0, 0.0, 0.0};
  VolumeView cut = view;
  cut.cuts.push_back({.kept = {normal, bounds.upper.x + bounds.diagonal()}});
  extremes.same("this data, a cut beyond it", "cuts nothing", view, camera, cut, camera);
  cut.cuts.back().kept = {normal, bounds.lower.x - bounds.diagonal()};
  extremes.nothing("this data, a cut before it", "leaves nothing", cut, camera);
  Camera inside = camera;
  inside.view_height *= 1e-3;
  extremes.sound("this data, seen from within", "a camera next to the middle of the volume", view, inside);
}

}  // namespace

std::vector<StabilityCase> run_volume_extremes(const VolumeView& view, Progress* progress) {
  Extremes extremes(progress);
  own_data(extremes, view);
  return extremes.take();
}

}  // namespace palpate
