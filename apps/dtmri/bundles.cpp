#include "apps/dtmri/bundles.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>

#include "apps/dtmri/region_text.h"
#include "apps/dtmri/slice_images.h"
#include "apps/dtmri/tract_request.h"
#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/text.h"
#include "common/math/vec_text.h"
#include "common/scene/tensor/tensor_spec.h"
#include "common/trace/tract/bundle.h"
#include "common/trace/tract/tract_edit.h"

namespace palpate {
namespace {

constexpr int kProfileNodes = 100;

/// Makes the lines of one bundle, step by step.
class BundleMaker {
 public:
  BundleMaker(const BundleText& bundle, const BundleGround& ground, BundleSet& set,
              std::vector<std::string>& notes)
      : bundle_(bundle), ground_(ground), set_(set), notes_(notes) {}

  [[nodiscard]] std::shared_ptr<const Tractogram> make() {
    const std::vector<BundleStep>& steps = bundle_.steps;
    std::size_t options = 0;  // the first one of the next trace
    for (std::size_t i = 0; i < steps.size(); ++i) {
      if (is_tracing(steps[i])) continue;
      if (steps[i].key == "trace") {
        add(source(std::span(steps).subspan(options, i + 1 - options)));
      } else if (steps[i].key == "file") {
        add(source(std::span(steps).subspan(i, 1)));
      } else if (steps[i].key == "line") {
        add_line(steps[i]);
      } else if (steps[i].key == "also") {
        outer_.push_back(std::exchange(lines_, Tractogram()));
      } else if (steps[i].key == "all") {
        Tractogram inner = std::exchange(lines_, std::move(outer_.back()));
        outer_.pop_back();
        append_lines(inner, lines_);
      } else {
        edit(steps[i]);
      }
      options = i + 1;
    }
    const TensorVoxels& voxels = ground_.voxels;
    lines_.image = TractogramImage{voxels.points, voxels.axes, voxels.origin};
    return std::make_shared<const Tractogram>(std::move(lines_));
  }

 private:
  void add(const std::shared_ptr<const Tractogram>& more) { append_lines(*more, lines_); }

  void add_line(const BundleStep& step) {
    const std::size_t count = split(step.value, ',').size();
    const std::vector<double> v = parse_numbers(step.value, count, "line=");
    Tractogram one;
    for (std::size_t i = 0; i < count; i += 3) one.points.emplace_back(vec_at(v, i));
    one.starts.push_back(one.points.size());
    append_lines(one, lines_);
  }

  /// What the file or the trace gives that the steps ask for.
  std::shared_ptr<const Tractogram> source(std::span<const BundleStep> steps) {
    const std::string text = steps_text(steps);
    auto made = set_.sources.find(text);
    if (made == set_.sources.end()) made = set_.sources.emplace(text, new_source(text, steps)).first;
    for (const std::string& note : made->second.notes) say(note);
    return made->second.lines;
  }
  BundleSource new_source(const std::string& text, std::span<const BundleStep> steps) {
    if (ground_.before != nullptr) {
      const auto made = ground_.before->sources.find(text);
      if (made != ground_.before->sources.end()) return made->second;
    }
    const bool file = steps.back().key == "file";
    ViewTracts tracts = file ? read(steps.back().value) : trace(steps.first(steps.size() - 1));
    if (tracts.bundle->order.empty()) tracts.notes.push_back("WARNING: no tract: " + tracts.why_none);
    return {.lines = tracts.bundle->lines, .notes = std::move(tracts.notes)};
  }
  ViewTracts read(const std::string& file) {
    return read_view_tracts({.file = file}, ground_.voxels.field.get(), ground_.document.common.threads,
                            ground_.progress);
  }
  ViewTracts trace(std::span<const BundleStep> options) {
    if (!ground_.voxels.field)
      throw usage_error("--bundle: " + steps_text(options) +
                        "|trace=: there are no tensors to trace tracts through");
    Document with = ground_.document;
    with.tracts = tracing_of(options);
    return trace_view_tracts(with, ground_.voxels, ground_.cones, ground_.progress);
  }

