/// Words of EX files with a meaning of their own: bases, labels of values, numbers behind keys.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "loaders/cardiac/ex/ex_model.h"
#include "loaders/cardiac/text_lines.h"

namespace palpate::ex {

/// More versions than any model has: a claim that is a mistake.
inline constexpr std::int64_t kMostVersions = 10'000;

/// The number behind `key` in a line: "#Versions= 3".
[[nodiscard]] std::optional<double> number_behind(std::string_view line, std::string_view key);

/// "c.Hermite", "l.simplex(2;3)". @throws Error (bad input) about the current line, as those below.
[[nodiscard]] Basis basis_of(const TextLines& lines, std::string_view word);

/// "no modify", "increasing in xi1".
[[nodiscard]] Winding winding_of(const TextLines& lines, std::string_view text);

/// "value", "d/ds1", "d2/ds1ds2(2)": the kind, and the number in brackets, which is 1 where there is none.
[[nodiscard]] std::pair<int, int> label_and_number(const TextLines& lines, std::string_view word);

/// " x. #Values=5 (value(2),d/ds1(2),d/ds2)" in the current line: of each label all versions, one after the other.
/// @param count how many there must be.
[[nodiscard]] std::vector<ValueLabel> labels_of(const TextLines& lines, std::size_t count);

/// "Shape. Dimension=3, simplex(2;3)*simplex*simplex", with or without the comma.
[[nodiscard]] Linked linked_axes(const TextLines& lines);

}  // namespace palpate::ex
