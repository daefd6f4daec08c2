#include "common/hand/mode/linear_mode.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <string_view>

#include "common/base/error.h"
#include "common/base/text.h"
#include "common/hand/mode/texture_link.h"
#include "common/haptics/constraint/linear.h"
#include "common/haptics/scalar_frame.h"
#include "common/math/units.h"

namespace palpate {
namespace {

constexpr char kBetweenAxes = '/';

/// Values that fall lead out of what is dense: that is the side on which a unilateral axis is free.
constexpr Outward kFreeSide = Outward::kFalling;

const std::shared_ptr<const VectorField>& flow_of(const HapticScene& scene) {
  if (scene.field) return scene.field;
  throw Error(ExitCode::kBadInput,
              "mode linear: the reference or measure asks for a flow, and there is none");
}

/// The speed where no scalar was chosen.
std::shared_ptr<const ScalarField> scalar_of(const HapticScene& scene) {
  return scene.scalar ? scene.scalar : make_speed_field(flow_of(scene));
}

std::unique_ptr<ReferenceFrame> make_frame(const HapticScene& scene) {
  const auto by_scalar = [&](Tangents tangents) {
    return std::make_unique<ScalarFrame>(scalar_of(scene), scene.workspace, kFreeSide, tangents);
  };
  switch (scene.settings.linear.reference) {
    case LinearReference::kFlow:
      return std::make_unique<FlowFrame>(flow_of(scene), scene.workspace);
    case LinearReference::kGradient:
      return by_scalar(Tangents::kOpen);
    case LinearReference::kCurvature:
      return by_scalar(Tangents::kPrincipal);
    case LinearReference::kAxes: {
      const auto turned = [&](const Vec3& axis) { return scene.workspace.turned(axis); };
      return std::make_unique<FixedFrame>(
          Mat3{turned({1.0, 0.0, 0.0}), turned({0.0, 1.0, 0.0}), turned({0.0, 0.0, 1.0})});
    }
    case LinearReference::kAuto:
      break;
  }
  if (scene.field) return std::make_unique<FlowFrame>(scene.field, scene.workspace);
  return by_scalar(Tangents::kOpen);
}

std::shared_ptr<SampledMeasure> make_measure(const HapticScene& scene) {
  const LinearMeasure wanted = scene.settings.linear.measure;
  if (wanted == LinearMeasure::kGradient) {
    return std::make_shared<GradientMeasure>(scalar_of(scene), scene.workspace);
  }
  if (wanted == LinearMeasure::kSpeed || !scene.scalar) {
    return std::make_shared<SpeedMeasure>(flow_of(scene), scene.workspace);
  }
  return std::make_shared<ValueMeasure>(scene.scalar, scene.workspace);
}

/// The value of an enumeration that is called `word`.
template <typename Enum>
Enum named(const std::string& word, int count, const std::string& option) {
  std::string known;
  for (int i = 0; i < count; ++i) {
    const auto value = static_cast<Enum>(i);
    if (word == name_of(value)) return value;
    (known += known.empty() ? "" : ", ") += name_of(value);
  }
  throw usage_error(option + ": unknown '" + word + "'; known are " + known);
}

/// One transfer function for each axis. @param unit in which their values are given [SI].
std::array<HapticTransferFunction, 3> curves(const std::string& text, const std::string& option,
                                             double unit) {
  const std::vector<std::string_view> parts = split(text, kBetweenAxes);
  if (parts.size() != 1 && parts.size() != 3) {
    throw usage_error(option + ": one constant or curve for all axes is expected, or three with '/' between");
  }
  std::array<HapticTransferFunction, 3> functions;
  for (std::size_t a = 0; a < 3; ++a) {
    const auto problem = HapticTransferFunction::read(parts[a % parts.size()], functions[a], unit);
    if (problem) throw usage_error(option + ": " + *problem);
  }
  return functions;
}

template <typename Text>
std::string text_of_axes(const LinearSettings& settings, char between, const Text& text) {
  std::string all;
  for (const LinearAxis& axis : settings.axes)
    (all += all.empty() ? "" : std::string(1, between)) += text(axis);
  return all;
}

/// One text where all axes have the same.
template <typename Text>
std::string text_of_curves(const LinearSettings& settings, const Text& text) {
  const auto& axes = settings.axes;
  std::string first = text(axes[0]);
  if (first == text(axes[1]) && first == text(axes[2])) return first;
  return text_of_axes(settings, kBetweenAxes, text);
}

}  // namespace

HapticChain make_linear(const HapticScene& scene) {
  // Constants take no measure, but an edit may make a curve of them while the hand holds on.
  const auto measure = make_measure(scene);
  const AxisMeasures measures{.kappa = measure, .tau = measure};
  return textured_chain(
      std::make_unique<LinearConstraint>(make_frame(scene), std::array{measures, measures, measures}), scene);
}

LinearSettings linear_settings(const LinearSpec& spec) {
  LinearSettings settings;
  settings.reference = named<LinearReference>(spec.reference, kLinearReferenceCount, "--reference");
  settings.measure = named<LinearMeasure>(spec.measure, kLinearMeasureCount, "--measure");
  const std::vector<std::string_view> rules = split(spec.axes, ',');
  if (rules.size() != settings.axes.size()) {
    throw usage_error(
        "--axis-rules: three rules with commas between are expected, such as free,drag,drag; found '" +
        spec.axes + "'");
  }
  const auto tau = curves(spec.tau, "--tau", kMetresPerMillimetre);
  const auto kappa = curves(spec.kappa, "--kappa", 1.0);
  for (std::size_t a = 0; a < settings.axes.size(); ++a) {
    LinearAxis& axis = settings.axes[a];
    axis.rule = named<AxisRule>(std::string(trimmed(rules[a])), kAxisRuleCount, "--axis-rules");
    axis.tau = tau[a];
    axis.kappa = kappa[a];
    if (!(axis.tau.lowest() >= 0.0)) throw usage_error("--tau: distances of zero or more in mm are expected");
    if (!(axis.kappa.lowest() >= 0.0 && axis.kappa.highest() <= 1.0)) {
      throw usage_error("--kappa: parts of the stiffness from 0 to 1 are expected");
    }
  }
  if (leaves_axes_open(settings.reference) && !(settings.axes[1] == settings.axes[2])) {
    throw usage_error("--reference " + spec.reference +
                      " leaves the second and third axis open: give both the same rule, tau and kappa, or "
                      "take curvature or axes");
  }
  settings.friction = spec.friction;
  if (!std::isfinite(settings.friction) || settings.friction < 0.0) {
    throw usage_error("--friction: a number of zero or more is expected");
  }
  return settings;
}

LinearSpec linear_text(const LinearSettings& settings) {
  return {.reference = std::string(name_of(settings.reference)),
          .axes = text_of_axes(settings, ',', [](const LinearAxis& axis) { return name_of(axis.rule); }),
          .tau = text_of_curves(settings,
                                [](const LinearAxis& axis) { return axis.tau.text(kMetresPerMillimetre); }),
          .kappa = text_of_curves(settings, [](const LinearAxis& axis) { return axis.kappa.text(); }),
          .measure = std::string(name_of(settings.measure)),
          .friction = settings.friction};
}

std::vector<std::pair<std::string, std::string>> linear_options(const LinearSettings& settings) {
  const LinearSpec spec = linear_text(settings);
  return {
      {"reference", spec.reference}, {"axis-rules", spec.axes}, {"tau", spec.tau},
      {"kappa", spec.kappa},         {"measure", spec.measure}, {"friction", exact_number(spec.friction)}};
}

}  // namespace palpate
