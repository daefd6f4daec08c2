#include "common/compose/label_volume.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/text.h"
#include "common/field/array_type.h"
#include "common/field/transfer/label_table.h"
#include "common/load/image/image_header.h"
#include "common/math/lattice.h"

namespace palpate {
namespace {

using Color = std::array<std::uint8_t, 4>;

std::optional<LabelTable> asked_labels(const Input& input) {
  const std::string& words = input.spec().labels;
  if (words == "off") return std::nullopt;
  std::optional<LabelTable> stated;
  if (!input.spec().files.empty()) {
    const auto header = read_image_header(input.spec().files.front());
    if (header) stated = header->labels;
  }
  if (words == "auto") return stated;
  if (words == "on") return stated.value_or(LabelTable());
  return read_label_table(words);
}

/// Between parts and what belongs to none colours go on as they are: voxels beside a part have its colour, too.
void reach_out(const Index3& n, const std::vector<std::uint8_t>& inside, std::vector<Color>& colors) {
  const auto at = [&](int x, int y, int z) {
    return as_size(x) + as_size(n.x) * (as_size(y) + as_size(n.y) * as_size(z));
  };
  for (int z = 0; z < n.z; ++z) {
    for (int y = 0; y < n.y; ++y) {
      for (int x = 0; x < n.x; ++x) {
        if (inside[at(x, y, z)] != 0) continue;
        int nearest = 4;
        for (int c = std::max(0, z - 1); c <= std::min(n.z - 1, z + 1); ++c) {
          for (int b = std::max(0, y - 1); b <= std::min(n.y - 1, y + 1); ++b) {
            for (int a = std::max(0, x - 1); a <= std::min(n.x - 1, x + 1); ++a) {
              const int steps = std::abs(a - x) + std::abs(b - y) + std::abs(c - z);
              if (steps >= nearest || inside[at(a, b, c)] == 0) continue;
              nearest = steps;
              colors[at(x, y, z)] = colors[at(a, b, c)];
            }
          }
        }
      }
    }
  }
}

}  // namespace

std::shared_ptr<const VolumeImage> with_labels(std::shared_ptr<const VolumeImage> image, const Input& input) {
  const std::string& words = input.spec().labels;
  const bool forced = words != "auto" && words != "off";
  const bool whole = is_whole(image->stored) && !image->sparse && !image->colors;
  if (!whole) {
    if (forced)
      throw usage_error("--labels " + words + ": " + input.field_label() + " of " + input.title() +
                        " has no whole numbers, which labels are");
    return image;
  }
  const std::optional<LabelTable> asked = asked_labels(input);
  if (!asked) return image;
  constexpr std::size_t kMost = 100'000;
  std::map<double, Color> colors;  // of what occurs
  std::vector<Label> present;
  auto own = std::make_shared<std::vector<Color>>(image->point_count());
  std::vector<std::uint8_t> inside(own->size());
  for (std::size_t i = 0; i < own->size(); ++i) {
    const double value = std::round(image->value(i));
    if (value == 0.0 || !std::isfinite(value)) continue;
    auto known = colors.find(value);
    if (known == colors.end()) {
      if (colors.size() == kMost)
        throw usage_error("--labels: more than " + std::to_string(kMost) + " parts");
      present.push_back(asked->at(value));
      Color color{0, 0, 0, 255};
      for (std::size_t c = 0; c < 3; ++c)
        color[c] = static_cast<std::uint8_t>(std::lround(255.0F * present.back().color[static_cast<int>(c)]));
      known = colors.emplace(value, color).first;
    }
    (*own)[i] = known->second;
    inside[i] = 1;
  }
  reach_out(image->points, inside, *own);
  auto labelled = std::make_shared<VolumeImage>(*image);
  labelled->labels = std::make_shared<const LabelTable>(std::move(present));
  labelled->colors = std::move(own);
  return labelled;
}

ColorTransfer label_transfer(const VolumeImage& image) {
  constexpr double kBetween = 0.5, kOpacity = 0.6;
  constexpr std::size_t kFew = 32;
  const std::vector<Label>& labels = image.labels->labels();
  const bool few = !labels.empty() && labels.size() <= kFew && labels.front().value > 0.0;
  const Vec3f first = few ? labels.front().color : Vec3f{0.8F};
  std::vector<ColorPoint> points{{0.0, first, 0.0}, {kBetween, first, 0.0}, {kBetween, first, kOpacity}};
  for (std::size_t i = 1; few && i < labels.size(); ++i) {
    const double border = 0.5 * (labels[i - 1].value + labels[i].value);
    points.push_back({border, labels[i - 1].color, kOpacity});
    points.push_back({border, labels[i].color, kOpacity});
  }
  return ColorTransfer(std::move(points));
}

std::string label_note(const VolumeImage& image) {
  if (image.labels) {
    return counted(image.labels->labels().size(), "part") +
           " of a label map in colours of their own; 0 is clear, a transfer function gives the opacity alone";
  }
  if (!is_whole(image.stored) || image.sparse || image.colors || image.point_count() == 0) return {};
  constexpr std::size_t kLooks = std::size_t{1} << 18, kFew = 64;
  std::size_t step = std::max<std::size_t>(1, image.point_count() / kLooks);
  // One that divides a layer would go down a few columns alone, which may all be air.
  while (std::gcd(step, as_size(image.points.x) * as_size(image.points.y)) > 1) ++step;
  std::set<double> different;
  for (std::size_t i = 0; i < image.point_count(); i += step) {
    different.insert(image.number(i));
    if (different.size() > kFew) return {};
  }
  if (different.size() < 2) return {};
  return "its whole numbers are few, " + std::to_string(different.size()) +
         ": where they name parts, --labels on draws these in colours of their own";
}

}  // namespace palpate
