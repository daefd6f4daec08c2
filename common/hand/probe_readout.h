/// What is read out of the probe beside the picture: the state of the hand, and the data at the proxy.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/field/vector_field.h"
#include "common/hand/mode/chain_description.h"
#include "common/math/vec.h"
#include "common/servo/servo_loop.h"

namespace palpate {

/// Data units unless stated.
struct ProbeReadout {
  bool held = false;  ///< a hand is on the probe
  bool acts = false;  ///< and holds its button
  HoldState state = HoldState::kFree;
  ForceCut cut = ForceCut::kNone;
  Vec3 probe{0.0};
  Vec3 proxy{0.0};
  std::vector<Vec3> links;  ///< the proxies of all links, in the order of the chain
  std::string cell;         ///< of the grid, at the proxy: a number, or i j k; empty where there is none
  Vec3 velocity{0.0};       ///< at the proxy, of a flow; meaningless where `sampled` is false
  bool sampled = false;
  std::optional<Mat3> tensor;    ///< at the proxy, of an image of tensors; none where there is none
  std::optional<double> scalar;  ///< at the proxy, of the scalar that is felt; none outside the data
  std::string scalar_name;       ///< empty where none is felt
  /// There, where it is felt as a texture, as a part of the range of the values.
  std::optional<double> noise;
  int popped = 0;  ///< times that the hand has gone over to another line, or through a surface
  double residual = 0.0;
  double force = 0.0;                ///< [N]
  double stretch = 0.0;              ///< [mm]
  double perceived_stiffness = 0.0;  ///< [N/m] as ChainStep has it
  ServoState servo;                  ///< rates and lateness
  std::string fault;   ///< where the seconds before the last fault were saved, a sentence; empty: none
  std::string device;  ///< what the user should know or do about a real device now; empty: nothing
};

/// Cells that were sampled last.
struct ReadoutHints {
  CellHint field, scalar, noise;
};

/// Samples what is open at `readout.proxy`. @param noise that is felt there; null: none is.
void read_data(const NamedField& open, const ScalarField* noise, ReadoutHints& hints, ProbeReadout& readout);

}  // namespace palpate
