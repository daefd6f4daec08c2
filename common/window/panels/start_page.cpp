#include "common/window/panels/start_page.h"

#include <algorithm>
#include <cstdint>
#include <utility>

#include <imgui.h>

#include "common/base/index.h"
#include "common/scene/input.h"
#include "common/window/panels/panel_parts.h"

namespace palpate {
std::string name_of(const InputFiles& input) {
  if (!input.example.empty()) return input.example;
  std::string name;
  for (const auto& file : input.files) name += (name.empty() ? "" : " ") + file.filename().string();
  return input.solution ? name + " " + input.solution->filename().string() : name;
}

StartPage::StartPage(std::string program, FieldKind kind) : program_(std::move(program)) {
  for (const ExampleInfo& example : examples_of(kind)) {
    examples_.push_back({.files = {}, .solution = {}, .example = example.name});
    summaries_.push_back(example.summary);
  }
}

bool StartPage::handle(const InputEvent& event) {
  if (event.kind != InputKind::kKeyDown || count_ == 0) return false;
  const auto last = count_ - 1;
  const bool seen = std::exchange(by_keys_, true);
  switch (event.key) {
    case key_code::kRight:
      if (seen) current_ = std::min(last, current_ + 1);
      break;
    case key_code::kLeft:
      if (seen && current_ > 0) --current_;
      break;
    case key_code::kDown:
      if (seen) current_ = std::min(last, current_ + columns_);
      break;
    case key_code::kUp:
      if (seen) current_ -= std::min(current_, columns_);
      break;
    case key_code::kEnter:
    case key_code::kPadEnter:
      chosen_ = seen;
      break;
    default:
      by_keys_ = seen;
      return false;
  }
  scrolls_ = true;
  return true;
}

bool StartPage::draw_card(const Card& card, std::size_t place, float width, const SmallPicture& seen) {
  const float em = ImGui::GetFontSize();
  const float picture = width * static_cast<float>(kPictureHeight) / static_cast<float>(kPictureWidth);
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  const ImVec2 size{width, picture + 2.9F * em};
  ImGui::PushID(static_cast<int>(place));
  const bool pressed = ImGui::InvisibleButton("card", size);
  note_control(card.name.c_str());
  const bool hovered = ImGui::IsItemHovered();
  ImGui::PopID();
  const bool current = by_keys_ && place == current_;
  ImDrawList& drawing = *ImGui::GetWindowDrawList();
  const ImVec2 across{corner.x + size.x, corner.y + size.y};
  const float round = 0.4F * em;
  drawing.AddRectFilled(corner, across, ImGui::GetColorU32(hovered ? ImGuiCol_Button : ImGuiCol_FrameBg),
                        round);
  const ImVec2 below{across.x, corner.y + picture};
  if (seen.texture != 0) {
    // NOLINTNEXTLINE(performance-no-int-to-ptr): Dear ImGui's renderer for OpenGL takes names so
    drawing.AddImageRounded(reinterpret_cast<ImTextureID>(static_cast<std::intptr_t>(seen.texture)), corner,
                            below, {0.0F, 0.0F}, {1.0F, 1.0F}, IM_COL32_WHITE, round,
                            ImDrawFlags_RoundCornersTop);
  } else {
    const std::string words(seen.instead);
    const ImVec2 text = ImGui::CalcTextSize(words.c_str());
    drawing.AddText({corner.x + 0.5F * (width - text.x), corner.y + 0.5F * (picture - text.y)},
                    ImGui::GetColorU32(ImGuiCol_TextDisabled), words.c_str());
  }
  const float room = width - em;
  drawing.AddText({corner.x + 0.5F * em, corner.y + picture + 0.25F * em}, ImGui::GetColorU32(ImGuiCol_Text),
                  shortened(card.name, room).c_str());
  drawing.AddText({corner.x + 0.5F * em, corner.y + picture + 1.5F * em},
                  ImGui::GetColorU32(ImGuiCol_TextDisabled), shortened(card.what, room).c_str());
  if (current || hovered) {
    drawing.AddRect(corner, across, ImGui::GetColorU32(ImGuiCol_CheckMark), round, 0,
                    current ? 0.15F * em : 0.08F * em);
  }
  hint("%s\n%s", card.name.c_str(), card.what.c_str());
  if (current && std::exchange(scrolls_, false)) ImGui::SetScrollHereY();
  return pressed || (current && std::exchange(chosen_, false));
}

void StartPage::draw_cards(const std::vector<Card>& cards, std::size_t first, const PictureOf& picture,
                           Actions& actions) {
  constexpr float kWidth = 14.0F;  // heights of the text
  const float em = ImGui::GetFontSize(), gap = 0.8F * em;
  const float room = ImGui::GetContentRegionAvail().x;
  columns_ = floor_size(std::max(1.0F, (room + gap) / (kWidth * em + gap)));
  // Cards share what is left of a row.
  const auto many = static_cast<float>(columns_);
  const float width = std::min((room - (many - 1.0F) * gap) / many, 1.35F * kWidth * em);
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {gap, gap});
  for (std::size_t i = 0; i < cards.size(); ++i) {
    if (i % columns_ > 0) ImGui::SameLine();
    if (draw_card(cards[i], first + i, width, picture(cards[i].input))) actions.open = cards[i].input;
  }
  ImGui::PopStyleVar();
}

StartPage::Actions StartPage::draw(const std::vector<InputFiles>& recent, const PictureOf& picture,
                                   bool beside, const std::string& message) {
  Actions actions;
  std::vector<Card> lately, made;
  for (const InputFiles& input : recent)
    lately.push_back({input, name_of(input), input.files.front().parent_path().string()});
  for (std::size_t i = 0; i < examples_.size(); ++i)
    made.push_back({examples_[i], examples_[i].example, summaries_[i]});
  count_ = lately.size() + made.size();
  current_ = std::min(current_, count_ - std::min<std::size_t>(count_, 1));

  const float em = ImGui::GetFontSize();
  ImGui::SetNextWindowPos({0.0F, 0.0F});
  ImGui::SetNextWindowSize(ImGui::GetIO().DisplaySize);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {2.0F * em, 1.5F * em});
  ImGui::Begin("start", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoBringToFrontOnFocus);
  ImGui::SetWindowFontScale(1.6F);
  ImGui::TextUnformatted(program_.c_str());
  ImGui::SetWindowFontScale(1.0F);
  actions.ask_to_open = button("Open…", {9.0F * em, 2.0F * em});
  hint("data, or a session (Ctrl+O)");
  ImGui::SameLine();
  ImGui::BeginGroup();
  ImGui::TextUnformatted("or drop files here");
  ImGui::TextDisabled("%s", beside ? "Esc goes back to what is open, H lists the keys"
                                   : "arrows and Enter choose, H lists the keys, Ctrl+Q quits");
  ImGui::EndGroup();
  if (!message.empty()) ImGui::TextWrapped("%s", message.c_str());
  ImGui::Spacing();
  ImGui::BeginChild("cards");
  if (!lately.empty()) {
    heading("RECENT");
    ImGui::Spacing();
    draw_cards(lately, 0, picture, actions);
    ImGui::Spacing();
  }
  heading("EXAMPLES");
  ImGui::Spacing();
  draw_cards(made, lately.size(), picture, actions);
  ImGui::EndChild();
  ImGui::End();
  ImGui::PopStyleVar();
  chosen_ = false;
  return actions;
}

}  // namespace palpate
