#include "common/load/format.h"

#include <array>

namespace palpate {

std::string_view name_of(Format format) noexcept {
  static constexpr std::array<std::string_view, kFormatCount> kNames{"legacy VTK",      "VTK XML",
                                                                     "VTK multi-block", "VTK XML in pieces",
                                                                     "VTK time series", "PLOT3D",
                                                                     "EnSight",         "Exodus II",
                                                                     "OpenFOAM",        "NRRD",
                                                                     "NIfTI",           "MetaImage",
                                                                     "MRtrix image",    "EX",
                                                                     "openCARP",        "TetGen",
                                                                     "MRtrix tracks",   "TrackVis tracks",
                                                                     "TRX tracks",      "DICOM",
                                                                     "OpenVDB",         "raw voxels"};
  return kNames[static_cast<std::size_t>(format)];
}

std::string_view helper_of(Format format) noexcept {
  switch (format) {
    case Format::kLegacyVtk:
    case Format::kVtkXml:
    case Format::kVtkMultiBlock:
    case Format::kVtkParallel:
    case Format::kParaviewSeries:
      return "palpate-load-vtk";
    case Format::kNrrd:
      return "palpate-load-nrrd";
    case Format::kNifti:
      return "palpate-load-nifti";
    case Format::kMetaImage:
      return "palpate-load-meta";
    case Format::kMrtrixImage:
      return "palpate-load-mif";
    case Format::kEx:
    case Format::kCarp:
    case Format::kTetgen:
      return "palpate-load-cardiac";
    case Format::kTck:
    case Format::kTrk:
    case Format::kTrx:
      return "palpate-load-tract";
    case Format::kDicom:
      return "palpate-load-dicom";
    case Format::kVdb:
      return "palpate-load-vdb";
    case Format::kRaw:
      return "palpate-load-raw";
    default:
      return "palpate-load-solver";
  }
}

}  // namespace palpate
