#include "common/base/check.h"
#include "common/base/error.h"
#include "common/load/helper/chosen_loader.h"
#include "loaders/vtk/solver_readers.h"

namespace palpate {
namespace {

class SolverLoader : public ChosenLoader {
 public:
  // Collated cases of OpenFOAM.
  [[nodiscard]] bool writes_temporary_files() const override { return true; }

 protected:
  std::unique_ptr<Loader> choose(const LoadRequest& request, Format format) override {
    switch (format) {
      case Format::kPlot3d:
        return make_plot3d_reader();
      case Format::kExodus:
        return make_exodus_reader();
      case Format::kEnsight:
        return make_ensight_reader();
      case Format::kOpenFoam:
        return make_openfoam_reader();
      default:
        throw input_error({request.files.front().string(), "", "is " + std::string(row_of(format).name),
                           "a solver format"});
    }
  }
};

}  // namespace

std::unique_ptr<Loader> make_solver_loader() { return std::make_unique<SolverLoader>(); }

}  // namespace palpate