  void edit(const BundleStep& step) {
    const std::string& key = step.key;
    if (key == "keep" || key == "drop" || key == "crop") {
      const TractRegion inside = region(step.value);
      lines_ = key == "crop" ? cropped_lines(lines_, inside) : lines_through(lines_, inside, key == "keep");
      return;
    }
    const std::vector<double> v = parse_numbers(step.value, split(step.value, ',').size(), key);
    if (key == "smooth") {
      lines_ = smooth_lines(lines_, v[0]);
    } else if (key == "resample") {
      lines_ = resample_lines(lines_, v[0]);
    } else if (key == "length") {
      lines_ = lines_of_length(lines_, v[0], v[1]);
    } else if (key == "part") {
      const double length = glm::length(vec_at(v, 0));
      lines_ = part_lines(lines_, {.normal = vec_at(v, 0) / length, .offset = v[3] / length});
    } else {
      edit_numbered(step, v);
    }
  }

  void edit_numbered(const BundleStep& step, const std::vector<double>& v) {
    std::vector<std::size_t> numbers;  // from 0
    const std::size_t named = step.key == "cut" ? 1 : v.size();
    for (std::size_t i = 0; i < named; ++i) numbers.push_back(static_cast<std::size_t>(v[i]) - 1);
    const auto missing =
        std::ranges::find_if(numbers, [&](std::size_t n) { return n >= lines_.line_count(); });
    if (missing != numbers.end()) {
      say("WARNING: " + step.key + "=" + step.value + " is left out: there is no tract " +
          std::to_string(*missing + 1) + " of " + std::to_string(lines_.line_count()));
      return;
    }
    if (step.key == "delete") {
      lines_ = delete_lines(lines_, numbers);
    } else if (step.key == "join") {
      lines_ = join_lines(lines_, numbers[0], numbers[1]);
    } else if (const auto at = nearest_place_of(lines_, numbers[0], vec_at(v, 1))) {
      const std::size_t before = lines_.line_count();
      lines_ = cut_line(lines_, *at);
      if (lines_.line_count() == before)
        say("WARNING: " + step.key + "=" + step.value + " cuts nothing: it lies at an end of the tract");
    }
  }

  TractRegion region(const std::string& text) {
    const bool left_handed = parse_tensor_spec(ground_.document.input.tensor).left_handed;
    std::vector<MaskFile> masks;
    std::vector<TractRegion> regions = read_regions({text}, "--bundle", left_handed, masks, ground_.progress);
    for (const MaskFile& mask : masks) {
      for (const std::string& note : mask.notes) say(note);
    }
    return std::move(regions.front());
  }

  void say(const std::string& words) {
    notes_.push_back((bundle_.name.empty() ? "a bundle" : "bundle " + bundle_.name) + ": " + words);
  }

