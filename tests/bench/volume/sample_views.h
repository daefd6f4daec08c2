/// The two real volumes of the benchmarks, each seen through a transfer function that suits it.
#pragma once

#include <string>

#include "common/field/transfer/color_transfer.h"
#include "tests/bench/volume/vtk_side.h"

namespace palpate::bench {

/// A CT of a tooth: enamel before dentine.
inline VolumeView tooth_view(const std::string& file) {
  VolumeView view;
  view.image = read_sample(file);
  view.transfer = ColorTransfer({{499.0, {0.6F, 0.3F, 0.2F}, 0.0},
                                 {500.0, {0.6F, 0.3F, 0.2F}, 0.005},
                                 {800.0, {0.9F, 0.6F, 0.3F}, 0.08},
                                 {1300.0, {1.0F, 1.0F, 1.0F}, 0.5}});
  return view;
}

/// An MR image of a head: the skin faint before the brain.
inline VolumeView head_view(const std::string& file) {
  VolumeView view;
  view.image = read_sample(file);
  view.transfer = ColorTransfer({{59.0, {0.4F, 0.2F, 0.2F}, 0.0},
                                 {60.0, {0.4F, 0.2F, 0.2F}, 0.002},
                                 {120.0, {0.8F, 0.5F, 0.4F}, 0.04},
                                 {255.0, {1.0F, 1.0F, 1.0F}, 0.4}});
  return view;
}

}  // namespace palpate::bench
