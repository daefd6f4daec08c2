/// HDF5 files made in memory, and in them one cell as CGNS and VTKHDF have it.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <hdf5.h>

#include "common/math/vec.h"
#include "tests/loaders/cell_kinds.h"

namespace palpate::test {

class Hdf5File {
 public:
  Hdf5File() {
    const hid_t access = H5Pcreate(H5P_FILE_ACCESS), creation = H5Pcreate(H5P_FILE_CREATE);
    constexpr std::size_t kGrow = 1U << 16U;
    H5Pset_fapl_core(access, kGrow, false);
    H5Pset_link_creation_order(creation, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED);
    static int made = 0;  // no two have one name at a time
    file_ = H5Fcreate(("in memory " + std::to_string(++made)).c_str(), H5F_ACC_TRUNC, creation, access);
    H5Pclose(creation);
    H5Pclose(access);
  }
  ~Hdf5File() { H5Fclose(file_); }
  Hdf5File(const Hdf5File&) = delete;
  Hdf5File& operator=(const Hdf5File&) = delete;

  [[nodiscard]] std::string bytes() const {
    H5Fflush(file_, H5F_SCOPE_GLOBAL);
    std::string out(static_cast<std::size_t>(H5Fget_file_image(file_, nullptr, 0)), '\0');
    H5Fget_file_image(file_, out.data(), out.size());
    return out;
  }

  void group(const std::string& path) const {
    const hid_t creation = H5Pcreate(H5P_GROUP_CREATE);
    H5Pset_link_creation_order(creation, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED);
    H5Gclose(H5Gcreate2(file_, path.c_str(), H5P_DEFAULT, creation, H5P_DEFAULT));
    H5Pclose(creation);
  }

