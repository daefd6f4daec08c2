/// EX models over time: several .exnode files with other values at the same nodes, as "gfx read nodes … time T" of cmgui
/// takes them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "loaders/cardiac/ex/ex_mesh.h"
#include "loaders/cardiac/ex/ex_model.h"

namespace palpate::ex {

/// A model as its files have it, at one time or at several.
struct TimedModel {
  Model model;                      ///< at the first time
  std::vector<Model> later;         ///< with the model's elements, and the nodes of that time
  std::vector<double> times;        ///< empty where there is one
  std::vector<std::string> states;  ///< their files
};

/// Reads files of one model. An .exnode file whose nodes are all there, with other values, is another time: the number
/// at the end of its name where all of those files have one of their own (they are put in that order), else 0, 1, 2 …
/// @param files nodes first. @throws Error as read_ex_file().
[[nodiscard]] TimedModel read_ex_files(const std::vector<std::string>& files);

/// Samples the later times into arrays of the same mesh. @param first the sampled model.
/// @return of each time after the first the point arrays that differ from the first time's.
/// @throws Error as sample(), and (bad input) where points move in time.
[[nodiscard]] std::vector<std::vector<DataArray>> sample_later(const TimedModel& timed, const DataSet& first,
                                                               int refine, std::uint64_t memory,
                                                               std::vector<std::string>& notes);

}  // namespace palpate::ex
