/// netCDF by the CF conventions through vtkNetCDFCFReader: the variables along one set of three axes, as they stand, and
/// time.
#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include <netcdf.h>
#include <vtkInformation.h>
#include <vtkNetCDFCFReader.h>
#include <vtkSmartPointer.h>
#include <vtkStdString.h>
#include <vtkStreamingDemandDrivenPipeline.h>
#include <vtkStringArray.h>

#include "common/base/error.h"
#include "common/base/text.h"
#include "loaders/hdf/hdf5_check.h"
#include "loaders/hdf/netcdf_values.h"
#include "loaders/vtk/netcdf_check.h"
#include "loaders/vtk/one_reader.h"

namespace palpate {
namespace {

/// Attributes of the variables of a file.
class Attributes {
 public:
  explicit Attributes(const std::string& file)
      : opened_(nc_open(file.c_str(), NC_NOWRITE, &file_) == NC_NOERR) {}
  ~Attributes() {
    if (opened_) nc_close(file_);
  }
  Attributes(const Attributes&) = delete;
  Attributes& operator=(const Attributes&) = delete;

  /// `units`, in small letters; empty where there is none.
  [[nodiscard]] std::string units_of(const std::string& variable) const {
    int id = 0;
    return opened_ && nc_inq_varid(file_, variable.c_str(), &id) == NC_NOERR ? text_of(id, "units") : "";
  }
  /// The array of a variable, as its attributes want its numbers taken.
  [[nodiscard]] DataArray marked(const DataArray& array) const {
    int id = 0;
    if (!opened_ || nc_inq_varid(file_, array.name.c_str(), &id) != NC_NOERR) return array;
    return NetcdfValues(file_, id).marked(array);
  }
  /// Whether a variable is the topology of a mesh (UGRID conventions, "Topology dimension").
  [[nodiscard]] bool of_mesh() const {
    int count = 0;
    if (!opened_ || nc_inq_nvars(file_, &count) != NC_NOERR) return false;
    for (int id = 0; id < count; ++id) {
      if (text_of(id, "cf_role") == "mesh_topology") return true;
    }
    return false;
  }
  /// What VTK's reader fails at, with what to do, or nothing: several numbers where it has room for one, an axis without places that has a variable, one longer than the file can
  /// fill, for which it makes places, and variables along a fourth axis that is not told to be time.
  [[nodiscard]] std::optional<std::array<std::string, 2>> problem(std::uint64_t file_size) const {
    constexpr std::uint64_t kMostPacked = 1100;  // deflate makes no more of a byte
    int axes = 0, variables = 0;
    if (!opened_ || nc_inq(file_, &axes, &variables, nullptr, nullptr) != NC_NOERR) return std::nullopt;
    for (int axis = 0; axis < axes; ++axis) {
      std::size_t length = 0;
      if (nc_inq_dimlen(file_, axis, &length) != NC_NOERR) continue;
      const std::string name = name_of_axis(axis);
      int of_axis = 0;
      if (length == 0 && nc_inq_varid(file_, name.c_str(), &of_axis) == NC_NOERR) {
        return {{"has no place along '" + printable(name) + "'",
                 "of a run that has written nothing yet; 'ncks -x -v " + printable(name) +
                     "' leaves out what it says of that axis"}};
      }
      if (length / kMostPacked <= file_size) continue;
      return {{"has an axis '" + printable(name) + "' of " + std::to_string(length) + " places",
               "the file may be damaged"}};
    }
    for (int id = 0; id < variables; ++id) {
      for (const char* one : {"scale_factor", "add_offset"}) {  // VTK's reader has room for one number
        std::size_t count = 0;
        if (nc_inq_attlen(file_, id, one, &count) == NC_NOERR && count > 1)
          return {{"has " + std::to_string(count) + " numbers in the attribute " + one + " of '" +
                       name_of_variable(id) + "', where one is due",
                   "the file may be damaged"}};
      }
      int rank = 0;
      if (nc_inq_varndims(file_, id, &rank) != NC_NOERR || rank < 4) continue;
      std::vector<int> along(static_cast<std::size_t>(rank));
      if (nc_inq_vardimid(file_, id, along.data()) != NC_NOERR) continue;
      const std::string first = name_of_axis(along[0]);
      int of_axis = 0;
      if (nc_inq_varid(file_, first.c_str(), &of_axis) == NC_NOERR &&
          !(text_of(of_axis, "units") + text_of(of_axis, "standard_name") + text_of(of_axis, "axis")).empty())
        continue;
      return {
          {"does not say that '" + printable(first) + "', the first axis of '" + name_of_variable(id) +
               "', is time",
           "give its variable units, for example 'ncatted -a units," + printable(first) + ",c,c,s THIS'"}};
    }
    return std::nullopt;
  }

 private:
  [[nodiscard]] std::string name_of_axis(int axis) const {
    std::array<char, NC_MAX_NAME + 1> name{};
    return nc_inq_dimname(file_, axis, name.data()) == NC_NOERR ? name.data() : "";
  }

  [[nodiscard]] std::string name_of_variable(int variable) const {
    std::array<char, NC_MAX_NAME + 1> name{};
    return nc_inq_varname(file_, variable, name.data()) == NC_NOERR ? printable(name.data()) : "";
  }

