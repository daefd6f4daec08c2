/// Annotations that the user places, a point at a time, and takes back.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "common/geometry/annotation.h"
#include "common/render/scene_view.h"

namespace palpate {

class AnnotationList {
 public:
  AnnotationList() = default;
  explicit AnnotationList(std::vector<Annotation> entries) : now_{std::move(entries), {}} {}

  /// What the next points make; ends what is being placed.
  void choose(AnnotationKind kind);
  [[nodiscard]] AnnotationKind kind() const noexcept { return kind_; }

  /// The next point. What has all its points is an entry.
  void add(const Vec3& place);
  /// Ends a curve or an area; what has too few points is dropped.
  void finish();
  /// @pre index < entries().size().
  void remove(std::size_t index);
  /// Takes back the last of these; false where there is none.
  bool undo();

  [[nodiscard]] const std::vector<Annotation>& entries() const noexcept { return now_.entries; }
  [[nodiscard]] const std::vector<Vec3>& pending() const noexcept { return now_.pending; }

 private:
  struct State {
    std::vector<Annotation> entries;
    std::vector<Vec3> pending;
  };

  State now_;
  AnnotationKind kind_ = AnnotationKind::kLength;
  std::vector<State> before_;
};

/// All of them as an option's value: their words with ';' between.
[[nodiscard]] std::string text_of(const std::vector<Annotation>& annotations);
/// @throws Error (usage) that names `option`.
[[nodiscard]] std::vector<Annotation> annotations_of(const std::vector<std::string>& words,
                                                     const std::string& option);

/// What a picture shows of them, and of what is being placed.
/// @param unit of lengths; empty: not known. @param next where the next point would be.
[[nodiscard]] std::vector<NoteView> notes_of(const AnnotationList& list, const std::string& unit,
                                             const std::optional<Vec3>& next);

}  // namespace palpate
