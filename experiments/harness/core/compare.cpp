// SPDX-License-Identifier: MIT
#include "experiments/harness/core/compare.h"

#include <fmt/format.h>

#include <numeric>
#include <vector>

#include "experiments/harness/core/document.h"
#include "renderer/base/image.h"

namespace rtrays {

namespace {

double mean_of(const std::vector<float> &values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

}  // namespace

nlohmann::json compare_images(const std::filesystem::path &image_path,
                              const std::filesystem::path &reference_path) {
    const Image image = read_exr(image_path), reference = read_exr(reference_path);
    nlohmann::json comparison = to_json(compute_metrics(image, reference));
    for (const std::string &name : rgb_names()) {
        comparison["mean_ratio"].push_back(mean_of(image.channel(name)) /
                                           mean_of(reference.channel(name)));
    }
    comparison["image"] = image_path.string();
    comparison["reference"] = reference_path.string();
    if (has_variance(image) && has_variance(reference)) {
        const AgreementPolicy policy;
        comparison["agreement"] = to_json(test_agreement(image, reference, policy), policy);
    }
    return comparison;
}

std::string comparison_text(const nlohmann::json &comparison) {
    std::string text;
    for (const auto &[key, field] : metric_keys) {
        text += fmt::format("{:11} {:.6g}\n", key, comparison.at(key).get<double>());
    }
    if (!comparison.contains("agreement")) {
        return text + "no agreement test: an image lacks the layers variance.*\n";
    }
    const auto &agreement = comparison.at("agreement");
    const auto &difference = agreement.at("relative_difference");
    text +=
        fmt::format("blocks      {} of {} tests reject at {} (Holm), largest |z| {:.2f} at {}\n",
                    agreement.at("rejected").get<int>(), agreement.at("tests").get<int>(),
                    agreement.at("alpha").get<double>(), agreement.at("largest_z").get<double>(),
                    agreement.at("largest_z_at").get<std::string>());
    text += fmt::format(
        "mean        {:+.4f} % [{:+.4f}, {:+.4f}]: {}\n",
        100 * difference.at("value").get<double>(), 100 * difference.at("low").get<double>(),
        100 * difference.at("high").get<double>(), agreement.at("equivalence").get<std::string>());
    return text;
}

}  // namespace rtrays
