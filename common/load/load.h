/// Opening data files: finds the loader by content, runs it as a helper program under memory and time
/// limits, maps the arrays it hands over and checks them.
///
/// The helper stays alive while a Source does, so that a time series is read step by step.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/base/progress.h"
#include "common/field/data_set.h"
#include "common/field/tensor/tensor_source.h"
#include "common/field/vector_choice.h"
#include "common/load/raw_layout.h"

namespace palpate {

/// Asks for tensors, or for what tensors can be fitted to: a fourth axis of an image holds components, not
/// time.
struct DiffusionRequest {
  std::filesystem::path bval;  ///< b-values; empty: those beside the image
  std::filesystem::path bvec;  ///< gradient directions, likewise

  [[nodiscard]] bool names_gradients() const { return !bval.empty() || !bvec.empty(); }
};

/// What a reader is told. A document's InputOptions are one, with words beside it.
struct LoadRequest {
  std::vector<std::filesystem::path> files;       ///< several: blocks to be joined, or a numbered time series
  std::optional<std::filesystem::path> solution;  ///< PLOT3D solution file
  std::optional<RawLayout> raw;                   ///< the file holds voxels without a header
  std::optional<DiffusionRequest> diffusion;
  int refine = 0;      ///< cells along each axis of a curved element (EX models); 0: the loader's own choice
  std::string series;  ///< DICOM: a series of the folder by its number there or its UID; empty: the only one
  bool allow_gaps = false;  ///< DICOM: slices may be missing, and hold no values
  /// NIfTI: images that state no orientation run from right to left.
  bool left_handed = false;
  /// A heart's wall is asked for: numbers and names of the faces of its border may say what they are. Others have no use for them.
  bool wall = false;
  /// Of a wall: which numbers of faces mean the inner and the outer surface, "1,4/2"; empty: by names, or by shape.
  std::string surface_markers;
};

struct LoadLimits {
  std::uint64_t memory_bytes = 0;  ///< of the helper; 0: from the size of the input and the machine
  double seconds = 0.0;            ///< for one answer; 0: from the size of the input
};

/// What a block holds, known before its arrays are read.
struct BlockInfo {
  std::string name;
  std::string grid;  ///< "uniform", "rectilinear", "curvilinear", "unstructured"
  Index3 points{0};  ///< structured grids: points along i, j, k
  std::uint64_t point_count = 0;
  std::uint64_t cell_count = 0;
  Box bounds;
  std::vector<ArrayInfo> arrays;
  /// Why no line in space can be traced in it ("holds points, lines or surfaces …"); empty for a volume.
  std::string not_volume;
  /// Surfaces are among the cells of the volume, or beside it with a number each: a wall's may say what they are.
  bool faces = false;
};

struct FileInfo {
  std::string format;             ///< FormatRow::name, set by serve_loader(); empty: made on the fly
  std::string loader;             ///< helper program that read it, likewise
  std::vector<BlockInfo> blocks;  ///< volumes; where the file has none, what else it holds
  std::vector<double> times;      ///< empty for a single state
  std::string units;              ///< as the file states them ("coordinates in mm"), or empty
  bool anatomical = false;        ///< coordinates are RAS+: x to the right, y to the front, z up
  std::optional<std::array<double, 2>> window;  ///< values that the file wants shown black and white
  std::vector<std::string> notes;               ///< byte order found, blocks skipped, orientation
  DiffusionInfo diffusion;                      ///< where the file holds tensors or what they are fitted to
  double exact_volume = 0.0;      ///< of a model of curved elements, by quadrature; 0: not known
  std::optional<Vec3> long_axis;  ///< of a heart, from apex to base, where the file's coordinates have one
};

/// The field data of a VTK file that hold FileInfo::long_axis: three numbers.
inline constexpr const char* kLongAxisArray = "long_axis";

/// An open input with its helper program. Movable; closing it ends the helper.
class Source {
 public:
  /// @throws Error (bad input: one line naming the file; usage: a helper program is not built) or Cancelled.
  static Source open(const LoadRequest& request, const LoadLimits& limits = {}, Progress* progress = nullptr);
  Source(Source&&) noexcept;
  Source& operator=(Source&&) noexcept;
  ~Source();

  [[nodiscard]] const FileInfo& info() const noexcept;
  /// All arrays of all blocks, of one name and association listed once.
  [[nodiscard]] std::vector<ArrayInfo> arrays() const;
  /// Reads the topology and the named arrays at one time step; no other array is read where the format
  /// allows that.
  [[nodiscard]] std::vector<DataSet> read(const std::vector<std::string>& array_names,
                                          std::size_t time_step = 0, Progress* progress = nullptr);

 private:
  struct State;
  explicit Source(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace palpate