  template <typename T>
  void set(const std::string& path, const std::vector<T>& values, std::vector<hsize_t> counts = {}) const {
    if (counts.empty()) counts = {values.size()};
    const hid_t space = H5Screate_simple(static_cast<int>(counts.size()), counts.data(), nullptr);
    const hid_t made =
        H5Dcreate2(file_, path.c_str(), type_of<T>(), space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    if (!values.empty()) H5Dwrite(made, type_of<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
    H5Dclose(made);
    H5Sclose(space);
  }
  /// A set of numbers that are never written.
  void claim(const std::string& path, const std::vector<hsize_t>& counts) const {
    const hid_t space = H5Screate_simple(static_cast<int>(counts.size()), counts.data(), nullptr);
    H5Dclose(
        H5Dcreate2(file_, path.c_str(), H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
    H5Sclose(space);
  }
  /// Numbers in double or single precision.
  void set_real(const std::string& path, const std::vector<double>& values, bool wide,
                const std::vector<hsize_t>& counts = {}) const {
    if (wide) {
      set(path, values, counts);
    } else {
      set(path, std::vector<float>(values.begin(), values.end()), counts);
    }
  }

  template <typename T>
  void attribute(const std::string& path, const std::string& name, const std::vector<T>& values) const {
    const hsize_t count = values.size();
    const hid_t space = H5Screate_simple(1, &count, nullptr);
    const hid_t made = H5Acreate_by_name(file_, path.c_str(), name.c_str(), type_of<T>(), space, H5P_DEFAULT,
                                         H5P_DEFAULT, H5P_DEFAULT);
    H5Awrite(made, type_of<T>(), values.data());
    H5Aclose(made);
    H5Sclose(space);
  }
  /// Of so many characters, filled up with zeros; in place of one of that name.
  void word(const std::string& path, const std::string& name, std::string text, std::size_t length) const {
    text.resize(length);
    if (H5Aexists_by_name(file_, path.c_str(), name.c_str(), H5P_DEFAULT) > 0)
      H5Adelete_by_name(file_, path.c_str(), name.c_str(), H5P_DEFAULT);
    const hid_t space = H5Screate(H5S_SCALAR), type = H5Tcopy(H5T_C_S1);
    H5Tset_size(type, length);
    const hid_t made = H5Acreate_by_name(file_, path.c_str(), name.c_str(), type, space, H5P_DEFAULT,
                                         H5P_DEFAULT, H5P_DEFAULT);
    H5Awrite(made, type, text.data());
    H5Aclose(made);
    H5Tclose(type);
    H5Sclose(space);
  }

 private:
  template <typename T>
  static hid_t type_of() {
    if (std::is_same_v<T, double>) return H5T_NATIVE_DOUBLE;
    if (std::is_same_v<T, float>) return H5T_NATIVE_FLOAT;
    if (std::is_same_v<T, std::int64_t>) return H5T_NATIVE_INT64;
    if (std::is_same_v<T, std::int32_t>) return H5T_NATIVE_INT32;
    if (std::is_same_v<T, std::uint8_t>) return H5T_NATIVE_UINT8;
    return H5T_NATIVE_SCHAR;
  }

  hid_t file_ = -1;
};

/// Nodes of a CGNS tree as its library lays them out in HDF5 ("CGNS HDF5 file mapping manual").
class CgnsTree {
 public:
  CgnsTree() {
    describe("/", "HDF5 MotherNode", "Root Node of HDF5 File", "MT");
    characters("/ format", "IEEE_LITTLE_32", 15);
    characters("/ hdf5version", "HDF5 Version 1.10.8", 33);
    real("/CGNSLibraryVersion", "CGNSLibraryVersion_t", {4.2}, false);
  }
  void empty(const std::string& path, const std::string& label) const { node(path, label, "MT"); }
  void real(const std::string& path, const std::string& label, const std::vector<double>& values, bool wide,
            const std::vector<hsize_t>& counts = {}) const {
    node(path, label, wide ? "R8" : "R4");
    file_.set_real(path + "/ data", values, wide, counts);
  }
  void whole(const std::string& path, const std::string& label, const std::vector<std::int32_t>& values,
             const std::vector<hsize_t>& counts = {}) const {
    node(path, label, "I4");
    file_.set(path + "/ data", values, counts);
  }
  void text(const std::string& path, const std::string& label, const std::string& value,
            const std::vector<hsize_t>& counts = {}) const {
    node(path, label, "C1");
    file_.set(path + "/ data", std::vector<char>(value.begin(), value.end()), counts);
  }
  void label(const std::string& path, const std::string& label, std::size_t length) const {
    file_.word(path, "label", label, length);
  }
  [[nodiscard]] std::string bytes() const { return file_.bytes(); }

 private:
  void node(const std::string& path, const std::string& label, const std::string& type) const {
    file_.group(path);
    describe(path, path.substr(path.rfind('/') + 1), label, type);
    file_.attribute(path, "flags", std::vector<std::int32_t>{1});
  }
  void describe(const std::string& path, const std::string& name, const std::string& label,
                const std::string& type) const {
    constexpr std::size_t kName = 33, kType = 3;
    file_.word(path, "name", name, kName);
    file_.word(path, "label", label, kName);
    file_.word(path, "type", type, kType);
  }
  void characters(const std::string& path, std::string value, std::size_t length) const {
    value.resize(length);
    file_.set(path, std::vector<char>(value.begin(), value.end()));
  }

  Hdf5File file_;
};

inline constexpr int kNx = 4, kNy = 3, kNz = 2;  // points of a lattice

inline std::vector<Vec3> lattice() {
  std::vector<Vec3> out;
  for (int k = 0; k < kNz; ++k) {
    for (int j = 0; j < kNy; ++j) {
      for (int i = 0; i < kNx; ++i) out.emplace_back(0.5 * i, 1.0 * j, 2.0 * k);
    }
  }
  return out;
}

inline std::vector<double> along(const std::vector<Vec3>& all, int axis) {
  std::vector<double> out;
  for (const Vec3& v : all) out.push_back(v[axis]);
  return out;
}
inline std::vector<Vec3> flows_at(const std::vector<Vec3>& all) {
  std::vector<Vec3> out;
  for (const Vec3& x : all) out.push_back(flow_at(x));
  return out;
}

/// One cell in a CGNS file, with velocities at its nodes. @param cells that it claims to have.
inline std::string cgns_file(const CellKind& kind, bool wide, std::int32_t cells = 1) {
  const std::vector<Vec3> nodes = places(kind, kind.cgns_nodes);
  const auto n = static_cast<std::int32_t>(nodes.size());
  const CgnsTree tree;
  tree.whole("/Base", "CGNSBase_t", {3, 3});
  tree.whole("/Base/Zone", "Zone_t", {n, cells, 0}, {3, 1});
  tree.text("/Base/Zone/ZoneType", "ZoneType_t", "Unstructured");
  tree.empty("/Base/Zone/GridCoordinates", "GridCoordinates_t");
  tree.whole("/Base/Zone/Cells", "Elements_t", {kind.cgns, 0});
  tree.whole("/Base/Zone/Cells/ElementRange", "IndexRange_t", {1, cells});
  std::vector<std::int32_t> order;
  for (std::int32_t i = 1; i <= n; ++i) order.push_back(i);
  tree.whole("/Base/Zone/Cells/ElementConnectivity", "DataArray_t", order);
  tree.empty("/Base/Zone/Solution", "FlowSolution_t");
  tree.text("/Base/Zone/Solution/GridLocation", "GridLocation_t", "Vertex");
  const std::vector<Vec3> flows = flows_at(nodes);
  for (int axis = 0; axis < 3; ++axis) {
    const std::string letter(1, "XYZ"[axis]);
    tree.real("/Base/Zone/GridCoordinates/Coordinate" + letter, "DataArray_t", along(nodes, axis), wide);
    tree.real("/Base/Zone/Solution/Velocity" + letter, "DataArray_t", along(flows, axis), wide);
  }
  return tree.bytes();
}

inline std::vector<double> tuples_of(const std::vector<Vec3>& all) {
  std::vector<double> out;
  for (const Vec3& v : all) out.insert(out.end(), {v.x, v.y, v.z});
  return out;
}

/// One cell in a VTKHDF file of version 1.0.
inline std::string vtkhdf_file(const CellKind& kind, bool wide) {
  const std::vector<Vec3> nodes = places(kind, kind.vtk_nodes);
  const auto n = static_cast<std::int64_t>(nodes.size());
  const Hdf5File file;
  file.group("/VTKHDF");
  file.attribute("/VTKHDF", "Version", std::vector<std::int64_t>{1, 0});
  file.word("/VTKHDF", "Type", "UnstructuredGrid", 16);
  file.set("/VTKHDF/NumberOfPoints", std::vector<std::int64_t>{n});
  file.set("/VTKHDF/NumberOfCells", std::vector<std::int64_t>{1});
  file.set("/VTKHDF/NumberOfConnectivityIds", std::vector<std::int64_t>{n});
  std::vector<std::int64_t> order;
  for (std::int64_t i = 0; i < n; ++i) order.push_back(i);
  file.set("/VTKHDF/Connectivity", order);
  file.set("/VTKHDF/Offsets", std::vector<std::int64_t>{0, n});
  file.set("/VTKHDF/Types", std::vector<std::uint8_t>{kind.vtk});
  file.set_real("/VTKHDF/Points", tuples_of(nodes), wide, {nodes.size(), 3});
  file.group("/VTKHDF/PointData");
  file.set_real("/VTKHDF/PointData/U", tuples_of(flows_at(nodes)), wide, {nodes.size(), 3});
  return file.bytes();
}

/// The numbers of one cell for XDMF, whose text xdmf_file() is.
inline std::string xdmf_numbers(const CellKind& kind, bool wide) {
  const std::vector<Vec3> nodes = places(kind, kind.vtk_nodes);
  const Hdf5File file;
  std::vector<std::int64_t> order;
  for (std::size_t i = 0; i < nodes.size(); ++i) order.push_back(static_cast<std::int64_t>(i));
  file.set("/cells", order, {1, nodes.size()});
  file.set_real("/points", tuples_of(nodes), wide, {nodes.size(), 3});
  file.set_real("/u", tuples_of(flows_at(nodes)), wide, {nodes.size(), 3});
  return file.bytes();
}

/// One cell in XDMF, its numbers in the text, or in a.h5 beside it. Cells as "XDMF Model and Format" calls them.
inline std::string xdmf_file(const CellKind& kind, bool wide, bool beside) {
  static const std::vector<std::pair<int, const char*>> kNames{
      {10, "Tetrahedron"},    {12, "Hexahedron"},    {13, "Wedge"},         {14, "Pyramid"},
      {24, "Tetrahedron_10"}, {25, "Hexahedron_20"}, {29, "Hexahedron_27"}, {26, "Wedge_15"},
      {32, "Wedge_18"},       {27, "Pyramid_13"}};
  const char* name = "";
  for (const auto& [vtk, of_kind] : kNames) name = vtk == kind.vtk ? of_kind : name;
  const std::vector<Vec3> nodes = places(kind, kind.vtk_nodes);
  const std::string n = std::to_string(nodes.size());
  const auto item = [&](const std::string& counts, bool whole, const std::string& place,
                        const std::string& text) {
    return "<DataItem Dimensions=\"" + counts + "\" NumberType=\"" + (whole ? "Int" : "Float") +
           "\" Precision=\"" + (whole || wide ? "8" : "4") + "\" Format=\"" +
           (beside ? "HDF\">a.h5:/" + place : "XML\">" + text) + "</DataItem>";
  };
  std::string order, points, values;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    order += std::to_string(i) + " ";
    points += words_of(nodes[i]) + " ";
    values += words_of(flow_at(nodes[i])) + " ";
  }
  return "<?xml version=\"1.0\"?>\n<Xdmf Version=\"3.0\"><Domain><Grid Name=\"g\" GridType=\"Uniform\"><Topology "
         "TopologyType=\"" +
         std::string(name) + "\" NumberOfElements=\"1\">" + item("1 " + n, true, "cells", order) +
         "</Topology><Geometry GeometryType=\"XYZ\">" + item(n + " 3", false, "points", points) +
         "</Geometry><Attribute Name=\"U\" AttributeType=\"Vector\" Center=\"Node\">" +
         item(n + " 3", false, "u", values) + "</Attribute></Grid></Domain></Xdmf>\n";
}

}  // namespace palpate::test
