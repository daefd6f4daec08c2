#include "apps/cardiac/mesher/tetgen_filling.h"

#include <memory>
#include <string>

#include <tetgen.h>

#include "common/base/error.h"
#include "common/base/text.h"

namespace palpate {
namespace {

/// The border as TetGen takes it. Its destructor frees what was allocated here with new[].
std::unique_ptr<tetgenio> input_of(const WallBorder& border) {
  auto in = std::make_unique<tetgenio>();
  in->firstnumber = 0;
  in->numberofpoints = static_cast<int>(border.points.size());
  in->pointlist = new REAL[3 * border.points.size()];
  for (std::size_t p = 0; p < border.points.size(); ++p)
    for (std::size_t a = 0; a < 3; ++a) in->pointlist[3 * p + a] = border.points[p][static_cast<int>(a)];
  in->numberoffacets = static_cast<int>(border.triangles.size());
  in->facetlist = new tetgenio::facet[border.triangles.size()];
  for (std::size_t t = 0; t < border.triangles.size(); ++t) {
    tetgenio::facet& facet = in->facetlist[t];
    tetgenio::init(&facet);
    facet.numberofpolygons = 1;
    facet.polygonlist = new tetgenio::polygon[1];
    tetgenio::init(facet.polygonlist);
    facet.polygonlist->numberofvertices = 3;
    facet.polygonlist->vertexlist = new int[3];
    for (std::size_t i = 0; i < 3; ++i)
      facet.polygonlist->vertexlist[i] = static_cast<int>(border.triangles[t][i]);
  }
  in->numberofholes = static_cast<int>(border.holes.size());
  if (border.holes.empty()) return in;
  in->holelist = new REAL[3 * border.holes.size()];
  for (std::size_t h = 0; h < border.holes.size(); ++h)
    for (std::size_t a = 0; a < 3; ++a) in->holelist[3 * h + a] = border.holes[h][static_cast<int>(a)];
  return in;
}

void run(std::string switches, tetgenio& in, tetgenio& out) {
  try {
    tetrahedralize(switches.data(), &in, &out);
  } catch (int code) {
    throw work_error("TetGen gave up on the surfaces (its error " + std::to_string(code) + ")");
  }
}

}  // namespace

FinishedMesh fill_border(const WallBorder& border, double largest_volume) {
  check_border(border);
  const auto in = input_of(border);
  {
    // "d" only looks for facets that cross; it lists their points, and is clean where filling would crash.
    tetgenio crossing;
    run("pdQ", *in, crossing);
    if (crossing.numberofpoints > 0)
      throw work_error(
          "surfaces of the wall cross or touch (" + std::to_string(crossing.numberoftrifaces) +
          " of their triangles): a finer --refine may part them, --mesher delaunay does not mind");
  }
  tetgenio out;
  std::string switches = "pYq" + short_number(kRadiusEdge) + "Q";
  if (largest_volume > 0.0) switches += "a" + exact_number(largest_volume);
  run(switches, *in, out);
  if (out.numberoftetrahedra <= 0 || out.numberofcorners != 4)
    throw work_error("TetGen gave no tetrahedron: the surfaces enclose nothing");

  FinishedMesh mesh;
  mesh.points.reserve(static_cast<std::size_t>(out.numberofpoints));
  for (std::size_t p = 0; p < static_cast<std::size_t>(out.numberofpoints); ++p)
    mesh.points.emplace_back(out.pointlist[3 * p], out.pointlist[3 * p + 1], out.pointlist[3 * p + 2]);
  mesh.tets.reserve(static_cast<std::size_t>(out.numberoftetrahedra));
  for (std::size_t t = 0; t < static_cast<std::size_t>(out.numberoftetrahedra); ++t) {
    TetMesh::Tet tet{};
    for (std::size_t i = 0; i < 4; ++i) tet[i] = static_cast<std::uint32_t>(out.tetrahedronlist[4 * t + i]);
    mesh.tets.push_back(tet);
  }
  mesh.note = std::to_string(border.triangles.size()) + " triangles of the surfaces kept, " +
              std::to_string(out.numberofpoints - in->numberofpoints) + " points added inside";
  return mesh;
}

}  // namespace palpate