  const BundleText& bundle_;
  const BundleGround& ground_;
  BundleSet& set_;
  std::vector<std::string>& notes_;
  Tractogram lines_;
  std::vector<Tractogram> outer_;  // of also=
};

void measure(const SliceImage* image, BundleView& bundle) {
  bundle.measure = image != nullptr ? image->name : std::string();
  bundle.profile.reset();
  bundle.mean.reset();
  if (image == nullptr) return;
  bundle.profile = bundle_profile(*bundle.lines, kProfileNodes,
                                  [image](const Vec3& x) { return image->image->value_at(x); });
  double sum = 0.0, count = 0.0;
  for (const BundleNode& node : bundle.profile->nodes) {
    if (node.lines == 0) continue;
    sum += node.mean * static_cast<double>(node.lines);
    count += static_cast<double>(node.lines);
  }
  if (count > 0.0) bundle.mean = sum / count;
}

void add_colors(const std::string& color, const SliceImage* image, const Tractogram& lines,
                std::vector<std::uint32_t>& colors) {
  if (const auto own = color_of_text(color)) {
    colors.insert(colors.end(), lines.points.size(), packed_color(*own));
  } else if (image == nullptr) {
    colors.insert(colors.end(), lines.points.size(), TractBundle::kByDirection);
  } else {
    const double lower = image->window.level - 0.5 * image->window.width;
    for (const Vec3f& x : lines.points)
      colors.push_back(packed_color(
          map_color(ColorMap::kSequential, (image->image->value_at(Vec3(x)) - lower) / image->window.width)));
  }
}

}  // namespace

std::shared_ptr<const TensorVoxels> lattice_of_lines(const Tractogram& lines) {
  auto lattice = std::make_shared<TensorVoxels>();
  if (lines.image) {
    lattice->points = lines.image->voxels;
    lattice->axes = lines.image->axes;
    lattice->origin = lines.image->origin;
  } else {
    constexpr double kMostVoxels = 256.0;  // along an edge
    Box box;
    for (const Vec3f& x : lines.points) {
      if (is_finite(Vec3(x))) box.include(Vec3(x));
    }
    const Vec3 size = box.size();
    const double edge = std::max(1.0, std::max({size.x, size.y, size.z}) / kMostVoxels);
    lattice->points = Index3(glm::ceil(size / edge)) + 1;
    lattice->axes = Mat3(edge);
    lattice->origin = 0.5 * (box.lower + box.upper) - 0.5 * edge * (Vec3(lattice->points) - 1.0);
  }
  lattice->last_shown = lattice->points - 1;
  return lattice;
}

std::shared_ptr<const Tractogram> make_bundle_lines(const BundleText& bundle, const BundleGround& ground,
                                                    BundleSet& set, std::vector<std::string>& notes) {
  return BundleMaker(bundle, ground, set, notes).make();
}

std::shared_ptr<const BundleSet> make_bundles(const BundleGround& ground,
                                              const std::vector<SliceImage>& images,
                                              std::vector<std::string>& notes) {
  const TractAppearance& asked = ground.document.tract_appearance;
  if (asked.bundles.empty()) return nullptr;
  auto set = std::make_shared<BundleSet>();
  const SliceImage* const image =
      asked.bundle_profile.empty() ? nullptr : find_slice_image(images, asked.bundle_profile);
  if (image == nullptr && !asked.bundle_profile.empty())
    notes.push_back("WARNING: --bundle-profile " + asked.bundle_profile +
                    ": slices of this image do not show it; nothing is plotted");
  set->texts = asked.bundles;
  for (const std::string& text : asked.bundles) {
    const BundleText bundle = parse_bundle(text);
    BundleView view{.text = steps_text(bundle.steps), .lines = nullptr};
    const BundleView* same = nullptr;
    if (ground.before != nullptr) {
      const auto found = std::ranges::find(ground.before->bundles, view.text, &BundleView::text);
      if (found != ground.before->bundles.end()) same = &*found;
    }
    if (same != nullptr) {
      view = *same;
      // Sources of what has not changed stay, for the next edit.
      for (const auto& [key, lines] : ground.before->sources) {
        if (view.text.find(key) != std::string::npos) set->sources.emplace(key, lines);
      }
    } else {
      view.lines = make_bundle_lines(bundle, ground, *set, view.notes);
      const TractogramLengths lengths = lengths_of(*view.lines);
      view.shortest = lengths.least;
      view.median = lengths.median;
      view.longest = lengths.most;
      const BundleDensity density = bundle_density(*view.lines, *view.lines->image);
      view.volume = density.volume;
      view.outside = density.outside;
    }
    notes.insert(notes.end(), view.notes.begin(), view.notes.end());
    measure(image, view);
    set->bundles.push_back(std::move(view));
  }
  return set;
}

std::shared_ptr<const TractBundle> drawn_together(const std::shared_ptr<const TractBundle>& tracts,
                                                  const BundleSet& set, const std::vector<SliceImage>& images,
                                                  std::vector<std::string>& notes) {
  Tractogram all;
  std::vector<std::uint32_t> colors;
  if (tracts) {
    all.points = tracts->lines->points;
    all.starts = tracts->lines->starts;
    colors.assign(all.points.size(), TractBundle::kByDirection);
  }
  for (std::size_t i = 0; i < set.bundles.size(); ++i) {
    const BundleText bundle = parse_bundle(set.texts[i]);
    if (!bundle.shown) continue;
    const bool plain = bundle.color == "direction" || color_of_text(bundle.color);
    const SliceImage* const image = plain ? nullptr : find_slice_image(images, bundle.color);
    if (!plain && image == nullptr)
      notes.push_back("WARNING: bundle " + bundle.name + ": color=" + bundle.color +
                      ": slices of this image do not show it; coloured by direction");
    const Tractogram& lines = *set.bundles[i].lines;
    add_colors(bundle.color, image, lines, colors);
    const std::size_t before = all.points.size();
    all.points.insert(all.points.end(), lines.points.begin(), lines.points.end());
    for (std::size_t l = 0; l < lines.line_count(); ++l) all.starts.push_back(before + lines.starts[l + 1]);
  }
  if (all.line_count() == 0) return nullptr;
  return make_tract_bundle(std::make_shared<const Tractogram>(std::move(all)), std::move(colors));
}

}  // namespace palpate
