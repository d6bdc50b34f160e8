// SPDX-License-Identifier: MIT
#include "experiments/harness/core/statistics.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <boost/math/statistics/linear_regression.hpp>
#include <boost/math/statistics/univariate_statistics.hpp>
#include <cmath>
#include <random>

#include "renderer/base/error.h"

namespace rtrays {

using boost::math::statistics::mean;
using boost::math::statistics::sample_variance;
using boost::math::statistics::simple_ordinary_least_squares;
using boost::math::statistics::variance;

namespace {

double standard_error(const std::vector<double> &values) {
    return std::sqrt(sample_variance(values) / static_cast<double>(values.size()));
}

double checked_log(double error) {
    if (!(error > 0) || !std::isfinite(error)) {
        throw run_error(fmt::format(
            "an error of {} has no logarithm; image and reference may be the same file, or the "
            "reference may be too noisy (make references)",
            error));
    }
    return std::log(error);
}

/// Inverse variances over the seeds, relative to the largest variance. Identical seeds would give a
/// point infinite weight, so variances are bounded below by 1e-6 of the largest. All weights are 1
/// if no point has any variance.
std::vector<double> inverse_variances(const std::vector<std::vector<double>> &logs) {
    std::vector<double> weights(logs.front().size());
    for (size_t p = 0; p < weights.size(); ++p) {
        std::vector<double> column;
        for (const auto &row : logs) {
            column.push_back(row[p]);
        }
        weights[p] = sample_variance(column);
    }
    const double largest = *std::max_element(weights.begin(), weights.end());
    for (double &w : weights) {
        w = largest > 0 ? largest / std::max(w, 1e-6 * largest) : 1.0;
    }
    return weights;
}

}  // namespace

Interval mean_interval(const std::vector<double> &values, double confidence) {
    if (values.size() < 2) {
        throw run_error(
            fmt::format("an interval of a mean needs at least 2 values, got {}", values.size()));
    }
    const boost::math::students_t_distribution<double> t(static_cast<double>(values.size() - 1));
    const double reach = boost::math::quantile(t, 0.5 + confidence / 2) * standard_error(values);
    const double center = mean(values);
    return {center, center - reach, center + reach};
}

double quantile(std::vector<double> values, double p) {
    if (values.empty()) {
        throw run_error("quantile of an empty sample");
    }
    std::sort(values.begin(), values.end());
    const double position = p * static_cast<double>(values.size() - 1);
    const auto below = static_cast<size_t>(position);
    const size_t above = std::min(below + 1, values.size() - 1);
    return values[below] +
           (position - static_cast<double>(below)) * (values[above] - values[below]);
}

double median(const std::vector<double> &values) {
    return quantile(values, 0.5);
}

Interval median_interval(std::vector<double> values, double confidence) {
    std::sort(values.begin(), values.end());
    const size_t n = values.size();
    // The interval from the (k+1)-th smallest to the (k+1)-th largest misses the median with
    // probability 2 P(Binomial(n, 1/2) <= k).
    if (n == 0 || 2 * std::pow(0.5, static_cast<double>(n)) > 1 - confidence) {
        throw run_error(fmt::format("{} values are too few for a {} % interval of their median", n,
                                    100 * confidence));
    }
    const boost::math::binomial_distribution<double> below(static_cast<double>(n), 0.5);
    size_t k = 0;
    while (2 * boost::math::cdf(below, static_cast<double>(k + 1)) <= 1 - confidence) {
        ++k;
    }
    return {median(values), values[k], values[n - 1 - k]};
}

double weighted_slope(const std::vector<double> &x, const std::vector<double> &y,
                      const std::vector<double> &w) {
    double sum_w = 0, mean_x = 0, mean_y = 0;
    for (size_t i = 0; i < x.size(); ++i) {
        sum_w += w[i];
        mean_x += w[i] * x[i];
        mean_y += w[i] * y[i];
    }
    mean_x /= sum_w;
    mean_y /= sum_w;
    double covariance = 0, spread = 0;
    for (size_t i = 0; i < x.size(); ++i) {
        covariance += w[i] * (x[i] - mean_x) * (y[i] - mean_y);
        spread += w[i] * (x[i] - mean_x) * (x[i] - mean_x);
    }
    if (!(spread > 0)) {
        throw run_error("a slope needs at least two distinct abscissae");
    }
    return covariance / spread;
}

Interval power_law_exponent(const std::vector<double> &x, const std::vector<double> &y,
                            double confidence) {
    const size_t n = x.size();
    if (n < 3 || y.size() != n) {
        throw run_error(fmt::format(
            "an exponent with its interval needs at least 3 points, got {} and {}", n, y.size()));
    }
    std::vector<double> log_x, log_y;
    for (size_t i = 0; i < n; ++i) {
        if (!(x[i] > 0 && y[i] > 0)) {
            throw run_error(
                fmt::format("a power law needs positive values, got ({}, {})", x[i], y[i]));
        }
        log_x.push_back(std::log(x[i]));
        log_y.push_back(std::log(y[i]));
    }
    const auto [constant, exponent] = simple_ordinary_least_squares(log_x, log_y);
    double residuals = 0;
    for (size_t i = 0; i < n; ++i) {
        residuals += std::pow(log_y[i] - constant - exponent * log_x[i], 2);
    }
    const auto freedom = static_cast<double>(n - 2);
    const double error =
        std::sqrt(residuals / freedom / (variance(log_x) * static_cast<double>(n)));
    const double reach =
        error * boost::math::quantile(boost::math::students_t(freedom), 0.5 + 0.5 * confidence);
    return {exponent, exponent - reach, exponent + reach};
}

Interval convergence_slope(const std::vector<double> &spp,
                           const std::vector<std::vector<double>> &errors, double confidence,
                           int resamples) {
    const size_t seeds = errors.size(), points = spp.size();
    if (seeds < 8 || points < 2) {
        throw run_error(fmt::format("a slope needs at least 8 seeds and 2 points, got {} and {}",
                                    seeds, points));
    }
    std::vector<double> x(points);
    std::transform(spp.begin(), spp.end(), x.begin(), checked_log);
    std::vector<std::vector<double>> logs;
    for (const auto &row : errors) {
        logs.emplace_back(row.size());
        std::transform(row.begin(), row.end(), logs.back().begin(), checked_log);
    }
    // With fixed weights the slope is linear in y: the slope of the mean curve is the mean of the
    // seeds' slopes.
    const std::vector<double> weights = inverse_variances(logs);
    std::vector<double> slopes;
    for (const auto &row : logs) {
        slopes.push_back(weighted_slope(x, row, weights));
    }
    const double center = mean(slopes), error = standard_error(slopes);
    if (!(error > 0)) {
        return {center, center, center};
    }
    std::mt19937_64 engine(0x5eed);
    std::uniform_int_distribution<size_t> pick(0, seeds - 1);
    std::vector<double> t_values;
    std::vector<double> sample(seeds);
    while (t_values.size() < static_cast<size_t>(resamples)) {
        std::generate(sample.begin(), sample.end(), [&] { return slopes[pick(engine)]; });
        const double resampled_error = standard_error(sample);
        if (resampled_error > 1e-9 * error) {  // a resample of one seed alone has no t value
            t_values.push_back((mean(sample) - center) / resampled_error);
        }
    }
    const double tail = (1 - confidence) / 2;
    return {center, center - quantile(t_values, 1 - tail) * error,
            center - quantile(t_values, tail) * error};
}

double slope_bias_of_scatter(const std::vector<double> &spp,
                             const std::vector<std::vector<double>> &errors) {
    const auto relative_variance = [&](size_t point) {
        std::vector<double> squares;
        for (const auto &row : errors) {
            squares.push_back(row.at(point) * row.at(point));
        }
        return sample_variance(squares) / (mean(squares) * mean(squares));
    };
    return (relative_variance(0) - relative_variance(spp.size() - 1)) / 4 /
           std::log(spp.back() / spp.front());
}

double normal_quantile_two_sided(double confidence) {
    return boost::math::quantile(boost::math::normal_distribution<double>(), 0.5 + confidence / 2);
}

double student_quantile_two_sided(double confidence, double freedom) {
    return boost::math::quantile(boost::math::complement(
        boost::math::students_t_distribution<double>(freedom), (1 - confidence) / 2));
}

Interval paired_error_ratio(const std::vector<double> &candidate,
                            const std::vector<double> &baseline, double confidence) {
    if (candidate.size() != baseline.size() || candidate.size() < 2) {
        throw run_error(fmt::format(
            "a paired comparison needs equal numbers of errors, at least 2, got {} and {}",
            candidate.size(), baseline.size()));
    }
    std::vector<double> ratios(candidate.size());
    for (size_t i = 0; i < ratios.size(); ++i) {
        ratios[i] = checked_log(candidate[i]) - checked_log(baseline[i]);
    }
    const boost::math::students_t_distribution<double> t(static_cast<double>(ratios.size() - 1));
    const double reach = boost::math::quantile(t, confidence) * standard_error(ratios);
    const double center = mean(ratios);
    return {std::expm1(center), std::expm1(center - reach), std::expm1(center + reach)};
}

const char *to_string(GateDecision decision) {
    switch (decision) {
        case GateDecision::pass:
            return "pass";
        case GateDecision::fail:
            return "fail";
        case GateDecision::undecided:
            return "undecided";
    }
    throw run_error("unknown gate decision");
}

GateDecision decide_gate(const Interval &change, double tolerance) {
    if (change.value > tolerance && change.low > 0) {
        return GateDecision::fail;
    }
    return change.high < tolerance ? GateDecision::pass : GateDecision::undecided;
}

}  // namespace rtrays
