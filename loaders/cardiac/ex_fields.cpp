#include "loaders/cardiac/ex_fields.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <utility>

#include "common/base/error.h"
#include "common/base/text.h"

namespace palpate::ex {
namespace {

bool is_own(const std::vector<ElementField>& header, const ElementField& field) {
  return &field == coordinates_of(header) || field.name == "coordinates" || field.name == "fibres" ||
         field.name == "fibers";
}

const ElementField* named(const std::vector<ElementField>& header, const std::string& name) {
  const auto field =
      std::find_if(header.begin(), header.end(), [&](const ElementField& f) { return f.name == name; });
  return field == header.end() ? nullptr : &*field;
}

}  // namespace

std::vector<OtherField> other_fields(const Model& model, const std::string& file,
                                     std::vector<std::string>& notes) {
  std::map<std::string, std::size_t> elements_with;
  for (const Element& element : model.elements) {
    const std::vector<ElementField>& header = model.element_headers[element.header];
    for (const ElementField& field : header)
      if (!is_own(header, field)) ++elements_with[field.name];
  }
  std::vector<OtherField> others;
  for (const auto& [name, with] : elements_with) {
    std::string why;
    if (with < model.elements.size())
      why = counted(model.elements.size() - with, "element") + " of " +
            std::to_string(model.elements.size()) + " without it";
    OtherField other{.name = name, .of_element = {}};
    for (const Element& element : model.elements) {
      if (!why.empty()) break;
      const ElementField& field = *named(model.element_headers[element.header], name);
      if (other.of_element.empty()) other.components = static_cast<int>(field.components.size());
      if (field.system != System::kCartesian) why = "its coordinates are not Cartesian";
      if (static_cast<int>(field.components.size()) != other.components)
        why = "elements disagree on its components";
      if (!why.empty()) break;
      try {
        other.of_element.emplace_back(model, element, field, file);
      } catch (const Error& error) {
        why = error.what();
      }
    }
    if (why.empty()) {
      others.push_back(std::move(other));
    } else {
      notes.push_back("field \"" + name + "\" left out: " + why);
    }
  }
  return others;
}

}  // namespace palpate::ex
