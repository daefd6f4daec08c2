/// Virtual fixtures: curves, surfaces and landmarks that hold, stop or pull a hand in every mode, in the grammar of
/// `--fixture`, a list in the order of the chain:
///
///   FILE.csv | .vtp | .trk | .tck | .trx     polylines: a table with the header x,y,z[,line], or lines of a file
///   FILE.stl | .ply | .obj | .vtp            a surface of triangles that is touched
///   circle:x,y,z,nx,ny,nz,r                  centre, axis, radius
///   sphere:x,y,z,r                           the surface of a sphere
///   plane:nx,ny,nz,d                         the plane n.x = d
///   half-space:nx,ny,nz,d                    a wall: the hand stays where n.x >= d
///   magnet:x,y,z[,MM[,N]]                    catches a hand within so many mm (5) with so many N (1.5)
///   well:x,y,z[,MM[,N]]                      leads it there from afar (50 mm, 0.5 N)
///   forces:FILE.csv                          the force of a table t,fx,fy,fz (a log of `probe`), played back over time
///   mode                                     where the mode's own constraints stand; last, where it is not said
///
/// Coordinates and radii are the data's own; millimetres and newtons are the hand's.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "common/base/progress.h"
#include "common/geometry/surface_mesh.h"
#include "common/haptics/constraint/force_playback.h"
#include "common/haptics/constraint/landmark_pull.h"
#include "common/haptics/constraint/link_settings.h"
#include "common/haptics/proxy_chain.h"
#include "common/haptics/workspace.h"

namespace palpate {

/// One of the list, ready to be felt and drawn.
struct Fixture {
  enum class Kind : std::uint8_t {
    kMode,
    kCircle,
    kSphere,
    kPlane,
    kHalfSpace,
    kLandmark,
    kForces,
    kLines,
    kSurface
  };

  std::string text;  ///< as the user wrote it
  Kind kind = Kind::kMode;
  Vec3 at{0.0};                ///< centre, landmark, or a point of the plane; data coordinates
  Vec3 normal{0.0, 0.0, 1.0};  ///< unit
  double radius = 0.0;         ///< data units
  Landmark landmark;           ///< but for its place
  std::shared_ptr<const std::vector<TimedForce>> forces;
  std::vector<std::vector<Vec3>> lines;     ///< data coordinates
  std::shared_ptr<const SurfaceMesh> mesh;  ///< data coordinates
  std::uint64_t fingerprint = 0;            ///< of what a file held; 0: there is none
  std::vector<std::string> notes;           ///< what the user is to know of it
};
using FixtureList = std::vector<std::shared_ptr<const Fixture>>;

/// @throws Error (usage) that shows the grammar; (bad input) naming the file; Cancelled.
[[nodiscard]] std::shared_ptr<const Fixture> read_fixture(const std::string& text,
                                                          Progress* progress = nullptr);

/// Fixtures by what the user wrote, each read once.
class FixtureStore {
 public:
  /// @throws Error as read_fixture(), (usage) where the list makes no chain: `mode` twice, or more than kMost.
  [[nodiscard]] FixtureList list(const std::vector<std::string>& texts, Progress* progress = nullptr);

  static constexpr std::size_t kMost = 4;  ///< beside the mode

 private:
  std::map<std::string, std::shared_ptr<const Fixture>> known_;
};

/// Puts the links of `fixtures` around those of the mode in `chain`: in front, and behind where the list says so.
/// Surfaces have friction where the settings of the chain have it.
void add_fixtures(ProxyChain& chain, const FixtureList& fixtures, const Workspace& workspace);

/// @name A list in a recording: one word without blanks, which tells files that have changed
/// @{
[[nodiscard]] std::string fixture_word(const FixtureList& fixtures);
/// @throws Error (bad input) where the word makes no sense, or a file holds something else than it did.
[[nodiscard]] FixtureList fixtures_of_word(const std::string& word, FixtureStore& store,
                                           Progress* progress = nullptr);
/// @}

}  // namespace palpate
