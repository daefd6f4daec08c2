/// The stiffest wall that the device of a session can show.
#pragma once

#include <string>

#include "common/hand/probe_options.h"
#include "common/haptics/chain_settings.h"

namespace palpate {

class StiffnessLimits {
 public:
  /// `options` outlive it.
  explicit StiffnessLimits(const ProbeSessionOptions& options) : options_(options) {}

  /// Where the stiffness asked for is more than that: one line that names the limit. Empty where it is not,
  /// and for devices that show no force.
  [[nodiscard]] std::string note(const ChainSettings& asked) const;
  /// The limit in words: "passive up to 200 N/m (hold of the servo)", or what the device was tuned to. Empty
  /// for devices that show no force, and where nothing is known.
  [[nodiscard]] std::string text(const ChainSettings& asked) const;

 private:
  const ProbeSessionOptions& options_;
};

}  // namespace palpate
