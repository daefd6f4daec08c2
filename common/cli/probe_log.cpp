#include "common/cli/probe_log.h"

#include <cmath>

#include "common/base/index.h"
#include "common/base/text.h"
#include "common/field/tensor/tensor_measure.h"
#include "common/field/value_histogram.h"

namespace palpate {

ProbeLog::ProbeLog(OutputFile& file, const Workspace& workspace, int links, const Measured& measured)
    : file_(file), workspace_(workspace), links_(links), measured_(measured) {
  std::string header = "t,x,y,z,px,py,pz,fx,fy,fz,state,residual,us";
  for (int i = 1; i <= links; ++i) {
    for (const char* axis : {"x", "y", "z"}) {
      header += ",p";
      header += std::to_string(i) + axis;
    }
  }
  if (measured.tensors != nullptr) header += ",force,cl,cp,cs,fa";
  if (measured.scalar != nullptr) {
    header += ",value,below";
    if (measured.scalar->lowest() <= measured.scalar->highest())
      histogram_ = value_histogram(*measured.scalar);
  }
  if (measured.noise != nullptr) header += ",noise";
  for (const VolumeField& field : measured.secondary) header += ",value:" + field.name;
  file_.write(header + "\n");
}

void ProbeLog::add(const PathRow& row, const HandStep& step, double microseconds) {
  line_.clear();
  line_ += exact_number(row.time);
  add_vector(row.position);
  const Vec3 proxy = in_data(step.chain.proxy(step.probe), row, step, workspace_);
  add_vector(proxy);
  add_vector(step.force);
  (line_ += ',').append(name_of(step.state));
  (line_ += ',') += exact_number(step.chain.residual / workspace_.scale());
  (line_ += ',') += short_number(microseconds);
  for (int i = 0; i < links_; ++i) {
    const bool there = i < step.chain.links;
    add_vector(in_data(there ? step.chain.proxies[as_size(i)] : step.probe, row, step, workspace_));
  }
  if (measured_.tensors != nullptr) {
    const TensorMeasures measures = measures_at(*measured_.tensors, proxy, hint_);
    for (const double value : {glm::length(step.force), measures.parts.linear, measures.parts.planar,
                               measures.parts.spherical, measures.fractional_anisotropy})
      (line_ += ',') += exact_number(value);
  }
  if (measured_.scalar != nullptr) {
    const ScalarSample sample = measured_.scalar->sample(proxy, hint_);
    const bool there = sample.status == SampleStatus::kOk;
    const double local = sample.value * measured_.scalar->value_scale();
    (line_ += ',') += exact_number(there ? sample.value : NAN);
    (line_ += ',') += exact_number(there ? part_below(histogram_, local) : NAN);
  }
  if (measured_.noise != nullptr) {
    const ScalarSample sample = measured_.noise->sample(proxy, noise_hint_);
    (line_ += ',') += exact_number(sample.status == SampleStatus::kOk ? sample.value : NAN);
  }
  for (const VolumeField& field : measured_.secondary)
    (line_ += ',') += exact_number(field.image->value_at(proxy));
  line_ += '\n';
  file_.write(line_);
}

Vec3 ProbeLog::in_data(const Vec3& proxy, const PathRow& row, const HandStep& step,
                       const Workspace& workspace) {
  return proxy == step.probe && is_finite(row.position) ? row.position : workspace.data_from_workspace(proxy);
}

void ProbeLog::add_vector(const Vec3& v) {
  for (int axis = 0; axis < 3; ++axis) (line_ += ',') += exact_number(v[axis]);
}

}  // namespace palpate