  [[nodiscard]] std::string text_of(int variable, const char* name) const {
    constexpr std::size_t kLongest = 200;
    std::size_t length = 0;
    nc_type type = NC_NAT;
    if (nc_inq_att(file_, variable, name, &type, &length) != NC_NOERR || type != NC_CHAR || length > kLongest)
      return {};
    std::string text(length, ' ');
    if (nc_get_att_text(file_, variable, name, text.data()) != NC_NOERR) return {};
    return lowered(trimmed(text));
  }

  int file_ = 0;
  bool opened_;
};

class NetcdfLoader : public OneReader {
 protected:
  vtkSmartPointer<vtkAlgorithm> make_reader(const std::string& file, std::vector<std::string>&) override {
    check_netcdf(file);
    check_hdf5(file);
    attributes_.emplace(file);
    if (attributes_->of_mesh()) {
      throw input_error({file, "", "is a mesh by the UGRID conventions, which VTK 9.1 has no reader of",
                         "a grid by the CF conventions",
                         "open it in ParaView 5.12 or later, which reads UGRID, and save it as .vtu"});
    }
    std::error_code ignored;
    if (const auto wrong = attributes_->problem(std::filesystem::file_size(file, ignored)))
      throw input_error({file, "", wrong->at(0), "", wrong->at(1)});
    reader_ = vtkSmartPointer<vtkNetCDFCFReader>::New();
    reader_->SetFileName(file.c_str());
    reader_->SphericalCoordinatesOff();
    return reader_;
  }

  /// Takes the axes with the most variables along three of which there is more than one place.
  void look(const std::string& file, std::vector<std::string>& notes) override {
    std::map<std::string, std::vector<std::string>> by_axes;
    vtkStringArray* const axes = reader_->GetVariableDimensions();
    for (int v = 0; v < reader_->GetNumberOfVariableArrays(); ++v)
      by_axes[axes->GetValue(v)].emplace_back(reader_->GetVariableArrayName(v));
    std::string chosen;
    for (const auto& [these, names] : by_axes) {
      if (names.size() > names_.size() && is_volume(these)) {
        chosen = these;
        names_ = names;
      }
    }
    if (chosen.empty()) throw input_error({file, "", "has no variable along three axes", "a volume"});
    reader_->SetDimensions(chosen.c_str());
    reader_->UpdateInformation();
    std::string others;
    for (const auto& [these, names] : by_axes) {
      for (const std::string& name : names) {
        if (these != chosen) others += (others.empty() ? "'" : ", '") + name + "' " + these;
      }
    }
    if (!others.empty())
      notes.push_back("variables along other axes than " + chosen + " left out: " + others);
    warn_of_units(chosen, notes);
  }

  void select(const std::set<std::string>* wanted) override {
    const bool any = wanted == nullptr || std::ranges::any_of(names_, [&](const std::string& name) {
                       return wanted->count(name) > 0;
                     });
    for (int v = 0; v < reader_->GetNumberOfVariableArrays(); ++v) {
      const std::string name = reader_->GetVariableArrayName(v);
      const bool along = std::ranges::find(names_, name) != names_.end();
      // The grid is that of a variable.
      const bool takes =
          along && (any ? wanted == nullptr || wanted->count(name) > 0 : name == names_.front());
      reader_->SetVariableArrayStatus(name.c_str(), takes ? 1 : 0);
    }
  }

  void finish(DataSet& block) override {
    for (DataArray& array : block.arrays) array = attributes_->marked(array);
  }

 private:
  bool is_volume(const std::string& axes) {
    reader_->SetDimensions(axes.c_str());
    reader_->UpdateInformation();
    vtkInformation* const about = reader_->GetOutputInformation(0);
    auto* const key = vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT();
    if (about->Has(key) == 0) return false;
    const int* const extent = about->Get(key);
    return extent[1] > extent[0] && extent[3] > extent[2] && extent[5] > extent[4];
  }

  /// @param axes "(time, z, lat, lon)"
  void warn_of_units(const std::string& axes, std::vector<std::string>& notes) {
    std::string names = axes;
    std::ranges::replace_if(
        names, [](char c) { return c == '(' || c == ')' || c == ','; }, ' ');
    for (const std::string_view name : words(names)) {
      const std::string units = attributes_->units_of(std::string(name));
      if (units.starts_with("degree")) {
        notes.push_back(
            "WARNING: axis '" + std::string(name) + "' is in degrees ('" + units +
            "'): lines of a velocity in metres a second are not those of the flow; write x and y in metres");
      }
    }
    const char* const time = reader_->GetTimeUnits();
    const std::string units = time == nullptr ? "" : lowered(trimmed(time));
    if (!units.empty() && !units.starts_with("s ") && !units.starts_with("sec"))
      notes.push_back("WARNING: times are in '" + units +
                      "': lines in time take them in the unit of the velocity");
  }

  vtkSmartPointer<vtkNetCDFCFReader> reader_;
  std::optional<Attributes> attributes_;
  std::vector<std::string> names_;  ///< of the variables along the axes that are read
};

}  // namespace

[[nodiscard]] std::unique_ptr<Loader> make_netcdf_loader() { return std::make_unique<NetcdfLoader>(); }

}  // namespace palpate
