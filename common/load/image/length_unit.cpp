#include "common/load/image/length_unit.h"

#include <algorithm>
#include <array>
#include <string>

#include "common/base/text.h"

namespace palpate {

std::optional<double> millimetres_in(std::string_view unit) {
  struct Unit {
    std::string_view symbol, name;
    double millimetres = 1.0;
  };
  constexpr std::array<Unit, 8> kUnits{{{"m", "meter", 1e3},
                                        {"dm", "decimeter", 1e2},
                                        {"cm", "centimeter", 1e1},
                                        {"mm", "millimeter", 1.0},
                                        {"um", "micrometer", 1e-3},
                                        {"\xC2\xB5m", "micron", 1e-3},  // the micro sign
                                        {"nm", "nanometer", 1e-6},
                                        {"\xCE\xBCm", "micro meter", 1e-3}}};  // the Greek letter
  std::string word = lowered(trimmed(unit));
  if (word.ends_with("metre") || word.ends_with("metres")) word.replace(word.rfind("metre"), 5, "meter");
  if (word.size() > 2 && word.ends_with('s')) word.pop_back();
  const auto* const found = std::find_if(kUnits.begin(), kUnits.end(), [&word](const Unit& one) {
    return word == one.symbol || word == one.name;
  });
  return found == kUnits.end() ? std::nullopt : std::optional(found->millimetres);
}

}  // namespace palpate
