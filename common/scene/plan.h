/// The plan of a scene: what it uses and what it leaves out, with bytes and milliseconds (`--explain`).
#pragma once

#include <string>

#include "common/base/needs.h"
#include "common/scene/input.h"

namespace palpate {

/// What a verb does with its input.
struct SceneUse {
  std::string verb;         ///< "trace"
  bool field = true;        ///< reads the vector field (all verbs but a bare look at the file)
  bool all_arrays = false;  ///< `info`: reads every array for its range
  bool tracing = false;
  bool drawing = false;  ///< a picture or the window
  bool window = false;
  std::string color_array;  ///< array that colours the lines, empty for none
};

/// Plans the scene from what the loader says, before any array is read. Bytes are those of the arrays and of
/// the structures made from them as predicted from point and cell counts; times are unknown (0) until
/// measured.
[[nodiscard]] Needs plan_scene(const Input& input, const SceneUse& use);

/// What making the field took, in the place of the prediction: bytes by `field`, milliseconds by `input`.
void measure_plan(Needs& plan, const Input& input, const VectorField& field);

/// The plan as lines of text: used things first, then those left out.
[[nodiscard]] std::string plan_text(const Needs& plan);

}  // namespace palpate
