#include "loaders/vtk/vtk_files.h"

#include <vtkDataObject.h>
#include <vtkDataSet.h>
#include <vtkSmartPointer.h>

#include "common/base/error.h"
#include "loaders/vtk/legacy_file.h"
#include "loaders/vtk/vtk_convert.h"

namespace palpate {
namespace {

class VtkFiles : public Loader {
 public:
  FileInfo open(const LoadRequest& request, Format format) override {
    file_ = request.files.front().string();
    FileInfo info;
    info.format = name_of(format);
    data_ = read_legacy(file_, errors_);
    for (const auto& b : leaves_of(data_)) {
      const auto why = why_not_volume(b.data);
      if (!why.empty()) throw input_error({file_, b.name, why});
      info.blocks.push_back(describe_block(b.data, b.name));
    }
    return info;
  }
  std::vector<DataSet> read(const std::vector<std::string>& names, std::size_t) override {
    std::vector<DataSet> blocks;
    for (const auto& b : leaves_of(data_))
      blocks.push_back(convert_block(b.data, b.name, {names.begin(), names.end()}, file_));
    return blocks;
  }

 private:
  VtkErrors errors_;
  std::string file_;
  vtkSmartPointer<vtkDataObject> data_;
};

}  // namespace

std::unique_ptr<Loader> make_vtk_loader() { return std::make_unique<VtkFiles>(); }

}  // namespace palpate
