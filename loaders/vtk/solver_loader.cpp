#include "common/base/check.h"
#include "common/base/error.h"
#include "loaders/vtk/solver_readers.h"

namespace palpate {
namespace {

class SolverLoader : public Loader {
 public:
  FileInfo open(const LoadRequest& request, Format format) override {
    switch (format) {
      case Format::kPlot3d:
        reader_ = make_plot3d_reader();
        break;
      case Format::kExodus:
        reader_ = make_exodus_reader();
        break;
      case Format::kEnsight:
        reader_ = make_ensight_reader();
        break;
      case Format::kOpenFoam:
        reader_ = make_openfoam_reader();
        break;
      default:
        throw input_error({request.files.front().string(), "", "is " + std::string(row_of(format).name),
                           "a solver format"});
    }
    reader_->on_progress = on_progress;
    return reader_->open(request, format);
  }

  std::vector<DataSet> read(const std::vector<std::string>& names, std::size_t step) override {
    if (!reader_) throw work_error("nothing was opened");
    return reader_->read(names, step);
  }

 private:
  std::unique_ptr<Loader> reader_;
};

}  // namespace

std::unique_ptr<Loader> make_solver_loader() { return std::make_unique<SolverLoader>(); }

}  // namespace palpate
