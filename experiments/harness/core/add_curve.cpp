// SPDX-License-Identifier: MIT
#include "experiments/harness/core/add_curve.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <vector>

#include "experiments/harness/core/agreement.h"
#include "experiments/harness/core/description.h"
#include "experiments/harness/core/document.h"
#include "experiments/harness/core/error_parts.h"
#include "renderer/base/error.h"
#include "renderer/base/files.h"

namespace rtrays {

namespace fs = std::filesystem;

namespace {

struct ListedImage {
    double seconds = 0;
    fs::path file;
};

/// Images by seed and samples per pixel.
using ListedImages = std::map<uint32_t, std::map<uint64_t, ListedImage>>;

constexpr const char *header = "spp,seed,seconds,image";
constexpr size_t least_seeds = 8, least_points = 3;

/// Parses a number. Throws `Error` (bad input) that begins with `location`.
template <class Number>
Number parse_number(const std::string &text, const std::string &location) {
    Number number{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || end != text.data() + text.size() || !(number > 0)) {
        throw input_error(fmt::format("{}: expected a positive number, got '{}'", location, text));
    }
    return number;
}

/// Splits a line into the four columns; the last one may contain commas.
std::vector<std::string> columns_of(std::string line, const std::string &location) {
    if (!line.empty() && line.back() == '\r') {
        line.pop_back();
    }
    std::vector<std::string> columns;
    for (int i = 0; i < 3; ++i) {
        const size_t comma = line.find(',');
        if (comma == std::string::npos) {
            throw input_error(fmt::format("{}: expected the columns {}", location, header));
        }
        columns.push_back(line.substr(0, comma));
        line.erase(0, comma + 1);
    }
    columns.push_back(line);
    return columns;
}

ListedImages read_list(const fs::path &list) {
    std::istringstream lines(read_file(list));
    ListedImages images;
    std::string line;
    for (int number = 1; std::getline(lines, line); ++number) {
        const std::string location = fmt::format("{}:{}", list.string(), number);
        const std::vector<std::string> columns = columns_of(line, location);
        if (number == 1) {
            if (fmt::format("{},{},{},{}", columns[0], columns[1], columns[2], columns[3]) !=
                header) {
                throw input_error(fmt::format("{}: expected the columns {}", location, header));
            }
            continue;
        }
        const auto spp = parse_number<uint64_t>(columns[0], location);
        const auto seed = parse_number<uint32_t>(columns[1], location);
        const bool is_new =
            images[seed]
                .emplace(spp, ListedImage{parse_number<double>(columns[2], location),
                                          list.parent_path() / columns[3]})
                .second;
        if (!is_new) {
            throw input_error(
                fmt::format("{}: a second image of seed {} at {} spp", location, seed, spp));
        }
    }
    return images;
}

/// Throws `Error` (bad input) unless all seeds have the same sample counts, and enough of them.
void require_ladders(const ListedImages &images, const fs::path &list) {
    if (images.size() < least_seeds) {
        throw input_error(fmt::format("{}: {} seeds; at least {} are needed for intervals",
                                      list.string(), images.size(), least_seeds));
    }
    const auto &first = images.begin()->second;
    if (first.size() < least_points) {
        throw input_error(fmt::format("{}: {} sample counts; at least {} are needed for a slope",
                                      list.string(), first.size(), least_points));
    }
    for (const auto &[seed, ladder] : images) {
        const bool same =
            ladder.size() == first.size() &&
            std::equal(ladder.begin(), ladder.end(), first.begin(),
                       [](const auto &a, const auto &b) { return a.first == b.first; });
        if (!same) {
            throw input_error(fmt::format("{}: seed {} has other sample counts than seed {}",
                                          list.string(), seed, images.begin()->first));
        }
    }
}

/// Throws `Error` (bad input) if an image says that it has another number of samples per pixel.
void require_samples(const Image &image, uint64_t spp, const fs::path &file) {
    if (image.has("samples")) {
        const auto &samples = image.channel("samples");
        const float most = *std::max_element(samples.begin(), samples.end());
        if (most != static_cast<float>(spp)) {
            throw input_error(fmt::format("{}: has {} samples per pixel, but is listed with {}",
                                          file.string(), most, spp));
        }
    }
}

Json load_run(const fs::path &path) {
    Json document = parse_document(read_file(path), path.string());
    if (document.at("kind") != "curves") {
        throw input_error(fmt::format("{}: expected a run of the kind \"curves\"", path.string()));
    }
    return document;
}

}  // namespace

fs::path add_curve(const AddCurveOptions &options) {
    const fs::path path = options.run / document_name;
    Json document = load_run(path);
    const ListedImages images = read_list(options.list);
    require_ladders(images, options.list);
    const Image reference =
        read_exr(options.run / document.at("reference").at("image").get<std::string>());
    const FirstHits first_hits = first_hits_of(
        read_exr(options.run / document.at("first_hits").at("image").get<std::string>()));

    const std::string id = "added." + file_name_of(options.label);
    for (const Json &other : document.at("curves")) {
        const bool is_same = other.at("id") == id;
        if (is_same != (other.value("label", "") == options.label)) {
            throw input_error(fmt::format(
                "--label '{}': the run has another curve '{}' of this name, or with equal file "
                "names; choose another label",
                options.label, other.at("id").get<std::string>()));
        }
    }
    std::vector<Repetition> repetitions;
    std::vector<Image> last;          // of each seed
    std::map<uint64_t, Image> early;  // of the first seed
    for (const auto &[seed, ladder] : images) {
        Repetition &repetition = repetitions.emplace_back();
        repetition.seed = seed;
        for (const auto &[spp, listed] : ladder) {
            const Image image = read_exr(listed.file);
            require_samples(image, spp, listed.file);
            try {
                repetition.points.push_back({spp, listed.seconds, listed.seconds,
                                             compute_metrics(image, reference),
                                             divide_mse(image, reference, first_hits)});
            } catch (const Error &error) {
                throw input_error(fmt::format("{}: {}", listed.file.string(), error.what()));
            }
            if (repetitions.size() == 1) {
                early[spp] = image;
            }
            if (spp == ladder.rbegin()->first) {
                last.push_back(image);
            }
        }
    }
    const AgreementPolicy policy;
    Json curve = summarise_curve(repetitions, document.at("reference").at("noise_floor").at("mse"));
    curve["id"] = id;
    curve["label"] = curve["engine"] = options.label;
    curve["scene"] = document.at("curves").at(0).at("scene");
    curve["agreement"] = to_json(test_agreement(last, reference, policy), policy);
    curve["image"] = fmt::format("images/{}.exr", id);
    curve["image_spp"] = images.begin()->second.rbegin()->first * images.size();
    curve["layers"] = curve["early_images"] = Json::array();
    for (const auto &entry : early) {
        curve["early_images"].push_back(
            {{"spp", entry.first}, {"image", fmt::format("images/{}.{}spp.exr", id, entry.first)}});
    }

    Json curves = Json::array({curve});
    for (const Json &other : document.at("curves")) {
        if (other.at("id") != id) {
            curves.push_back(other);
        }
    }
    document["curves"] = curves;
    parse_document(document.dump(), path.string());
    write_exr(average_images(last), options.run / curve["image"].get<std::string>());
    for (const Json &entry : curve["early_images"]) {
        write_exr(early.at(entry.at("spp").get<uint64_t>()),
                  options.run / entry.at("image").get<std::string>());
    }
    write_file(path, document.dump(1) + "\n");
    return path;
}

}  // namespace rtrays
