#include "common/window/panels/message_log.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <ctime>

#include <imgui.h>

#include "common/window/panels/panel_parts.h"

namespace palpate {
namespace {

std::string time_of_day() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  localtime_r(&now, &parts);
  std::array<char, 16> text{};
  std::strftime(text.data(), text.size(), "%H:%M:%S", &parts);
  return text.data();
}

std::string line_of(const MessageLog::Message& message) {
  return message.time + "  " + (message.error ? "error: " : "") + message.words;
}

}  // namespace

void MessageLog::add(const std::string& words, bool error) {
  if (words.empty() || (!messages_.empty() && messages_.back().words == words)) return;
  messages_.push_back({time_of_day(), words, error});
}

std::string MessageLog::text() const {
  std::string all;
  for (const Message& message : messages_) all += line_of(message) + "\n";
  return all;
}

void MessageLog::draw() {
  if (!shown) return;
  constexpr float kWidth = 50.0F, kHeight = 24.0F;  // heights of the text
  const float em = ImGui::GetFontSize();
  const ImVec2 window = ImGui::GetIO().DisplaySize;
  center_next_window();
  ImGui::SetNextWindowSize(
      {std::min(kWidth * em, window.x - 2.0F * em), std::min(kHeight * em, window.y - 2.0F * em)});
  ImGui::Begin("Messages  (F2)", &shown,
               ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoSavedSettings);
  ImGui::BeginDisabled(messages_.empty());
  if (button("Copy all")) ImGui::SetClipboardText(text().c_str());
  ImGui::EndDisabled();
  hint("a line each, with the time");
  ImGui::SameLine();
  ImGui::TextDisabled(messages_.empty() ? "nothing was said yet" : "a click copies one");
  ImGui::Separator();
  ImGui::BeginChild("messages");
  for (std::size_t i = messages_.size(); i-- > 0;) {  // the newest first
    const Message& message = messages_[i];
    ImGui::PushID(static_cast<int>(i));
    ImGui::TextDisabled("%s", message.time.c_str());
    ImGui::SameLine();
    ImGui::BeginGroup();
    ImGui::PushTextWrapPos(0.0F);
    if (message.error) ImGui::PushStyleColor(ImGuiCol_Text, {0.93F, 0.36F, 0.30F, 1.0F});
    ImGui::TextUnformatted(message.words.c_str());
    if (message.error) ImGui::PopStyleColor();
    ImGui::PopTextWrapPos();
    ImGui::EndGroup();
    note_control(message.words.c_str());
    if (ImGui::IsItemClicked()) ImGui::SetClipboardText(line_of(message).c_str());
    hint("a click copies it");
    ImGui::PopID();
  }
  ImGui::EndChild();
  ImGui::End();
}

}  // namespace palpate
