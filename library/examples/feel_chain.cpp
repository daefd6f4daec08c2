// A hand moves through a built-in flow, held by a streamline until a plane stops it: prints what it feels.

#include <cstdio>
#include <vector>

#include <palpate/touch.h>

int main() {
  namespace palpate = palpate::api;
  const palpate::Field field = palpate::Field::example("abc");
  const palpate::Chain chain({palpate::Link::streamline(field), palpate::Link::plane({2, 0, 0}, {-1, 0, 0})},
                             {.settings = {{"stiffness", "400"}}});
  std::vector<palpate::Point> path;
  for (int i = 0; i <= 1000; ++i) path.push_back({1.0 + 0.0015 * i, 1.0, 1.0});
  const palpate::Touch touch = chain.run(path);
  for (std::size_t i = 0; i < touch.count(); i += 100) {
    const palpate::Point &at = touch.proxies()[i * touch.links() + 1], &force = touch.force()[i];
    std::printf("%zu ms: at %.3f %.3f %.3f, force %.2f %.2f %.2f N, %s\n", i, at[0], at[1], at[2], force[0],
                force[1], force[2], palpate::state_names()[touch.state()[i]].c_str());
  }
}
