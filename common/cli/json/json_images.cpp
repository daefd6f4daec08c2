#include "common/base/version.h"
#include "common/cli/json/json_output.h"
#include "common/cli/json/json_parts.h"

namespace palpate {

std::string image_json(const ImageSummary& summary) {
  const Json json{{"input", summary.input},
                  {"field", summary.field},
                  {"out", summary.output},
                  {"what", summary.what},
                  {"voxels", summary.voxels},
                  {"with_tensor", summary.with_tensor},
                  {"lifted", summary.lifted},
                  {"unusable", summary.unusable},
                  {"negative", summary.negative},
                  {"suggested_turn", summary.turn},
                  {"turn_gain", summary.gain},
                  {"notes", summary.notes},
                  {"seconds_load", summary.seconds_load},
                  {"seconds_made", summary.seconds_made},
                  {"seconds_write", summary.seconds_write},
                  {"version", version()}};
  return json_text(json);
}

std::string lattice_json(const LatticeSummary& summary) {
  const auto list = [](const Vec3& v) { return Json{v.x, v.y, v.z}; };
  const UniformTopology& lattice = summary.lattice;
  const Json json{{"input", summary.input},
                  {"field", summary.field},
                  {"out", summary.output},
                  {"size", {lattice.points.x, lattice.points.y, lattice.points.z}},
                  {"origin", list(lattice.origin)},
                  {"axes", {list(lattice.axes[0]), list(lattice.axes[1]), list(lattice.axes[2])}},
                  {"right", summary.right},
                  {"up", summary.up},
                  {"outside", summary.outside},
                  {"range", {summary.lowest, summary.highest}},
                  {"window", summary.window},
                  {"level", summary.level},
                  {"lines", summary.lines},
                  {"seconds_load", summary.seconds_load},
                  {"seconds_made", summary.seconds_made},
                  {"version", version()}};
  return json_text(json);
}

}  // namespace palpate
