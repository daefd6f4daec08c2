/// The file formats that the loaders read, and which helper program reads which.
#pragma once

#include <cstdint>
#include <string_view>

namespace palpate {

enum class Format : std::uint8_t {
  kLegacyVtk,       ///< "# vtk DataFile"
  kVtkXml,          ///< .vti .vtr .vts .vtu .vtp
  kVtkMultiBlock,   ///< .vtm: an index of blocks
  kVtkParallel,     ///< .pvti .pvtr .pvts .pvtu .pvtp: an index of pieces
  kParaviewSeries,  ///< .pvd, or .vtu.series: an index of time steps
  kPlot3d,
  kEnsight,
  kExodus,
  kOpenFoam,
  kNrrd,
  kNifti,
  kMetaImage,    ///< .mha, .mhd
  kMrtrixImage,  ///< .mif, .mih
  kEx,           ///< .exnode, .exelem: finite element models of CMISS and OpenCMISS
  kCarp,         ///< openCARP: .pts, .elem, .lon
  kTetgen,       ///< TetGen and Chaste: .node, .ele, .face, .ortho, .axi, .bases
  kTck,          ///< MRtrix tracks
  kTrk,          ///< TrackVis
  kTrx,          ///< tractograms as a folder or zip file
  kDicom,        ///< a series of slices, in files of one folder
  kVdb,          ///< OpenVDB: sparse grids
  kRaw           ///< voxels without a header: never found by content
};
inline constexpr int kFormatCount = 22;

/// "legacy VTK", as `info` shows it.
[[nodiscard]] std::string_view name_of(Format format) noexcept;

/// The helper program that reads it: "palpate-load-vtk". The VTK formats proper have a helper of their own
/// since the readers of solver formats pull in 80 more libraries and start several times more slowly.
[[nodiscard]] std::string_view helper_of(Format format) noexcept;

}  // namespace palpate
