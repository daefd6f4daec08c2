// Surfaces of triangles: the first byte chooses .stl, .ply or .obj. What is read names points that are there.
#include <cstdint>

#include "common/base/error.h"
#include "common/load/read_surface.h"
#include "tests/fuzz/memory_path.h"

using namespace palpate;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 1) return 0;
  constexpr const char* kNames[] = {"a.stl", "a.ply", "a.obj"};
  const test::MemoryPath file(data + 1, size - 1);
  try {
    const SurfaceTriangles surface = read_surface(file.path(kNames[data[0] % 3]));
    if (surface.triangles.empty()) __builtin_trap();
    for (const auto& triangle : surface.triangles)
      for (const std::uint32_t corner : triangle)
        if (corner >= surface.points.size()) __builtin_trap();
    for (const Vec3& point : surface.points)
      if (!is_finite(point)) __builtin_trap();
  } catch (const Error&) {  // refused in one line
  }
  return 0;
}
