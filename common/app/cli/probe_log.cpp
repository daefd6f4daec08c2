#include "common/app/cli/probe_log.h"

#include "common/base/text.h"
#include "common/field/tensor/measures_at.h"

namespace palpate {

ProbeLog::ProbeLog(OutputFile& file, const Workspace& workspace, int links, const TensorField* tensors)
    : file_(file), workspace_(workspace), links_(links), tensors_(tensors) {
  std::string header = "t,x,y,z,px,py,pz,fx,fy,fz,state,residual,us";
  for (int i = 1; i <= links; ++i) {
    for (const char* axis : {"x", "y", "z"}) {
      header += ",p";
      header += std::to_string(i) + axis;
    }
  }
  if (tensors != nullptr) header += ",force,cl,cp,cs,fa";
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
    add_vector(
        in_data(there ? step.chain.proxies[static_cast<std::size_t>(i)] : step.probe, row, step, workspace_));
  }
  if (tensors_ != nullptr) {
    const TensorMeasures measures = measures_at(*tensors_, proxy, hint_);
    for (const double value : {glm::length(step.force), measures.parts.linear, measures.parts.planar,
                               measures.parts.spherical, measures.fractional_anisotropy})
      (line_ += ',') += exact_number(value);
  }
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
