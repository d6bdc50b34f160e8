// SPDX-License-Identifier: MIT
// Statistics of the measurements: intervals, medians, convergence slopes and the gate's decision.
#pragma once

#include <vector>

namespace rtrays {

/// Estimate with the bounds of its confidence interval.
struct Interval {
    double value = 0;
    double low = 0;
    double high = 0;
};

/// Returns the mean of independent values with its interval from Student's t. Throws `Error` (run
/// failed) for fewer than 2 values.
Interval mean_interval(const std::vector<double> &values, double confidence);

/// Returns a quantile by linear interpolation between order statistics (Hyndman & Fan 1996, type
/// 7); `p` in [0, 1]. Throws `Error` (run failed) for an empty sample.
double quantile(std::vector<double> values, double p);

double median(const std::vector<double> &values);

/// Returns the median with its distribution-free interval from order statistics. The interval
/// covers the median with a probability of at least `confidence`. Throws `Error` (run failed) if
/// the sample is too small for that (n < 6 for 95 %).
Interval median_interval(std::vector<double> values, double confidence = 0.95);

/// Returns the slope of y against x by least squares with weights w >= 0.
double weighted_slope(const std::vector<double> &x, const std::vector<double> &y,
                      const std::vector<double> &w);

/// Returns the exponent k of y = c x^k by least squares on logarithms. The interval comes from
/// Student's t over the residuals, so the points must be independent. Throws `Error` (run failed)
/// for fewer than 3 points and for values that are not positive.
Interval power_law_exponent(const std::vector<double> &x, const std::vector<double> &y,
                            double confidence = 0.95);

/// Returns the slope of log error against log spp with its interval.
///
/// `errors[seed][point]` is the error (> 0) of an independent seed at `spp[point]`. Points of one
/// seed share samples, so seeds are resampled, never points. Weights are inverse variances of the
/// log error over the seeds. The interval is a bootstrap-t (Efron & Tibshirani 1993, 12.5), because
/// percentile intervals of about eight seeds cover too little. The resampling is seeded, so equal
/// input gives equal output. Throws `Error` (run failed) for fewer than 8 seeds or 2 points.
Interval convergence_slope(const std::vector<double> &spp,
                           const std::vector<std::vector<double>> &errors, double confidence = 0.95,
                           int resamples = 4000);

/// Estimates the bias of a convergence slope that is caused by the scatter of the seeds.
///
/// The estimator's slope is half that of the log of the mean MSE. The slope of the mean log RMSE
/// lies above it, because E[log X] = log m - c / 2 + ... for a variable X with mean m and relative
/// variance c. If many pixels share the error, c of the squared errors is small. If rare bright
/// paths cause it, c is large and decreases with the sample count. The estimate uses the first and
/// the last sample count. The arguments are those of `convergence_slope`.
double slope_bias_of_scatter(const std::vector<double> &spp,
                             const std::vector<std::vector<double>> &errors);

/// Returns the z for which P(|N(0,1)| <= z) = confidence.
double normal_quantile_two_sided(double confidence);

/// Returns the t for which P(|T| <= t) = confidence. T has Student's distribution with `freedom`
/// degrees of freedom.
double student_quantile_two_sided(double confidence, double freedom);

/// Returns the mean of log(candidate[k] / baseline[k]) as a relative change, exp(mean) - 1. The
/// bounds are one-sided, each at `confidence`, from Student's t over the pairs. Both samples are
/// errors > 0 and are paired by index (equal seeds). Throws `Error` (run failed) for fewer than 2
/// pairs.
Interval paired_error_ratio(const std::vector<double> &candidate,
                            const std::vector<double> &baseline, double confidence = 0.999);

enum class GateDecision { pass, fail, undecided };

const char *to_string(GateDecision decision);

/// Decides one stage of the gate. It fails if the estimate exceeds `tolerance` and the lower bound
/// exceeds 0. It passes if the upper bound is below `tolerance`. Otherwise it is undecided.
GateDecision decide_gate(const Interval &change, double tolerance = 0.05);

}  // namespace rtrays
