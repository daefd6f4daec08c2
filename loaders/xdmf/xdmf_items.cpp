#include "loaders/xdmf/xdmf_items.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string_view>
#include <vector>

#include <libxml/parser.h>
#include <libxml/tree.h>
#include <libxml/xpath.h>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/text.h"
#include "loaders/vtk/xml_values.h"

namespace palpate {
namespace {

const xmlChar* as_xml(const char* text) { return reinterpret_cast<const xmlChar*>(text); }

std::string taken(xmlChar* text) {
  if (text == nullptr) return {};
  std::string out(reinterpret_cast<const char*>(text));
  xmlFree(text);
  return out;
}
std::string attribute(xmlNode* node, const char* name) { return taken(xmlGetProp(node, as_xml(name))); }
void set(xmlNode* node, const char* name, const std::string& value) {
  xmlSetProp(node, as_xml(name), as_xml(value.c_str()));
}
bool is_item(const xmlNode* node) {
  return node->type == XML_ELEMENT_NODE && xmlStrcmp(node->name, as_xml("DataItem")) == 0;
}

class Items {
 public:
  Items(const std::string& file, std::vector<std::string>& notes)
      : file_(file),
        notes_(notes),
        document_(
            xmlReadFile(file.c_str(), nullptr, XML_PARSE_NONET | XML_PARSE_NOERROR | XML_PARSE_NOWARNING),
            xmlFreeDoc) {}

  std::optional<std::string> replaced() {
    if (document_ == nullptr) return std::nullopt;  // which libxdmf says
    xmlNode* const root = xmlDocGetRootElement(document_.get());
    if (root == nullptr) return std::nullopt;
    std::vector<xmlNode*> items;
    find(root, items);
    for (xmlNode* const item : items) check_text(item);
    // Items within others stand behind them.
    bool changed = false;
    for (auto item = items.rbegin(); item != items.rend(); ++item)
      if (stands(*item)) changed = replace(*item) || changed;
    if (!changed) return std::nullopt;
    items.clear();
    find(root, items);
    for (xmlNode* const item : items) name_from_anywhere(item);
    xmlChar* text = nullptr;
    int size = 0;
    xmlDocDumpMemory(document_.get(), &text, &size);
    return taken(text);
  }

 private:
  static void find(xmlNode* node, std::vector<xmlNode*>& items) {
    for (xmlNode* child = node->children; child != nullptr; child = child->next) {
      if (is_item(child)) items.push_back(child);
      find(child, items);
    }
  }

  [[noreturn]] void refuse(xmlNode* item, const std::string& problem, const std::string& expected,
                           const char* remedy = "write the values as a plain DataItem") const {
    throw input_error({file_, "line " + std::to_string(xmlGetLineNo(item)), problem, expected, remedy});
  }

  /// Whether it is still in the document.
  bool stands(const xmlNode* node) const {
    const xmlNode* top = node;
    while (top->parent != nullptr && top->parent->type == XML_ELEMENT_NODE) top = top->parent;
    return top == xmlDocGetRootElement(document_.get());
  }

  /// Takes out the attribute whose values `item` are, with a word. Refuses what is of the grid.
  void leave_out(xmlNode* item, const std::string& problem, const std::string& expected) {
    xmlNode* of = item;
    while (of != nullptr && of->type == XML_ELEMENT_NODE && xmlStrcmp(of->name, as_xml("Attribute")) != 0)
      of = of->parent;
    if (of == nullptr || of->type != XML_ELEMENT_NODE) refuse(item, problem, expected);
    notes_.push_back("attribute '" + printable(attribute(of, "Name").substr(0, 60)) + "' left out: line " +
                     std::to_string(xmlGetLineNo(item)) + " " + problem + "; expected " + expected);
    xmlUnlinkNode(of);
    taken_out_.emplace_back(of, xmlFreeNode);
  }

  /// The item that `item` refers to, or itself.
  xmlNode* meant(xmlNode* item) const {
    std::string path = attribute(item, "Reference");
    if (path.empty()) return item;
    if (path == "XML") path = trimmed(taken(xmlNodeGetContent(item)));
    const std::unique_ptr<xmlXPathContext, void (*)(xmlXPathContext*)> context(
        xmlXPathNewContext(document_.get()), xmlXPathFreeContext);
    const std::unique_ptr<xmlXPathObject, void (*)(xmlXPathObject*)> found(
        xmlXPathEvalExpression(as_xml(path.c_str()), context.get()), xmlXPathFreeObject);
    if (found == nullptr || found->nodesetval == nullptr || found->nodesetval->nodeNr != 1 ||
        !is_item(found->nodesetval->nodeTab[0]))
      refuse(item, "refers to '" + printable(path.substr(0, 60)) + "'", "one DataItem");
    return found->nodesetval->nodeTab[0];
  }

