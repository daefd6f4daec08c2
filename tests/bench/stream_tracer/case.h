/// The data sets of the comparison, as both programs read them, and their seeds.
#pragma once

#include <string>
#include <vector>

#include <vtkDataSet.h>
#include <vtkSmartPointer.h>

#include "common/field/data_set.h"
#include "common/math/vec.h"

namespace palpate::bench {

struct Case {
  std::string name;
  vtkSmartPointer<vtkDataSet> vtk;
  std::vector<DataSet> blocks;
  std::vector<Vec3> seeds;
  double diagonal = 1.0;
};

/// @throws std::runtime_error where the file is another one.
[[nodiscard]] Case carotid(const char* path, int seed_count);
[[nodiscard]] Case blunt_fin(const char* xyz, const char* q, int seed_count);

/// Keeps the seeds whose index `keep` accepts.
template <typename Keep>
void select_seeds(Case& c, const Keep& keep) {
  std::vector<Vec3> kept;
  for (std::size_t i = 0; i < c.seeds.size(); ++i) {
    if (keep(i)) kept.push_back(c.seeds[i]);
  }
  c.seeds = std::move(kept);
}

}  // namespace palpate::bench
