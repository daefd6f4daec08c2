/// Options of haptic modes as words of the command line: plain values that hand/mode/ reads.
#pragma once

#include <string>
#include <vector>

namespace palpate {

/// Of the mode `linear` (hand/mode/linear_mode.h).
struct LinearSpec {
  std::string reference = "auto";       ///< name_of(LinearReference)
  std::string axes = "free,drag,drag";  ///< name_of(AxisRule) of each axis
  std::string tau = "4";                ///< drag thresholds [mm]: one for all axes, or three with '/' between
  std::string kappa = "1";              ///< stiffness factors, likewise
  std::string measure = "value";        ///< name_of(LinearMeasure): what curves take
  double friction = 0.0;
};

/// Of haptic grid and cutting planes (hand/mode/grid_mode.h); grammar of haptics/widget/widget_text.h.
struct GridSpec {
  std::string frame = "data";
  std::string spacing;              ///< H or H,H,H [data units]; empty: that of the data
  std::string marks;                ///< landmarks
  std::string switch_at = "nodes";  ///< name_of(GridSwitch)
  int peaks = 0;
  double pull = 6.0;   ///< [mm]
  double notch = 3.0;  ///< [mm]
  double detents = 0.0;
};
struct PlaneSpec {
  std::string planes;
  double detent = 15.0;  ///< [degrees]
  double sphere = 25.0;  ///< radius [mm]
  double reach = 8.0;    ///< [mm]
};

/// What is felt beside the mode, and of surfaces of all kinds (hand/mode/fixture.h).
struct FixtureSpec {
  std::vector<std::string> list;  ///< grammar of read_fixture(), in the order of the chain
  double snap = 5.0;              ///< [mm] at which a shape catches
  double release = 10.0;          ///< [mm] at which it lets go
  double carry = 0.0;             ///< [mm/s] along curves
  double carry_force = 1.0;       ///< [N]
  double static_friction = 0.0;
  double dynamic_friction = 0.0;
  double grain = 0.0;              ///< [mm]
  double viscosity = 0.0;          ///< [N s/m]
  double even_stiffness = 0.0;     ///< [N/m]
  double event_force = 0.0;        ///< [N]
  double event_frequency = 150.0;  ///< [Hz]
};

}  // namespace palpate
