// SPDX-License-Identifier: MIT
// Intervals and decisions: medians, convergence slopes and the gate's rule.
#pragma once

#include <vector>

namespace rtrays {

/// An estimate with the ends of its confidence interval.
struct Interval {
    double value = 0;
    double low = 0;
    double high = 0;
};

/// The mean of independent values, at least 2, with its interval by Student's t. Throws `Error`
/// (run failed) for fewer.
Interval mean_interval(const std::vector<double> &values, double confidence);

/// Linear interpolation between order statistics (Hyndman & Fan 1996, type 7); `p` in [0, 1].
/// Throws `Error` (run failed) on an empty sample.
double quantile(std::vector<double> values, double p);

double median(const std::vector<double> &values);

/// The median with its distribution-free interval from order statistics. The interval covers at
/// least `confidence`; throws `Error` (run failed) when the sample is too small to promise that (n
/// < 6 for 95 %).
Interval median_interval(std::vector<double> values, double confidence = 0.95);

/// Slope of y against x by least squares with weights w >= 0.
double weighted_slope(const std::vector<double> &x, const std::vector<double> &y,
                      const std::vector<double> &w);

/// The exponent k of y = c x^k by least squares on logarithms, with its interval by Student's t
/// over the residuals: for points that do not depend on each other. Needs at least 3 points, all
/// positive; throws `Error` (run failed) otherwise.
Interval power_law_exponent(const std::vector<double> &x, const std::vector<double> &y,
                            double confidence = 0.95);

/// Slope of log error against log spp with its interval.
///
/// `errors[seed][point]` are the errors (> 0) of independent seeds, each at all of `spp[point]`.
/// Points of one seed share samples, so SEEDS are resampled, never points. Weights are inverse
/// variances of the log error over seeds; the interval is a bootstrap-t (Efron & Tibshirani
/// 1993, 12.5), because with about eight seeds percentile intervals cover too little. Needs >= 8
/// seeds and >= 2 points, throws `Error` (run failed) otherwise. The resampling is seeded, so equal
/// input gives equal output.
Interval convergence_slope(const std::vector<double> &spp,
                           const std::vector<std::vector<double>> &errors, double confidence = 0.95,
                           int resamples = 4000);

/// How far the slope of mean log RMSE lies above half that of the log of the mean MSE, which alone
/// is that of the estimator, because seeds scatter: of a variable X of mean m and relative variance
/// c, E[log X] = log m
/// - c / 2 + ... Where many pixels share the error, c of squared errors is small; where rare bright
/// paths make it, c is large and falls along the ladder. Taken from its ends; arguments as of
/// `convergence_slope`.
double slope_bias_of_scatter(const std::vector<double> &spp,
                             const std::vector<std::vector<double>> &errors);

/// The z for which P(|N(0,1)| <= z) = confidence.
double normal_quantile_two_sided(double confidence);

/// The t for which P(|T| <= t) = confidence, T being Student's of so many degrees of freedom.
double student_quantile_two_sided(double confidence, double freedom);

/// Mean of log(candidate[k] / baseline[k]) as a relative change (exp(mean) - 1) with one-sided
/// bounds, each at `confidence`, from Student's t over the pairs. Both samples are errors > 0,
/// paired by index (same seed); needs >= 2 pairs, throws `Error` (run failed) otherwise.
Interval paired_error_ratio(const std::vector<double> &candidate,
                            const std::vector<double> &baseline, double confidence = 0.999);

enum class GateDecision { pass, fail, undecided };

const char *to_string(GateDecision decision);

/// One stage of the gate (architecture, "The gate"): fail when the estimate exceeds `tolerance` and
/// the lower bound exceeds 0, pass when the upper bound is below `tolerance`, undecided otherwise.
GateDecision decide_gate(const Interval &change, double tolerance = 0.05);

}  // namespace rtrays
