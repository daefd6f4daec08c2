/// VTKHDF through vtkHDFReader: images and meshes of version 1.
#include <memory>

#include <vtkDataArraySelection.h>
#include <vtkHDFReader.h>
#include <vtkSmartPointer.h>

#include "loaders/hdf/hdf5_check.h"
#include "loaders/vtk/one_reader.h"

namespace palpate {
namespace {

class VtkHdfLoader : public OneReader {
 protected:
  vtkSmartPointer<vtkAlgorithm> make_reader(const std::string& file, std::vector<std::string>&) override {
    check_hdf5(file);
    check_vtkhdf(file);
    reader_ = vtkSmartPointer<vtkHDFReader>::New();
    reader_->SetFileName(file.c_str());
    return reader_;
  }
  void select(const std::set<std::string>* wanted) override {
    select_in(reader_->GetPointDataArraySelection(), wanted);
    select_in(reader_->GetCellDataArraySelection(), wanted);
  }

 private:
  vtkSmartPointer<vtkHDFReader> reader_;
};

}  // namespace

[[nodiscard]] std::unique_ptr<Loader> make_vtkhdf_loader() { return std::make_unique<VtkHdfLoader>(); }

}  // namespace palpate
