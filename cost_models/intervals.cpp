#include "cost_models/intervals.h"

#include <algorithm>
#include <cmath>

#include "cost_models/covariance.h"
#include "cost_models/published.h"
#include "cost_models/ratios.h"
#include "hwsim/config/assign.h"
#include "hwsim/gpu/gpu_keys.h"
#include "hwsim/gpu/gpu_show.h"

namespace hwsim::cost_models {
namespace {

using NamedParts = std::vector<std::pair<std::string, double>>;

bool changed(const Calibration& calibration, const GpuConfig& gpu, const std::string& hash) {
  const std::set<std::string> keys = hashed_keys();
  const auto new_and_set = [&](const std::string& key) {
    const auto origin = gpu.origins.find(key);
    return !calibration.gpu_keys.contains(key) && origin != gpu.origins.end() &&
           (origin->second.layer == Origin::Layer::overlay ||
            origin->second.layer == Origin::Layer::command_line);
  };
  return content_hash(gpu, calibration.gpu_keys) != hash ||
         std::any_of(keys.begin(), keys.end(), new_and_set);
}

double widest(const std::map<std::string, double>& quantiles, std::initializer_list<Split> splits) {
  double widest = 0.0;
  for (const Split split : splits)
    if (const auto found = quantiles.find(std::string(split_name(split))); found != quantiles.end())
      widest = std::max(widest, found->second);
  return widest;
}

/// Whether a frame's time on the GPU depends on the parameter.
bool of_interval(const Calibration& calibration, const CalibratedParameter& p, const std::string& gpu) {
  return p.name != kPresent && concerns(calibration, p, gpu);
}

Support support_of(const Calibration& calibration, const GpuConfig& gpu, const std::string& fitted_id,
                   const std::string& technique) {
  const std::string& hash = calibration.gpu_hashes.at(fitted_id);
  const auto same_kind = [&](const std::string& other) {
    return technique_id(other) == technique_id(technique);
  };
  const bool somewhere = std::ranges::any_of(calibration.techniques, [&](const auto& entry) {
    return std::ranges::any_of(entry.second, same_kind);
  });
  if (changed(calibration, gpu, hash) || !somewhere) return Support::extrapolated;
  const auto here = calibration.techniques.find(fitted_id);
  const bool fitted = here != calibration.techniques.end() && here->second.contains(technique);
  return fitted && credible(calibration, fitted_id) ? Support::calibrated : Support::interpolated;
}

/// No frame of a user is a published one: the narrowest interval is that of a scene that the fit did not see.
double interval_quantile(const std::map<std::string, double>& quantiles, Support support) {
  const double narrowest = widest(quantiles, {Split::in_sample, Split::leave_scene_out});
  if (support == Support::interpolated) return std::max(narrowest, widest(quantiles, {Split::leave_gpu_out}));
  if (support != Support::extrapolated) return narrowest;
  return std::max(narrowest, widest(quantiles, {Split::leave_technique_out, Split::rate_extrapolation,
                                                Split::leave_gpu_out}));
}

std::string id_of(const CalibratedParameter& parameter) { return parameter.member + "." + parameter.name; }

double part(const NamedParts& parts, const std::string& name) {
  const auto found = std::ranges::find(parts, name, &NamedParts::value_type::first);
  return found == parts.end() ? 0.0 : found->second;
}

std::vector<double> gradient_of(const Calibration& calibration, const NamedParts& by_parameter) {
  std::vector<double> gradient;
  for (const CalibratedParameter& p : calibration.parameters)
    gradient.push_back(part(by_parameter, id_of(p)));
  return gradient;
}

/// Sum of the squares of what each unit's part changed by: 0 when the same units hold the frame up for the
/// same parts of its time, 2 when the whole time moved from one unit to another.
double moved_squares(const NamedParts& before, const NamedParts& after) {
  double sum = 0.0;
  for (const auto& [unit, was] : before) sum += std::pow(part(after, unit) - was, 2);
  for (const auto& [unit, is] : after)
    if (std::ranges::find(before, unit, &NamedParts::value_type::first) == before.end()) sum += is * is;
  return sum;
}

}  // namespace

std::string calibrated_id(const Calibration& calibration, const GpuConfig& gpu) {
  if (calibration.gpu_hashes.contains(gpu.id)) return gpu.id;
  const auto parent = std::ranges::find_if(
      gpu.parents, [&](const std::string& id) { return calibration.gpu_hashes.contains(id); });
  return parent == gpu.parents.end() ? std::string() : *parent;
}

bool credible(const Calibration& calibration, const std::string& gpu) {
  return std::ranges::all_of(calibration.parameters, [&](const CalibratedParameter& p) {
    return p.credible || !p.used || !of_interval(calibration, p, gpu);
  });
}

std::vector<std::string> interval_keys(const Calibration& calibration, const std::string& gpu) {
  std::vector<std::string> keys;
  for (const CalibratedParameter& p : calibration.parameters)
    if (of_interval(calibration, p, gpu)) keys.push_back(p.name);
  return keys;
}

FrameInterval frame_interval(const Calibration& calibration, const TimedFrame& frame, const GpuConfig& gpu,
                             const std::string& technique) {
  const std::string fitted_id = calibrated_id(calibration, gpu);
  if (fitted_id.empty()) return {};
  FrameInterval result{support_of(calibration, gpu, fitted_id, technique), {}, {}};
  GpuValues<double> values = gpu;
  const std::vector<Key> keys = keys_of(values);
  std::vector<double> gradient(calibration.parameters.size(), 0.0);
  for (std::size_t i = 0, next = 0; i < gradient.size(); ++i) {
    const CalibratedParameter& p = calibration.parameters[i];
    if (!of_interval(calibration, p, fitted_id)) continue;
    const double slope_ns = frame.slopes_ns.at(next++);
    const Key* key = find_key(keys, p.name);
    if (key && frame.time_ns > 0.0)
      gradient[i] = slope_ns * *std::get<double*>(key->slot) / frame.time_ns;  // by the logarithm
  }
  for (std::size_t i = 0; i < gradient.size(); ++i)
    if (gradient[i] != 0.0) result.by_parameter.emplace_back(id_of(calibration.parameters[i]), gradient[i]);
  const double sd = std::sqrt(log_variance(calibration.covariance, gradient) +
                              calibration.residual_log_sd * calibration.residual_log_sd);
  const double quantile = interval_quantile(calibration.quantile90, result.support);
  result.interval_ns = {frame.time_ns * std::exp(-quantile * sd), frame.time_ns * std::exp(quantile * sd)};
  return result;
}

std::optional<double> ratio_half_width(const Calibration& calibration, const ErrorSources& before,
                                       const ErrorSources& after, const Likeness& likeness) {
  if (likeness.support == Support::uncalibrated) return std::nullopt;
  const double model_variance = calibration.residual_log_sd * calibration.residual_log_sd;
  double variance = log_ratio_variance(calibration.covariance, gradient_of(calibration, before.by_parameter),
                                       gradient_of(calibration, after.by_parameter));
  const bool same_frame = likeness.gpu && likeness.scene;
  if (!likeness.technique) variance += calibration.ratio_log_sd * calibration.ratio_log_sd;
  if (likeness.technique && same_frame)
    variance += model_variance * moved_squares(before.by_unit, after.by_unit);
  if (!same_frame) variance += 2.0 * model_variance;
  // A change of the hardware is no other technique: what the fit does not know of it stands in the variance.
  const Support support = likeness.technique && same_frame ? Support::calibrated : likeness.support;
  const auto& quantiles = same_frame ? calibration.ratio_quantile90 : calibration.quantile90;
  return std::exp(interval_quantile(quantiles, support) * std::sqrt(variance));
}

IntervalModel interval_model(const Calibration& calibration) {
  IntervalModel model{.residual_log_sd = calibration.residual_log_sd,
                      .ratio_log_sd = calibration.ratio_log_sd,
                      .covariance = calibration.covariance};
  for (const Support support : {Support::calibrated, Support::interpolated, Support::extrapolated}) {
    model.quantile90[support] = interval_quantile(calibration.quantile90, support);
    model.ratio_quantile90[support] = interval_quantile(calibration.ratio_quantile90, support);
  }
  for (const CalibratedParameter& p : calibration.parameters) model.parameters.push_back(id_of(p));
  return model;
}

std::vector<std::string> interval_parameters(const Calibration& calibration, const std::string& gpu) {
  std::vector<std::string> ids;
  for (const CalibratedParameter& p : calibration.parameters)
    if (of_interval(calibration, p, gpu)) ids.push_back(id_of(p));
  return ids;
}

Support support_of(const Calibration& calibration, const GpuConfig& gpu, const std::string& technique) {
  const std::string fitted_id = calibrated_id(calibration, gpu);
  return fitted_id.empty() ? Support::uncalibrated : support_of(calibration, gpu, fitted_id, technique);
}

}  // namespace hwsim::cost_models
