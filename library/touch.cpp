#include "library/palpate/touch.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "common/base/index.h"
#include "common/base/text.h"
#include "common/device/device_limits.h"
#include "common/haptics/constraint/anisotropy_drag.h"
#include "common/haptics/constraint/half_space.h"
#include "common/haptics/constraint/isosurface.h"
#include "common/haptics/constraint/streamline.h"
#include "common/haptics/force_field/force_field.h"
#include "common/haptics/settings_text.h"
#include "common/servo/hand_step.h"
#include "library/access.h"

namespace palpate::api {
namespace {

/// f = -dU/dx of the hand: with U in joules and x = s x_data, that is -grad U / s.
class PotentialForce final : public ForceField {
 public:
  PotentialForce(std::shared_ptr<const ScalarField> joules, const Workspace& workspace)
      : ForceField(workspace), joules_(std::move(joules)), scale_(workspace.scale()) {}

 private:
  [[nodiscard]] SampleStatus feel(const Vec3& x_data, CellHint& hint,
                                  LinkUpdate& link) const noexcept override {
    const VectorSample slope = joules_->gradient(x_data, hint);
    if (slope.status == SampleStatus::kOk) link.extra_force = -slope.value / scale_;
    return slope.status;
  }

  std::shared_ptr<const ScalarField> joules_;
  double scale_;
};

/// Name and value of each setting, as texts have them.
std::vector<std::pair<std::string, std::string>> pairs_of(const ChainSettings& settings) {
  std::vector<std::pair<std::string, std::string>> pairs;
  const std::string text = settings_text(settings);
  for (const std::string_view word : words(text)) {
    const std::size_t sign = word.find('=');
    pairs.emplace_back(word.substr(0, sign), word.substr(sign + 1));
  }
  return pairs;
}

ChainSettings settings_of(const ChainOptions& options) {
  auto pairs = pairs_of({});
  for (const auto& [name, value] : options.settings) {
    const auto found = std::ranges::find(pairs, name, &std::pair<std::string, std::string>::first);
    if (found == pairs.end()) {
      std::string known;
      for (const auto& pair : pairs) known += (known.empty() ? "" : ", ") + pair.first;
      throw Error(Error::Kind::kUsage, "there is no setting \"" + name + "\"; those of chains are " + known);
    }
    if (value.find_first_of(" \t\n") != std::string::npos)
      throw Error(Error::Kind::kUsage, name + ": \"" + value + "\" is no value");
    found->second = value;
  }
  std::string text;
  for (const auto& [name, value] : pairs) text += (text.empty() ? "" : " ") + name + "=" + value;
  ChainSettings settings;
  if (const auto wrong = read_settings(text, settings))
    throw Error(Error::Kind::kUsage, "settings: " + *wrong);
  return settings;
}

}  // namespace

struct LinkData {
  /// For a hand that has so many metres by length of the data.
  std::function<std::unique_ptr<Constraint>(double scale)> make;
  double diagonal = 0.0;  ///< of the data; 0: it has none
};

Link TouchAccess::link(LinkData made) {
  Link handle;
  handle.data_ = std::make_shared<LinkData>(std::move(made));
  return handle;
}

Touch TouchAccess::touch(TouchData made) {
  Touch handle;
  handle.data_ = std::make_shared<TouchData>(std::move(made));
  return handle;
}

std::unique_ptr<ProxyChain> TouchAccess::make(const Chain& chain) {
  const ChainData& data = of(chain);
  std::vector<std::unique_ptr<Constraint>> links;
  for (const auto& link : data.links) links.push_back(link->make(data.scale));
  return std::make_unique<ProxyChain>(std::move(links), data.settings);
}

void TouchData::add(const HandStep& step, double scale, const Point* probe) {
  const Point where = probe != nullptr ? *probe : point_of(step.probe / scale);
  for (std::size_t l = 0; l < links; ++l) {
    const Vec3 proxy = static_cast<int>(l) < step.chain.links ? step.chain.proxies[l] : step.probe;
    // Where nothing holds it the proxy is the probe, to the last bit.
    const bool free = proxy == step.probe && is_finite(vec_of(where));
    proxies.push_back(free ? where : point_of(proxy / scale));
  }
  times.push_back(step.time);
  probes.push_back(where);
  force.push_back(point_of(step.force));
  residual.push_back(step.chain.residual / scale);
  state.push_back(static_cast<std::uint8_t>(step.state));
}

Link Link::streamline(const Field& field) {
  const auto of = Access::of(field);
  return TouchAccess::link({[of](double scale) -> std::unique_ptr<Constraint> {
                              const Workspace workspace(scale, of->frame());
                              return std::make_unique<StreamlineConstraint>(
                                  std::make_shared<LiveLine>(of, LiveLine::kFollowTolerance, 0), workspace);
                            },
                            of->diagonal()});
}

Link Link::isosurface(const Scalar& field, const std::vector<double>& values) {
  Isovalues isovalues;
  if (values.empty() || values.size() > isovalues.value.size())
    throw Error(Error::Kind::kUsage, "isosurface: one to " + std::to_string(isovalues.value.size()) +
                                         " values are expected, not " + std::to_string(values.size()));
  for (const double value : values) {
    if (!std::isfinite(value)) throw Error(Error::Kind::kUsage, "isosurface: a value is not finite");
  }
  std::ranges::copy(values, isovalues.value.begin());
  isovalues.count = static_cast<int>(values.size());
  const auto of = Access::of(field);
  return TouchAccess::link({[of, isovalues](double scale) -> std::unique_ptr<Constraint> {
                              return std::make_unique<IsosurfaceConstraint>(of, Workspace(scale, of->frame()),
                                                                            isovalues);
                            },
                            of->diagonal()});
}

Link Link::plane(const Point& point, const Point& outward) {
  const Vec3 at = vec_of(point), normal = vec_of(outward);
  if (!is_finite(at) || !is_finite(normal) || !(glm::length(normal) > 0.0))
    throw Error(Error::Kind::kUsage, "plane: a point and a direction that is not zero are expected");
  return TouchAccess::link({[at, normal](double scale) -> std::unique_ptr<Constraint> {
                              return std::make_unique<HalfSpaceConstraint>(scale * at, normal);
                            },
                            0.0});
}

Link Link::flow(const Field& field) {
  const auto of = Access::of(field);
  return TouchAccess::link({[of](double scale) -> std::unique_ptr<Constraint> {
                              return std::make_unique<DirectDisplay>(of, Workspace(scale, of->frame()));
                            },
                            of->diagonal()});
}

Link Link::potential(const Scalar& joules) {
  const auto of = Access::of(joules);
  return TouchAccess::link({[of](double scale) -> std::unique_ptr<Constraint> {
                              return std::make_unique<PotentialForce>(of, Workspace(scale, of->frame()));
                            },
                            of->diagonal()});
}

Link Link::drag() {
  return TouchAccess::link(
      {[](double) -> std::unique_ptr<Constraint> { return std::make_unique<IsotropicDrag>(); }, 0.0});
}

std::vector<std::pair<std::string, std::string>> chain_settings(const ChainOptions& options) {
  return pairs_of(settings_of(options));
}

const std::vector<std::string>& state_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (int i = 0; i < kHoldStateCount; ++i) all.emplace_back(name_of(static_cast<HoldState>(i)));
    return all;
  }();
  return names;
}

