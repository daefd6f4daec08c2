/// The input of a scene: files or a built-in example, opened; its arrays are read and its field is made only
/// on demand, so that what a verb does not need is not loaded.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/progress.h"
#include "common/field/analytic/examples.h"
#include "common/field/analytic/heart_example.h"
#include "common/field/heart/heart.h"
#include "common/field/heart/regions.h"
#include "common/field/scalar_choice.h"
#include "common/field/scalar_field.h"
#include "common/field/tensor/tensor_field.h"
#include "common/field/tensor/tensor_source.h"
#include "common/field/vector_field.h"
#include "common/load/load.h"
#include "common/scene/document/input_options.h"
#include "common/scene/tensor/tensor_image.h"
#include "common/scene/time_steps.h"

namespace palpate {

/// The built-in data sets of a kind; the first is the one shown by default.
[[nodiscard]] std::vector<ExampleInfo> examples_of(FieldKind kind);

class Input {
 public:
  /// Opens the files (a helper program starts) or finds the example.
  /// @throws Error (usage: neither or both named, an unknown example; bad input); Cancelled.
  static Input open(const InputOptions& spec, Progress* progress = nullptr);

  /// "carotid.vtk", "example abc"
  [[nodiscard]] const std::string& title() const noexcept { return title_; }
  [[nodiscard]] const InputOptions& spec() const noexcept { return spec_; }
  /// What the loader says, or would say of a built-in volume; null for a formula.
  [[nodiscard]] const FileInfo* file() const noexcept;
  [[nodiscard]] const std::vector<ArrayInfo>& arrays() const noexcept { return arrays_; }
  /// What the loader has to say, and where the layout of voxels without a header was taken from.
  [[nodiscard]] std::vector<std::string> notes() const;
  /// Why there is no volume in the file, or empty.
  [[nodiscard]] const std::string& not_volume() const noexcept { return not_volume_; }
  /// Names of all fields of spec().kind that can be made, the default first; none without a volume.
  [[nodiscard]] const std::vector<std::string>& fields() const noexcept { return fields_; }
  /// Whether one can be made: there are a volume and an array for it, or it is a formula.
  [[nodiscard]] bool has_field() const noexcept;
  /// Whether `name` is one of them, or the bare name of an array that makes one.
  [[nodiscard]] bool names_field(const std::string& name) const;
  [[nodiscard]] const std::vector<double>& times() const noexcept;
  [[nodiscard]] const TimeChoice& time() const noexcept { return time_; }
  /// Moves to another time step. @pre step < times().size().
  void set_time_step(std::size_t step) noexcept { time_ = {step, true}; }

  /// Chooses another field, as `--field` would. Unknown names are refused by choice() and load_field().
  void set_field(std::string name) { spec_.field = std::move(name); }
  /// Chooses regions of a heart, as `--regions` would. @throws Error (usage) for one that the file has not.
  void set_regions(const std::string& numbers);
  /// Chooses how a heart's surfaces are painted, as `--paint-surface` would. @throws Error (usage).
  void set_paint(const std::vector<std::string>& paint);
  /// The regions of a heart's mesh, chosen or not; none where it has no array of them. Read once.
  /// @throws Error, Cancelled.
  [[nodiscard]] const std::vector<RegionCount>& regions(Progress* progress = nullptr);
  /// How tensors are read and fitted from now on; where their gradients and handedness come from was chosen by open().
  void set_tensor_reading(TensorSpec reading) { spec_.tensor = std::move(reading); }
  /// Chooses what InputOptions::secondary has.
  void set_secondary(std::vector<std::string> names) { spec_.secondary = std::move(names); }

