/// The stimuli of the four tasks of Ikits 2006, ch. 7: made fields, their global view, and paths in them.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "common/base/progress.h"
#include "common/study/path_trial.h"

namespace palpate {

/// What is asked of the paths of a task.
struct PathWish {
  bool flat = true;
  PathGoal goal = PathGoal::kEnd;
  double length = 0.1;  ///< [m] of every path: equal distances for all
};

/// Candidates that were good, and out of how many.
struct PathChoice {
  std::vector<std::shared_ptr<const PathStimulus>> stimuli;  ///< the best ones
  std::vector<double> scores;                                ///< of each of them
  std::vector<int> field_numbers;                            ///< likewise, from 0
  std::size_t good = 0, tried = 0;
  std::size_t fields = 0;  ///< that the kept ones are of
};

inline constexpr double kStimulusSize = 0.25;  ///< [m] side of the square or cube, as in the reference
inline constexpr int kFields = 30;             ///< data sets of a kind
inline constexpr double kMostSpread = 3.0;     ///< see choose_paths(), as the next four
inline constexpr std::size_t kMostOfField = 3;
inline constexpr double kStartsApart = 0.015;  ///< [m]
inline constexpr double kMostShared = 0.5;
inline constexpr double kTurn = 0.015;  ///< [m]

/// A field of a kind: 19 random vectors by biharmonic splines on 128 x 128 points, or 13 by inverse distance on
/// 32^3. @param number from 0.
[[nodiscard]] std::shared_ptr<const VectorField> stimulus_field(bool flat, std::uint64_t seed, int number);

/// The streamlines from 6 x 6 or 5 x 5 x 5 seeds, both ways.
[[nodiscard]] std::shared_ptr<const std::vector<Line>> global_view(const VectorField& field, bool flat);

/// The part of a path that lies within 5 mm of another one, of whichever of both it is more. @pre neither is empty.
[[nodiscard]] double shared_part(const std::vector<Vec3>& a, const std::vector<Vec3>& b) noexcept;

/// Places in these fields are drawn, as many in each that has not given kMostOfField good ones, until 70 or a few more
/// are good, or 10 000 were drawn in each of the others. The `count` best are kept, of up to as many as there are fields
/// two of each field at most, and of those that share more than kMostShared of their way with a better one of their field
/// none before all others are kept. Good is a path that
///   - has the length wished for, within the field and a margin of it;
///   - keeps off the displayed lines where it is not shown: 4 mm in the mean;
///   - meets its circle or plane for the first time at its end; all of the circle lies in the field;
///   - begins kStartsApart from those that were found before it in its field;
///   - is a curve, neither straight nor a spiral: the chord is 0.55 to 0.97 of it, and within kTurn it turns by a right angle
///     at most: a line that holds the hand leads it back where somebody looks farther ahead than the turn;
///   - forgives, where it is not shown: lines that begin 2 mm beside it, at its start and at each quarter, meet the goal no
///     farther than kMostSpread times that from its end: where the flow parts nobody finds the end who was off by little;
///   - in 3D has a view, of 16 around it, in which its depth is below a third of its length, its start is not behind displayed
///     lines, and less than a tenth of it is, as seen from the eye of the window.
/// The score is least for paths off displayed lines (8 mm and more count alike), of middling curvature, of little depth
/// and occlusion, that forgive most.
/// @throws Error (usage) for a `count` above 70; (work failed) where too few are good; Cancelled.
[[nodiscard]] PathChoice choose_paths(const PathWish& wish, std::uint64_t seed, int count,
                                      Progress& progress);

}  // namespace palpate
