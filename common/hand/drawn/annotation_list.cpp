#include "common/hand/drawn/annotation_list.h"

#include <utility>

#include "common/base/error.h"

namespace palpate {

void AnnotationList::choose(AnnotationKind kind) {
  if (kind == kind_) return;
  finish();
  kind_ = kind;
}

void AnnotationList::add(const Vec3& place) {
  pending_.push_back(place);
  const PointsNeeded needed = points_needed(kind_);
  if (needed.most == 0 || pending_.size() < needed.most) return;
  entries_.push_back({kind_, std::exchange(pending_, {}), {}});
}

void AnnotationList::finish() {
  std::vector<Vec3> points = std::exchange(pending_, {});
  if (!points.empty() && points.size() >= points_needed(kind_).least)
    entries_.push_back({kind_, std::move(points), {}});
}

void AnnotationList::remove(std::size_t index) {
  entries_.erase(entries_.begin() + static_cast<std::ptrdiff_t>(index));
}

bool AnnotationList::take_back() {
  if (pending_.empty()) return false;
  pending_.pop_back();
  return true;
}

void AnnotationList::put(std::vector<Annotation> entries) {
  entries_ = std::move(entries);
  pending_.clear();
}

std::string text_of(const std::vector<Annotation>& annotations) {
  std::string text;
  for (const Annotation& each : annotations) (text += text.empty() ? "" : ";") += text_of(each);
  return text;
}

std::vector<Annotation> annotations_of(const std::vector<std::string>& words, const std::string& option) {
  std::vector<Annotation> annotations;
  for (const std::string& word : words) {
    Annotation annotation;
    if (const auto problem = read_text(word, annotation)) throw usage_error(option + ": " + *problem);
    annotations.push_back(std::move(annotation));
  }
  return annotations;
}

std::vector<NoteView> notes_of(const AnnotationList& list, const std::string& unit,
                               const std::optional<Vec3>& next) {
  std::vector<NoteView> notes;
  const auto words = [&](const Annotation& each) {
    const std::string measure = measure_text(each, unit);
    return each.label + (each.label.empty() || measure.empty() ? "" : ": ") + measure;
  };
  for (const Annotation& each : list.entries()) notes.push_back({each.points, outline_of(each), words(each)});
  if (list.pending().empty()) return notes;
  // As it would be with the next point where that is now.
  Annotation pending{list.kind(), list.pending(), {}};
  if (next) pending.points.push_back(*next);
  const bool measured = pending.points.size() >= points_needed(pending.kind).least;
  notes.push_back({list.pending(), pending.points, measured ? words(pending) : std::string()});
  return notes;
}

}  // namespace palpate
