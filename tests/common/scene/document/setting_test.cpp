#include "common/scene/document/setting.h"

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <type_traits>
#include <variant>

#include <gtest/gtest.h>

#include "common/base/error.h"

namespace palpate::test {
namespace {

/// Where the values of all rows stand in `document`.
std::set<const void*> places_of(Document& document) {
  std::set<const void*> places;
  for (const Setting& row : settings()) std::visit([&](auto at) { places.insert(&at(document)); }, row.place);
  return places;
}

/// Members of structs by their addresses. The names stand for all members of a struct in turn: the compiler
/// counts them, so that one more has to be named here, and then it needs a row.
TEST(Settings, HaveARowForEveryMemberOfADocument) {
  Document document;
  const std::set<const void*> places = places_of(document);
  std::size_t members = 0;
  const auto expect = [&](const char* group, const auto&... values) {
    std::size_t index = 0;
    const auto one = [&](const void* value) {
      ++index;
      EXPECT_TRUE(places.contains(value)) << "member " << index << " of " << group << " has no row";
    };
    (one(&values), ...);
    members += sizeof...(values);
  };
  {
    const auto& [a, b, c, d, e, f, g] = document.common;
    expect("common", a, b, c, d, e, f, g);
  }
  {
    const auto& [files, solution, layout, diffusion, refine, series, gaps, left_handed, wall, markers] =
        static_cast<const LoadRequest&>(document.input);
    expect("request", files, solution, refine, series, gaps, markers);
    const auto& [example, field, secondary, time, kind, raw, tensor, cells, directions, regions, paint,
                 mesher, labels, volume, remesher, cache] = static_cast<const InputTexts&>(document.input);
    expect("input", example, field, time, cells, directions, regions, paint, mesher, labels, volume, cache);
    const auto& [a, b, c, d, e, f] = raw;
    expect("raw", a, b, c, d, e, f);
    const auto& [m, n, o, p, q, r, s, t, u, v, w, x, y, z, z1] = tensor;
    expect("tensor", m, n, o, p, q, r, s, t, u, v, w, x, y, z, z1);
    (void)layout, (void)diffusion, (void)left_handed, (void)wall, (void)secondary, (void)kind,
        (void)remesher;  // what the program makes of the others
  }
  {
    const auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, n, o] = document.tracing;
    expect("tracing", a, b, c, d, e, f, g, h, i, j, k, l, m, n, o);
  }
  {
    const auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q] = document.tracts;
    expect("tracts", a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q);
  }
  {
    const auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, s, t, u, v, w, x, y, z, a1, b1, c1] =
        document.view;
    expect("view", a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, s, t, u, v, w, x, y, z, a1, b1, c1);
  }
  {
    const auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, s, t, u, v] = document.volume;
    expect("volume", a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, s, t, u, v);
  }
  {
    const auto& [a, b, c, d, e, f, g, h, i, j, k, l, m] = document.panes;
    expect("panes", a, b, c, d, e, f, g, h, i, j, k, l, m);
  }
  {
    const auto& [a, b, c, d, e, f, g] = document.slice;
    expect("slice", a, b, c, d, e, f, g);
  }
  {
    const auto& [a, b, c, d, e, f, g, h, i, j, k, l] = document.tensors;
    expect("tensors", a, b, c, d, e, f, g, h, i, j, k, l);
  }
  {
    const auto& [a, b, c, d, e, f] = document.tract_appearance;
    expect("tract_appearance", a, b, c, d, e, f);
  }
  {
    const auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, s, t, u, v, w, x, y, z] =
        document.heart;
    expect("heart", a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, s, t, u, v, w, x, y, z);
  }
  {
    const auto& [a, b, c, d] = document.series;
    expect("series", a, b, c, d);
  }
  {
    const auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, linear, grid, planes, fixtures, q, r, s, t,
                 u, v, w, x, y, z, z1, z2, z3, z4, z5, z6, z7, z8] = document.touch;
    expect("touch", a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, s, t, u, v, w, x, y, z, z1, z2, z3,
           z4, z5, z6, z7, z8);
    const auto& [l1, l2, l3, l4, l5, l6] = linear;
    expect("linear", l1, l2, l3, l4, l5, l6);
    const auto& [g1, g2, g3, g4, g5, g6, g7, g8] = grid;
    expect("grid", g1, g2, g3, g4, g5, g6, g7, g8);
    const auto& [p1, p2, p3, p4] = planes;
    expect("planes", p1, p2, p3, p4);
    const auto& [f1, f2, f3, f4, f5, f6, f7, f8, f9, f10, f11, f12] = fixtures;
    expect("fixtures", f1, f2, f3, f4, f5, f6, f7, f8, f9, f10, f11, f12);
  }
  {
    const auto& [a, b, c, d, e, f] = document.hand;
    expect("hand", a, b, c, d, e, f);
  }
  {
    const auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r] = document.output;
    expect("output", a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r);
  }
  {
    const auto& [a, b, c, d, e, f, g, h, i, j] = document.calibration;
    expect("calibration", a, b, c, d, e, f, g, h, i, j);
  }
  {
    const auto& [a, b, c, d, e, f, g, h] = document.head_errors;
    expect("head_errors", a, b, c, d, e, f, g, h);
  }
  {
    const auto& [a, b, c, d, e, f, g, h, i, j, k, l, m] = document.trial;
    expect("trial", a, b, c, d, e, f, g, h, i, j, k, l, m);
  }
  {
    const auto& [a, b, c, d] = document.device_outputs;
    expect("device_outputs", a, b, c, d);
  }
  {
    const auto& [a, b, c, d, e, f, g, h, i] = document.study;
    expect("study", a, b, c, d, e, f, g, h, i);
  }
  EXPECT_EQ(members, places.size());
}

