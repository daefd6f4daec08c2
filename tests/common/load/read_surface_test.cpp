// Surfaces from files of every kind, whole and damaged.

#include "common/load/read_surface.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/load/write/write_surface.h"
#include "tests/support/temp_folder.h"

namespace palpate::test {
namespace {

template <typename T>
void put(std::string& bytes, T value, bool swapped = false) {
  std::array<char, sizeof(T)> raw{};
  std::memcpy(raw.data(), &value, sizeof(T));
  if (swapped) std::reverse(raw.begin(), raw.end());
  bytes.append(raw.data(), raw.size());
}

std::string binary_stl() {
  std::string bytes = "solid in name alone";
  bytes.resize(80, ' ');
  put<std::uint32_t>(bytes, 1);
  for (const float value : {0.F, 0.F, 1.F, 0.F, 0.F, 0.5F, 2.F, 0.F, 0.5F, 0.F, 3.F, 0.5F}) put(bytes, value);
  put<std::uint16_t>(bytes, 0);
  return bytes;
}

std::string refusal_of(const std::filesystem::path& file) {
  try {
    (void)read_surface(file);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kBadInput) << error.what();
    return error.what();
  }
  ADD_FAILURE() << file << " was accepted";
  return {};
}

void expect_triangle(const SurfaceTriangles& surface) {
  ASSERT_EQ(surface.triangles.size(), 1U);
  const auto& [a, b, c] = surface.triangles[0];
  EXPECT_EQ(surface.points[a], Vec3(0.0, 0.0, 0.5));
  EXPECT_EQ(surface.points[b], Vec3(2.0, 0.0, 0.5));
  EXPECT_EQ(surface.points[c], Vec3(0.0, 3.0, 0.5));
}

TEST(ReadSurface, TakesStlInBytesAndInText) {
  const TempFolder folder;
  expect_triangle(read_surface(folder.write("bytes.stl", binary_stl())));
  expect_triangle(read_surface(
      folder.write("text.STL",
                   "solid part\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 5e-1\n"
                   "   vertex 2 0 .5\n   vertex 0 3 0.5\n  endloop\n endfacet\nendsolid part\n")));
}

TEST(ReadSurface, TakesPlyOfEveryOrder) {
  const TempFolder folder;
  const std::string head =
      "element vertex 3\nproperty double x\nproperty float y\nproperty float z\nproperty uchar red\n"
      "element face 1\nproperty list uchar int vertex_indices\nproperty float quality\nend_header\n";
  expect_triangle(
      read_surface(folder.write("text.ply", "ply\nformat ascii 1.0\ncomment made by hand\n" + head +
                                                "0 0 0.5 255\n2 0 0.5 0\n0 3 0.5 7\n3 0 1 2 0.25\n")));
  for (const bool swapped : {false, true}) {
    std::string bytes = std::string("ply\nformat ") +
                        (swapped ? "binary_big_endian" : "binary_little_endian") + " 1.0\n" + head;
    for (const auto& [x, y] : {std::pair{0.0, 0.F}, std::pair{2.0, 0.F}, std::pair{0.0, 3.F}}) {
      put(bytes, x, swapped);
      put(bytes, y, swapped);
      put(bytes, 0.5F, swapped);
      put<std::uint8_t>(bytes, 9);
    }
    put<std::uint8_t>(bytes, 3);
    for (const std::int32_t index : {0, 1, 2}) put(bytes, index, swapped);
    put(bytes, 0.25F, swapped);
    expect_triangle(read_surface(folder.write("bytes.ply", bytes)));
    // Cut anywhere it is refused, and never read beyond.
    for (std::size_t length = 0; length < bytes.size(); length += 7)
      (void)refusal_of(folder.write("cut.ply", bytes.substr(0, length)));
  }
}

TEST(ReadSurface, TakesObjWithPolygonsAndIndicesFromTheEnd) {
  const TempFolder folder;
  const SurfaceTriangles quad = read_surface(folder.write(
      "quad.obj",
      "# a quad\nmtllib none.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvn 0 0 1\nf 1//1 2//1 3//1 -1//1\n"));
  ASSERT_EQ(quad.triangles.size(), 2U);
  EXPECT_EQ(quad.triangles[1], (std::array<std::uint32_t, 3>{0, 2, 3}));
}

TEST(ReadSurface, TakesPolygonsOfVtk) {
  const TempFolder folder;
  const std::vector<Vec3> points{{0.0, 0.0, 0.5}, {2.0, 0.0, 0.5}, {0.0, 3.0, 0.5}};
  const std::vector<std::array<std::uint32_t, 3>> triangles{{0, 1, 2}};
  write_surface(folder.path("one.vtp"), points, triangles, {.name = "part", .of = {0}, .words = {"a"}}, {},
                false);
  expect_triangle(read_surface(folder.path("one.vtp")));
}

TEST(ReadSurface, RefusesWhatIsDamaged) {
  const TempFolder folder;
  const auto refused = [&](const char* name, const std::string& text) {
    return refusal_of(folder.write(name, text));
  };
  EXPECT_NE(refused("a.stl", binary_stl().substr(0, 120)).find("a.stl"), std::string::npos);
  (void)refused("b.stl", "");
  (void)refused("c.stl", "solid cut\nvertex 0 0 0\nvertex 1 0 0\n");
  (void)refused("d.stl", "solid none\nendsolid none\n");
  EXPECT_NE(refused("a.obj", "v 0 0 0\nv 1 0\n").find("line 2"), std::string::npos);
  (void)refused("b.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n");
  (void)refused("c.obj", "f 1 2 3\n");
  (void)refused("a.ply", "ply\nformat ascii 1.0\nelement vertex 99999999999\nproperty float x\nend_header\n");
  (void)refused("b.ply",
                "ply\nformat ascii 1.0\nelement face 1\nproperty list uchar int vertex_indices\n"
                "end_header\n3 0 1 2\n");
  (void)refused("c.ply", "ply\nformat xml 1.0\nend_header\n");
  (void)refused("d.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\n");
  EXPECT_NE(refused("nowhere.obj", "v 0 0 0\nv 1 0 0\nv 0 nan 0\nf 1 2 3\n").find("point 2: is nowhere"),
            std::string::npos);
  EXPECT_NE(
      refused("flat.ply",
              "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nelement face 1\n"
              "property list uchar int vertex_indices\nend_header\n0 0\n1 0\n0 1\n3 0 1 2\n")
          .find("vertices without z"),
      std::string::npos);
  (void)refused(
      "half.ply",
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 1\nproperty list uchar float vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n"
      "3 0 1 1.5\n");
  (void)refusal_of(folder.path("not there.stl"));
}

}  // namespace
}  // namespace palpate::test
