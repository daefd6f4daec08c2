#include "common/compose/line_color.h"

#include <array>
#include <functional>
#include <limits>
#include <utility>

#include "common/base/error.h"
#include "common/base/ledger.h"
#include "common/base/parallel.h"

namespace palpate {
namespace {

constexpr std::array<std::pair<const char*, Measure>, 4> kMeasures{
    {{"divergence", Measure::kDivergence},
     {"vorticity", Measure::kVorticityMagnitude},
     {"q", Measure::kQ},
     {"lambda2", Measure::kLambda2}}};

template <typename Sampler>
std::shared_ptr<const LineArray> sampled(const std::string& name, const std::vector<Line>& lines, int threads,
                                         const Sampler& sampler) {
  std::vector<std::size_t> first{0};
  for (const Line& line : lines) first.push_back(first.back() + line.points.size());
  auto array = std::make_shared<LineArray>();
  array->name = name;
  array->at = [sampler](const Vec3& x, CellHint& hint) {
    const ScalarSample s = sampler(x, hint);
    return s.status == SampleStatus::kOk ? s.value : std::numeric_limits<double>::quiet_NaN();
  };
  array->values.resize(first.back());
  parallel_for(lines.size(), threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t l = begin; l < end; ++l) {
      CellHint hint;
      for (std::size_t p = 0; p < lines[l].points.size(); ++p)
        array->values[first[l] + p] = static_cast<float>(array->at(lines[l].points[p].position, hint));
    }
  });
  return array;
}

}  // namespace

std::optional<Measure> measure_of(const std::string& name) {
  for (const auto& [word, measure] : kMeasures) {
    if (name == word) return measure;
  }
  return std::nullopt;
}

std::vector<std::string> measure_names() {
  std::vector<std::string> names;
  for (const auto& [word, measure] : kMeasures) names.emplace_back(word);
  return names;
}

std::vector<std::string> color_arrays(const Input& input) {
  std::vector<std::string> names = measure_names();
  for (const ArrayInfo& array : input.arrays()) names.push_back(array.name);
  return names;
}

LineColor line_color(const std::string& name, const Input& input) {
  if (name.empty()) return {};
  if (const auto measure = measure_of(name)) return {.by = ColorBy::kArray, .measure = measure, .name = name};
  for (const ArrayInfo& array : input.arrays()) {
    if (array.name != name) continue;
    const int component = array.components == 1 ? 0 : ScalarChoice::kMagnitude;
    return {.by = ColorBy::kArray, .array = ScalarChoice{name, array.association, component}, .name = name};
  }
  try {
    return {.by = color_by_from_name(name), .name = name};
  } catch (const Error& error) {
    std::string others;
    for (const std::string& other : color_arrays(input)) others += ", " + other;
    throw usage_error(error.what() + others);
  }
}

LineStyle line_style(const LineColor& color, Input& input, const std::shared_ptr<const VectorField>& field,
                     const std::vector<Line>& lines, int threads, Progress* progress) {
  LineStyle style{.color_by = color.by};
  if (color.measure) {
    const Work work("measures of the velocity gradient", color.name + " at the points of the lines");
    style.array =
        sampled(color.name, lines, threads, [field, measure = *color.measure](const Vec3& x, CellHint& hint) {
          return sample_measure(*field, measure, x, hint);
        });
  } else if (color.array) {
    if (progress) progress->begin("reading " + color.name, 0);
    const std::vector<DataSet> blocks = input.read({color.array->array}, progress);
    const auto scalar =
        make_scalar_field(*field, blocks, *color.array, input.spec().files.front().string(), threads);
    style.array = sampled(color.name, lines, threads,
                          [scalar](const Vec3& x, CellHint& hint) { return scalar->sample(x, hint); });
  }
  return style;
}

}  // namespace palpate
