#include "common/base/last_acts.h"

#include <mutex>
#include <utility>
#include <vector>

namespace palpate {
namespace {

std::mutex last_acts_mutex;

std::vector<LastAct*>& last_acts() {
  static std::vector<LastAct*> acts;
  return acts;
}

}  // namespace

LastAct::LastAct(std::function<void()> act) : act_(std::move(act)) {
  const std::lock_guard lock(last_acts_mutex);
  last_acts().push_back(this);
}

LastAct::~LastAct() {
  const std::lock_guard lock(last_acts_mutex);
  std::erase(last_acts(), this);
}

void run_last_acts() {
  const std::lock_guard lock(last_acts_mutex);
  for (auto act = last_acts().rbegin(); act != last_acts().rend(); ++act) (*act)->act_();
}

}  // namespace palpate
