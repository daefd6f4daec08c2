/// One VTK XML file (.vti .vtr .vts .vtu .vtp, or .pvti .pvtr .pvts with their pieces) through VTK's reader,
/// with the arrays asked for and no others.
#pragma once

#include <memory>
#include <optional>
#include <set>
#include <string>

#include "loaders/vtk/vtk_errors.h"
#include "loaders/vtk/xml_scan.h"

class vtkDataSet;

namespace palpate {

class XmlFile {
 public:
  /// Scans the file and reads its topology. @throws Error (bad input).
  XmlFile(const std::string& file, VtkErrors& errors);
  ~XmlFile();
  XmlFile(const XmlFile&) = delete;
  XmlFile& operator=(const XmlFile&) = delete;

  /// Reads the arrays of these names. The result lives as long as this object, until the next call.
  /// @throws Error (bad input).
  vtkDataSet* read(const std::set<std::string>& wanted);

  /// The time that its field data TimeValue states.
  [[nodiscard]] std::optional<double> time() const;

  [[nodiscard]] const XmlScan& scan() const noexcept { return scan_; }

 private:
  struct Reader;
  std::string file_;
  VtkErrors& errors_;
  XmlScan scan_;
  std::unique_ptr<Reader> reader_;
};

/// The time that the field data TimeValue of the XML file states, an index of pieces included, if that stands in
/// the first 4 MB; none also where the file cannot be read.
[[nodiscard]] std::optional<double> xml_time(const std::string& file, VtkErrors& errors);

}  // namespace palpate
