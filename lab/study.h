/// A study at work: what it is asked for, and how it speaks to its user.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "common/base/progress.h"
#include "common/scene/input.h"
#include "common/scene/report_request.h"
#include "lab/data/sweep.h"
#include "lab/page/report.h"

namespace palpate {

class Study {
 public:
  /// `request` and `progress` outlive it.
  Study(const ReportRequest& request, Progress& progress) : request_(request), progress_(progress) {}

  [[nodiscard]] const ReportRequest& request() const noexcept { return request_; }
  [[nodiscard]] const Document& document() const noexcept { return request_.document; }
  [[nodiscard]] Progress* progress() const noexcept { return &progress_; }
  [[nodiscard]] int threads() const noexcept { return document().common.threads; }
  /// @throws Error (usage) for another word than those of effort_from_name().
  [[nodiscard]] Effort effort() const { return effort_from_name(document().output.effort); }

  /// A remark.
  void note(const std::string& line) const;
  /// A result, or part of one.
  void print(const std::string& text) const;

  /// The document's input.
  /// @throws Error as Input::open(); (usage) for a field that is none.
  [[nodiscard]] Input open() const;

  /// A report of `input` on this machine; its scene begins with what was chosen of the input.
  [[nodiscard]] Report begin(const Input& input) const;

  /// Writes the report to the document's folder, and says of it its title, `figures` and each case with its limit.
  /// @param figures lines of text, may be empty. @param rows how many of them were measured.
  /// @throws Error as write_report().
  [[nodiscard]] ReportAnswer finish(const Report& report, const std::string& figures, std::size_t rows) const;

 private:
  const ReportRequest& request_;
  Progress& progress_;
};

/// A line for each case: whether it holds, its name, what was measured, and the limit.
[[nodiscard]] std::string cases_text(const std::vector<StabilityCase>& cases);

/// Moves `from` behind what is there.
void append(std::vector<StabilityCase> from, std::vector<StabilityCase>& to);

/// Points of the diagrams of all sections.
[[nodiscard]] std::size_t work_precision_rows(const Report& report);

/// @name What is studied, a file each
/// @{
[[nodiscard]] ReportAnswer study_vectors(const Study& study);     ///< lines, constraints, resampling, walls
[[nodiscard]] ReportAnswer study_scalars(const Study& study);     ///< pictures of a volume, planes in it
[[nodiscard]] ReportAnswer study_tensors(const Study& study);     ///< fitted directions, tracts
[[nodiscard]] ReportAnswer study_fibres(const Study& study);      ///< mesh, layers, fibres, touch of a heart
[[nodiscard]] ReportAnswer study_experiment(const Study& study);  ///< what participants did (common/study)
/// @}

}  // namespace palpate
