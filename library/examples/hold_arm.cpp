// A simulated arm, led into a wall for half a second, and what it feels there: a thread steps the chain 1000 times a second.

#include <chrono>
#include <cstdio>
#include <thread>

#include <palpate/servo.h>

int main() {
  namespace palpate = palpate::api;
  const palpate::Chain wall({palpate::Link::plane({0, 0, 0}, {-1, 0, 0})});  // metres; free where x < 0
  palpate::Servo servo(palpate::Device::simulated({.hand = "firm"}), wall);
  servo.lead({-0.01, 0, 0});
  for (int i = 0; i < 50; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    servo.lead({-0.01 + 0.001 * i, 0, 0});
  }
  const palpate::ServoNow now = servo.now();
  std::printf("%llu steps, %llu late: hand %.4f m, proxy %.4f m, force %.2f N, %s\n",
              static_cast<unsigned long long>(now.steps), static_cast<unsigned long long>(now.late),
              now.probe[0], now.proxy[0], now.force[0], palpate::state_names()[now.state].c_str());
}