Chain::Chain(const std::vector<Link>& links, const ChainOptions& options) {
  if (links.empty() || links.size() > as_size(ChainStep::kMaxLinks))
    throw Error(Error::Kind::kUsage, "a chain has one to " + std::to_string(ChainStep::kMaxLinks) +
                                         " links, not " + std::to_string(links.size()));
  ChainData made;
  made.settings = settings_of(options);
  made.limits.force_cap = options.force_cap;
  made.limits.slew_cap = options.slew_cap;
  if (!made.limits.valid())
    throw Error(Error::Kind::kUsage, "force_cap and slew_cap: finite numbers above zero are expected");
  double diagonal = 0.0;
  for (const Link& link : links) {
    made.links.push_back(TouchAccess::of(link));
    diagonal = std::max(diagonal, made.links.back()->diagonal);
  }
  made.scale = options.scale;
  if (options.scale == 0.0) made.scale = diagonal > 0.0 ? Workspace::default_scale(diagonal) : 1.0;
  if (!(std::isfinite(made.scale) && made.scale > 0.0))
    throw Error(Error::Kind::kUsage, "scale: metres by length of the data, above zero, are expected");
  data_ = std::make_shared<ChainData>(std::move(made));
}

double Chain::scale() const noexcept { return data_->scale; }

Touch Chain::run(std::span<const Point> path, std::span<const double> times, const Watcher& watch) const {
  if (!times.empty() && times.size() != path.size())
    throw Error(Error::Kind::kUsage, "as many times as points are expected");
  return watched(watch, [&](Progress& progress) {
    constexpr double kStep = 0.001;  // [s]
    constexpr std::size_t kStepsBetweenChecks = 4096;
    const double scale = data_->scale;
    HandStepper stepper(TouchAccess::make(*this), data_->limits);
    TouchData data{.links = data_->links.size()};
    data.proxies.reserve(path.size() * data.links);
    progress.begin("probing", path.size());
    for (std::size_t i = 0; i < path.size(); ++i) {
      if (i % kStepsBetweenChecks == 0) progress.check();
      const double time = times.empty() ? kStep * static_cast<double>(i) : times[i];
      HandInput hand{.time = time, .present = true};
      hand.sample = {time, scale * vec_of(path[i]), 0};
      data.add(stepper.step(hand), scale, &path[i]);
      progress.advance();
    }
    return TouchAccess::touch(std::move(data));
  });
}

std::size_t Touch::count() const noexcept { return data_->state.size(); }
std::size_t Touch::links() const noexcept { return data_->links; }
std::span<const double> Touch::times() const noexcept { return data_->times; }
std::span<const Point> Touch::probes() const noexcept { return data_->probes; }
std::span<const Point> Touch::proxies() const noexcept { return data_->proxies; }
std::span<const Point> Touch::force() const noexcept { return data_->force; }
std::span<const double> Touch::residual() const noexcept { return data_->residual; }
std::span<const std::uint8_t> Touch::state() const noexcept { return data_->state; }

}  // namespace palpate::api
