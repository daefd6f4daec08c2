/// Annotations that the user places, a point at a time.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/geometry/annotation.h"
#include "common/render/scene_view.h"

namespace palpate {

class AnnotationList {
 public:
  AnnotationList() = default;
  explicit AnnotationList(std::vector<Annotation> entries) : entries_(std::move(entries)) {}

  /// What the next points make; ends what is being placed.
  void choose(AnnotationKind kind);
  [[nodiscard]] AnnotationKind kind() const noexcept { return kind_; }

  /// The next point. What has all its points is an entry.
  void add(const Vec3& place);
  /// Ends a curve or an area; what has too few points is dropped.
  void finish();
  /// @pre index < entries().size().
  void remove(std::size_t index);
  /// Takes back the last point of what is being placed; false where there is none.
  bool take_back();
  /// These in place of all others, and of what is being placed.
  void put(std::vector<Annotation> entries);

  [[nodiscard]] const std::vector<Annotation>& entries() const noexcept { return entries_; }
  [[nodiscard]] const std::vector<Vec3>& pending() const noexcept { return pending_; }

 private:
  std::vector<Annotation> entries_;
  std::vector<Vec3> pending_;
  AnnotationKind kind_ = AnnotationKind::kLength;
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
