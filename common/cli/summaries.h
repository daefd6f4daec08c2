/// What the verbs found out, as plain values: printed as text by the verb, as JSON by json_output.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/compose/resampled_volume.h"
#include "common/device/device.h"
#include "common/field/array_statistics.h"
#include "common/field/grid/mesh_quality.h"
#include "common/geometry/annotation.h"
#include "common/geometry/tractogram.h"
#include "common/hand/technique/scene_pick.h"
#include "common/haptics/constraint.h"
#include "common/render/budget/frame_quality.h"
#include "common/render/volume/estimate/image_error.h"
#include "common/render/volume/volume_view.h"
#include "common/scene/input.h"
#include "common/servo/servo_loop.h"
#include "common/trace/line_errors.h"
#include "common/trace/trace.h"
#include "common/trace/tract/trace_tracts.h"
#include "common/trace/tract/tract_orientation.h"
#include "common/trace/unsteady/trace_unsteady.h"

namespace palpate {

struct TraceSummary {
  std::string input;
  std::string field;
  std::string output;  ///< empty: none
  std::size_t seeds = 0;
  std::vector<Vec3> seed_points;
  TraceResult result;  ///< lines included
  LineKind kind = LineKind::kStreamlines;
  InTime in_time;  ///< of all kinds but streamlines
  double tolerance = 0.0;
  double diagonal = 0.0;
  double max_length = 0.0;  ///< data units, as applied
  int threads = 0;
  double seconds_load = 0.0;
  double seconds_write = 0.0;
  std::vector<std::string> advice;  ///< what to change
  std::string failure;              ///< why there is no line; empty where there is one
};

struct TractSummary {
  std::string input;
  std::string field;
  std::string output;  ///< empty: none
  std::size_t seeds = 0;
  TractOptions options;
  TractResult result;  ///< lines included
  LineErrors errors;
  int threads = 0;
  double seconds_load = 0.0;
  double seconds_prepare = 0.0;  ///< field, regions and seeds
  double seconds_write = 0.0;
  std::vector<std::string> advice;  ///< what to change
  std::string failure;              ///< why there is no line; empty where there is one
};

struct ArraySummary {
  ArrayInfo info;
  ArrayStatistics statistics;
};

/// Lines of a file, and how long they are.
struct LinesSummary {
  std::size_t lines = 0;
  std::size_t points = 0;
  TractogramLengths lengths;
};

/// The surfaces of a wall; lengths and areas in data units.
struct WallSurfacesSummary {
  struct Part {
    std::string name;
    double area = 0.0;
    std::size_t pieces = 0;  ///< that hang together, of 1 % of the border at least
  };
  std::string output;
  std::vector<Part> parts;
  double confidence = 0.0;  ///< the part of the border's area that has a role
  double monotone = 0.0;    ///< the share of points from which the depth rises and falls to the surfaces
  double thinnest = 0.0, median = 0.0, thickest = 0.0;  ///< wall from its inner surfaces
  std::vector<std::string> notes;                       ///< how they were found, and what is doubtful
};

struct InfoSummary {
  const Input* input = nullptr;
  std::optional<WallSurfacesSummary> surfaces;  ///< of a wall, where they were asked for
  std::vector<ArraySummary> arrays;
  std::vector<std::string> orientation;       ///< a sentence a block
  std::string field;                          ///< empty: none can be made
  double max_speed = 0.0;                     ///< of a vector field
  std::optional<ComponentRange> field_range;  ///< of a scalar field with finite values
  double largest_trace = 0.0;                 ///< of a tensor field, in the data's units
  std::size_t negative_tensors = 0;           ///< of a tensor field: with an eigenvalue below zero
  std::optional<LinesSummary> tracts;         ///< of a file of lines
  std::string no_layers;                      ///< why a heart has none and none can be made; empty: they can
  Box bounds;
  std::uint64_t memory_bytes = 0;  ///< arrays as stored
  std::vector<std::string> notes;
  double seconds_load = 0.0;
};

struct ProbeSummary {
  std::string input;
  std::string field;
  std::string mode;
  std::string scalar;                 ///< of which isosurfaces are felt; empty: of none
  std::string output;                 ///< empty: none
  std::vector<std::string> fixtures;  ///< as they were asked for, in the order of the chain
  PlanePoses planes;                  ///< of the plane widget at the end, data coordinates
  std::vector<Vec4> landmarks;        ///< of the grid: n, d with n.x = d
  std::optional<Box> box;  ///< of interest, where the hand has left it on a haptic grid, data coordinates
  std::optional<Vec3> focal_point;  ///< of the view that the hand has moved over the grid
  std::string tract;                ///< where the way of the proxy was saved; empty: nowhere
  std::size_t tracts = 0;           ///< in it
  std::size_t steps = 0;
  ChainSettings settings;
  DeviceLimits limits;
  std::string device;  ///< whose hand it was, "Novint Falcon class in a firm hand"; empty: the path itself
  double workspace_scale = 0.0;  ///< [m] per data unit
  double max_force = 0.0;        ///< [N]
  double least_perceived = 0.0;  ///< [N/m] ChainStep::perceived_stiffness, the least; 0: nothing pulled
  double max_residual = 0.0;     ///< data units
  double diagonal = 0.0;         ///< data units
  std::array<std::size_t, kHoldStateCount> states{};
  std::string replay;  ///< verdict on a replayed recording; empty: it was none
  bool replay_differs = false;
  std::vector<std::string> changed_inputs;          ///< of the recording, a sentence each
  double us_p50 = 0.0, us_p99 = 0.0, us_max = 0.0;  ///< [us] thread CPU time of a step
  double seconds_load = 0.0;
  double seconds_probe = 0.0;
};

/// What was marked and measured.
struct AnnotationSummary {
  std::string input;
  std::string output;  ///< empty: none
  std::vector<Annotation> annotations;
  std::vector<double> values;  ///< of the volume at their points, one after the other; NaN outside
  std::size_t outside = 0;     ///< points
};

/// An image that was written.
struct ImageSummary {
  std::string input;
  std::string field;
  std::string output;
  std::string what;  ///< "fa"
  std::size_t voxels = 0;
  std::size_t with_tensor = 0;  ///< voxels
  std::size_t lifted = 0;       ///< of a fit: counts of TensorFit
  std::size_t unusable = 0;
  std::size_t negative = 0;
  std::string turn;  ///< that the orientation check suggests; empty: none
  double gain = 1.0;
  double seconds_load = 0.0;
  double seconds_made = 0.0;
  double seconds_write = 0.0;
  std::vector<std::string> notes;
};

/// A slice or a part of a volume that was written.
struct LatticeSummary {
  std::string input;
  std::string field;
  std::string output;
  UniformTopology lattice;
  std::string right, up;  ///< what lies there in a slice, in words; empty for a volume
  std::size_t outside = 0;
  double lowest = 0.0, highest = 0.0;  ///< of the data
  double window = 0.0, level = 0.0;    ///< of a picture
  std::size_t lines = 0;               ///< of equal value, written in place of an image
  double seconds_load = 0.0;
  double seconds_made = 0.0;
};

/// Tracts held against an image.
struct TractFitSummary {
  std::string input;   ///< the image
  std::string tracts;  ///< the file of lines
  std::string output;  ///< empty: none
  LinesSummary lines;  ///< as written
  TractFit fit;        ///< as read
  std::string turn;    ///< that was asked for; empty: none
  std::vector<std::string> notes;
};

/// A map of a heart's angles that was written.
struct MapSummary {
  /// The mean over the points of a range of depths.
  struct Band {
    double depth = 0.0;      ///< the middle of the range
    double mean = 0.0;       ///< degrees; of angles the mean of directions without sign
    double deviation = 0.0;  ///< root mean square from it
    std::size_t points = 0;  ///< where the angle is defined
  };
  std::string input;
  std::string field;
  std::string output;
  std::string angle;       ///< "helix"
  std::string convention;  ///< empty for what is no angle
  Vec3 axis{0.0};          ///< zero for what needs none
  std::size_t points = 0;
  std::size_t undefined = 0;
  std::vector<Band> bands;
  std::size_t lines = 0;        ///< of equal value
  std::optional<double> layer;  ///< on which they are; none: none are written
  double seconds_load = 0.0;
  double seconds_map = 0.0;
};

/// A scalar at places over time.
struct SeriesSummary {
  std::string input;
  std::string output;  ///< empty: none
  std::string value;   ///< its name
  std::vector<Vec3> places;
  std::vector<double> times;   ///< rising; several alike in the order of the file
  std::vector<double> values;  ///< time after time, of each place; NaN outside and where there is none
  std::size_t unordered = 0;   ///< steps that the file has out of order
  double seconds = 0.0;
};

/// A heart that was written in another format.
struct ConvertSummary {
  std::string input;
  std::vector<std::string> files;
  std::size_t times = 0;  ///< steps; 0: it has no times
  double seconds = 0.0;
};

/// Fibres that were made by a rule.
struct FibreRuleSummary {
  std::string input;
  std::vector<std::string> files;
  std::string rule;
  double endo = 0.0, epi = 0.0, sheet_endo = 0.0, sheet_epi = 0.0;  ///< [degrees]
  bool doste = false;  ///< turned out of the layer by the next two in place of the sheet's
  double transverse_endo = 0.0, transverse_epi = 0.0, right_endo = 0.0, right_epi = 0.0;  ///< [degrees]
  std::size_t elements = 0;
  std::size_t undefined = 0;  ///< of them where the rule is not: they have the mean of their neighbours
  std::size_t without = 0;    ///< of these without a neighbour that has a direction
  double farthest = 0.0;      ///< of an undefined one from the apex, data units
  double median_turn = 0.0,
         most_turn = 0.0;  ///< of the rule within an element, half and 95 % below [degrees]
  bool two = false;        ///< ventricles
  std::vector<std::string> notes;
  double seconds = 0.0;
};

/// Coordinates of the points of a wall.
struct CoordinatesSummary {
  struct Column {
    std::string name;
    double lower = 0.0, upper = 0.0;
    std::size_t undefined = 0;  ///< points
  };
  std::string input;
  std::string output;  ///< empty: none
  Vec3 axis{0.0};      ///< unit, from apex to base
  Vec3 middle{0.0};    ///< a place on it
  Vec3 apex_inner{0.0}, apex_outer{0.0};
  std::size_t points = 0;
  std::vector<Column> columns;
  std::vector<std::string> notes;
  double seconds = 0.0;
};

/// A wall that was filled with tetrahedra.
struct MeshSummary {
  std::string picture;  ///< file; empty: none
  std::string input;
  std::string output;  ///< empty: none
  std::string mesher;
  MeshQuality quality;
  double exact_volume = 0.0;                        ///< of the curved model; 0: not known
  double cells_volume = 0.0;                        ///< of the cells as sampled
  std::uint64_t outside = 0, flat = 0, shared = 0;  ///< FinishedMesh of the mesher
  std::size_t layer_cells = 0;                      ///< that have a depth
  std::size_t backward_cells = 0;  ///< of these: where it falls along the way out of the wall
  std::vector<std::string> notes;
  double seconds_load = 0.0;
  double seconds_mesh = 0.0;  ///< the next two and passing arrays to and fro
  double seconds_triangulate = 0.0;
  double seconds_choose = 0.0;
  double seconds_report = 0.0;
};

struct RenderSummary {
  std::string input;
  std::string field;
  std::string output;
  int width = 0;
  int height = 0;
  std::size_t lines = 0;
  std::size_t points = 0;
  std::size_t seeds_left_out = 0;  ///< TraceResult::seeds_left_out
  std::size_t voxels = 0;          ///< of a volume
  double first_frame_ms = 0.0;
  double frame_ms = 0.0;
  int frames_timed = 0;
  int frames = 1;                        ///< that were written: of a film more than one
  double frame_rate = 0.0;               ///< of a film [1/s]
  FrameQuality quality;                  ///< that --frame-budget left
  std::optional<double> expected_error;  ///< RenderedImage::expected_error
  bool timer_query = false;              ///< it was held by timer queries, not by the clock
  double image_error = 0.0;
  std::string image_error_kind;
  std::optional<ImageError> estimate;  ///< of a volume: what image_error is from
  double seconds_load = 0.0;
  std::vector<TakenScalar> volumes;  ///< DrawnScene::volumes
  double seconds_trace = 0.0;
  std::string renderer;
  std::string tables_by;         ///< SceneRenderer::tables_by()
  bool picks = false;            ///< --pick
  std::optional<Picked> picked;  ///< by it
  BrickShare bricks;             ///< of a volume that is stored in bricks
};

}  // namespace palpate
