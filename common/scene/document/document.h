/// The document: all that a user can set of a scene, as a tree of plain values.
///
/// Each value is one row of a table (setting.h), which has its name, unit, range, help and whether sessions
/// keep it. Command line, sessions, panels, JSON and the reference page read these tables; nothing else
/// spells a setting.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "common/scene/document/device_options.h"
#include "common/scene/document/input_options.h"
#include "common/scene/touch_spec.h"

namespace palpate {

/// Taken by every verb.
struct CommonOptions {
  bool json = false;              ///< one JSON object on stdout and nothing else there
  bool quiet = false;             ///< errors only on stderr
  bool explain = false;           ///< print the plan
  bool force = false;             ///< overwrite outputs
  int threads = 0;                ///< 0: all cores
  std::uint64_t seed = 1;         ///< of random numbers
  std::filesystem::path session;  ///< that the document was read from; empty: none
};

/// Where lines start and how they are traced.
struct TracingOptions {
  std::string seeds;       ///< grammar of scene/seeds.h; empty: the verb's default
  std::string direction;   ///< forward, backward, both; empty: the verb's default
  std::string integrator;  ///< empty: exact on tetrahedra, dp54 elsewhere
  double tolerance = 1e-6;
  double step = 0.0;
  double max_length = 0.0;
  double max_time = 0.0;
  std::int64_t max_steps = 1'000'000;
  std::vector<std::string> stop_planes;  ///< nx,ny,nz,d: lines end where n.x = d
  std::string lines = "streamlines";     ///< name_of(LineKind)
  std::string time_order = "linear";     ///< name_of(TimeOrder)
  std::optional<double> release_from;    ///< UnsteadyOptions::from; absent: the time of the input
  double release_every = 0.0;            ///< UnsteadyOptions::every
  std::optional<double> until;           ///< UnsteadyOptions::until
  double memory = 0.0;                   ///< that lines may take [2^20 bytes]; 0: a quarter of the machine's

  bool operator==(const TracingOptions&) const = default;
};

/// Where tracts start, where they go and where they end. Lengths in mm.
struct TractTracingOptions {
  std::string seeds;  ///< grammar of tract_request.h
  int seeds_per_voxel = 1;
  std::string integrator = "dp54";
  double tolerance = 1e-4;
  double step = 0.0;
  std::string measure = "fa";  ///< fa, cl
  double cutoff = 0.2;
  double max_angle = 0.0;  ///< [degrees]
  double min_radius = 0.0;
  double min_length = 0.0;
  double max_length = 0.0;
  std::string direction = "both";  ///< forward, backward, both
  std::int64_t max_steps = 1'000'000;
  std::optional<double> max_cone;  ///< [degrees] of the 95 % cone of the main direction, in (0, 90]
  std::vector<std::string> include, exclude, stop;  ///< regions; grammar of tract_request.h

