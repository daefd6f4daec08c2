/// CGNS through vtkCGNSReader: all bases and zones, structured and unstructured, each a block.
#include <memory>

#include <vtkCGNSReader.h>
#include <vtkSmartPointer.h>

#include "common/base/error.h"
#include "loaders/hdf/cgns_check.h"
#include "loaders/hdf/hdf5_check.h"
#include "loaders/vtk/one_reader.h"

namespace palpate {
namespace {

class CgnsLoader : public OneReader {
 protected:
  vtkSmartPointer<vtkAlgorithm> make_reader(const std::string& file,
                                            std::vector<std::string>& notes) override {
    check_hdf5(file);
    units_ = check_cgns(file, notes);
    reader_ = vtkSmartPointer<vtkCGNSReader>::New();
    reader_->SetFileName(file.c_str());
    reader_->DoublePrecisionMeshOn();
    reader_->LoadBndPatchOff();
    return reader_;
  }
  void look(const std::string&, std::vector<std::string>&) override { reader_->EnableAllBases(); }
  void select(const std::set<std::string>* wanted) override {
    for (int i = 0; i < reader_->GetNumberOfPointArrays(); ++i) {
      const std::string name = reader_->GetPointArrayName(i);
      reader_->SetPointArrayStatus(name.c_str(), wanted == nullptr || wanted->count(name) > 0 ? 1 : 0);
    }
    for (int i = 0; i < reader_->GetNumberOfCellArrays(); ++i) {
      const std::string name = reader_->GetCellArrayName(i);
      reader_->SetCellArrayStatus(name.c_str(), wanted == nullptr || wanted->count(name) > 0 ? 1 : 0);
    }
  }
  [[nodiscard]] std::string units() const override { return units_; }

 private:
  std::string units_;
  vtkSmartPointer<vtkCGNSReader> reader_;
};

}  // namespace

[[nodiscard]] std::unique_ptr<Loader> make_cgns_loader() { return std::make_unique<CgnsLoader>(); }

}  // namespace palpate
