#include "common/field/color_transfer_file.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <string_view>
#include <utility>
#include <vector>

#include "common/base/csv_reader.h"
#include "common/base/error.h"
#include "common/base/number_text.h"
#include "common/base/text.h"

namespace palpate {
namespace {

constexpr std::size_t kMostPoints = 65536;  // more than the values of most data: such a file is a mistake
constexpr std::string_view kWhat =
    "a transfer function: a table with the header value,red,green,blue,opacity";
constexpr std::string_view kWords = "points:";
constexpr std::size_t kNumbers = 5;  // of a point

std::string row_of(const ColorPoint& point) {
  std::string row = exact_number(point.value);
  for (int c = 0; c < 3; ++c) row += "," + exact_number(static_cast<double>(point.color[c]));
  return row + "," + exact_number(point.opacity);
}

}  // namespace

ColorTransfer read_color_transfer(const std::string& file, double lower, double upper) {
  constexpr std::array<std::string_view, 4> kColumns{"red", "green", "blue", "opacity"};
  constexpr std::array<std::string_view, 2> kPlaces{"value", "fraction"};
  CsvReader table(file, kColumns, kPlaces, std::string(kWhat));
  std::vector<ColorPoint> points;
  bool fractions = false;
  for (std::array<double, 6> row{}; table.next(row);) {
    const auto [red, green, blue, opacity, value, fraction] = row;
    if (std::isnan(value) == std::isnan(fraction)) {
      table.refuse("holds no value", "a finite number in one column, value or fraction");
    }
    fractions = std::isnan(value);
    const double place = fractions ? fraction : value;
    if (!std::isfinite(place)) table.refuse("holds a value that is not finite", "a finite number");
    for (const double part : {red, green, blue, opacity}) {
      if (!(part >= 0.0 && part <= 1.0)) {
        table.refuse("holds a colour or opacity outside [0, 1]", "numbers from 0 to 1");
      }
    }
    if (fractions && !(place >= 0.0 && place <= 1.0)) {
      table.refuse("holds a fraction outside [0, 1]", "numbers from 0 to 1");
    }
    if (!points.empty() && place < points.back().value) {
      table.refuse("holds a lower value than the row before it", "points by ascending value");
    }
    if (points.size() >= kMostPoints) {
      table.refuse("is one point too many", "at most " + std::to_string(kMostPoints) + " points");
    }
    points.push_back({place, Vec3f(red, green, blue), opacity});
  }
  if (points.empty()) {
    throw input_error({file, "", "holds no point below its header", std::string(kWhat), ""});
  }
  ColorTransfer transfer(std::move(points));
  return fractions ? spread(transfer, lower, upper) : transfer;
}

std::string color_transfer_text(const ColorTransfer& transfer) {
  std::string text = "value,red,green,blue,opacity\n";
  for (const ColorPoint& point : transfer.points()) text += row_of(point) + "\n";
  return text;
}

std::string transfer_words(const ColorTransfer& transfer) {
  std::string words(kWords);
  for (const ColorPoint& point : transfer.points()) {
    if (words.size() > kWords.size()) words += '/';
    words += row_of(point);
  }
  return words;
}

std::optional<ColorTransfer> transfer_from_words(const std::string& text) {
  if (!text.starts_with(kWords)) return std::nullopt;
  std::vector<ColorPoint> points;
  for (const std::string_view row : split(std::string_view(text).substr(kWords.size()), '/')) {
    std::vector<double> numbers;
    for (const std::string_view part : split(row, ',')) {
      const auto value = number(part);
      if (!value) break;
      numbers.push_back(*value);
    }
    if (numbers.size() != kNumbers || points.size() >= kMostPoints) {
      throw usage_error(
          "'" + std::string(row) +
          "' is no point of a transfer function: value,red,green,blue,opacity is expected, with "
          "'/' between points");
    }
    points.push_back({numbers[0], Vec3f(numbers[1], numbers[2], numbers[3]), numbers[4]});
  }
  return ColorTransfer(std::move(points));
}

}  // namespace palpate