  std::vector<xmlNode*> parts(xmlNode* item) const {
    std::vector<xmlNode*> out;
    for (xmlNode* child = item->children; child != nullptr; child = child->next)
      if (is_item(child)) out.push_back(meant(child));
    return out;
  }

  /// @param what the numbers are, for messages.
  std::vector<std::int64_t> numbers(xmlNode* item, const std::string& text, const char* what) const {
    std::vector<std::int64_t> out;
    constexpr std::size_t kMost = 64;
    std::string blank = text;
    std::ranges::replace_if(
        blank, [](char c) { return c == ',' || c == '\n' || c == '\r' || c == '\t'; }, ' ');
    for (const std::string_view word : words(blank)) {
      std::int64_t number = 0;
      const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
      if (error != std::errc() || end != word.data() + word.size() || number < 0 || out.size() == kMost)
        refuse(item, std::string("has ") + what + " '" + printable(text.substr(0, 60)) + "'",
               "whole numbers");
      out.push_back(number);
    }
    return out;
  }
  std::vector<std::int64_t> counts(xmlNode* item) const {
    return numbers(item, attribute(item, "Dimensions"), "Dimensions");
  }
  static std::int64_t product(const std::vector<std::int64_t>& all) {
    std::int64_t out = 1;
    for (const std::int64_t n : all)
      if (__builtin_mul_overflow(out, n, &out)) return -1;
    return out;
  }

  /// Numbers that stand in the file: as many as Dimensions say, each one of its type. libxdmf takes what it can of a word, and
  /// 0 for those that are missing.
  void check_text(xmlNode* item) const {
    constexpr const char* kDamaged = "the file may be damaged";
    const std::string format = lowered(attribute(item, "Format"));
    const bool plain =
        attribute(item, "ItemType").empty() || lowered(attribute(item, "ItemType")) == "uniform";
    if (!plain || !attribute(item, "Type").empty() || !attribute(item, "Reference").empty() ||
        (!format.empty() && format != "xml") || xmlFirstElementChild(item) != nullptr)
      return;
    std::string type = lowered(attribute(item, "NumberType"));
    if (type.empty()) type = lowered(attribute(item, "DataType"));
    const bool real = type.empty() || type == "float";
    if (!real && type != "int" && type != "uint") return;
    const TextValues values = text_values(taken(xmlNodeGetContent(item)), real            ? "Float64"
                                                                          : type == "int" ? "Int64"
                                                                                          : "UInt64");
    if (!values.wrong.empty()) {
      refuse(item, "has '" + values.wrong + "' as its value " + std::to_string(values.count + 1),
             "a number of type " + (type.empty() ? "float" : type), kDamaged);
    }
    const std::int64_t due = product(counts(item));
    if (due >= 0 && !attribute(item, "Dimensions").empty() && values.count != static_cast<std::uint64_t>(due))
      refuse(item, "has " + counted(values.count, "number"), std::to_string(due) + " by its Dimensions",
             kDamaged);
  }

  bool replace(xmlNode* item) {
    std::string type = lowered(attribute(item, "ItemType"));
    if (type.empty()) type = lowered(attribute(item, "Type"));
    if (type == "hyperslab") {
      slab(item);
    } else if (type == "function") {
      function(item);
    } else if (type == "coordinates") {
      leave_out(item, "has values by coordinates", "a HyperSlab or all values");
    } else {
      return false;
    }
    return true;
  }

