#include "common/window/panels/unsaved_question.h"

#include <array>

#include <imgui.h>

#include "common/window/panels/panel_parts.h"

namespace palpate {
namespace {

constexpr const char* kId = "###unsaved";

struct Choice {
  const char* words;
  int key;
  UnsavedQuestion::Answer answer;
};
constexpr std::array<Choice, 3> kChoices{
    {{"Save  (S)", 'S', UnsavedQuestion::Answer::kSave},
     {"Discard  (D)", 'D', UnsavedQuestion::Answer::kDiscard},
     {"Cancel  (Esc)", key_code::kEscape, UnsavedQuestion::Answer::kCancel}}};

}  // namespace

void UnsavedQuestion::ask(std::string words, Leaving leaving) {
  words_ = std::move(words);
  leaving_ = std::move(leaving);
  key_ = Answer::kNone;
}

bool UnsavedQuestion::handle(const InputEvent& event) {
  if (!asking()) return false;
  if (event.kind == InputKind::kKeyDown) {
    for (const Choice& choice : kChoices) {
      if (event.key == choice.key) key_ = choice.answer;
    }
    return true;
  }
  return event.kind == InputKind::kPress || event.kind == InputKind::kWheel || event.kind == InputKind::kDrop;
}

UnsavedQuestion::Answer UnsavedQuestion::draw() {
  if (!asking()) return Answer::kNone;
  if (!ImGui::IsPopupOpen(kId)) ImGui::OpenPopup(kId);
  center_next_window();
  constexpr ImGuiWindowFlags kFlags = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                                      ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_AlwaysAutoResize;
  Answer answer = key_;
  if (ImGui::BeginPopupModal(kId, nullptr, kFlags)) {
    constexpr float kTextWidth = 26.0F, kButtonWidth = 8.0F;  // heights of the text
    ImGui::PushTextWrapPos(kTextWidth * ImGui::GetFontSize());
    ImGui::TextUnformatted(words_.c_str());
    ImGui::PopTextWrapPos();
    ImGui::Spacing();
    for (const Choice& choice : kChoices) {
      if (button(choice.words, {kButtonWidth * ImGui::GetFontSize(), 0.0F})) answer = choice.answer;
      ImGui::SameLine();
    }
    if (answer != Answer::kNone) ImGui::CloseCurrentPopup();
    ImGui::EndPopup();
  }
  if (answer != Answer::kNone) words_.clear();
  return answer;
}

}  // namespace palpate
