#include "common/cli/json/json_parts.h"

#include <string>

#include "common/base/index.h"

namespace palpate {

Json vec_json(const Vec3& x) { return {x.x, x.y, x.z}; }
Json box_json(const Box& box) { return {{"lower", vec_json(box.lower)}, {"upper", vec_json(box.upper)}}; }

Json lines_json(const LinesSummary& lines) {
  return {{"lines", lines.lines},
          {"points", lines.points},
          {"length_min", lines.lengths.least},
          {"length_median", lines.lengths.median},
          {"length_mean", lines.lengths.mean},
          {"length_max", lines.lengths.most},
          {"length_bin", lines.lengths.bin},
          {"length_histogram", lines.lengths.histogram}};
}

Json ends_json(const std::array<std::size_t, kEndCount>& counts) {
  Json ends = Json::object();
  for (int e = 0; e < kEndCount; ++e) {
    ends[std::string(name_of(static_cast<End>(e)))] = counts[as_size(e)];
  }
  return ends;
}

}  // namespace palpate
