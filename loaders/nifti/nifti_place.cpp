#include "loaders/nifti/nifti_place.h"

#include <algorithm>
#include <cmath>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/text.h"

namespace palpate {
namespace {

/// Says what becomes of the header's unit of length.
void note_units(const nifti_image& image, std::vector<std::string>& notes) {
  if (image.xyz_units == NIFTI_UNITS_METER) notes.emplace_back("coordinates turned from metres into mm");
  if (image.xyz_units == NIFTI_UNITS_MICRON)
    notes.emplace_back("coordinates turned from micrometres into mm");
  if (nifti_millimetres(image.xyz_units) == 1.0 && image.xyz_units != NIFTI_UNITS_MM)
    notes.emplace_back("the header names no unit of length; taken for mm");
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

NiftiPlace place_nifti(const nifti_image& image, const NiftiQform& qform, std::optional<bool> left_handed,
                       const std::string& file) {
  NiftiPlace place;
  UniformTopology& topology = place.topology;
  topology.points = {static_cast<int>(image.nx), static_cast<int>(image.ny), static_cast<int>(image.nz)};
  const double unit = nifti_millimetres(image.xyz_units);
  note_units(image, place.notes);
  for (int axis = 0; axis < 3; ++axis) {
    const double step = qform.steps[as_size(axis) + 1];
    if ((step == 0.0 || !std::isfinite(step)) && topology.points[axis] > 1 && image.sform_code <= 0)
      place.notes.push_back("WARNING: the header states no step along axis " + std::to_string(axis + 1) +
                            ": taken as 1");
  }
  std::optional<UniformTopology> qform_place;
  if (image.qform_code > 0) qform_place = place_by(qform, topology.points, unit);
  bool sform = image.sform_code > 0;
  if (sform) {
    set_transform(image.sto_xyz, unit, topology);
    const bool zero = topology.axes == Mat3{0.0};
    if (zero || (qform_place && !spans_volume(topology))) {
      sform = false;
      place.notes.push_back("WARNING: the header claims an sform (" + space_name(image.sform_code) +
                            ") that " + (zero ? "is zero" : "spans no volume") + ": left aside");
    }
  }
  if (image.qform_code > 0 && !qform_place) {
    if (!sform)
      throw input_error({file, "header", "its qform is no rotation with steps and a place",
                         "a quaternion of at most unit length, and finite numbers", ""});
    place.notes.push_back("WARNING: the header claims a qform (" + space_name(image.qform_code) +
                          ") that is no rotation with steps and a place: left aside");
  }
  place.anatomical = sform || qform_place;
  if (sform) {
    place.notes.push_back("RAS+ mm from the sform, " + space_name(image.sform_code));
    if (qform_place) {
      const double apart = farthest_apart(topology, *qform_place);
      const double voxel = std::min(
          {glm::length(topology.axes[0]), glm::length(topology.axes[1]), glm::length(topology.axes[2])});
      if (apart > 0.5 * voxel)
        place.notes.push_back("the header's qform lies up to " + short_number(apart) + " mm from its sform");
    }
  } else if (qform_place) {
    topology = *qform_place;
    place.notes.push_back("RAS+ mm from the qform, " + space_name(image.qform_code));
  } else {
    topology.axes = Mat3{0.0};
    topology.origin = Vec3{0.0};
    for (int axis = 0; axis < 3; ++axis) {
      const double step = std::abs(qform.steps[as_size(axis) + 1]);
      topology.axes[axis][axis] = unit * (step > 0.0 && std::isfinite(step) ? step : 1.0);
    }
    if (left_handed.value_or(false)) topology.axes[0] = -topology.axes[0];
    place.notes.push_back(
        "WARNING: neither sform nor qform: spacings alone, no orientation known; taken as " +
        std::string(left_handed.value_or(false) ? "left-handed, from right to left"
                                                : "right-handed, from left to right") +
        (left_handed ? " (--handedness)" : "") + ". Programs disagree here: left and right may be mirrored" +
        (left_handed ? ", and so may gradients along x" : ""));
  }
  if (!spans_volume(topology)) {
    throw input_error({file, "header", "its axes span no volume", "three independent, finite directions"});
  }
  return place;
}

}  // namespace palpate
