/// One of VTK's readers as a Loader: what it finds in one file is described and read, and what it complains about fails
/// the reading.
#pragma once

#include <set>
#include <string>
#include <vector>

#include <vtkSmartPointer.h>

#include "common/load/helper/serve.h"
#include "loaders/vtk/vtk_convert.h"
#include "loaders/vtk/vtk_errors.h"

class vtkAlgorithm;
class vtkDataArraySelection;

namespace palpate {

class OneReader : public Loader {
 public:
  FileInfo open(const LoadRequest& request, Format format) final;
  std::vector<DataSet> read(const std::vector<std::string>& names, std::size_t step) final;

 protected:
  /// Checks the file, and makes its reader. @param notes get the sentences that tell the user. @throws Error.
  virtual vtkSmartPointer<vtkAlgorithm> make_reader(const std::string& file,
                                                    std::vector<std::string>& notes) = 0;
  /// Once the reader has had its first look at the file. @throws Error.
  virtual void look(const std::string& file, std::vector<std::string>& notes);
  /// Chooses arrays; null: all.
  virtual void select(const std::set<std::string>* wanted) = 0;

  /// What the file states of units (FileInfo::units), once the reader was made.
  [[nodiscard]] virtual std::string units() const { return {}; }

  /// What is left to do to a block that was read.
  virtual void finish(DataSet& block);

  static void select_in(vtkDataArraySelection* selection, const std::set<std::string>* wanted);

 private:
  std::vector<VtkBlock> usable(std::vector<std::string>* notes);
  void update(std::size_t step);

  VtkErrors errors_;
  vtkSmartPointer<vtkAlgorithm> reader_;
  std::string file_;
  std::vector<double> times_;
};

}  // namespace palpate
