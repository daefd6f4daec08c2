#include "loaders/vtk/vtk_errors.h"

#include <algorithm>
#include <cctype>
#include <cstring>

#include <vtkLogger.h>
#include <vtkOutputWindow.h>
#include <vtkSmartPointer.h>

#include "common/base/error.h"

namespace palpate {
namespace {

class Collector : public vtkOutputWindow {
 public:
  static Collector* New() {
    auto* collector = new Collector;
    collector->InitializeObjectBase();
    return collector;
  }

  void DisplayText(const char*) override {}
  void DisplayWarningText(const char* text) override { keep_if_data_lost(text); }
  void DisplayGenericWarningText(const char* text) override { keep_if_data_lost(text); }
  void DisplayDebugText(const char*) override {}
  void DisplayErrorText(const char* text) override {
    if (first.empty()) first = text;
  }

  std::string first;

 private:
  /// Text that is no number is only a warning to VTK's legacy reader, which goes on without the values.
  void keep_if_data_lost(const char* text) {
    if (std::strstr(text, "Error reading") != nullptr) DisplayErrorText(text);
  }
};

/// VTK writes "ERROR: In file.cxx, line 12\nvtkReader (0x55…): what\n\n": the last part is what counts.
std::string one_line(std::string text) {
  const std::size_t object = text.find("): ");
  if (object != std::string::npos) text.erase(0, object + 3);
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return std::iscntrl(c) != 0; }, ' ');
  while (!text.empty() && (text.back() == ' ' || text.back() == '.')) text.pop_back();
  constexpr std::size_t kLongest = 200;
  if (text.size() > kLongest) text.resize(kLongest);
  return text;
}

}  // namespace

VtkErrors::VtkErrors() {
  vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_OFF);
  const auto collector = vtkSmartPointer<Collector>::New();
  vtkOutputWindow::SetInstance(collector);
}

VtkErrors::~VtkErrors() { vtkOutputWindow::SetInstance(nullptr); }

void VtkErrors::check(const std::string& file) {
  auto* collector = dynamic_cast<Collector*>(vtkOutputWindow::GetInstance());
  if (collector == nullptr || collector->first.empty()) return;
  std::string text;
  text.swap(collector->first);
  throw input_error({file, "", "VTK's reader says: " + one_line(text), "", "the file may be damaged"});
}

}  // namespace palpate
