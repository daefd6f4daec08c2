#include "common/render/ticks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "common/base/index.h"

namespace palpate {
namespace {

// Largest magnitudes written without an exponent.
constexpr double kPlainMin = 1e-3, kPlainMax = 1e5;

std::string print(const char* format, int digits, double value) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), format, digits, value);
  return text.data();
}

// "1.50e-07" reads better as "1.5e-7".
std::string tidy_exponent(std::string text) {
  const auto e = text.find('e');
  if (e == std::string::npos) return text;
  std::string mantissa = text.substr(0, e);
  if (mantissa.find('.') != std::string::npos) {
    mantissa.erase(mantissa.find_last_not_of('0') + 1);
    if (mantissa.back() == '.') mantissa.pop_back();
  }
  return mantissa + "e" + std::to_string(std::stoi(text.substr(e + 1)));
}

// A number on its own, in few characters.
std::string lone_number(double value) {
  const double size = std::abs(value);
  if (value == 0.0) return "0";
  if (!std::isfinite(value)) return std::isnan(value) ? "nan" : (value > 0 ? "inf" : "-inf");
  if (size >= kPlainMax || size < kPlainMin) return tidy_exponent(print("%.*e", 2, value));
  return print("%.*g", size >= 1000.0 ? 5 : 3, value);
}

// All numbers of one scale get the same number of decimals.
std::string tick_text(double value, double step, double largest) {
  if (value == 0.0) return "0";
  if (largest >= kPlainMax || largest < kPlainMin) {
    const int digits = std::max(
        0, static_cast<int>(std::floor(std::log10(std::abs(value))) - std::floor(std::log10(step) + 1e-9)));
    return tidy_exponent(print("%.*e", std::min(digits, 6), value));
  }
  const int decimals = std::max(0, static_cast<int>(-std::floor(std::log10(step) + 1e-9)));
  return print("%.*f", std::min(decimals, 9), value);
}

std::vector<Tick> linear_ticks(const ValueRange& range, int max_count) {
  const double span = range.upper - range.lower;
  const double largest = std::max(std::abs(range.lower), std::abs(range.upper));
  const double rough = span / std::max(1, max_count - 1);
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  double step = 10.0 * power;
  for (const double round : {1.0, 2.0, 5.0}) {
    if (round * power >= rough * (1.0 - 1e-9)) {
      step = round * power;
      break;
    }
  }
  std::vector<Tick> result;
  // Counted in whole steps, so that rounding neither drops the last tick nor adds up.
  const double first = std::ceil(range.lower / step - 1e-9), last = std::floor(range.upper / step + 1e-9);
  for (double i = first; i <= last && result.size() < as_size(max_count); ++i) {
    result.push_back({i * step, tick_text(i * step, step, largest)});
  }
  return result;
}

std::vector<Tick> decade_ticks(const ValueRange& range, int max_count) {
  const int first = static_cast<int>(std::ceil(std::log10(range.lower) - 1e-9));
  const int last = static_cast<int>(std::floor(std::log10(range.upper) + 1e-9));
  std::vector<Tick> result;
  const int stride = std::max(1, (last - first) / std::max(1, max_count - 1) +
                                     ((last - first) % std::max(1, max_count - 1) != 0 ? 1 : 0));
  for (int k = first; k <= last; k += stride) result.push_back({std::pow(10.0, k), "1e" + std::to_string(k)});
  if (result.size() >= 2) return result;
  result.clear();
  for (int k = first - 1; k <= last; ++k) {
    for (const double m : {1.0, 2.0, 5.0}) {
      const double value = m * std::pow(10.0, k);
      if (value >= range.lower * (1.0 - 1e-9) && value <= range.upper * (1.0 + 1e-9)) {
        result.push_back({value, lone_number(value)});
      }
    }
  }
  return result;
}

}  // namespace

std::vector<Tick> ticks(const ValueRange& range, bool logarithmic, int max_count) {
  if (!std::isfinite(range.lower) || !std::isfinite(range.upper)) return {};
  const double span = range.upper - range.lower;
  const double largest = std::max(std::abs(range.lower), std::abs(range.upper));
  if (!(span > 1e-12 * largest)) return {{range.lower, lone_number(range.lower)}};
  return logarithmic && range.lower > 0.0 ? decade_ticks(range, max_count) : linear_ticks(range, max_count);
}

}  // namespace palpate
