#include "lab/workbench/fit_text.h"

#include <cmath>

#include "common/base/figures.h"
#include "common/base/json.h"
#include "common/base/text.h"
#include "lab/page/json_number.h"

namespace palpate {
namespace {

std::string padded(std::string text, std::size_t width) {
  if (text.size() < width) text.append(width - text.size(), ' ');
  return text;
}

// A polynomial's coefficients mean nothing to a reader; arms have at most some forty numbers.
constexpr std::size_t kMostParametersShown = 60;

}  // namespace

std::string fit_text(const FitReport& report) {
  std::string out = report.kind + ": " + counted(report.measurements, "measurement") + " from " +
                    report.source + ", fitted in " + three_digits(report.seconds) + " s\n";
  out += "  " + padded("method", 18) + padded("judged on", 11) + padded("error", 19) + padded("mean", 10) +
         padded("deviation", 11) + "largest\n";
  for (const ErrorRow& row : report.errors) {
    out += "  " + padded(row.method, 18) + padded(row.left_out ? "left out" : "fitted", 11) +
           padded(row.quantity + " [" + row.unit + "]", 19) + padded(three_digits(row.errors.mean), 10) +
           padded(three_digits(row.errors.deviation), 11) + three_digits(row.errors.maximum) + "\n";
  }
  out += "  condition number " + three_digits(report.condition_number) + " (columns scaled to unit length)\n";
  if (report.chi_square)
    out += "  chi-square " + three_digits(*report.chi_square) + " for " +
           std::to_string(report.degrees_of_freedom) + " degrees of freedom, larger by chance in " +
           three_digits(100.0 * report.chi_square_probability) + " %\n";
  if (report.parameters.size() <= kMostParametersShown) {
    for (const FittedParameter& p : report.parameters)
      out += "  " + padded(p.name, 18) + padded(short_number(p.value), 14) +
             (std::isfinite(p.deviation) ? "+- " + three_digits(p.deviation) + " " : "") + p.unit + "\n";
  }
  for (const std::string& weak : report.weak) out += "  hardly distinguished: " + weak + "\n";
  for (const std::string& advice : report.advice) out += "  next: " + advice + "\n";
  constexpr std::size_t kMostRowsNamed = 10;
  if (!report.outliers.empty()) {
    out += "  far from the fit: row";
    for (std::size_t i = 0; i < report.outliers.size() && i < kMostRowsNamed; ++i)
      out += (i ? ", " : " ") + std::to_string(report.outliers[i]);
    if (report.outliers.size() > kMostRowsNamed)
      out += ", … (" + std::to_string(report.outliers.size()) + " in all; --json names them)";
    out += "\n";
  }
  return out;
}

std::string fit_json(const FitReport& report, const std::string& out) {
  Json json{{"kind", report.kind},
            {"source", report.source},
            {"measurements", report.measurements},
            {"seconds", report.seconds},
            {"iterations", report.iterations},
            {"condition_number", number_or_null(report.condition_number)},
            {"condition_scaling", "columns of the Jacobian scaled to unit length"}};
  Json errors = Json::array();
  for (const ErrorRow& row : report.errors) {
    errors.push_back({{"method", row.method},
                      {"quantity", row.quantity},
                      {"unit", row.unit},
                      {"left_out", row.left_out},
                      {"count", row.errors.count},
                      {"mean", number_or_null(row.errors.mean)},
                      {"deviation", number_or_null(row.errors.deviation)},
                      {"rms", number_or_null(row.errors.rms)},
                      {"maximum", number_or_null(row.errors.maximum)}});
  }
  json["errors"] = errors;
  if (report.chi_square) {
    json["chi_square"] = {{"value", *report.chi_square},
                          {"degrees_of_freedom", report.degrees_of_freedom},
                          {"probability", report.chi_square_probability}};
  }
  Json parameters = Json::array();
  for (const FittedParameter& p : report.parameters) {
    parameters.push_back({{"name", p.name},
                          {"value", number_or_null(p.value)},
                          {"deviation", number_or_null(p.deviation)},
                          {"unit", p.unit}});
  }
  json["parameters"] = parameters;
  json["weak"] = report.weak;
  json["advice"] = report.advice;
  json["outliers"] = report.outliers;
  Json work = Json::array();
  for (const WorkPrecision& row : report.work_precision) {
    work.push_back({{"method", row.method},
                    {"parameter", row.parameter},
                    {"error", number_or_null(row.error)},
                    {"error_kind", row.error_kind},
                    {"seconds", row.seconds}});
  }
  json["work_precision"] = work;
  if (!out.empty()) json["out"] = out;
  return json_text(json);
}

}  // namespace palpate