  bool operator==(const TractTracingOptions&) const = default;
};

/// How it is looked at.
struct ViewOptions {
  std::string camera;  ///< azimuth,elevation,roll,zoom in degrees; empty: the default view
  std::string focal;   ///< x,y,z in the middle of the picture; empty: the middle of what is shown
  std::string background = "dark";       ///< grammar of parse_background()
  bool outline = true;                   ///< edges of the domain
  bool axes = true;                      ///< their directions
  bool color_bar = true;                 ///< and other legends
  std::string color_bar_side = "right";  ///< right, left
  bool scale_bar = false;                ///< SceneView::show_scale_bar
  std::string caption;                   ///< SceneView::caption
  std::string color;                     ///< array that colours the lines; empty: speed
  std::string color_map;                 ///< name_of(ColorMap); empty: default_color_map()
  std::string range;                     ///< lower,upper: what colours spread over; empty: found
  std::optional<bool> log_colors;        ///< LineStyle::logarithmic
  std::optional<double> line_width;      ///< LineStyle::width; absent: as the kind of data has it
  double line_opacity = 1.0;             ///< LineStyle::opacity
  std::optional<bool> halos;             ///< LineStyle::halo; absent: as the kind of data has it
  bool depth_cue = true;                 ///< LineStyle::depth_cue
  double frame_budget = 0.0;     ///< [ms] that a picture may take while something moves; 0: the default
  bool converged = false;        ///< a picture of a volume as a window refines it at rest
  double play_rate = 5.0;        ///< time steps a second
  std::string stereo = "none";   ///< kStereoModeNames
  double eye_separation = 63.0;  ///< [mm]
  double eye_distance = 600.0;   ///< between eyes and screen [mm]
  double disparity_limit = 1.0;  ///< [degrees]
  bool swap_eyes = false;
  /// Where the head is before a screen: x,y,z[,qw,qx,qy,qz] of a tracker [m], replay:FILE.csv, and in windows
  /// hands, or a tracker by its driver; empty: none, or in windows as the workbench says.
  std::string head;
  std::optional<double> head_time;  ///< of that recording [s]; absent: its end
  std::string screen;               ///< which of the workbench's, or all; empty: the first
  std::string pick;  ///< grammar of parse_beam(): what it picks is marked in a picture; empty: none
};

/// How a volume is drawn.
struct VolumeOptions {
  bool shown = true;
  std::string scalar;    ///< of a flow: which scalars are one, as flow_volume.h has it; empty: none
  std::string resample;  ///< of a flow: N or N,N,N points that they are taken at; empty: those of an image
  std::string transfer;  ///< color_transfer_of(); empty: from the histogram of the values
  std::string focus;     ///< likewise inside lenses; empty: the denser half of what the context shows
  std::vector<std::string> lenses;      ///< grammar of parse_lens()
  std::vector<std::string> clips;       ///< nx,ny,nz,d: what lies where n.x > d is cut away
  bool plane_image = false;             ///< the values are drawn on these planes
  std::optional<double> window, level;  ///< of them; absent: default_window()
  std::string contours;                 ///< v,v,...: lines of equal value on these planes
  double samples = 4.0;                 ///< per voxel along a ray
  double far_sampling = 1.0;            ///< VolumeView::far_sampling
  double context_viewport = 1.0;        ///< ContextQuality::viewport
  int context_level = 0;                ///< ContextQuality::level
  double gpu_memory = 0.0;              ///< that voxels may take there [2^20 bytes]; 0: no bound
  std::string tables = "faster";        ///< VolumeView::table_maker
  bool shading = true;                  ///< Phong
  bool shadows = false;                 ///< VolumeView::shadows
  bool illustration = false;            ///< VolumeView::illustrated
  double context_fade = 0.0;            ///< VolumeView::context_fade
  std::string projection = "perspective";
};

/// Slices that are seen beside a volume (render/slice/slice_view.h).
struct PanesOptions {
  std::string layout = "1";             ///< 1, 2, 4: SlicePanes::layout
  std::string first = "axial";          ///< name of SlicePanes::first
  std::string cross;                    ///< x,y,z; empty: the middle of the volume
  std::string turn;                     ///< qw,qx,qy,qz of SlicePanes::turn; empty: none
  std::string center;                   ///< x,y,z; empty: the middle of the volume
  double zoom = 1.0;                    ///< SlicePanes::zoom
  double slab = 0.0;                    ///< SlicePanes::slab
  std::string rule = "mean";            ///< name of SlicePanes::rule
  std::string side = "radiological";    ///< radiological, neurological
  double blend = 0.0;                   ///< SlicePanes::blend
  std::string shown = "direction";      ///< SlicePanes::shown of tensors
  std::optional<double> window, level;  ///< SlicePanes::window of tensors
};

/// A slice that is written, or a part of a volume.
struct SliceOptions {
  std::string plane = "axial";  ///< grammar of parse_plane()
  double spacing = 0.0;         ///< of its pixels [data units]; 0: that of the voxels
  std::optional<double> window, level;
  std::string contours;  ///< v,v,...: lines of equal value, to be written in place of an image
  std::string box;       ///< x,y,z,x,y,z: the part of a volume that is kept; empty: all of it
  std::string type;      ///< name_of(ScalarType) of voxels that are written; empty: that of the data
};

/// How diffusion tensors are drawn.
struct TensorOptions {
  std::string slices = "all";           ///< grammar of parse_slices()
  std::string color = "direction";      ///< name_of(TensorColor)
  bool crosshair = true;                ///< TensorView::crosshair
  std::string glyphs = "none";          ///< name_of(GlyphShape)
  double glyph_fa = 0.15;               ///< TensorView::glyph_least_fa
  double glyph_spacing = 24.0;          ///< TensorView::glyph_spacing
  std::string voxels = "nearest";       ///< nearest, linear: how colours go on between the centres of voxels
  std::string underlay;                 ///< a scalar image below the slices; empty: none
  std::string blend = "anisotropy";     ///< name_of(UnderlayBlend)
  std::optional<double> window, level;  ///< of the underlay; absent: from its histogram
  std::string volume = "auto";          ///< auto: with a lens; none, fa, direction: of what is outside lenses
};

/// Tracts of a file, and how tracts are drawn.
struct TractAppearance {
  std::string file;                  ///< a tractogram; empty: none
  double width = 1.5;                ///< thousandths of the picture's height
  double opacity = 1.0;              ///< in (0, 1]
  std::optional<double> slab;        ///< TractView::slab_thickness
  std::vector<std::string> bundles;  ///< grammar of bundle_text.h
  std::string bundle_profile;        ///< name of a SliceImage, measured along all bundles; empty: nothing
};

/// What of a heart is traced, drawn and mapped.
struct HeartOptions {
  std::string layer;  ///< depth from 0 inner to 1 outer; empty: the verb's default
  std::string axis;   ///< x,y,z from apex to base; empty: as the wall opens
  std::string angle;  ///< name_of(WallAngle), gap, depth, a scalar; empty: the verb's default
  std::string convention = "streeter";  ///< name_of(AngleConvention)
  std::string cut;                      ///< nx,ny,nz,d: what lies beyond n.x = d is left out of the picture
  bool cut_face = true;                 ///< what the cut lays open of the wall is coloured as the layer
  std::string walls = "auto";           ///< kWallWords: surfaces of the wall that are drawn beside the layer
  double contours = 0.0;                ///< distance of lines of equal value on a layer; 0: none
  std::string contour_values;           ///< v,v,...: lines of equal value on a layer, to be written
  std::string lens;                     ///< sphere:x,y,z,r in which a layer shows `lens_angle`; empty: none
  std::string lens_angle = "helix";     ///< as `angle`
  std::filesystem::path beside;         ///< another heart or result, shown at the right; empty: none
  std::string beside_angle;             ///< that colours it, as `angle`; empty: the same
  double least_gap = 0.05;
  std::filesystem::path mesh_picture;           ///< of a made mesh; empty: none
  std::filesystem::path surfaces;               ///< of the wall, as they were found; empty: not written
  bool coordinates = false;                     ///< of the wall are written in place of angles
  std::string rule = "bayer";                   ///< name_of(FibreRule)
  double endo = 60.0, epi = -60.0;              ///< helix angle on the inner and the outer surface [degrees]
  double sheet_endo = -65.0, sheet_epi = 25.0;  ///< of the sheet, as Bayer et al. have them [degrees]
  double right_endo = 90.0,
         right_epi = -25.0;  ///< of the right ventricle, as Doste et al. have them [degrees]
  double transverse_endo = -20.0,
         transverse_epi = 20.0;  ///< of the fibre out of the layer, likewise [degrees]
};

/// What is looked at over time.
struct SeriesOptions {
  std::string value;                ///< a scalar; empty: the likeliest one
  std::vector<std::string> places;  ///< x,y,z
  std::filesystem::path path;       ///< table of more places; empty: none
  std::string plot;                 ///< open: the scalar that is plotted at the probe; empty: none
};

/// What the hand feels, and how the workspace lies over the data.
struct TouchOptions {
  std::string mode;                ///< empty: the program's first one
  double workspace_scale = 0.0;    ///< [m] per data unit; 0: the diagonal is 0.25 m
  double stiffness = 200.0;        ///< [N/m]
  double damping = 0.0;            ///< [N s/m] of the coupling
  std::string passivity = "auto";  ///< auto, on, off
  double release = 10.0;           ///< [mm]
  double drag = 4.0;               ///< [mm]
  std::string ticks;               ///< "auto" or the time between them; empty: none
  double tick_stiffness = 0.25;
  double speed_force = 0.0;      ///< [N]
  std::string scalar;            ///< of a flow; empty: the speed
  std::string isovalues;         ///< with commas between; empty: one that parts the values best
  std::string surface = "wall";  ///< name_of(IsosurfaceHold)
  double depth = 10.0;           ///< [mm] at which an isosurface lets through
  double snap = 0.0;             ///< [mm] at which a layer catches
  bool along_streamline = false;
  LinearSpec linear;  ///< mode linear
  GridSpec grid;      ///< mode grid
  PlaneSpec planes;   ///< mode plane-widget
  FixtureSpec fixtures;
  std::string noise_texture = "off";     ///< grammar of texture_settings()
  double field_force = 1.0;              ///< [N] of the force-field modes
  double field_damping = 5.0;            ///< [N s/m], likewise
  std::string density_curve;             ///< haptic transfer function; empty: straight
  std::string anisotropy_curve;          ///< haptic transfer function [mm]; empty: that of AnisotropySettings
  double fibre_spacing = 4.0;            ///< [mm]
  double least_friction = 0.5;           ///< [mm]
  double most_friction = 6.0;            ///< [mm]
  std::string stroke = "append";         ///< name_of(StrokeUse)
  std::vector<std::string> annotations;  ///< grammar of geometry/annotation.h
  std::filesystem::path drawn_lines;     ///< table of the lines and tracts that a hand has kept; empty: none
  double force_cap = 4.0;                ///< [N]
  double slew_cap = 200.0;               ///< [N/s]
  std::optional<bool> show_surfaces;     ///< TouchChoice::show_surface
  bool show_path = true;                 ///< TouchChoice::show_path
  bool stream_balls = true;              ///< TouchChoice::show_balls
  bool fade_lines = true;                ///< TouchChoice::fade_rest
  std::string local_lines = "none";      ///< name_of(SeedShape)
};

/// What moves the probe, and where that is recorded.
struct HandOptions {
  std::filesystem::path path;       ///< probe: the recorded path
  std::filesystem::path workbench;  ///< open, probe, render: workbench_file.h; empty: a desktop
  std::filesystem::path record;     ///< open: where the run is recorded
  /// open: mouse, replay:FILE.csv, hands:FILE.csv or simulated…; probe: mouse, which stands for the path, or
  /// simulated…
  std::string device = "mouse";
  double rate = 1000.0;          ///< of the servo [Hz]
  std::filesystem::path replay;  ///< open, probe: a recording to be played back
};

/// What is written.
struct OutputOptions {
  std::filesystem::path file;     ///< or the folder of a report; empty: none
  std::filesystem::path tract;    ///< probe: where the way of the proxy is saved as a line
  std::filesystem::path tracts;   ///< tracts: those that are held against the image
  std::string turn;               ///< tracts: grammar of parse_tract_turn(); empty: none
  std::filesystem::path profile;  ///< tracts: where a measure along the bundle is written; empty: nowhere
  std::filesystem::path
      profiled;     ///< tracts: the image whose values that are; empty: `measure` of the tensors
  int nodes = 100;  ///< tracts: places of the profile
  std::filesystem::path density;      ///< tracts: where lines a voxel are written; empty: nowhere
  std::filesystem::path lines_mask;   ///< tracts: where the voxels with lines are written; empty: nowhere
  std::string size;                   ///< WxH; empty: 1280x960, or that of the screen
  int repeat = 0;                     ///< render: frames to be timed after the first one
  int turntable = 0;                  ///< render: frames of a turn of the camera; 0: no film
  int path_frames = 0;                ///< render: frames along the path of the hand; 0: no film
  double frame_rate = 25.0;           ///< render: of a film [1/s]
  std::string effort = "normal";      ///< effort_from_name()
  std::string convention = "mrtrix";  ///< fit, measure: mrtrix, fsl
  std::string measure = "fa";         ///< measure: name_of(TensorMeasure)
  std::string westin = "trace";       ///< measure: name_of(WestinScale)
};

/// An experiment with participants: the folder that holds it, and what is done with it.
struct StudyOptions {
  std::string action;            ///< make, run, simulate, analyse, replay, sheet; empty: not said
  std::filesystem::path folder;  ///< of the experiment; empty: not said
  std::string tasks;             ///< make: names with commas between; empty: all of the program
  int participants = 20;         ///< make: how many the design is for
  int practice = 10;             ///< make: trials of a task that are not analysed
  int recorded = 20;             ///< make: trials of a task that are, half of them guided
  double guidance = 1.0;         ///< make: factor of the stiffness of what guides the hand
  std::string participant;       ///< run, simulate, replay: anonymous code; empty: the next one, or all
  std::string trial;             ///< replay: TASK/NUMBER; empty: all
};

struct Document {
  CommonOptions common;
  InputOptions input;
  TracingOptions tracing;
  TractTracingOptions tracts;
  ViewOptions view;
  VolumeOptions volume;
  PanesOptions panes;
  SliceOptions slice;
  TensorOptions tensors;
  TractAppearance tract_appearance;
  HeartOptions heart;
  SeriesOptions series;
  TouchOptions touch;
  HandOptions hand;
  OutputOptions output;
  CalibrationOptions calibration;
  HeadErrorOptions head_errors;
  TrialOptions trial;
  DeviceOutputs device_outputs;
  StudyOptions study;
  /// Names of the settings that were given, by the command line or a session. They say nothing of the scene:
  /// documents that differ in them alone are equal.
  std::vector<std::string> given;

  /// Whether all settings are the same.
  friend bool operator==(const Document& a, const Document& b);
};

}  // namespace palpate