  void slab(xmlNode* item) {
    const std::vector<xmlNode*> both = parts(item);
    if (both.size() != 2)
      refuse(item, "is a HyperSlab of " + counted(both.size(), "item"), "its place and an array");
    const std::vector<std::int64_t> place =
        numbers(item, taken(xmlNodeGetContent(both[0])), "a place of a HyperSlab");
    const std::vector<std::int64_t> all = counts(both[1]);
    const std::string format = lowered(attribute(both[1], "Format"));
    const std::string name(trimmed(taken(xmlNodeGetContent(both[1]))));
    if (format != "hdf" || name.find('|') != std::string::npos)
      return leave_out(item, "is a HyperSlab of values that are in no HDF5 array", "one of an HDF5 array");
    if (all.empty() || place.size() != 3 * all.size())
      refuse(item,
             "is a HyperSlab of " + counted(place.size(), "number") + " of an array of " +
                 std::to_string(all.size()) + " axes",
             "start, stride and count for each axis");
    const std::size_t axes = all.size();
    std::vector<std::int64_t> count;
    std::string words;
    for (std::size_t row = 0; row < 3; ++row) {
      for (std::size_t axis = 0; axis < axes; ++axis)
        words += (axis > 0 ? " " : row > 0 ? ":" : "") + std::to_string(place[row * axes + axis]);
    }
    for (std::size_t axis = 0; axis < axes; ++axis) {
      const std::int64_t start = place[axis], stride = place[axes + axis], n = place[2 * axes + axis];
      if (n < 1 || stride < 1 || start >= all[axis] || (n - 1) > (all[axis] - 1 - start) / stride) {
        refuse(item, "is a HyperSlab beyond its array along axis " + std::to_string(axis + 1),
               std::to_string(all[axis]) + " numbers");
      }
      count.push_back(n);
      words += (axis > 0 ? " " : ":") + std::to_string(all[axis]);
    }
    if (product(counts(item)) != product(count)) {
      std::string text;
      for (const std::int64_t n : count) text += (text.empty() ? "" : " ") + std::to_string(n);
      set(item, "Dimensions", text);
    }
    for (const char* const from : {"NumberType", "DataType", "Precision"})
      if (const std::string value = attribute(both[1], from); !value.empty()) set(item, from, value);
    make_plain(item);
    set(item, "Format", "HDF");
    xmlNodeAddContent(item, as_xml((name + "|" + words).c_str()));
  }

  void function(xmlNode* item) {
    std::string text = lowered(attribute(item, "Function"));
    std::erase_if(text, [](char c) { return c == ' '; });
    std::ranges::replace(text, ';', ',');
    const std::vector<xmlNode*> all = parts(item);
    std::string join = "join(", interlaced;
    for (std::size_t i = 0; i < all.size(); ++i) {
      const std::string argument = "$" + std::to_string(i);
      join += (i > 0 ? "," : "") + argument;
      interlaced += (i > 0 ? " # " : "") + argument;
    }
    const std::vector<std::int64_t> whole = counts(item);
    if (text.find_first_not_of("$0123456789#") == std::string::npos) return;  // as libxdmf writes it
    if (all.empty() || text != join + ")")
      return leave_out(item, "is the function '" + printable(attribute(item, "Function").substr(0, 60)) + "'",
                       "JOIN($0, $1, ...) of all its items");
    for (xmlNode* const part : all) {
      if (product(counts(part)) != product(counts(all[0])))
        refuse(item, "joins items of different sizes", "the same size for each");
    }
    const auto count = static_cast<std::int64_t>(all.size());
    if (whole.empty() || whole.back() != count || product(whole) != count * product(counts(all[0])))
      refuse(item, "joins " + counted(all.size(), "item") + " to '" + attribute(item, "Dimensions") + "'",
             "Dimensions that end with " + std::to_string(count));
    set(item, "Function", interlaced);
  }

  /// Leaves nothing of what it was.
  static void make_plain(xmlNode* item) {
    for (const char* const name : {"ItemType", "Type"}) xmlUnsetProp(item, as_xml(name));
    while (item->children != nullptr) {
      xmlNode* const child = item->children;
      xmlUnlinkNode(child);
      xmlFreeNode(child);
    }
  }

  /// Values beside the file stay beside it.
  void name_from_anywhere(xmlNode* item) const {
    const std::string format = lowered(attribute(item, "Format"));
    if (format != "hdf" && format != "binary") return;
    const std::string name(trimmed(taken(xmlNodeGetContent(item))));
    if (name.empty() || name.front() == '/') return;
    const std::filesystem::path folder = std::filesystem::absolute(file_).parent_path();
    xmlNodeSetContent(item, nullptr);
    xmlNodeAddContent(item, as_xml((folder / name).c_str()));
  }

  std::string file_;
  std::vector<std::string>& notes_;
  std::unique_ptr<xmlDoc, void (*)(xmlDoc*)> document_;
  std::vector<std::unique_ptr<xmlNode, void (*)(xmlNode*)>> taken_out_;
};

}  // namespace

std::optional<std::string> with_plain_items(const std::string& file, std::vector<std::string>& notes) {
  return Items(file, notes).replaced();
}

}  // namespace palpate
