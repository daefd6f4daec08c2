/// The command line's spelling of what of a heart is traced and measured: groups "Fibres" and "Angles".
#pragma once

#include "common/cli/scene_options.h"
#include "common/scene/options.h"

namespace palpate {

/// How fibres are traced. Binds the options to `tracing` and `heart`, which outlive `options`.
void add_fibre_options(SceneOptions& options, TracingOptions& tracing, HeartOptions& heart);

/// Which layer of the wall. Binds the option to `heart`, which outlives `options`.
void add_layer_option(SceneOptions& options, HeartOptions& heart);

/// Which angle, and what it is measured from. Binds the options to `heart`, which outlives `options`.
void add_angle_options(SceneOptions& options, HeartOptions& heart);

/// How finely curved elements are sampled, what fills their wall with tetrahedra, what directions of cells
/// are taken as, which triangles of a file are surfaces, and what is kept for the next opening. Binds the
/// options to `input`, which outlives `options`.
void add_heart_input_options(SceneOptions& options, InputOptions& input);

/// Which scalar over time, and where. Binds the options to `series`, which outlives `options`.
void add_series_options(SceneOptions& options, SeriesOptions& series);
/// How a layer is drawn. Binds as above.
void add_layer_look(SceneOptions& options, HeartOptions& heart);
/// Lines of equal value by their distance alone. Binds as above.
void add_contour_spacing(SceneOptions& options, HeartOptions& heart);
/// Lines of equal value that are written. Binds as above.
void add_contour_options(SceneOptions& options, HeartOptions& heart);
/// Which scalar is plotted over time at the probe. Binds as above.
void add_plot_option(SceneOptions& options, SeriesOptions& series);

}  // namespace palpate
