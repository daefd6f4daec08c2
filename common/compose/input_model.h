/// The model behind an explorer's window: an open input, what the explorer has read of it, and the scene that
/// is shown. What differs between explorers are four functions: read(), present(), and where they have
/// settings of their own, begin() and describe_session().
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/base/text.h"
#include "common/compose/stereo_text.h"
#include "common/compose/window_model.h"
#include "common/scene/input.h"
#include "common/scene/options.h"
#include "common/scene/session_of.h"

namespace palpate {

/// What is known of an input before any field is read: name, files, format, fields and times.
[[nodiscard]] SceneInfo describe_open_input(const Input& input);

/// A scene of `input` without lines, with its notes and the seconds that loading took.
[[nodiscard]] SceneState begin_state(const Input& input, const SceneSettings& settings);

/// The camera as a session's options, and how it projects where that can be chosen.
void describe_camera(Session& session, const SceneView& view);
void describe_projection(Session& session, const SceneView& view);
/// The lenses of a volume, and how its rays are cast.
void describe_rays(Session& session, const VolumeView& volume);
/// What is drawn on planes of a volume.
void describe_plane_images(Session& session, const VolumeView& volume);

/// Appends an option to a session; an empty value is left out.
void add_option(Session& session, const char* name, const std::string& value);

/// @tparam Content what one field at one time step gave: pointers to immutable things, cheap to copy.
template <typename Content>
class InputModel : public WindowModel {
 public:
  SceneState start(Progress& progress) final { return show(options_, progress); }

  SceneState open(const InputFiles& files, Progress& progress) final {
    if (scene_) {
      if (const std::optional<SceneSettings> with = join(files, scene_->shown.settings, progress)) {
        SceneState state = update(*with, progress);
        state.joined = true;
        return state;
      }
    }
    // A new input starts afresh: fields, times and settings of the old one mean nothing to it.
    Options options;
    options.common = options_.common;
    options.input.files = files.files;
    options.input.solution = files.solution;
    return show(std::move(options), progress);
  }

  SceneState update(const SceneSettings& settings, Progress& progress) final {
    Scene& scene = *scene_;
    const SceneSettings before = scene.shown.settings;
    try {
      Content content = scene.content;
      if (!same_content(settings, before)) {
        scene.input.set_field(settings.field);
        scene.input.set_beside(settings.beside);
        scene.input.set_time_step(settings.time_step);
        content = read(scene.input, options_, progress);
      }
      SceneState state = present(scene.input, content, options_, settings, &scene.shown, progress);
      scene.content = std::move(content);
      scene.shown = std::move(state);
    } catch (...) {
      scene.input.set_field(before.field);
      scene.input.set_beside(before.beside);
      scene.input.set_time_step(before.time_step);
      throw;
    }
    return scene.shown;
  }

  std::string save_session(const SceneSettings& settings, const SceneView& view,
                           const std::vector<std::pair<std::string, std::string>>& set) final {
    const InputSpec& spec = scene_->input.spec();
    Session session = begin_session(spec, program_);
    add_option(session, "example", spec.example);
    std::string fields = settings.field;
    for (const std::string& name : settings.beside) fields += "," + name;
    add_option(session, "field", fields);
    const auto& times = scene_->input.times();
    if (times.size() > 1) add_option(session, "time", exact_number(times[settings.time_step]));
    add_option(session, "series", spec.series);
    describe_session(session, spec, options_, settings, view);
    if (options_.view.frame_budget > 0.0)
      add_option(session, "frame-budget", exact_number(options_.view.frame_budget));
    for (const auto& [option, value] : stereo_options(options_.view)) add_option(session, option, value);
    for (const auto& [option, value] : set) add_option(session, option.c_str(), value);
    return store_session(session, spec);
  }

 protected:
  /// An open input, what was read of it last, and what was shown last.
  struct Scene {
    Input input;
    Content content;
    SceneState shown;
  };

  InputModel(Options options, std::string program, FieldKind kind)
      : options_(std::move(options)), program_(std::move(program)), kind_(kind) {}

  /// Reads the field that input.spec() means, at its time step.
  /// @throws Error, Cancelled.
  [[nodiscard]] virtual Content read(Input& input, const Options& options, Progress& progress) const = 0;

  /// The scene of `content` under `settings`.
  /// @param before what was shown of this input last, of another field or time step perhaps
  /// (same_content()); null for an input that was just opened.
  /// @throws Error, Cancelled.
  [[nodiscard]] virtual SceneState present(Input& input, const Content& content, const Options& options,
                                           const SceneSettings& settings, const SceneState* before,
                                           Progress& progress) const = 0;

  /// The settings by which `files` are shown beside what is open; nothing where they are to take its place.
  /// @throws Error, Cancelled.
  [[nodiscard]] virtual std::optional<SceneSettings> join(const InputFiles& /*files*/,
                                                          const SceneSettings& /*now*/,
                                                          Progress& /*progress*/) const {
    return std::nullopt;
  }

  /// Fills in options that were not given by what a new input holds, and may choose its time step.
  /// @throws Error, Cancelled.
  virtual void complete(Options& /*options*/, Input& /*input*/, Progress& /*progress*/) const {}

  /// Fills in the settings that a new input starts with, but for its field and time step.
  virtual void begin(SceneSettings& /*settings*/, const Input& /*input*/, const Options& /*options*/) const {}

  /// Appends the explorer's own options; those of inputs, time and touch are there without it.
  virtual void describe_session(Session& session, const InputSpec& spec, const Options& options,
                                const SceneSettings& settings, const SceneView& view) const = 0;

  /// Whether both settings mean the same fields at the same time.
  [[nodiscard]] static bool same_content(const SceneSettings& a, const SceneSettings& b) {
    return a.field == b.field && a.beside == b.beside && a.time_step == b.time_step;
  }

  /// What is open; null before start().
  [[nodiscard]] const Scene* scene() const noexcept { return scene_ ? &*scene_ : nullptr; }

 private:
  SceneState show(Options options, Progress& progress) {
    progress.begin("opening", 0);
    Input input = Input::open(input_spec(options.input, kind_), &progress);
    complete(options, input, progress);
    Content content = read(input, options, progress);
    SceneSettings settings;
    begin(settings, input, options);
    settings.field = input.field_label();
    settings.beside = input.spec().beside;
    settings.time_step = input.time().step;
    SceneState state = present(input, content, options, settings, nullptr, progress);
    scene_.emplace(Scene{std::move(input), std::move(content), std::move(state)});
    options_ = std::move(options);
    return scene_->shown;
  }

  Options options_;
  std::string program_;
  FieldKind kind_;
  std::optional<Scene> scene_;
};

}  // namespace palpate
