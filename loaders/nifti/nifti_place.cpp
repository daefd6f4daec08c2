#include "loaders/nifti/nifti_place.h"

#include <algorithm>
#include <cmath>

#include "common/base/error.h"
#include "common/base/text.h"

namespace palpate {
namespace {

/// Millimetres in the header's unit of length.
double millimetres(const nifti_image& image, std::vector<std::string>& notes) {
  switch (image.xyz_units) {
    case NIFTI_UNITS_METER:
      notes.emplace_back("coordinates turned from metres into mm");
      return 1e3;
    case NIFTI_UNITS_MICRON:
      notes.emplace_back("coordinates turned from micrometres into mm");
      return 1e-3;
    case NIFTI_UNITS_MM:
      return 1.0;
    default:
      notes.emplace_back("the header names no unit of length; taken for mm");
      return 1.0;
  }
}

void set_transform(const nifti_dmat44& m, double unit, UniformTopology& topology) {
  for (int row = 0; row < 3; ++row) {
    for (int axis = 0; axis < 3; ++axis) topology.axes[axis][row] = unit * m.m[row][axis];
    topology.origin[row] = unit * m.m[row][3];
  }
}

/// How far the two transforms of a header put the same voxel apart at most [mm].
double farthest_apart(const UniformTopology& a, const UniformTopology& b) {
  double farthest = 0.0;
  for (unsigned corner = 0; corner < 8; ++corner) {
    Vec3 index{0.0};
    for (int axis = 0; axis < 3; ++axis) {
      if ((corner >> static_cast<unsigned>(axis) & 1U) != 0) index[axis] = a.points[axis] - 1;
    }
    farthest = std::max(farthest, glm::distance(a.origin + a.axes * index, b.origin + b.axes * index));
  }
  return farthest;
}

bool all_zero(const nifti_dmat44& m) {
  for (int row = 0; row < 3; ++row) {
    for (int axis = 0; axis < 3; ++axis) {
      if (m.m[row][axis] != 0.0) return false;
    }
  }
  return true;
}

std::string space_name(int code) {
  switch (code) {
    case NIFTI_XFORM_SCANNER_ANAT:
      return "scanner space";
    case NIFTI_XFORM_ALIGNED_ANAT:
      return "aligned to another image";
    case NIFTI_XFORM_TALAIRACH:
      return "Talairach space";
    case NIFTI_XFORM_MNI_152:
      return "MNI 152 space";
    default:
      return "space " + std::to_string(code);
  }
}

}  // namespace

NiftiPlace place_nifti(const nifti_image& image, bool left_handed, const std::string& file) {
  NiftiPlace place;
  UniformTopology& topology = place.topology;
  topology.points = {static_cast<int>(image.nx), static_cast<int>(image.ny), static_cast<int>(image.nz)};
  const double unit = millimetres(image, place.notes);
  const bool zero = image.sform_code > 0 && all_zero(image.sto_xyz);
  const bool sform = image.sform_code > 0 && !zero;
  if (zero)
    place.notes.push_back("WARNING: the header claims an sform (" + space_name(image.sform_code) +
                          ") that is zero: left aside");
  place.anatomical = sform || image.qform_code > 0;
  if (sform) {
    set_transform(image.sto_xyz, unit, topology);
    place.notes.push_back("RAS+ mm from the sform, " + space_name(image.sform_code));
    if (image.qform_code > 0) {
      UniformTopology other = topology;
      set_transform(image.qto_xyz, unit, other);
      const double apart = farthest_apart(topology, other);
      const double voxel = std::min(
          {glm::length(topology.axes[0]), glm::length(topology.axes[1]), glm::length(topology.axes[2])});
      if (apart > 0.5 * voxel)
        place.notes.push_back("the header's qform lies up to " + short_number(apart) + " mm from its sform");
    }
  } else if (image.qform_code > 0) {
    set_transform(image.qto_xyz, unit, topology);
    place.notes.push_back("RAS+ mm from the qform, " + space_name(image.qform_code));
  } else {
    topology.axes = Mat3{0.0};
    for (int axis = 0; axis < 3; ++axis) topology.axes[axis][axis] = unit * std::abs(image.pixdim[axis + 1]);
    if (left_handed) topology.axes[0] = -topology.axes[0];
    place.notes.push_back(
        "WARNING: neither sform nor qform: spacings alone, no orientation known; taken as " +
        std::string(left_handed ? "left-handed, from right to left" : "right-handed, from left to right") +
        " (--handedness). Programs disagree here: left and right may be mirrored, and so may gradients along x");
  }
  // Steps of any unit: it is their directions that must span space.
  const double steps =
      glm::length(topology.axes[0]) * glm::length(topology.axes[1]) * glm::length(topology.axes[2]);
  constexpr double kFlat = 1e-9;
  if (!(std::abs(glm::determinant(topology.axes)) > kFlat * steps) || !std::isfinite(steps) ||
      !is_finite(topology.origin)) {
    throw input_error({file, "header", "its axes span no volume", "three independent, finite directions"});
  }
  return place;
}

}  // namespace palpate
