/// Values of nodes in EX files, and nodes and elements that are listed more than once.
#pragma once

#include <string>

#include "loaders/cardiac/ex/ex_model.h"
#include "loaders/cardiac/text_lines.h"

namespace palpate::ex {

/// The next value of a field. A string (a word, or what stands in quotes) and a place in an element ("1 0.5
/// 0.5 0.5", in older files "E 1 3 0.5 0.5 0.5": element, dimension, xi) are passed over: NaN.
/// @throws Error (bad input) naming the line where something else stands there.
[[nodiscard]] double node_value(TextLines& lines, const NodeField& field);

/// Adds the fields that a node has where it is listed again.
/// @return the name of a field that both have with other values; empty: there is none.
[[nodiscard]] std::string add_fields(const Node& again, Model& model, Node& there);
/// The same for an element: a field that both have is the same where its parameters are those of the same nodes.
[[nodiscard]] std::string add_fields(const Element& again, Model& model, Element& there);

/// Passes over the lines of numbers that follow.
void pass_numbers(TextLines& lines);

/// Numbers of an element's faces, behind "Faces:" and in the lines of numbers that follow.
/// @param triples before version 2 each is an element, a face and a line, of which two are zero.
[[nodiscard]] std::vector<std::int64_t> faces_of(TextLines& lines, bool triples);

}  // namespace palpate::ex