TEST(Settings, AreKnownToASessionByOneNameEach) {
  for (const FieldKind kind : kFieldKinds) {
    std::map<std::string_view, int> rows;
    for (const Setting& row : settings()) rows[row.name] += row.saved && row.kinds.has(kind) ? 1 : 0;
    for (const auto& [name, count] : rows)
      EXPECT_LE(count, 1) << name << " of " << name_of(kind) << " fields";
  }
}

TEST(Settings, SayWhatTheyAre) {
  for (const Setting& row : settings()) {
    EXPECT_FALSE(row.name.empty());
    EXPECT_FALSE(row.help.empty()) << row.name;
    EXPECT_FALSE(row.heading.empty()) << row.name;
    EXPECT_FALSE(row.groups.empty()) << row.name;
    EXPECT_FALSE(row.kinds.empty()) << row.name;
    if (row.spelling == Spelling::kOption) {
      EXPECT_FALSE(row.value_name().empty()) << row.name;
    }
    if (!row.words.empty() && !default_text(row).empty()) {
      EXPECT_TRUE(std::ranges::count(row.word_list(), default_text(row)) == 1) << row.name;
    }
  }
  EXPECT_EQ(setting("line-width").label(), "Line width");
  EXPECT_EQ(setting("stiffness").unit, "N/m");
  EXPECT_NE(setting("stiffness").full_help().find("default 200"), std::string::npos);
}

TEST(Settings, RefuseWhatTheyDoNotTake) {
  Document document;
  const auto refusal = [&](const char* name, const char* text) -> std::string {
    try {
      set_value(setting(name), document, text);
    } catch (const Error& error) {
      return error.what();
    }
    return {};
  };
  EXPECT_NE(refusal("line-opacity", "2").find("from 0.01 to 1"), std::string::npos);
  EXPECT_NE(refusal("tolerance", "0").find("above 0"), std::string::npos);
  EXPECT_NE(refusal("tolerance", "inf").find("--tolerance"), std::string::npos);
  EXPECT_NE(refusal("threads", "1.5").find("whole number"), std::string::npos);
  EXPECT_NE(refusal("shading", "maybe").find("on or off"), std::string::npos);
  EXPECT_NE(refusal("direction", "up").find("forward, backward, both"), std::string::npos);
  EXPECT_TRUE(document == Document()) << "what was refused has left no trace";
}

TEST(Settings, OfDevicesAreOfNoOtherProgram) {
  for (const Setting& row : settings()) {
    if (!row.kinds.has(FieldKind::kNone)) continue;
    const bool shared = row.groups.meets({Group::kCommon, Group::kOut, Group::kReport});
    EXPECT_EQ(row.kinds, shared ? kAllPrograms : Kinds{FieldKind::kNone}) << row.name;
  }
}

TEST(Settings, FindTheOneThatWasMeant) {
  EXPECT_EQ(nearest_setting("line-with", FieldKind::kVector), "line-width");
  EXPECT_EQ(nearest_setting("colour", FieldKind::kVector), "color");
  EXPECT_EQ(find_setting("axis-rules", FieldKind::kFibre), nullptr) << "hearts have no linear mode";
}

}  // namespace
}  // namespace palpate::test
