/// The plan of a scene: what it uses and what it leaves out, with bytes and milliseconds (`--explain`), and
/// what its parts took in the end.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "common/base/needs.h"
#include "common/scene/input.h"

namespace palpate {

/// What a verb does with its input.
struct SceneUse {
  std::string verb;         ///< "trace"
  bool field = true;        ///< reads the vector field (all verbs but a bare look at the file)
  bool all_arrays = false;  ///< `info`: reads every array for its range
  bool tracing = false;
  std::size_t lines = 0;  ///< how many are traced; 0: not known yet
  int threads = 1;        ///< that trace and make the field
  bool drawing = false;   ///< a picture or the window
  bool window = false;
  std::string color_array;                 ///< array that colours the lines, empty for none
  std::vector<std::string> secondary;      ///< scalars and files that lenses of a volume show
  std::vector<std::string> volume_arrays;  ///< arrays that are drawn as volumes beside lines
};

/// Plans the scene from what the loader says, before any array is read. Bytes are those of the arrays and of
/// the structures made from them as predicted from point and cell counts. Times are estimates from rates that
/// were measured once (plan.cpp), good to a factor of a few; 0 where unknown.
[[nodiscard]] Needs plan_scene(const Input& input, const SceneUse& use);

/// The plan as lines of text: used things first, then those left out.
[[nodiscard]] std::string plan_text(const Needs& plan);

/// What a part of the work took.
struct MeasuredCost {
  std::string_view what;  ///< "opening", a literal
  double milliseconds = 0.0;
  std::uint64_t bytes = 0;  ///< 0 where none or unknown
};

/// What opening, reading and making the field took; the verb appends its own part.
/// @param mesh of the field, or null where it is on another grid.
[[nodiscard]] std::vector<MeasuredCost> measured_costs(const Input& input, const TetMesh* mesh);

/// "measured: opening 8.3 ms, arrays 0.7 ms, field 154 ms (13.2 MB), lines 6.3 ms", a line.
[[nodiscard]] std::string measured_text(const std::vector<MeasuredCost>& costs);

}  // namespace palpate
