/// The log of `probe`: a table with one row a step (design contract: t,x,y,z,px,py,pz,fx,fy,fz,state,…).
#pragma once

#include <string>
#include <vector>

#include "common/base/files/output_file.h"
#include "common/device/probe_path.h"
#include "common/field/scalar_field.h"
#include "common/field/tensor/tensor_field.h"
#include "common/field/value_histogram.h"
#include "common/haptics/workspace.h"
#include "common/render/volume/volume_view.h"
#include "common/servo/hand_step.h"

namespace palpate {

class ProbeLog {
 public:
  /// What is measured at the proxy, in columns at the end; null: nothing of that kind.
  struct Measured {
    const TensorField* tensors = nullptr;  ///< force, cl, cp, cs and fa
    const ScalarField* scalar = nullptr;   ///< value, and below: the part of all values that are lower
    const ScalarField* noise = nullptr;    ///< noise, as a part of the range of the values
    std::vector<VolumeField> secondary;    ///< other scalars: value:NAME for each
  };
  ProbeLog(OutputFile& file, const Workspace& workspace, int links, const Measured& measured);

  /// @param row where the probe was, data coordinates. @param microseconds the step took.
  void add(const PathRow& row, const HandStep& step, double microseconds);

  /// The proxy in data coordinates; one that is the probe has the probe's very numbers.
  [[nodiscard]] static Vec3 in_data(const Vec3& proxy, const PathRow& row, const HandStep& step,
                                    const Workspace& workspace);

 private:
  void add_vector(const Vec3& v);

  OutputFile& file_;
  const Workspace& workspace_;
  int links_;
  Measured measured_;
  ValueHistogram histogram_;  ///< of the scalar, local values
  CellHint hint_, noise_hint_;
  std::string line_;
};

}  // namespace palpate