  /// The recipe of the vector field that spec().field means. @pre file().
  /// @throws Error (usage, listing the known ones), (bad input) where there is no vector field or no volume.
  [[nodiscard]] VectorChoice choice() const;
  /// The same for a scalar field.
  [[nodiscard]] ScalarChoice scalar_choice() const;
  /// The same for a tensor field.
  [[nodiscard]] TensorSource tensor_source() const;
  /// The same for the fibres of a heart.
  [[nodiscard]] HeartChoice heart_choice() const;
  /// What spec().field means, of any kind: "velocity"; empty for a heart without fibres.
  /// @throws as choice().
  [[nodiscard]] std::string field_label() const;
  /// The arrays that the field is made of; none for a formula. @throws as choice().
  [[nodiscard]] std::vector<std::string> field_arrays() const;

  /// One sentence that names the field and the time step, and what else there was to choose from.
  [[nodiscard]] std::string choice_sentence() const;

  /// Reads the arrays of the vector field and makes it.
  /// @throws Error, Cancelled.
  [[nodiscard]] std::shared_ptr<const VectorField> load_field(int threads, Progress* progress = nullptr);
  /// The same for the scalar field. @pre file().
  [[nodiscard]] std::shared_ptr<const ScalarField> load_scalar(int threads, Progress* progress = nullptr);
  /// The same for the tensor field. @pre file().
  /// @param image if not null, becomes what the field was made of, with the details of a fit.
  [[nodiscard]] std::shared_ptr<const TensorField> load_tensor(int threads, Progress* progress = nullptr,
                                                               TensorImage* image = nullptr);
  /// Fibres, sheets and layers of a heart. @pre file().
  /// @param value a scalar to come along as Heart::value (label_of() of scalar_choice.h); empty: none.
  /// @throws Error as make_heart(); Cancelled.
  [[nodiscard]] Heart load_heart(int threads, Progress* progress = nullptr, const std::string& value = {},
                                 LayersNeeded layers = LayersNeeded::kAlways);
  /// The image that load_tensor() makes its field of. @pre file().
  /// @param details FitOptions::details
  [[nodiscard]] TensorImage load_tensor_image(int threads, Progress* progress = nullptr,
                                              bool details = false);
  /// read() as a part of loading a field: seconds_read() is its time, seconds_field() 0.
  [[nodiscard]] std::vector<DataSet> read_timed(const std::vector<std::string>& names, Progress* progress);
  /// Reads topology and arrays by name at the chosen time step, with the cells of regions that are not chosen
  /// hidden. @pre file().
  [[nodiscard]] std::vector<DataSet> read(const std::vector<std::string>& names,
                                          Progress* progress = nullptr);

  [[nodiscard]] double seconds_open() const noexcept { return seconds_open_; }
  /// @name Of the last field that was loaded
  /// @{
  [[nodiscard]] double seconds_read() const noexcept { return seconds_read_; }
  [[nodiscard]] double seconds_field() const noexcept { return seconds_field_; }
  /// @}

 private:
  void open_example();
  void offer_parts() const;
  void open_files(Progress* progress);
  void find_face_surfaces(Progress* progress);
  void remesh(Progress* progress);
  [[nodiscard]] std::vector<DataSet> read_file(const std::vector<std::string>& names, Progress* progress);
  [[nodiscard]] std::vector<DataSet> read_whole(const std::vector<std::string>& names, Progress* progress);
  void part_fields();
  [[nodiscard]] std::string file_name() const;
  void check_volume() const;

  InputOptions spec_;
  std::string title_;
  std::string raw_note_;
  std::optional<Source> source_;
  std::optional<DataSet> made_;  ///< a built-in volume
  std::optional<HeartExample> made_heart_;
  std::optional<Remeshed> remeshed_;
  std::optional<FileInfo> made_info_;  ///< where it is not the source's
  std::vector<ArrayInfo> arrays_;
  std::vector<std::string> fields_;
  std::optional<std::vector<RegionCount>> regions_;
  std::vector<double> chosen_regions_;  ///< empty: all
  std::string not_volume_;
  TimeChoice time_;
  double seconds_open_ = 0.0;
  double seconds_read_ = 0.0;
  double seconds_field_ = 0.0;
};

}  // namespace palpate
