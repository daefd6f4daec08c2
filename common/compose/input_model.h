/// The model behind an explorer's window: an open input, what the explorer has read of it, and the scene that
/// is shown. What differs between explorers are read(), present() and keep(), and what they fill in of a new
/// document, begin().
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/base/text.h"
#include "common/compose/text/stereo_text.h"
#include "common/compose/window_model.h"
#include "common/scene/document/document.h"
#include "common/scene/input.h"
#include "common/scene/session_of.h"

namespace palpate {

/// What is known of an input before any field is read: name, files, format, fields and times.
[[nodiscard]] SceneInfo describe_open_input(const Input& input);

/// A scene of `input` without lines, with its notes and the seconds that loading took.
[[nodiscard]] SceneState begin_state(const Input& input, const Document& document);

/// The document by which `files.session` shows its inputs, or `files` where these are named.
/// @param program that opens it. @param given by the command line: what holds for all data stays.
/// @param notes gets a sentence on what has changed since it was saved.
/// @throws Error (bad input), also for a session of another program; Cancelled.
[[nodiscard]] Document document_of_session(const InputFiles& files, const std::string& program,
                                           const Document& given, std::vector<std::string>& notes,
                                           Progress& progress);

/// @tparam Content what one field at one time step gave: pointers to immutable things, cheap to copy.
template <typename Content>
class InputModel : public WindowModel {
 public:
  SceneState start(Progress& progress) final { return show(given_, progress); }

  SceneState open(const InputFiles& files, Progress& progress) final {
    if (!files.session.empty()) {
      std::vector<std::string> notes;
      Document document = document_of_session(files, program_, given_, notes, progress);
      SceneState state = show(std::move(document), progress);
      state.notes.insert(state.notes.begin(), notes.begin(), notes.end());
      scene_->shown.notes = state.notes;
      return state;
    }
    if (scene_) {
      if (const std::optional<Document> with = join(files, scene_->shown.document, progress)) {
        SceneState state = update(*with, progress);
        state.joined = true;
        return state;
      }
    }
    // A new input starts afresh: fields, times and settings of the old one mean nothing to it.
    Document document;
    document.common = given_.common;
    document.view = given_.view;
    document.view.camera.clear();
    document.view.focal.clear();
    document.view.color.clear();
    document.view.color_map.clear();
    document.view.range.clear();
    document.view.log_colors.reset();
    // What the hand can bear is no matter of the data.
    document.touch.damping = given_.touch.damping;
    document.touch.passivity = given_.touch.passivity;
    document.touch.force_cap = given_.touch.force_cap;
    document.touch.slew_cap = given_.touch.slew_cap;
    document.input.kind = given_.input.kind;
    document.input.files = files.files;
    document.input.solution = files.solution;
    document.input.example = files.example;
    document.input.series = files.series;
    take_tables(files, document);
    return show(std::move(document), progress);
  }

  SceneState update(const Document& document, Progress& progress) final {
    Scene& scene = *scene_;
    const Document before = scene.shown.document;
    try {
      Content content = scene.content;
      if (!same_content(document, before)) {
        choose(scene.input, document);
        content = read(scene.input, document, progress);
      }
      SceneState state = present(scene.input, content, document, &scene.shown, progress);
      scene.content = std::move(content);
      scene.shown = std::move(state);
    } catch (...) {
      choose(scene.input, before);
      throw;
    }
    return scene.shown;
  }

  std::string save_session(const Document& document, const std::filesystem::path& file) final {
    Document saved = document;
    for (const std::string& name : document.input.secondary) saved.input.field += "," + name;
    palpate::save_session(file, session_of(saved, program_));
    return file.string();
  }

  void close() final { scene_.reset(); }

 protected:
  /// An open input, what was read of it last, and what was shown last.
  struct Scene {
    Input input;
    Content content;
    SceneState shown;
  };

  /// @param document what the command line gave. @param program its name, for sessions.
  InputModel(Document document, std::string program, FieldKind kind)
      : given_(std::move(document)), program_(std::move(program)) {
    given_.input.kind = kind;
  }

  /// Reads the field that input.spec() means, at its time step.
  /// @throws Error, Cancelled.
  [[nodiscard]] virtual Content read(Input& input, const Document& document, Progress& progress) const = 0;

  /// The scene of `content` that `document` describes.
  /// @param before what was shown of this input last, of another field or time step perhaps
  /// (same_content()); null for an input that was just opened.
  /// @throws Error, Cancelled.
  [[nodiscard]] virtual SceneState present(Input& input, const Content& content, const Document& document,
                                           const SceneState* before, Progress& progress) const = 0;

  /// The document by which `files` are shown beside what is open; nothing where they are to take its place.
  /// @throws Error, Cancelled.
  [[nodiscard]] virtual std::optional<Document> join(const InputFiles& /*files*/, const Document& /*now*/,
                                                     Progress& /*progress*/) const {
    return std::nullopt;
  }

  /// Fills in what was not given by what a new input holds, and may choose its time step.
  /// @throws Error, Cancelled.
  virtual void complete(Document& /*document*/, Input& /*input*/, Progress& /*progress*/) const {}

  /// Whether both mean the same fields, regions and surfaces at the same time, read in the same way.
  [[nodiscard]] static bool same_content(const Document& a, const Document& b) {
    return a.input.field == b.input.field && a.input.secondary == b.input.secondary &&
           a.input.regions == b.input.regions && a.input.paint == b.input.paint &&
           a.input.time == b.input.time && a.input.tensor == b.input.tensor &&
           (a.input.kind != FieldKind::kScalar || a.volume.resample == b.volume.resample);
  }

  /// What is open; null before start().
  [[nodiscard]] const Scene* scene() const noexcept { return scene_ ? &*scene_ : nullptr; }

 private:
  static void choose(Input& input, const Document& document) {
    input.set_field(document.input.field);
    input.set_secondary(document.input.secondary);
    input.set_regions(document.input.regions);
    input.set_paint(document.input.paint);
    input.set_tensor_reading(document.input.tensor);
    if (!input.times().empty()) input.set_time_step(time_step_of(document, input.times()));
  }

  SceneState show(Document document, Progress& progress) {
    progress.begin("opening", 0);
    Input input = Input::open(document.input, &progress);
    complete(document, input, progress);
    Content content = read(input, document, progress);
    // Of tensors a file may lack any: tracts alone are shown, too.
    if (document.input.kind != FieldKind::kTensor || !input.fields().empty())
      document.input.field = input.field_label();
    document.input.secondary = input.spec().secondary;
    if (input.times().size() > 1) set_time_step(document, input.times(), input.time().step);
    SceneState state = present(input, content, document, nullptr, progress);
    scene_.emplace(Scene{std::move(input), std::move(content), std::move(state)});
    return scene_->shown;
  }

  Document given_;
  std::string program_;
  std::optional<Scene> scene_;
};

}  // namespace palpate
