/// Undo and redo of a document, as snapshots of it.
#pragma once

#include <cstddef>
#include <deque>
#include <string>
#include <utility>

#include "common/scene/document/document.h"

namespace palpate {

class DocumentHistory {
 public:
  static constexpr std::size_t kMostSteps = 200;  ///< a document takes some kilobytes

  /// @param document as it is now.
  explicit DocumentHistory(Document document) : now_(std::move(document)) {}

  /// The document is another one now; nothing where it is the same. What was undone is forgotten.
  /// @param what the edit is, in words: "line width". Edits of one kind that follow each other while `drag` is
  /// held are one step.
  void push(const Document& document, const std::string& what, bool drag = false);
  /// The document is another one without an edit: a default is known now.
  void settle(const Document& document) { now_ = document; }
  /// Ends a drag: the next edit is a step of its own.
  void end_drag() noexcept { dragged_.clear(); }

  [[nodiscard]] bool can_undo() const noexcept { return !past_.empty(); }
  [[nodiscard]] bool can_redo() const noexcept { return !future_.empty(); }
  /// What undo() and redo() would take back or do again; empty where there is nothing.
  [[nodiscard]] std::string undo_name() const { return can_undo() ? past_.back().what : std::string(); }
  [[nodiscard]] std::string redo_name() const { return can_redo() ? future_.back().what : std::string(); }

  /// @pre can_undo(). @return the document as it is then.
  const Document& undo();
  /// @pre can_redo(). @return the document as it is then.
  const Document& redo();
  [[nodiscard]] const Document& now() const noexcept { return now_; }

 private:
  /// A document beside the present one, and the edit that lies between.
  struct Step {
    Document document;
    std::string what;
  };
  std::deque<Step> past_, future_;  ///< the nearest last
  Document now_;
  std::string dragged_;  ///< what the drag is that goes on; empty: none
};

}  // namespace palpate
